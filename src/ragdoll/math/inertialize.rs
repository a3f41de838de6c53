//! Going over from one motion to another without a jump of position or velocity: the difference at the
//! moment of the switch is kept as an offset that dies away by a cubic.

use bevy::{math::ops, prelude::*};

use super::rotation::{from_rotation_vector, rotation_vector};

/// A position and rotation with their rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moving {
    /// Metres.
    pub position: Vec3,
    pub rotation: Quat,
    /// Metres per second.
    pub velocity: Vec3,
    /// World axes, radians per second.
    pub spin: Vec3,
}

/// What is left of a difference.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct PoseOffset {
    /// Difference of position at the start, metres.
    pub position: Vec3,
    /// Its rate at the start, metres per second.
    pub velocity: Vec3,
    /// Rotation vector of the difference of rotation at the start, radians.
    pub rotation: Vec3,
    /// Its rate at the start, radians per second.
    pub spin: Vec3,
    /// Time since the start, seconds.
    pub age: f32,
    /// Time after which nothing is left, seconds.
    pub duration: f32,
}

/// The rate of a rotation vector at which its rotation turns with this angular velocity.
fn rate_of_rotation_vector(v: Vec3, spin: Vec3) -> Vec3 {
    let angle = v.length();
    let once = v.cross(spin);
    let twice = v.cross(once);
    let part = if angle < 1.0e-2 {
        1.0 / 12.0
    } else {
        let (sin, cos) = ops::sin_cos(angle);
        // A half turn has no limit on either side: there the plain rate is the best there is.
        if sin.abs() < 1.0e-3 {
            return spin;
        }
        1.0 / (angle * angle) - (1.0 + cos) / (2.0 * angle * sin)
    };
    spin - once * 0.5 + twice * part
}

impl PoseOffset {
    /// The offset that takes what moves as `to` to where `from` is and moves, for so many seconds.
    pub(crate) fn between(from: &Moving, to: &Moving, duration: f32) -> Self {
        let turn = from.rotation * to.rotation.inverse();
        let rotation = rotation_vector(turn);
        let spin = from.spin - turn * to.spin;
        Self {
            position: from.position - to.position,
            velocity: from.velocity - to.velocity,
            rotation,
            spin: rate_of_rotation_vector(rotation, spin),
            age: 0.0,
            duration,
        }
    }

    /// Lets time pass.
    pub(crate) fn advance(&mut self, dt: f32) {
        self.age += dt;
        if self.age >= self.duration {
            *self = Self::default();
        }
    }

    pub(crate) fn is_over(&self) -> bool {
        self.duration <= 0.0
    }

    /// A pose with what is left of the offset added.
    pub(crate) fn apply(&self, position: Vec3, rotation: Quat) -> (Vec3, Quat) {
        if self.is_over() {
            return (position, rotation);
        }
        let s = (self.age / self.duration).clamp(0.0, 1.0);
        let rest = 1.0 - s;
        let value = rest * rest * (1.0 + 2.0 * s);
        let rate = rest * rest * s * self.duration;
        (
            position + self.position * value + self.velocity * rate,
            (from_rotation_vector(self.rotation * value + self.spin * rate) * rotation).normalize(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::math::rotation::angular_velocity;

    #[test]
    fn position_and_velocity_are_kept_at_the_switch_and_forgotten_at_the_end() {
        let from = Moving {
            position: Vec3::new(1.0, 2.0, 3.0),
            rotation: Quat::from_euler(EulerRot::XYZ, 0.4, -1.0, 0.3),
            velocity: Vec3::new(-3.0, 1.0, 0.5),
            spin: Vec3::new(2.0, -4.0, 1.0),
        };
        let to = Moving {
            position: Vec3::new(1.2, 1.9, 3.3),
            rotation: Quat::from_euler(EulerRot::XYZ, -0.5, 0.2, 0.1),
            velocity: Vec3::new(0.5, 0.0, 0.0),
            spin: Vec3::new(0.0, 1.0, 0.5),
        };
        let mut offset = PoseOffset::between(&from, &to, 0.4);
        let dt = 1.0e-3;
        let at = |offset: &PoseOffset, t: f32| {
            let turn = from_rotation_vector(to.spin * t);
            offset.apply(to.position + to.velocity * t, turn * to.rotation)
        };
        let (p0, q0) = at(&offset, 0.0);
        assert!(p0.distance(from.position) < 1.0e-5);
        assert!(rotation_vector(q0 * from.rotation.inverse()).length() < 1.0e-4);
        offset.advance(dt);
        let (p1, q1) = at(&offset, dt);
        assert!(((p1 - p0) / dt).distance(from.velocity) < 0.05);
        assert!(angular_velocity(q0, q1, dt).distance(from.spin) < 0.1);
        offset.advance(0.4);
        assert!(offset.is_over());
        let (end, _) = at(&offset, 0.4);
        assert_eq!(end, to.position + to.velocity * 0.4);
    }
}
