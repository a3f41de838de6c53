//! Where the wheels point.
//!
//! The driver asks for a curvature: the angle `δ` of a bicycle of the same wheelbase, whose turn has
//! the radius `L / tan δ` about a point beside the unsteered axle. With full Ackermann geometry each
//! steered wheel stands across the line to that point, `tan δᵢ = Lᵢ / (R − xᵢ)`, so that none scrubs;
//! with none all stand parallel. Wheels behind the unsteered axle steer the other way by themselves.

use bevy::{math::ops, prelude::*};

/// How a vehicle steers.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Steering {
    /// Greatest angle of the middle of the steered axle, radians, `0..π/2`.
    pub max_angle: f32,
    /// How much of Ackermann's geometry, 0 (parallel) to 1 (no scrub); below 0 the outer wheel turns
    /// more, as on race cars.
    pub ackermann: f32,
    /// Part of the greatest angle against speed, in the order of the speeds (metres per second),
    /// straight lines between; empty leaves it whole.
    pub speed_curve: Vec<SteerPoint>,
    /// Fastest change of the angle, radians per second, above 0.
    pub rate: f32,
    /// Angle that is added to all steered wheels, radians: a bent rack, or trim.
    pub offset: f32,
    /// Torque with which steering drives the wheels of one side and brakes those of the other, for
    /// each driven wheel, newton-metres, at least 0; for tracks.
    pub skid_torque: f32,
}

impl Default for Steering {
    fn default() -> Self {
        Self {
            max_angle: 35f32.to_radians(),
            ackermann: 1.0,
            speed_curve: Vec::new(),
            rate: 2.5,
            offset: 0.0,
            skid_torque: 0.0,
        }
    }
}

/// A point of a speed curve.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct SteerPoint {
    /// Metres per second, at least 0.
    pub speed: f32,
    /// Part of the greatest angle, `0..=1`.
    pub part: f32,
}

impl Steering {
    /// The angle that is asked for at a speed, radians, positive to the right.
    pub fn target(&self, steer: f32, speed: f32) -> f32 {
        steer.clamp(-1.0, 1.0) * self.max_angle * self.part_at(speed.abs())
    }

    fn part_at(&self, speed: f32) -> f32 {
        let Some(first) = self.speed_curve.first() else {
            return 1.0;
        };
        let mut before = *first;
        for p in &self.speed_curve {
            if speed < p.speed {
                let t = (speed - before.speed) / (p.speed - before.speed).max(1.0e-6);
                return lerp(before.part, p.part, t.max(0.0));
            }
            before = *p;
        }
        before.part
    }

    /// The angle after a tick of `dt`.
    pub(crate) fn turn(&self, angle: f32, target: f32, dt: f32) -> f32 {
        let most = self.rate * dt;
        angle + (target - angle).clamp(-most, most)
    }

    /// The angle of one wheel, radians, positive to the right. `ahead` and `right` are where it is as
    /// seen from the middle of the unsteered axle, `wheelbase` the distance of the steered axle.
    pub fn wheel_angle(&self, angle: f32, ahead: f32, right: f32, wheelbase: f32) -> f32 {
        if angle == 0.0 || wheelbase.abs() < 1.0e-3 {
            return angle * ahead.signum() + self.offset;
        }
        // The turn, to the right when positive.
        let curvature = ops::tan(angle) / wheelbase.abs();
        let parallel = ops::atan(ahead * curvature);
        let meeting = ops::atan2(ahead * curvature, (1.0 - right * curvature).max(1.0e-3));
        lerp(parallel, meeting, self.ackermann) + self.offset
    }
}

fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ackermann_angles_are_those_of_the_circle() {
        let steering = Steering::default();
        for (radius, inner, outer) in [
            (10.0, 16.93, 14.53),
            (5.0, 33.69, 25.77),
            (20.0, 8.30, 7.67),
        ] {
            let angle = ops::atan(2.8f32 / radius);
            let wheel = |right| steering.wheel_angle(angle, 2.8, right, 2.8);
            let (i, o) = (wheel(0.8), wheel(-0.8));
            assert!((i.to_degrees() - inner).abs() < 0.01, "{}", i.to_degrees());
            assert!((o.to_degrees() - outer).abs() < 0.01, "{}", o.to_degrees());
            let cot = 1.0 / ops::tan(o) - 1.0 / ops::tan(i);
            assert!((cot - 1.6 / 2.8).abs() < 1.0e-3, "{cot}");
            // The mirror image, and a steered rear.
            assert!((steering.wheel_angle(-angle, 2.8, -0.8, 2.8) + i).abs() < 1.0e-6);
            assert!((steering.wheel_angle(angle, -2.8, 0.8, 2.8) + i).abs() < 1.0e-6);
        }
    }

    #[test]
    fn without_ackermann_both_wheels_stand_parallel() {
        let steering = Steering {
            ackermann: 0.0,
            ..Steering::default()
        };
        let wheel = |right| steering.wheel_angle(0.3, 2.8, right, 2.8);
        assert_eq!(wheel(0.8), wheel(-0.8));
        assert!((wheel(0.8) - 0.3).abs() < 1.0e-6);
    }

    #[test]
    fn the_angle_follows_speed_and_rate() {
        let steering = Steering {
            speed_curve: vec![
                SteerPoint {
                    speed: 10.0,
                    part: 1.0,
                },
                SteerPoint {
                    speed: 30.0,
                    part: 0.2,
                },
            ],
            max_angle: 0.5,
            rate: 1.0,
            ..Steering::default()
        };
        assert_eq!(steering.target(1.0, 5.0), 0.5);
        assert!((steering.target(-1.0, 20.0) + 0.3).abs() < 1.0e-6);
        assert!((steering.target(3.0, 90.0) - 0.1).abs() < 1.0e-6);
        assert_eq!(steering.turn(0.0, 0.5, 0.1), 0.1);
    }
}
