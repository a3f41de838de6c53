//! Vehicles: our full model beside Rapier's `DynamicRayCastVehicleController`.

use bevy::{ecs::world::CommandQueue, prelude::*};
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
use embody_scenes::{
    Sim,
    terrain::StableId,
    traffic::{Driver, LOWEST, Traffic},
};

use super::{Bounds, Seen, Subject, Variant};
use crate::{
    probe::{begin, end},
    scene::Scene,
    side::Side,
};

pub const SUBJECT: Subject = Subject {
    name: "vehicles",
    one: "vehicle",
    scenes: &[
        Scene {
            name: "vehicles",
            about: "sports cars on ring roads over a wavy mesh, wheels by rays",
            warm_up: 240,
            build: |sim, side, count| traffic(sim, side, count, WheelProbe::Ray),
        },
        Scene {
            name: "vehicles_cylinders",
            about: "the same, wheels by cylinder casts",
            warm_up: 240,
            build: |sim, side, count| traffic(sim, side, count, WheelProbe::Cylinder),
        },
        Scene {
            name: "vehicles_parked",
            about: "the same, all parked",
            warm_up: 400,
            build: parked,
        },
    ],
    plugin: add_plugin,
    watch,
    // Nobody gets above this without being thrown.
    level: LOWEST - 0.3..4.0,
    count: 1000,
    steps: 300,
    variants: &[
        Variant {
            scene: "vehicles_cylinders",
            name: "cylinders",
            label: "wheels by cylinder casts, one thread",
            count: 1000,
            most: 25.0,
        },
        Variant {
            scene: "vehicles_parked",
            name: "parked",
            label: "parked",
            count: 1000,
            most: 0.3,
        },
    ],
    bounds: Bounds {
        ratio: None,
        most: Some(10.0),
        speed_up: 1.7,
        growth: 1.2,
    },
    counted: "What is timed is the vehicles' work alone: all our systems; for Rapier the update of its controllers,\n\
              which have neither engine nor gears, spinning wheels, tyre curves or anti-roll bars.",
};

fn add_plugin(app: &mut App, side: Side) {
    match side {
        Side::Ours => {
            use VehicleSystems::{Drive, Prepare, React};
            app.add_plugins(VehiclePlugin).add_systems(
                FixedPostUpdate,
                (
                    begin.before(Prepare),
                    end.after(Prepare).before(PhysicsSet::SyncBackend),
                    begin
                        .after(PhysicsSet::SyncBackend)
                        .before(EmbodySystems::Drive),
                    end.after(Drive).before(PhysicsSet::StepSimulation),
                    begin.after(PhysicsSet::Writeback).before(React),
                    end.after(React),
                ),
            );
        }
        Side::Rapier => {
            app.add_systems(
                FixedPostUpdate,
                (begin, update_controllers, end)
                    .chain()
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
            );
        }
    }
}

/// A sports car with its limited slip differential, gearbox, magic formula tyres and anti-roll bars;
/// it changes gear early, so that it does so on short roads.
fn car() -> VehiclePreset {
    let mut car = VehiclePreset::sports_car();
    if let Some(drivetrain) = &mut car.vehicle.drivetrain {
        drivetrain.gearbox.shifting = Shifting::Automatic {
            up: 3000.0,
            down: 1500.0,
        };
    }
    car
}

/// Distance of the axles, metres.
fn wheelbase(car: &VehiclePreset) -> f32 {
    let z = car.wheels.iter().map(|wheel| wheel.attachment.z);
    let (low, high) = z.fold((f32::MAX, f32::MIN), |(a, b), z| (a.min(z), b.max(z)));
    high - low
}

fn spawn(side: Side, world: &mut World, car: &VehiclePreset, at: Transform, extra: impl Bundle) {
    let entity = match side {
        Side::Ours => {
            let mut queue = CommandQueue::default();
            let entity = car.spawn(&mut Commands::new(&mut queue, world), at);
            queue.apply(world);
            entity
        }
        Side::Rapier => world.spawn((peer(car), at)).id(),
    };
    world
        .entity_mut(entity)
        .insert((Velocity::default(), extra));
}

/// The same body for Rapier's controller, which is made once the body is.
fn peer(car: &VehiclePreset) -> impl Bundle {
    let half = car.hull * 0.5;
    (
        RigidBody::Dynamic,
        Ccd::enabled(),
        Collider::compound(vec![(
            car.hull_center,
            Quat::IDENTITY,
            Collider::cuboid(half.x, half.y, half.z),
        )]),
        ColliderMassProperties::Density(0.0),
        AdditionalMassProperties::MassProperties(MassProperties {
            local_center_of_mass: car.mass.center,
            mass: car.mass.mass,
            principal_inertia_local_frame: Quat::IDENTITY,
            principal_inertia: car.mass.inertia,
        }),
        Peer::default(),
    )
}

#[derive(Component, Default)]
struct Peer(Option<DynamicRayCastVehicleController>);

