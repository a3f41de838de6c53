//! Wheels: entities of their own, tied to their vehicle.

use bevy::prelude::*;

use super::{output::WheelState, present::WheelPose, suspension::Suspension, tire::Tire};

/// One wheel of a vehicle. Spawn it with [`WheelOf`] its vehicle; at most
/// [`Wheel::MOST`](Self::MOST) to a vehicle.
///
/// Its [`Transform`] is written each frame, so that it is seen with its travel, steering and spin,
/// wherever it hangs in the hierarchy: below the vehicle, below a part of its model, or nowhere. A
/// model should have its axle along local `X`.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(WheelState, WheelPose, Transform)]
pub struct Wheel {
    /// Centre of the wheel at full bump, in the vehicle's axes, metres.
    pub attachment: Vec3,
    /// The way the wheel moves from bump to droop, in the vehicle's axes, unit length; straight down
    /// unless the strut leans.
    pub direction: Vec3,
    /// Metres, above 0.
    pub radius: f32,
    /// Metres, above 0.
    pub width: f32,
    /// Moment of inertia about its axle, brake disc included, kg·m², above 0; a solid wheel has half
    /// its mass times its radius squared.
    pub inertia: f32,
    /// Number of its axle, front to rear; wheels of one axle share an anti-roll bar and a differential.
    pub axle: u8,
    /// How much it takes part in steering: 1 fully, 0 not at all.
    pub steer: f32,
    /// Whether the drivetrain turns it.
    pub driven: bool,
    /// How much it takes part in the foot brake: 1 as the others, 0 not at all.
    pub brake: f32,
    /// Whether the hand brake holds it.
    pub handbrake: bool,
    /// Angle inward at the top, radians, positive on both sides.
    pub camber: f32,
    /// Angle inward at the front, radians, positive on both sides.
    pub toe: f32,
    /// Spring and damper.
    pub suspension: Suspension,
    /// The tyre.
    pub tire: Tire,
    /// How it feels for the ground.
    pub probe: WheelProbe,
}

impl Wheel {
    /// The most wheels a vehicle can have.
    pub const MOST: usize = super::solve::MOST_WHEELS;

    /// The same wheel with the inertia of a solid disc of this mass (kilograms) and its radius, and with
    /// the mass as that which follows the ground.
    pub fn with_mass(mut self, mass: f32) -> Self {
        self.inertia = 0.5 * mass * self.radius * self.radius;
        self.suspension.unsprung_mass = mass;
        self
    }
}

impl Default for Wheel {
    fn default() -> Self {
        Self {
            attachment: Vec3::ZERO,
            direction: Vec3::NEG_Y,
            radius: 0.32,
            width: 0.2,
            inertia: 1.0,
            axle: 0,
            steer: 0.0,
            driven: false,
            brake: 1.0,
            handbrake: false,
            camber: 0.0,
            toe: 0.0,
            suspension: Suspension::default(),
            tire: Tire::default(),
            probe: WheelProbe::Ray,
        }
    }
}

/// How a wheel feels for the ground.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum WheelProbe {
    /// A ray through its middle: the fastest. Falls into gaps, and takes kerbs as jumps.
    #[default]
    Ray,
    /// Parallel rays across its width, weighed alike: rides on the mean of what lies under it.
    Rays {
        /// How many, `2..=8`.
        count: u8,
    },
    /// A ball: smooth over edges that it meets from ahead and from the side.
    Sphere {
        /// Metres, above 0 and at most the wheel's radius.
        radius: f32,
    },
    /// The whole wheel: climbs kerbs with its tread. The dearest.
    Cylinder,
}

/// On a vehicle: looks for the ground only every so many ticks, as a vehicle far away may. In between
/// each wheel stands on the plane it was last found on, extended; a wheel in the air always looks.
/// Kerbs and gaps are met late by that many ticks.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ProbeInterval {
    /// Ticks from one look to the next; 1 looks in each, as does 0.
    pub ticks: u8,
}

impl Default for ProbeInterval {
    fn default() -> Self {
        Self { ticks: 4 }
    }
}

/// On a wheel: the vehicle it belongs to.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Debug, PartialEq, Clone)]
#[relationship(relationship_target = Wheels)]
pub struct WheelOf(pub Entity);

/// On a vehicle: its wheels, in the order in which they were tied to it. Kept by [`WheelOf`].
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[relationship_target(relationship = WheelOf, linked_spawn)]
pub struct Wheels(Vec<Entity>);
