//! The angles of all wheels.

use arrayvec::ArrayVec;

use super::Surroundings;
use crate::vehicle::{
    config::Vehicle, intent::VehicleIntent, solve::MOST_WHEELS, state::VehicleState,
};

/// Turns the steering towards what is asked, and tells each wheel's angle with toe, radians, positive
/// to the right.
pub(super) fn steer(
    s: &Surroundings,
    config: &Vehicle,
    state: &mut VehicleState,
    asked: &VehicleIntent,
    speed: f32,
) -> ArrayVec<f32, MOST_WHEELS> {
    let steering = &config.steering;
    let target = steering.target(asked.steer, speed);
    state.steer_angle = steering.turn(state.steer_angle, target, s.dt);
    // The turn is about the middle of the wheels that do not steer; with none, about the middle of all.
    let (mut fixed, mut fixed_count) = (0.0, 0.0f32);
    let (mut all, mut right, mut reach) = (0.0, 0.0, 0.0f32);
    for wheel in &s.wheels {
        all += wheel.attachment.z;
        right += wheel.attachment.x;
        if wheel.steer == 0.0 {
            fixed += wheel.attachment.z;
            fixed_count += 1.0;
        }
    }
    let count = s.wheels.len().max(1) as f32;
    right /= count;
    let about = if fixed_count > 0.0 {
        fixed / fixed_count
    } else {
        all / count
    };
    for wheel in &s.wheels {
        if wheel.steer != 0.0 {
            let ahead = about - wheel.attachment.z;
            if ahead.abs() > reach.abs() {
                reach = ahead;
            }
        }
    }
    s.wheels
        .iter()
        .map(|wheel| {
            let toe = if wheel.attachment.x < right {
                wheel.toe
            } else {
                -wheel.toe
            };
            if wheel.steer == 0.0 {
                return toe;
            }
            let ahead = about - wheel.attachment.z;
            let aside = wheel.attachment.x - right;
            let angle = state.steer_angle * wheel.steer;
            steering.wheel_angle(angle, ahead, aside, reach) + toe
        })
        .collect()
}
