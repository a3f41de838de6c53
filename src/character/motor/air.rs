//! In the air, and on ground too steep to stand on.

use bevy::{math::ops, prelude::*};

use super::{Course, approach};

/// What a flight goes by.
pub(super) struct Flight {
    pub up: Vec3,
    /// Acceleration against up, metres per second squared.
    pub gravity: f32,
    /// Level velocity asked for.
    pub wish: Vec3,
    /// Acceleration towards it, metres per second squared.
    pub rate: f32,
    pub max_fall: f32,
    pub dt: f32,
}

impl Flight {
    /// A parabola, steered level.
    pub fn fly(&self, velocity: Vec3) -> Course {
        let climb = velocity.dot(self.up);
        let level = velocity - self.up * climb;
        let steered = if self.wish == Vec3::ZERO {
            Course::constant(level)
        } else {
            // Who is faster already than asked for is turned, not slowed.
            let ahead = self.wish.normalize();
            let speed = level.dot(ahead).max(self.wish.length());
            approach(level, ahead * speed, self.rate, self.dt)
        };
        let end = (climb - self.gravity * self.dt).max(-self.max_fall);
        let mean = if end > -self.max_fall {
            (climb + end) * 0.5
        } else {
            end.min(climb)
        };
        Course {
            mean: steered.mean + self.up * mean,
            end: steered.end + self.up * end,
        }
    }
}

/// Speed with which a jump of this height begins under this gravity, metres per second.
pub(super) fn jump_speed(height: f32, gravity: f32) -> f32 {
    ops::sqrt(2.0 * gravity.max(0.0) * height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_reaches_its_height_at_every_tick_rate() {
        for hz in [30.0, 60.0, 240.0] {
            let flight = Flight {
                up: Vec3::Y,
                gravity: 9.81,
                wish: Vec3::ZERO,
                rate: 0.0,
                max_fall: 100.0,
                dt: 1.0 / hz,
            };
            let mut v = Vec3::Y * jump_speed(1.2, 9.81);
            let (mut y, mut top) = (0.0f32, 0.0f32);
            for _ in 0..hz as u32 {
                let course = flight.fly(v);
                // The parabola's own top may lie inside a tick.
                if v.y > 0.0 && course.end.y <= 0.0 {
                    top = top.max(y + v.y * v.y / (2.0 * 9.81));
                }
                y += course.mean.y / hz;
                v = course.end;
            }
            assert!((top - 1.2).abs() < 1e-3, "{hz} Hz: {top}");
        }
    }
}
