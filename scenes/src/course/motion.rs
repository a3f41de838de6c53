//! Platforms that move by the clock alone.

use bevy::{math::ops, prelude::*};

use super::extras::Motion;

/// On a position-driven kinematic body: moves it as an exact function of its own time.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct CourseMotion {
    /// The motion.
    pub motion: Motion,
    /// The pose it starts from.
    pub base: Transform,
    /// Seconds of motion so far; set it to 0 to start over.
    pub time: f64,
}

/// Moves everything that has a [`CourseMotion`], in `FixedUpdate`.
#[derive(Clone, Copy, Debug, Default)]
pub struct CourseMotionPlugin;

impl Plugin for CourseMotionPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(FixedUpdate, advance);
    }
}

fn advance(time: Res<Time>, mut moving: Query<(&mut CourseMotion, &mut Transform)>) {
    let dt = time.delta_secs_f64();
    if dt == 0.0 {
        return;
    }
    for (mut motion, mut transform) in &mut moving {
        motion.time += dt;
        *transform = pose_at(&motion.motion, &motion.base, motion.time);
    }
}

/// The pose of a motion that started from `base` this many seconds ago.
pub fn pose_at(motion: &Motion, base: &Transform, time: f64) -> Transform {
    match *motion {
        Motion::Shuttle {
            travel,
            speed,
            wait_near,
            wait_far,
            ramp,
        } => {
            let travel = Vec3::from_array(travel);
            let length = f64::from(travel.length());
            // A ramp goes half as far as the speed would in its time.
            let one_way = length / f64::from(speed) + f64::from(ramp);
            let way = shuttle(time, one_way, f64::from(wait_near), f64::from(wait_far));
            let part = eased(way, f64::from(ramp) / one_way);
            base.with_translation(base.translation + travel * part as f32)
        }
        Motion::Turn { axis, rate } => {
            // Whole turns are taken out first, or single precision loses the angle after a while.
            let turns = (time * f64::from(rate)).fract();
            let half = (turns * core::f64::consts::PI) as f32;
            let (sin, cos) = ops::sin_cos(half);
            let axis = Vec3::from_array(axis).normalize_or_zero() * sin;
            let turn = Quat::from_xyzw(axis.x, axis.y, axis.z, cos);
            base.with_rotation((base.rotation * turn).normalize())
        }
    }
}

/// Part of the way to the far end, 0 to 1.
fn shuttle(time: f64, one_way: f64, wait_near: f64, wait_far: f64) -> f64 {
    let cycle = wait_near + wait_far + 2.0 * one_way;
    if one_way <= 0.0 || !cycle.is_finite() {
        return 0.0;
    }
    let t = time.rem_euclid(cycle) - wait_near;
    if t < 0.0 {
        0.0
    } else if t < one_way {
        t / one_way
    } else if t < one_way + wait_far {
        1.0
    } else {
        (1.0 - (t - one_way - wait_far) / one_way).max(0.0)
    }
}

/// The part of the way after a part of the time, when the first and the last `ramp` of the time go
/// into starting and stopping evenly.
fn eased(time: f64, ramp: f64) -> f64 {
    let speed = 1.0 / (1.0 - ramp);
    if ramp <= 0.0 {
        time
    } else if time < ramp {
        0.5 * speed * time * time / ramp
    } else if time > 1.0 - ramp {
        let rest = 1.0 - time;
        1.0 - 0.5 * speed * rest * rest / ramp
    } else {
        speed * (time - 0.5 * ramp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shuttle_waits_goes_waits_and_comes_back() {
        let lift = Motion::Shuttle {
            travel: [0.0, 3.0, 0.0],
            speed: 1.5,
            wait_near: 1.0,
            wait_far: 0.5,
            ramp: 0.0,
        };
        let base = Transform::from_xyz(1.0, 2.0, 3.0);
        for (time, height) in [
            (0.5, 0.0),
            (1.0, 0.0),
            (2.0, 1.5),
            (3.0, 3.0),
            (3.5, 3.0),
            (4.5, 1.5),
            (5.5, 0.0),
            (6.0, 0.0),
            (7.5, 1.5),
        ] {
            let at = pose_at(&lift, &base, time).translation;
            assert!(
                at.distance(Vec3::new(1.0, 2.0 + height, 3.0)) < 1e-5,
                "at {time} s: {at}"
            );
        }
    }

    #[test]
    fn a_shuttle_with_ramps_goes_at_its_speed_between_them() {
        let ferry = Motion::Shuttle {
            travel: [0.0, 0.0, -18.0],
            speed: 3.0,
            wait_near: 0.0,
            wait_far: 1.0,
            ramp: 2.0,
        };
        let at = |time: f64| -pose_at(&ferry, &Transform::IDENTITY, time).translation.z;
        // 2 s to 3 m/s are 3 m, 4 s at it are 12 m, 2 s to rest are 3 m.
        for (time, way) in [
            (1.0, 0.75),
            (2.0, 3.0),
            (4.0, 9.0),
            (6.0, 15.0),
            (8.0, 18.0),
        ] {
            assert!((at(time) - way).abs() < 1e-4, "at {time} s: {}", at(time));
        }
    }

    #[test]
    fn a_turntable_still_knows_its_angle_after_a_million_turns() {
        let table = Motion::Turn {
            axis: [0.0, 1.0, 0.0],
            rate: 1.0,
        };
        let pose = pose_at(&table, &Transform::IDENTITY, 1_000_000.25);
        let expected = Quat::from_rotation_y(core::f32::consts::FRAC_PI_2);
        assert!(pose.rotation.angle_between(expected) < 1e-5, "{pose:?}");
    }
}
