//! The reference car of the analytic tests, and what drives and reads it.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use crate::Sim;

/// Gravity of the harness, metres per second squared.
pub const G: f32 = 9.81;

/// Mass of the reference car, kilograms.
pub const MASS: f32 = 1500.0;
/// Distance of each axle from the centre of mass, metres.
pub const HALF_BASE: f32 = 1.4;
/// Half the track, metres.
pub const HALF_TRACK: f32 = 0.8;
/// Height of the centre of mass above the ground at rest, metres.
pub const HEIGHT: f32 = 0.55;
/// Wheel radius, metres.
pub const RADIUS: f32 = 0.3;
/// Static sag, metres: `g / (2π · 1.5 Hz)²`.
pub const SAG: f32 = 0.110_44;

/// The reference car: its vehicle, mass and wheels (front left, front right, rear left, rear right).
#[derive(Clone)]
pub struct Plan {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its mass.
    pub mass: VehicleMass,
    /// Front left, front right, rear left, rear right.
    pub wheels: Vec<Wheel>,
    /// Its collider.
    pub hull: Collider,
}

/// A tyre of friction 1 that saturates, without rolling resistance.
pub fn plain_tire() -> Tire {
    Tire {
        along: TireModel::Linear { stiffness: 100.0e3 },
        across: TireModel::Linear { stiffness: 80.0e3 },
        rolling_resistance: 0.0,
        stiffness_exponent: 0.0,
        ..default()
    }
}

impl Plan {
    /// 1500 kg, wheelbase 2.8 m, track 1.6 m, centre of mass 0.55 m up, 1.5 Hz at half of critical;
    /// no air, no engine.
    pub fn reference() -> Self {
        let wheel = |x: f32, z: f32, axle: u8| Wheel {
            // Static compression leaves the hub one radius above the ground.
            attachment: Vec3::new(x, RADIUS - HEIGHT + (0.3 - SAG), z),
            radius: RADIUS,
            inertia: 1.0,
            axle,
            steer: if axle == 0 { 1.0 } else { 0.0 },
            suspension: Suspension {
                spring: SpringRate::RideFrequency(1.5),
                damping: Damper::Ratio {
                    bump: 0.5,
                    rebound: 0.5,
                },
                travel: 0.3,
                ..default()
            },
            tire: plain_tire(),
            ..default()
        };
        Self {
            vehicle: Vehicle {
                aero: None,
                brakes: Brakes {
                    torque: 40_000.0,
                    balance: 0.5,
                    hand_torque: 20_000.0,
                },
                ..Vehicle::unpowered()
            },
            mass: VehicleMass {
                mass: MASS,
                center: Vec3::ZERO,
                inertia: Vec3::new(2400.0, 2400.0, 600.0),
            },
            wheels: vec![
                wheel(-HALF_TRACK, -HALF_BASE, 0),
                wheel(HALF_TRACK, -HALF_BASE, 0),
                wheel(-HALF_TRACK, HALF_BASE, 1),
                wheel(HALF_TRACK, HALF_BASE, 1),
            ],
            hull: Collider::compound(vec![(
                Vec3::Y * 0.1,
                Quat::IDENTITY,
                Collider::cuboid(0.8, 0.2, 1.9),
            )]),
        }
    }

    /// Springs of its own kind on every wheel.
    pub fn suspension(mut self, change: impl Fn(&mut Suspension)) -> Self {
        for wheel in &mut self.wheels {
            change(&mut wheel.suspension);
        }
        self
    }

    /// Tyres of its own kind on every wheel.
    pub fn tire(mut self, change: impl Fn(&mut Tire)) -> Self {
        for wheel in &mut self.wheels {
            change(&mut wheel.tire);
        }
        self
    }

    /// Changes every wheel, by its number.
    pub fn wheel(mut self, change: impl Fn(usize, &mut Wheel)) -> Self {
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            change(i, wheel);
        }
        self
    }

    /// Pushes these wheels with this force each, newtons, at full throttle.
    pub fn direct(mut self, force: f32, driven: impl Fn(usize) -> bool) -> Self {
        for (i, wheel) in self.wheels.iter_mut().enumerate() {
            wheel.driven = driven(i);
        }
        self.vehicle.drivetrain = Some(Drivetrain {
            source: PowerSource::Direct { force },
            ..default()
        });
        self
    }

    /// Spawns it, awake for ever.
    pub fn spawn(&self, sim: &mut Sim, at: Transform) -> Car {
        let body = sim.spawn((
            self.vehicle.clone(),
            self.mass,
            self.hull.clone(),
            Velocity::default(),
            Sleeping::disabled(),
            at,
        ));
        let wheels = self
            .wheels
            .iter()
            .map(|wheel| sim.spawn((wheel.clone(), WheelOf(body))))
            .collect();
        Car { body, wheels }
    }

    /// Spawns it at rest on the plane through the origin with this rotation.
    pub fn park(&self, sim: &mut Sim, rotation: Quat) -> Car {
        let up = rotation * Vec3::Y;
        self.spawn(
            sim,
            Transform::from_translation(up * HEIGHT).with_rotation(rotation),
        )
    }
}

