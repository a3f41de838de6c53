//! What a vehicle is made of, as a whole.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{Ccd, RigidBody};

use super::{
    aero::Aero, drivetrain::Drivetrain, intent::VehicleIntent, output::VehicleTelemetry,
    report::VehicleReport, state::VehicleState, steering::Steering,
};

/// A vehicle on wheels: add it to an entity with a collider, give it [`Wheel`](super::Wheel)s by
/// [`WheelOf`](super::WheelOf), and it drives.
///
/// Its front is the entity's local `-Z`, its right local `+X`, its up local `+Y`. Mass and centre of
/// mass are those of the body; [`VehicleMass`](super::VehicleMass) sets them by number.
///
/// What it should do is asked through [`VehicleIntent`]; what it does is in [`VehicleTelemetry`] and
/// each wheel's [`WheelState`](super::WheelState). A value out of its range is refused with one
/// warning; the vehicle then is a body without wheels until the value is mended.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(
    VehicleIntent,
    VehicleState,
    VehicleTelemetry,
    VehicleReport,
    Transform,
    RigidBody::Dynamic,
    Ccd::enabled()
)]
pub struct Vehicle {
    /// How the wheels turn.
    pub steering: Steering,
    /// What turns the wheels; `None` for trailers and soap boxes.
    pub drivetrain: Option<Drivetrain>,
    /// What holds them.
    pub brakes: Brakes,
    /// Stiffness of the anti-roll bar of each axle by its number, newtons per metre of difference
    /// between the wheels of its two sides, at least 0; axles beyond the list have none.
    pub anti_roll: Vec<f32>,
    /// Air resistance and down-force; `None` drives on the moon.
    pub aero: Option<Aero>,
    /// Steepest ground that a wheel can stand on, radians between ground normal and the suspension's
    /// axis, `0..π/2`; steeper faces are walls to it.
    pub max_ground_angle: f32,
}

impl Default for Vehicle {
    fn default() -> Self {
        Self {
            steering: Steering::default(),
            drivetrain: Some(Drivetrain::default()),
            brakes: Brakes::default(),
            anti_roll: Vec::new(),
            aero: Some(Aero::default()),
            max_ground_angle: 65f32.to_radians(),
        }
    }
}

impl Vehicle {
    /// A vehicle that only rolls.
    pub fn unpowered() -> Self {
        Self {
            drivetrain: None,
            ..default()
        }
    }
}

/// The brakes of a vehicle.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Brakes {
    /// Torque of the foot brake on all wheels together, newton-metres, at least 0. More than the
    /// tyres hold locks the wheels.
    pub torque: f32,
    /// Part of it that goes to the front wheels, `0..=1`; the rest goes to the others.
    pub balance: f32,
    /// Torque of the hand brake on each wheel that has one, newton-metres, at least 0.
    pub hand_torque: f32,
}

impl Default for Brakes {
    fn default() -> Self {
        Self {
            torque: 8000.0,
            balance: 0.62,
            hand_torque: 2500.0,
        }
    }
}

/// Mass, centre of mass and inertia of a vehicle by number, in place of those of its own collider.
/// Colliders on children keep adding theirs.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct VehicleMass {
    /// Kilograms, above 0, wheels included.
    pub mass: f32,
    /// Centre of mass in the entity's axes, metres. Lower rolls less.
    pub center: Vec3,
    /// Moments of inertia about the entity's axes through the centre, kg·m², each above 0: pitch
    /// (`x`), yaw (`y`), roll (`z`).
    pub inertia: Vec3,
}

impl Default for VehicleMass {
    fn default() -> Self {
        Self::of_box(1200.0, Vec3::new(1.7, 1.2, 4.0), Vec3::new(0.0, -0.1, 0.0))
    }
}

impl VehicleMass {
    /// The inertia of a box of this size (metres) and mass, about a centre of mass that may lie
    /// elsewhere.
    pub fn of_box(mass: f32, size: Vec3, center: Vec3) -> Self {
        let s = size * size;
        Self {
            mass,
            center,
            inertia: Vec3::new(s.y + s.z, s.x + s.z, s.x + s.y) * (mass / 12.0),
        }
    }
}
