//! The movement layer: intent to velocity.
//!
//! Each mode is a small pure function from the present velocity to the velocity at the end of the
//! tick and the mean velocity during it. Both are exact for constant acceleration, so a jump
//! reaches its height and a run-up its length at every tick rate.

mod air;
mod config;
mod free;
mod ladder;
mod run;
mod walk;

pub use config::{CharacterMotor, CustomMotor};
pub(super) use run::{drive_motors, kept_velocity, leave_ground};
pub(super) use walk::along_ground;

use bevy::prelude::*;

/// Velocity over a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Course {
    /// Mean over the tick: what is moved, metres per second.
    pub mean: Vec3,
    /// At the end of the tick, metres per second.
    pub end: Vec3,
}

impl Course {
    pub fn constant(velocity: Vec3) -> Self {
        Self {
            mean: velocity,
            end: velocity,
        }
    }
}

/// Changes `from` towards `to` at no more than `rate` per second for `dt` seconds.
fn approach(from: Vec3, to: Vec3, rate: f32, dt: f32) -> Course {
    let change = to - from;
    let distance = change.length();
    if distance <= 0.0 || !(rate > 0.0) {
        return Course::constant(from);
    }
    let time = distance / rate;
    if time > dt {
        let end = from + change * (dt / time);
        return Course {
            mean: (from + end) * 0.5,
            end,
        };
    }
    let mean = ((from + to) * 0.5 * time + to * (dt - time)) / dt;
    Course { mean, end: to }
}

/// A velocity turned back by at most full speed.
fn limited(movement: Vec3) -> Vec3 {
    movement.clamp_length_max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_up_is_as_long_at_every_tick_rate() {
        let length = |hz: u32| {
            let (mut v, mut x) = (Vec3::ZERO, 0.0);
            for _ in 0..hz {
                let course = approach(v, Vec3::X * 5.0, 7.0, 1.0 / hz as f32);
                x += course.mean.x / hz as f32;
                v = course.end;
            }
            x
        };
        let exact = 5.0 * 5.0 / (2.0 * 7.0) + 5.0 * (1.0 - 5.0 / 7.0);
        for hz in [30, 60, 144, 240] {
            assert!((length(hz) - exact).abs() < 1e-4, "{hz} Hz: {}", length(hz));
        }
    }

    #[test]
    fn without_limit_the_speed_is_there_at_once() {
        let course = approach(Vec3::ZERO, Vec3::X, f32::INFINITY, 0.1);
        assert_eq!(course, Course::constant(Vec3::X));
    }
}
