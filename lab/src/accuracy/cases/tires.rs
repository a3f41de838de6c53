//! Tyre curves and relaxation, on a rig: a car that is led over the ground at a constant velocity and
//! does not turn. Sliding aside at a constant angle is slip across.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{
    Sim,
    reference::{Car, Plan},
};

use super::{Case, Stage, alone, case, mean};

/// Load of each wheel, newtons.
const LOAD: f64 = 1500.0 * 9.81 / 4.0;
const STIFFNESS: f32 = 80.0e3;
const BRUSH: TireModel = TireModel::Brush {
    stiffness: STIFFNESS,
};
const MAGIC: TireModel = TireModel::Magic {
    b: 10.0,
    c: 1.9,
    e: 0.97,
};
/// Relaxation length, metres.
const LENGTH: f32 = 0.5;

pub const CASES: &[Case] = &[
    alone(case(
        "vehicle A15",
        "brush: force at a slip of 0.001, of C s",
        "",
        1.0,
        0.01,
        // 1 − x + x² / 3 of it with x = C s / (3 µ N) = 0.0072.
        |s| force(s, BRUSH, 1.0e-3) * LOAD / (f64::from(STIFFNESS) * 1.0e-3),
    )),
    alone(case(
        "vehicle A15",
        "brush: force at half the slip of a full slide, of µ N",
        "",
        0.875,
        0.005,
        |s| force(s, BRUSH, (1.5 * LOAD) as f32 / STIFFNESS),
    )),
    alone(case(
        "vehicle A15",
        "brush: force at C s = 3 µ N, of µ N",
        "",
        1.0,
        0.001,
        |s| force(s, BRUSH, (3.0 * LOAD) as f32 / STIFFNESS),
    )),
    alone(case(
        "vehicle A15",
        "magic formula: force at a slip of 0.18, its peak, of µ N",
        "",
        1.0,
        0.001,
        |s| force(s, MAGIC, 0.18),
    )),
    alone(case(
        "vehicle A15",
        "magic formula: force at a slip of 1, of µ N",
        "",
        0.9145,
        0.005,
        |s| force(s, MAGIC, 1.0),
    )),
    alone(case(
        "vehicle A15",
        "gained over the relaxation length at 0.5 m/s, of the force that is missing",
        "",
        0.632,
        0.03,
        |s| relaxed(s, 0.5),
    )),
    alone(case(
        "vehicle A15",
        "gained over the relaxation length at 1 m/s, of the force that is missing",
        "",
        0.632,
        0.03,
        |s| relaxed(s, 1.0),
    )),
    // Here a tick is not short against the length.
    alone(case(
        "vehicle A15",
        "gained over the relaxation length at 10 m/s, of the force that is missing",
        "",
        0.632,
        0.03,
        |s| relaxed(s, 10.0),
    )),
];

/// Leads a car with such tyres straight ahead.
fn rig(s: &mut Stage, model: TireModel, length: f32, speed: f32) -> Option<Car> {
    let plan = Plan::reference().tire(|tire| {
        tire.along = model.clone();
        tire.across = model.clone();
        tire.relaxation_length = Vec2::splat(length);
    });
    s.park(&plan, 0.0, Quat::IDENTITY);
    s.sim.seconds(2.0);
    s.equip(
        LockedAxes::ROTATION_LOCKED
            | LockedAxes::TRANSLATION_LOCKED_X
            | LockedAxes::TRANSLATION_LOCKED_Z,
    );
    s.roll(Vec3::NEG_Z * speed);
    s.sim.seconds(0.5);
    s.own()
}

/// Force across of the wheels in parts of their load.
fn across(sim: &Sim, car: &Car) -> f64 {
    let parts: Vec<f64> = car
        .all(sim)
        .iter()
        .map(|wheel| f64::from(wheel.force.y.abs() / wheel.load.max(1.0)))
        .collect();
    mean(&parts)
}

/// Steady force across of a wheel that slips by this much of its speed, in parts of its load.
fn force(mut s: Stage, model: TireModel, slip: f32) -> f64 {
    let speed = 10.0;
    let Some(car) = rig(&mut s, model, 0.1, speed) else {
        return f64::NAN;
    };
    let ahead = (1.0 - slip * slip).max(0.0).sqrt();
    s.push(Vec3::new(slip, 0.0, -ahead) * speed);
    s.sim.seconds(1.0);
    across(&s.sim, &car)
}

/// How much of the force across that is missing after the first tick of a slide is there a relaxation
/// length later. The first tick is left out, as a speed that is set by hand counts at a crawl as one that
/// the last tick brought about. Between two ticks what is missing shrinks by equal parts on equal ways, as
/// it does by any filter of first order, exact or not.
fn relaxed(mut s: Stage, speed: f32) -> f64 {
    let model = TireModel::Linear {
        stiffness: STIFFNESS,
    };
    let Some(car) = rig(&mut s, model, LENGTH, speed) else {
        return f64::NAN;
    };
    s.push(Vec3::new(0.02, 0.0, -1.0) * speed);
    let ticks = f64::from(LENGTH / (speed * s.sim.dt()));
    let whole = ticks as usize;
    let path: Vec<f64> = (0..whole + 2)
        .map(|_| {
            s.sim.ticks(1);
            across(&s.sim, &car)
        })
        .collect();
    s.sim.seconds(f64::from(6.0 / speed));
    let last = across(&s.sim, &car);
    let missing = |i: usize| (1.0 - path[i] / last).ln();
    let part = ticks - whole as f64;
    let there = missing(whole) * (1.0 - part) + missing(whole + 1) * part;
    1.0 - (there - missing(0)).exp()
}