/// Wheels at the same places with the same springs and friction.
fn controller(
    car: &VehiclePreset,
    body: &RapierRigidBodyHandle,
) -> DynamicRayCastVehicleController {
    let mut controller = DynamicRayCastVehicleController::new(body.0);
    controller.index_forward_axis = 2;
    let quarter = car.mass.mass / car.wheels.len() as f32;
    for wheel in &car.wheels {
        let SpringRate::RideFrequency(hz) = wheel.suspension.spring else {
            continue;
        };
        let Damper::Ratio { bump, rebound } = wheel.suspension.damping else {
            continue;
        };
        let w = core::f32::consts::TAU * hz;
        // Per kilogram of the whole car.
        let damping = 2.0 * w * quarter / car.mass.mass;
        let tuning = WheelTuning {
            suspension_stiffness: w * w * quarter / car.mass.mass,
            suspension_compression: bump * damping,
            suspension_damping: rebound * damping,
            max_suspension_travel: wheel.suspension.travel,
            side_friction_stiffness: 1.0,
            friction_slip: wheel.tire.friction.x,
            max_suspension_force: 1.0e6,
        };
        controller.add_wheel(
            wheel.attachment,
            Vec3::NEG_Y,
            Vec3::X,
            wheel.suspension.travel,
            wheel.radius,
            &tuning,
        );
    }
    controller
}

#[derive(Resource)]
struct Fleet {
    car: VehiclePreset,
    wheelbase: f32,
}

/// What a game does for Rapier's controllers: each has the whole world's queries to itself in turn.
fn update_controllers(
    time: Res<Time>,
    mut worlds: Query<(
        &mut RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )>,
    mut peers: Query<(&mut Peer, &RapierContextEntityLink, &RapierRigidBodyHandle)>,
    fleet: Res<Fleet>,
) {
    let dt = time.delta_secs();
    for (mut peer, link, body) in &mut peers {
        let Ok((simulation, mut colliders, mut bodies)) = worlds.get_mut(link.0) else {
            continue;
        };
        let controller = peer.0.get_or_insert_with(|| controller(&fleet.car, body));
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

fn traffic(sim: &mut Sim, side: Side, count: u32, probe: WheelProbe) {
    let mut car = car();
    for wheel in &mut car.wheels {
        wheel.probe = probe;
    }
    place(sim, side, count, &car);
    sim.app
        .insert_resource(Fleet {
            wheelbase: wheelbase(&car),
            car,
        })
        .add_systems(FixedUpdate, (ask_drivers, steer_ours, steer_peers).chain());
}

fn place(sim: &mut Sim, side: Side, count: u32, car: &VehiclePreset) {
    let traffic = Traffic::for_cars(count);
    let world = sim.app.world_mut();
    traffic.spawn_ground(world);
    for i in 0..count {
        let (driver, start) = traffic.driver(i);
        spawn(side, world, car, start, (StableId(i), driver));
    }
}

fn parked(sim: &mut Sim, side: Side, count: u32) {
    let car = car();
    place(sim, side, count, &car);
    let brake = |mut intents: Query<&mut VehicleIntent>| {
        for mut intent in &mut intents {
            intent.set_if_neq(VehicleIntent {
                brake: 1.0,
                ..default()
            });
        }
    };
    sim.app
        .insert_resource(Fleet {
            wheelbase: wheelbase(&car),
            car,
        })
        .add_systems(FixedUpdate, brake);
}

/// The drivers are the game's part, the same on every side and not measured.
fn ask_drivers(fleet: Res<Fleet>, mut drivers: Query<(&mut Driver, &Transform, &Velocity)>) {
    for (mut driver, at, velocity) in &mut drivers {
        driver.drive(at, velocity.linear, fleet.wheelbase);
    }
}

fn steer_ours(fleet: Res<Fleet>, mut cars: Query<(&Driver, &Velocity, &mut VehicleIntent)>) {
    let steering = &fleet.car.vehicle.steering;
    for (driver, velocity, mut intent) in &mut cars {
        // The wheel turns less at speed: asked for so that the angle is the driver's.
        let most = steering.max_angle * part(steering, velocity.linear.length());
        intent.throttle = driver.throttle;
        intent.brake = driver.brake;
        intent.steer = (driver.angle / most).clamp(-1.0, 1.0);
    }
}

/// Part of the steering angle that is left at a speed.
fn part(steering: &Steering, speed: f32) -> f32 {
    let mut before = SteerPoint {
        speed: 0.0,
        part: 1.0,
    };
    for point in &steering.speed_curve {
        if speed < point.speed {
            let t = (speed - before.speed) / (point.speed - before.speed);
            return before.part + t * (point.part - before.part);
        }
        before = *point;
    }
    before.part
}

fn steer_peers(fleet: Res<Fleet>, mut cars: Query<(&Driver, &mut Peer)>) {
    let car = &fleet.car;
    for (driver, mut peer) in &mut cars {
        let Some(controller) = &mut peer.0 else {
            continue;
        };
        for (wheel, config) in controller.wheels_mut().iter_mut().zip(&car.wheels) {
            // About the way up: to the left is positive.
            wheel.steering = -driver.angle * config.steer;
            // A sports car's 0.8 g on its driven wheels, and its 1 g of brakes as an impulse each tick.
            let driven = if config.driven { 0.5 } else { 0.0 };
            wheel.engine_force = driver.throttle * driven * 0.8 * 9.81 * car.mass.mass;
            wheel.brake = driver.brake * 0.25 * 9.81 * car.mass.mass / 60.0;
        }
    }
}

fn watch(world: &mut World) -> Vec<Seen> {
    let mut cars = world.query::<(&StableId, &Driver, &Transform)>();
    cars.iter(world)
        .map(|(id, driver, transform)| Seen {
            id: *id,
            at: transform.translation,
            wished: driver.speed,
            upright: transform.up().y > 0.3,
        })
        .collect()
}
