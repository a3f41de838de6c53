//! What the brakes hold each wheel with.

use arrayvec::ArrayVec;
use bevy::math::{Vec3, ops};

use super::{Axes, Found, Surroundings};
use crate::{
    backend::rigid::Rigid,
    vehicle::{
        config::Vehicle, intent::VehicleIntent, output::VehicleTelemetry, solve::MOST_WHEELS,
        state::VehicleState,
    },
};

/// Torque of the brakes on each wheel, newton-metres, rolling resistance included.
pub(super) struct BrakeTorques {
    pub torque: ArrayVec<f32, MOST_WHEELS>,
    pub abs: ArrayVec<bool, MOST_WHEELS>,
}

pub(super) fn brakes(
    s: &Surroundings,
    config: &Vehicle,
    state: &mut VehicleState,
    telemetry: &mut VehicleTelemetry,
    asked: &VehicleIntent,
    rigid: &Rigid,
    axes: &Axes,
    found: &[Found],
    speed: f32,
    ground_spin: Vec3,
) -> BrakeTorques {
    let mut pedal = asked.brake;
    if s.assists.hill.is_none() {
        state.hill_hold = 0.0;
    }
    if let Some(hill) = s.assists.hill {
        if asked.brake > 0.05 && speed.abs() < 0.5 {
            state.hill_hold = hill.time;
        } else if asked.throttle > 0.0 || speed.abs() > 0.5 {
            state.hill_hold = 0.0;
        }
        if state.hill_hold > 0.0 && asked.brake <= 0.05 {
            state.hill_hold = (state.hill_hold.min(hill.time) - s.dt).max(0.0);
            pedal = 1.0;
        }
    }
    let count = s.wheels.len().max(1) as f32;
    let middle = s.wheels.iter().map(|w| w.attachment.z).sum::<f32>() / count;
    let is_front = |z: f32| z < middle - 1.0e-3;
    let (mut front, mut rear) = (0.0f32, 0.0f32);
    for wheel in &s.wheels {
        if is_front(wheel.attachment.z) {
            front += wheel.brake;
        } else {
            rear += wheel.brake;
        }
    }
    let balance = match (front > 0.0, rear > 0.0) {
        (true, true) => config.brakes.balance,
        (true, false) => 1.0,
        _ => 0.0,
    };
    let mut out = BrakeTorques {
        torque: ArrayVec::new(),
        abs: ArrayVec::new(),
    };
    let (stability, at_front) = stability(s, state, rigid.spin - ground_spin, axes, speed);
    telemetry.stability_control = stability.abs() > 0.0;
    for (i, wheel) in s.wheels.iter().enumerate() {
        let is_front = is_front(wheel.attachment.z);
        let (part, total) = if is_front {
            (balance, front)
        } else {
            (1.0 - balance, rear)
        };
        let mut torque = if total > 0.0 {
            pedal * config.brakes.torque * part * wheel.brake / total
        } else {
            0.0
        };
        let last = &mut state.wheels[i];
        let mut holding_back = false;
        match s.assists.abs {
            Some(abs) if torque > 0.0 && found[i].contact.is_some() => {
                let along = speed.abs().max(0.1);
                let slip = (last.spin * wheel.radius).abs() / along - 1.0;
                last.abs = abs.part(last.abs, slip, along, s.dt);
                holding_back = last.abs < 0.98;
                torque *= last.abs;
            }
            _ => last.abs = 1.0,
        }
        if wheel.handbrake {
            torque += asked.handbrake * config.brakes.hand_torque;
        }
        // A yaw that is too far to the left is met by a brake on the right, and the other way round.
        let side = wheel.attachment.x.signum();
        if stability * side > 0.0 && wheel.brake > 0.0 && is_front == at_front {
            torque += stability.abs();
        }
        out.torque.push(torque);
        out.abs.push(holding_back);
    }
    out
}

/// Brake torque that stability control wants, newton-metres, positive on the right side; and whether at
/// the front: who turns too much is held by an outer front wheel, who turns too little by an inner rear
/// one, so that the axle that slides keeps its grip. `spin` and `speed` are against the ground: a turntable
/// takes the vehicle round without any slip.
fn stability(
    s: &Surroundings,
    state: &VehicleState,
    spin: Vec3,
    axes: &Axes,
    speed: f32,
) -> (f32, bool) {
    let Some(control) = s.assists.stability else {
        return (0.0, true);
    };
    if speed < 3.0 {
        return (0.0, true);
    }
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    for wheel in &s.wheels {
        low = low.min(wheel.attachment.z);
        high = high.max(wheel.attachment.z);
    }
    let wheelbase = (high - low).max(0.1);
    // To the right positive. A turn can never be tighter than the grip of the road, about 1 g.
    let most = 9.0 / speed;
    let wanted = (speed * ops::tan(state.steer_angle) / wheelbase).clamp(-most, most);
    let turning = -spin.dot(axes.up);
    let error = wanted - turning;
    let beyond = error.abs() - control.tolerance;
    if beyond <= 0.0 {
        return (0.0, true);
    }
    let too_much = turning * error < 0.0;
    // A brake on the right turns to the right.
    (beyond * control.strength * error.signum(), too_much)
}
