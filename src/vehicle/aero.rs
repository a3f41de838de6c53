//! Air: drag, lift and control in flight.

use bevy::prelude::*;

/// Density of air at sea level, kilograms per cubic metre.
const AIR: f32 = 1.225;

/// The air around a vehicle. Drag is `½ ρ CdA v²` against the motion, at the centre of mass.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Aero {
    /// Drag coefficient times frontal area, square metres, at least 0; a car has 0.6 to 0.9.
    pub drag_area: f32,
    /// Down-force coefficient times area, square metres, negative lifts: at the front axle, at the
    /// rear axle.
    pub downforce_area: Vec2,
    /// Greatest torque that the driver has in the air about pitch, yaw and roll, newton-metres, each
    /// at least 0; 0 leaves flight to physics.
    pub air_control: Vec3,
}

impl Default for Aero {
    fn default() -> Self {
        Self {
            drag_area: 0.66,
            downforce_area: Vec2::ZERO,
            air_control: Vec3::ZERO,
        }
    }
}

/// Forces of the air, newtons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AirForces {
    /// World axes, at the centre of mass.
    pub drag: Vec3,
    /// Along the vehicle's down, at the front axle and at the rear axle.
    pub down: Vec2,
}

impl Aero {
    /// `velocity` relative to the air, `forward` the vehicle's, world axes. Drag is taken at the
    /// velocity that it leads to within the tick, so that no area makes it throw a light body back.
    pub(crate) fn forces(&self, velocity: Vec3, forward: Vec3, mass: f32, dt: f32) -> AirForces {
        let speed = velocity.length();
        let per_speed = 0.5 * AIR * self.drag_area * speed;
        let along = velocity.dot(forward);
        // A force that grows with the square has twice its ratio as its slope.
        let drag = -velocity * (per_speed / (1.0 + dt * per_speed / mass));
        AirForces {
            drag,
            down: self.downforce_area * (0.5 * AIR * along * along),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drag_is_that_of_the_formula_and_never_turns_the_motion() {
        let aero = Aero::default();
        let f = aero.forces(Vec3::X * 50.0, Vec3::X, 1.0e9, 0.016);
        assert!((f.drag.x + 0.5 * 1.225 * 0.66 * 2500.0).abs() < 0.1);
        let light = aero.forces(Vec3::X * 1.0e4, Vec3::X, 1.0, 0.1);
        assert!(light.drag.x * 0.1 > -1.0e4);
    }
}
