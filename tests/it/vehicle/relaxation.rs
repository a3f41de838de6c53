//! How the force of a tyre builds up over the distance that it rolls.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Metres.
const LENGTH: f32 = 0.5;

/// How much of the force across that is missing after the first tick of a slide is there a relaxation
/// length later: of a car that is led over the ground at a speed and does not turn.
fn gained_over_the_length(hz: f64, speed: f32) -> f32 {
    let plan = Plan::reference().tire(|tire| {
        let linear = TireModel::Linear { stiffness: 80.0e3 };
        (tire.along, tire.across) = (linear.clone(), linear);
        tire.relaxation_length = Vec2::splat(LENGTH);
    });
    let mut sim = Sim::new(hz);
    plane(&mut sim, Quat::IDENTITY);
    let car = plan.park(&mut sim, Quat::IDENTITY);
    sim.seconds(2.0);
    let rail = LockedAxes::ROTATION_LOCKED
        | LockedAxes::TRANSLATION_LOCKED_X
        | LockedAxes::TRANSLATION_LOCKED_Z;
    insert(&mut sim, car.body, rail);
    car.roll(&mut sim, Vec3::NEG_Z * speed);
    sim.seconds(0.5);
    car.push(&mut sim, Vec3::new(0.02, 0.0, -1.0) * speed);
    let across = |sim: &Sim| {
        let parts = car.all(sim).into_iter().map(|w| w.force.y.abs() / w.load);
        parts.sum::<f32>() / 4.0
    };
    let step = speed * sim.dt();
    let mut path = Vec::new();
    while path.len() < 2 || (path.len() - 2) as f32 * step < LENGTH {
        sim.ticks(1);
        path.push(across(&sim));
    }
    sim.seconds(f64::from(6.0 / speed).max(0.5));
    let last = across(&sim);
    // Between two ticks what is missing shrinks by equal parts on equal ways.
    let missing = |i: usize| ops::ln(1.0 - path[i] / last);
    let ticks = LENGTH / step;
    let whole = ticks as usize;
    let here = missing(whole) + (missing(whole + 1) - missing(whole)) * (ticks - whole as f32);
    1.0 - ops::exp(here - missing(0))
}

#[test]
fn over_the_relaxation_length_63_percent_of_the_force_build_up_at_any_speed_and_tick_rate() {
    let mut found = Findings::new();
    for hz in RATES {
        // At 30 m/s and 30 Hz a tick is two lengths long.
        for speed in [0.5, 1.0, 10.0, 30.0] {
            let part = gained_over_the_length(hz, speed);
            found.near(format!("{hz} Hz {speed} m/s"), part, 0.632, 0.006);
        }
    }
}
