//! What traction control has to know: how much the driven wheels slip, and what their tyres take up.

use super::{Found, Surroundings};
use crate::vehicle::{
    assists::{Load, TractionControl},
    drivetrain::{Drivetrain, PowerSource, motor_power, power},
    state::VehicleState,
};

/// Speed below which slips are measured as if at it, metres per second: a ratio to nothing says nothing.
const CRAWL: f32 = 3.0;

/// Greatest slip ratio of a driven wheel on the ground, positive driving in the direction of the gear, and
/// the speed that it is measured against. A vehicle that rolls the other way counts as one that stands:
/// its wheels have to push.
pub(super) fn driven_slip(s: &Surroundings, state: &VehicleState, speed: f32) -> (f32, f32) {
    let direction = if state.gear < 0 { -1.0 } else { 1.0 };
    let speed = (direction * speed).max(0.0);
    let mut most = (0.0f32, CRAWL);
    for (wheel, last) in s.wheels.iter().zip(&state.wheels) {
        if wheel.driven && last.ground.is_some() {
            let rim = direction * last.spin * wheel.radius;
            let reference = speed.max(rim).max(CRAWL);
            let slip = (rim - speed) / reference;
            if slip > most.0 {
                most = (slip, reference);
            }
        }
    }
    most
}

/// What the driven wheels have to do at a speed that slips are measured against; `weight` is the part of
/// the vehicle's weight along itself, newtons, positive forward.
pub(super) fn load(
    s: &Surroundings,
    drivetrain: &Drivetrain,
    state: &VehicleState,
    found: &[Found],
    ratio: f32,
    reference: f32,
    weight: f32,
) -> Load {
    let direction = if state.gear < 0 { -1.0 } else { 1.0 };
    let (mut taken, mut radii, mut inertia, mut count) = (0.0f32, 0.0f32, 0.0f32, 0.0f32);
    for (i, wheel) in s.wheels.iter().enumerate().filter(|(_, w)| w.driven) {
        radii += wheel.radius;
        inertia += wheel.inertia;
        count += 1.0;
        let Some(touch) = found[i].contact else {
            continue;
        };
        let along = touch.normal.cross(found[i].axle).normalize_or_zero();
        let push = -state.wheels[i].ground_force.dot(along);
        taken += (direction * push * wheel.radius).max(0.0);
    }
    let geared = ratio.abs() * drivetrain.efficiency;
    let (full, lost) = match &drivetrain.source {
        PowerSource::Direct { force } => (force * radii, 0.0),
        PowerSource::Motor(motor) => {
            inertia += motor.inertia * ratio * ratio;
            let full = motor_power(motor, state.engine_speed, 1.0, direction).torque;
            (full.abs() * geared, 0.0)
        }
        PowerSource::Engine(engine) => {
            inertia += engine.inertia * ratio * ratio;
            let drag = engine.friction + engine.viscosity * state.engine_speed.abs();
            let full = power(engine, state.engine_speed, 1.0, false, false, s.dt).torque;
            (full * geared, drag * geared)
        }
    };
    let radius = radii / count;
    let needed = (-direction * weight).max(0.0) * radius;
    let part = |torque: f32| torque / (full + lost);
    let load = Load {
        held: part(taken + lost),
        slowing: part(inertia * reference / (radius * TractionControl::TIME)),
        // Far beyond what the tyres take it only spins them.
        needed: part(needed.min(1.5 * taken) + lost),
    };
    // Between two gears nothing is driven.
    let sound = load.held + load.slowing + load.needed;
    if sound.is_finite() && full + lost > 0.0 {
        load
    } else {
        Load::default()
    }
}
