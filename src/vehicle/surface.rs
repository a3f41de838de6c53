//! What the ground does to tyres.

use bevy::prelude::*;

/// Friction of a collider for tyres: scales each tyre's own coefficient. 1 is dry asphalt, 0.7 wet
/// asphalt, 0.6 gravel, 0.1 ice, 0 no friction at all. Without it a collider counts as 1, whatever
/// its Rapier friction, which is that of bodies against bodies. With a value out of its range it
/// counts as absent, and is named in a warning.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfaceFriction {
    /// Friction, at least 0.
    pub friction: f32,
    /// Factor on the tyres' rolling resistance, at least 0: sand has about 20.
    pub rolling_resistance: f32,
}

impl Default for SurfaceFriction {
    fn default() -> Self {
        Self {
            friction: 1.0,
            rolling_resistance: 1.0,
        }
    }
}

impl SurfaceFriction {
    /// This friction, and the rolling resistance of asphalt.
    pub fn new(friction: f32) -> Self {
        Self {
            friction,
            ..default()
        }
    }
}

/// Carries vehicles that stand on this collider, as a conveyor belt does, while the collider itself
/// stands still. With a value that is no number it counts as absent, and is named in a warning.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct RoadVelocity {
    /// Velocity of the surface in the collider's own axes, metres per second.
    pub linear: Vec3,
    /// Turning of the surface about the collider's origin, in its own axes, radians per second.
    pub angular: Vec3,
}

impl SurfaceFriction {
    pub(crate) fn is_sound(&self) -> bool {
        let sound = |v: f32| v >= 0.0 && v.is_finite();
        sound(self.friction) && sound(self.rolling_resistance)
    }
}

impl RoadVelocity {
    pub(crate) fn is_sound(&self) -> bool {
        self.linear.is_finite() && self.angular.is_finite()
    }
}