/// A spawned car.
#[derive(Clone)]
pub struct Car {
    /// The vehicle.
    pub body: Entity,
    /// In the order of the plan.
    pub wheels: Vec<Entity>,
}

impl Car {
    /// What a wheel did in the last tick.
    pub fn wheel(&self, sim: &Sim, i: usize) -> WheelState {
        sim.get::<WheelState>(self.wheels[i])
    }

    /// What all wheels did.
    pub fn all(&self, sim: &Sim) -> Vec<WheelState> {
        (0..self.wheels.len()).map(|i| self.wheel(sim, i)).collect()
    }

    /// Load of each wheel, newtons.
    pub fn loads(&self, sim: &Sim) -> Vec<f32> {
        self.all(sim).iter().map(|w| w.load).collect()
    }

    /// Changes what is asked of it.
    pub fn ask(&self, sim: &mut Sim, change: impl FnOnce(&mut VehicleIntent)) {
        edit(sim, self.body, change);
    }

    /// Its velocity.
    pub fn velocity(&self, sim: &Sim) -> Velocity {
        sim.get::<Velocity>(self.body)
    }

    /// Sets its velocity, metres per second.
    pub fn push(&self, sim: &mut Sim, velocity: Vec3) {
        edit::<Velocity>(sim, self.body, |v| v.linear = velocity);
    }

    /// Sets the car in motion with its wheels rolling along.
    pub fn roll(&self, sim: &mut Sim, velocity: Vec3) {
        self.push(sim, velocity);
        let speed = velocity.length();
        edit::<VehicleState>(sim, self.body, |state| {
            for wheel in &mut state.wheels {
                wheel.spin = speed / RADIUS;
            }
        });
    }

    /// Where it is.
    pub fn pose(&self, sim: &Sim) -> Transform {
        sim.get::<Transform>(self.body)
    }

    /// What it did in the last tick.
    pub fn telemetry(&self, sim: &Sim) -> VehicleTelemetry {
        sim.get::<VehicleTelemetry>(self.body)
    }

    /// Its state.
    pub fn state(&self, sim: &Sim) -> VehicleState {
        sim.get::<VehicleState>(self.body)
    }

    /// Whether everything of the car is finite.
    pub fn finite(&self, sim: &Sim) -> bool {
        let (pose, velocity, state) = (self.pose(sim), self.velocity(sim), self.state(sim));
        pose.translation.is_finite()
            && pose.rotation.is_finite()
            && velocity.linear.is_finite()
            && velocity.angular.is_finite()
            && state
                .wheels
                .iter()
                .all(|w| w.spin.is_finite() && w.bristle.is_finite() && w.compression.is_finite())
            && self
                .all(sim)
                .iter()
                .all(|w| w.load.is_finite() && w.force.is_finite())
    }
}

/// Changes a component in place.
pub fn edit<C: Component<Mutability = bevy::ecs::component::Mutable>>(
    sim: &mut Sim,
    entity: Entity,
    change: impl FnOnce(&mut C),
) {
    if let Some(mut component) = sim.app.world_mut().get_mut::<C>(entity) {
        change(&mut component);
    }
}

/// Adds components to an entity.
pub fn insert(sim: &mut Sim, entity: Entity, bundle: impl Bundle) {
    sim.app.world_mut().entity_mut(entity).insert(bundle);
}

/// A large plane through the origin, tilted by this rotation.
pub fn plane(sim: &mut Sim, rotation: Quat) -> Entity {
    let center = rotation * (Vec3::NEG_Y * 0.5);
    sim.fixed(
        Collider::cuboid(2000.0, 0.5, 2000.0),
        Transform::from_translation(center).with_rotation(rotation),
    )
}

/// Nose up a hill of this angle, degrees.
pub fn uphill(degrees: f32) -> Quat {
    Quat::from_rotation_x(degrees.to_radians())
}

/// Side-on on a hill of this angle, degrees.
pub fn side_on(degrees: f32) -> Quat {
    Quat::from_rotation_z(degrees.to_radians())
}

/// A point after a time on the front's own way: where the nose looks.
pub fn forward(pose: &Transform) -> Vec3 {
    pose.rotation * Vec3::NEG_Z
}

/// Sine of degrees.
pub fn sin(degrees: f32) -> f32 {
    ops::sin(degrees.to_radians())
}

/// Cosine of degrees.
pub fn cos(degrees: f32) -> f32 {
    ops::cos(degrees.to_radians())
}
