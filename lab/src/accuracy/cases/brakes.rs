//! Brakes: stopping, holding a hill, standing, the friction ellipse.

use bevy::prelude::*;
use embody_scenes::reference::{Plan, side_on, uphill};

use super::{Case, Stage, case, nothing};

pub const CASES: &[Case] = &[
    case(
        "vehicle A7",
        "stopping distance from 20 m/s",
        "m",
        20.387,
        0.03,
        stop,
    ),
    nothing(
        "vehicle A8",
        "creep in 10 s, braked nose up on 20 degrees",
        "mm",
        1.0,
        |s| creep(s, uphill(20.0)),
    ),
    nothing(
        "vehicle A8",
        "creep in 10 s, braked across 20 degrees",
        "mm",
        1.0,
        |s| creep(s, side_on(20.0)),
    ),
    case(
        "vehicle A8",
        "slide, braked, 32 degrees at friction 0.6",
        "m/s²",
        0.207,
        0.05,
        slide,
    ),
    nothing("vehicle A9", "drift at rest in 20 s", "mm", 0.1, drift),
    case(
        "vehicle A12",
        "greatest grip, braking and steering, of µ N",
        "",
        1.0,
        1.0e-3,
        ellipse,
    ),
];

fn stop(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 20.0);
    let from = s.pose().translation;
    s.ask(0.0, 1.0, 0.0);
    let stopped = s.time_until(20.0, |s| s.speed() < 0.01);
    if stopped.is_infinite() {
        return f64::NAN;
    }
    s.pose().translation.distance(from).into()
}

fn creep(mut s: Stage, rotation: Quat) -> f64 {
    s.park(&Plan::reference(), 0.0, rotation);
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(5.0);
    let from = s.pose().translation;
    s.sim.seconds(10.0);
    1000.0 * f64::from(s.pose().translation.distance(from))
}

fn slide(mut s: Stage) -> f64 {
    let plan = Plan::reference().tire(|tire| tire.friction = Vec2::splat(0.6));
    s.park(&plan, 0.0, uphill(32.0));
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(4.0);
    let along = |s: &Stage| f64::from(s.velocity().linear.length());
    let (v0, span) = (along(&s), 4.0);
    s.sim.seconds(span);
    (along(&s) - v0) / span
}

fn drift(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    let from = s.pose().translation;
    s.sim.seconds(20.0);
    1000.0 * f64::from(s.pose().translation.distance(from))
}

fn ellipse(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 20.0);
    s.ask(0.0, 0.3, 0.2);
    let mut most = 0.0f64;
    for _ in 0..(1.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        most = s.grips().into_iter().fold(most, f64::max);
    }
    most
}
