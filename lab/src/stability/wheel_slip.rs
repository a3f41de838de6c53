//! Slip stiffness of the tyre against speed, of a free wheel at 60 ticks per second.
//!
//! A wheel of inertia `I` and radius `R` on a road of speed `v`; its carcass of length `σ` is stretched
//! by `u`: `u' = s − v u / σ`, and the slip velocity changes by `s' = −R² C u / (I σ)`. With
//! `κ = R² C / (I σ)` and `d = v / σ`, by trace and determinant of one tick, semi-implicit Euler is
//! stable for `κ dt² < 4 − 2 d dt`. Explicit Euler is so for `κ dt < d`, and from `d dt = 2` on soft
//! tyres break as well: there is no stiffness below which all is well.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::{
    Sim,
    reference::{Plan, RADIUS, edit, plane},
};

use super::{Limit, Map, find_limit};

const SPEEDS: [f64; 6] = [0.5, 2.0, 5.0, 10.0, 20.0, 50.0];
const HZ: f64 = 60.0;
const INERTIA: f64 = 1.0;
const LENGTH: f64 = 0.2;
const LEAST: f64 = 1.0;
const MOST: f64 = 1.0e9;
/// Slip ratio that a wheel starts with.
const START: f32 = 0.02;

pub fn map(quick: bool) -> Map {
    let speeds = if quick { &SPEEDS[3..4] } else { &SPEEDS[..] };
    let most = if quick { 1.0e7 } else { MOST };
    let mut limits: Vec<Limit> = formulas()
        .into_iter()
        .filter(|limit| speeds.contains(&limit.at))
        .collect();
    for &speed in speeds {
        limits.push(Limit {
            method: "bevy_embody",
            at: speed,
            predicted: Some(f64::INFINITY),
            measured: find_limit(1.0e3, most, |c| settles(speed as f32, c as f32)),
            ours: true,
        });
    }
    Map {
        name: "vehicle_tire",
        title: "Stiffest tyre that stays stable: a free wheel of 0.3 m and 1 kg·m² at 60 ticks per second",
        across: "speed (m/s)",
        up: "slip stiffness (N per unit of slip)",
        most,
        limits,
    }
}

/// The methods without a physics world.
pub fn formulas() -> Vec<Limit> {
    let r = f64::from(RADIUS);
    let dt = 1.0 / HZ;
    let to_stiffness = INERTIA * LENGTH / (r * r);
    let mut limits = Vec::new();
    for speed in SPEEDS {
        let d = speed / LENGTH;
        // Else a soft tyre is not stable either.
        let explicit = if d * dt < 2.0 { d / dt } else { 0.0 };
        limits.push(Limit {
            method: "explicit Euler",
            at: speed,
            predicted: Some((explicit * to_stiffness).max(LEAST)),
            measured: find_limit(LEAST, MOST, |c| decays(speed, c, dt, true)),
            ours: false,
        });
    }
    for speed in SPEEDS {
        let d = speed / LENGTH;
        let semi = ((4.0 - 2.0 * d * dt) / (dt * dt)).max(0.0);
        limits.push(Limit {
            method: "semi-implicit Euler",
            at: speed,
            predicted: Some((semi * to_stiffness).max(LEAST)),
            measured: find_limit(LEAST, MOST, |c| decays(speed, c, dt, false)),
            ours: false,
        });
    }
    limits
}

/// Whether the slip of a wheel on a road that does not slow down goes back to nothing.
fn decays(speed: f64, c: f64, dt: f64, explicit: bool) -> bool {
    let r = f64::from(RADIUS);
    let (mut u, mut s) = (0.0f64, 1.0f64);
    let mut most = 0.0f64;
    for i in 0..20_000 {
        let (u0, s0) = (u, s);
        s = s0 - dt * r * r * c / (INERTIA * LENGTH) * u0;
        u = u0 + dt * (if explicit { s0 } else { s } - speed / LENGTH * u0);
        if !(u.is_finite() && s.is_finite()) {
            return false;
        }
        if i > 15_000 {
            most = most.max(s.abs());
        }
    }
    most <= 1.0
}

/// Whether the wheels of a rolling car that turn a little too fast come back to its speed.
fn settles(speed: f32, c: f32) -> bool {
    let mut sim = Sim::with(HZ, (EmbodyCorePlugin, VehiclePlugin));
    plane(&mut sim, Quat::IDENTITY);
    let plan = Plan::reference().tire(|tire| {
        tire.along = TireModel::Linear { stiffness: c };
        tire.across = TireModel::Linear { stiffness: c };
        tire.relaxation_length = Vec2::splat(LENGTH as f32);
    });
    let car = plan.park(&mut sim, Quat::IDENTITY);
    sim.ticks(2);
    car.roll(&mut sim, Vec3::NEG_Z * speed);
    sim.ticks(2);
    edit::<VehicleState>(&mut sim, car.body, |state| {
        for wheel in &mut state.wheels {
            wheel.spin *= 1.0 + START;
        }
    });
    sim.seconds(1.0);
    let mut off = 0.0f32;
    for _ in 0..20 {
        sim.ticks(1);
        let rolling = -car.velocity(&sim).linear.z;
        for wheel in car.all(&sim) {
            let slip = (wheel.spin * RADIUS - rolling).abs();
            off = off.max(if slip.is_finite() {
                slip
            } else {
                f32::INFINITY
            });
        }
    }
    off <= START * speed
}
