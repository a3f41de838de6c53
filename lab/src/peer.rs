//! Rapier's `DynamicRayCastVehicleController` on the same body as one of our vehicles.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::{
    plugin::context::{
        RapierContextColliders, RapierContextEntityLink, RapierContextSimulation,
        RapierRigidBodySet,
    },
    prelude::*,
    rapier::{
        control::{DynamicRayCastVehicleController, WheelTuning},
        parry::query::DefaultQueryDispatcher,
        prelude::QueryFilter as RapierFilter,
    },
};

/// The controller of a body, made once the body is.
#[derive(Component)]
pub struct Peer {
    pub wheels: Vec<Wheel>,
    mass: f32,
    pub controller: Option<DynamicRayCastVehicleController>,
}

impl Peer {
    /// What the driver does: angle of the front wheels (radians, positive to the right), force on all
    /// driven wheels together (newtons) and impulse of each brake in a tick (newton-seconds).
    pub fn ask(&mut self, angle: f32, force: f32, brake: f32) {
        let Some(controller) = &mut self.controller else {
            return;
        };
        let driven = self.wheels.iter().filter(|wheel| wheel.driven).count();
        for (wheel, config) in controller.wheels_mut().iter_mut().zip(&self.wheels) {
            // About the way up: to the left is positive.
            wheel.steering = -angle * config.steer;
            wheel.engine_force = if config.driven {
                force / driven as f32
            } else {
                0.0
            };
            wheel.brake = brake;
        }
    }
}

/// A body of this mass and hull with such wheels.
pub fn peer(mass: &VehicleMass, hull: Collider, wheels: &[Wheel]) -> impl Bundle {
    (
        RigidBody::Dynamic,
        Ccd::enabled(),
        hull,
        ColliderMassProperties::Density(0.0),
        AdditionalMassProperties::MassProperties(MassProperties {
            local_center_of_mass: mass.center,
            mass: mass.mass,
            principal_inertia_local_frame: Quat::IDENTITY,
            principal_inertia: mass.inertia,
        }),
        Velocity::default(),
        Peer {
            wheels: wheels.to_vec(),
            mass: mass.mass,
            controller: None,
        },
    )
}

/// What a game does for Rapier's controllers: each has the whole world's queries to itself in turn.
pub fn update_controllers(
    time: Res<Time>,
    mut worlds: Query<(
        &mut RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    mut peers: Query<(&mut Peer, &RapierContextEntityLink, &RapierRigidBodyHandle)>,
) {
    let dt = time.delta_secs();
    for (mut peer, link, body) in &mut peers {
        let Ok((simulation, mut colliders, mut bodies)) = worlds.get_mut(link.0) else {
            continue;
        };
        let peer = &mut *peer;
        let controller = peer
            .controller
            .get_or_insert_with(|| controller(&peer.wheels, peer.mass, body));
        let queries = simulation.broad_phase.as_query_pipeline_mut(
            &DefaultQueryDispatcher,
            &mut bodies.bodies,
            &mut colliders.colliders,
            RapierFilter::default()
                .exclude_rigid_body(body.0)
                .exclude_sensors(),
        );
        controller.update_vehicle(dt, queries);
    }
}

/// Wheels at the same places with the same springs, dampers and friction.
fn controller(
    wheels: &[Wheel],
    mass: f32,
    body: &RapierRigidBodyHandle,
) -> DynamicRayCastVehicleController {
    let mut controller = DynamicRayCastVehicleController::new(body.0);
    controller.index_forward_axis = 2;
    let share = mass / wheels.len() as f32;
    for wheel in wheels {
        let suspension = &wheel.suspension;
        let stiffness = match suspension.spring {
            SpringRate::RideFrequency(hz) => {
                let w = core::f32::consts::TAU * hz;
                share * w * w
            }
            SpringRate::Stiffness(k) => k,
        };
        let (bump, rebound) = match suspension.damping {
            Damper::Ratio { bump, rebound } => {
                let critical = 2.0 * (stiffness * share).sqrt();
                (bump * critical, rebound * critical)
            }
            Damper::Coefficient { bump, rebound } => (bump, rebound),
        };
        // Its figures are per kilogram of the whole car.
        let tuning = WheelTuning {
            suspension_stiffness: stiffness / mass,
            suspension_compression: bump / mass,
            suspension_damping: rebound / mass,
            max_suspension_travel: suspension.travel,
            side_friction_stiffness: 1.0,
            friction_slip: wheel.tire.friction.x,
            max_suspension_force: f32::MAX,
        };
        controller.add_wheel(
            wheel.attachment,
            Vec3::NEG_Y,
            Vec3::X,
            suspension.travel,
            wheel.radius,
            &tuning,
        );
    }
    controller
}
