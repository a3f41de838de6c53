//! Drive: weight transfer, top speed, coasting.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::reference::{HEIGHT, MASS, Plan, RADIUS, SAG, plane};

use super::{Case, Stage, alone, case};

pub const CASES: &[Case] = &[
    case(
        "vehicle A4",
        "weight transfer at 5 m/s², of (m h + Σ I / R) a / L",
        "",
        1.0,
        0.03,
        transfer,
    ),
    alone(case(
        "vehicle A13",
        "terminal speed at 2000 N",
        "m/s",
        67.16,
        0.01,
        terminal,
    )),
    alone(case(
        "vehicle A14",
        "speed after coasting 10 s from 30 m/s",
        "m/s",
        26.75,
        0.01,
        coast,
    )),
];

/// The same car on springs of 5 Hz, so that its pitch does not shift the wheels under it.
pub fn stiff() -> Plan {
    let sag = SAG * (1.5 / 5.0) * (1.5 / 5.0);
    Plan::reference().wheel(|_, wheel| {
        wheel.suspension.spring = SpringRate::RideFrequency(5.0);
        wheel.attachment.y += SAG - sag;
    })
}

fn transfer(mut s: Stage) -> f64 {
    let force = 5.0 * MASS;
    let plan = stiff().direct(force / 4.0, |_| true);
    s.park(&plan, force, Quat::IDENTITY);
    s.sim.seconds(3.0);
    let before: f64 = s.loads()[..2].iter().sum();
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(2.5);
    let (v0, span) = (s.speed(), 0.5);
    s.sim.seconds(span);
    let a = (s.speed() - v0) / span;
    let after: f64 = s.loads()[..2].iter().sum();
    // What spins the wheels up turns the body the other way: a fiftieth more than m h a.
    let spins = 4.0 * s.wheel_inertia() / f64::from(RADIUS);
    (before - after) / ((f64::from(MASS * HEIGHT) + spins) * a / 2.8)
}

fn windy() -> Plan {
    let mut plan = Plan::reference().tire(|tire| tire.rolling_resistance = 0.012);
    plan.vehicle.aero = Some(Aero {
        drag_area: 0.66,
        ..default()
    });
    plan
}

fn terminal(mut s: Stage) -> f64 {
    let plan = windy().direct(500.0, |_| true);
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(&plan, 2000.0, Transform::from_xyz(0.0, HEIGHT, 1900.0));
    s.sim.seconds(2.0);
    // The way to a speed that is reached in minutes is cut short: it must be where the pull on both
    // sides of it is the same.
    let pull = |s: &mut Stage, from: f32| {
        s.roll(Vec3::NEG_Z * from);
        s.sim.seconds(2.0);
        let v0 = s.speed();
        s.sim.seconds(4.0);
        (0.5 * (v0 + s.speed()), (s.speed() - v0) / 4.0)
    };
    s.ask(1.0, 0.0, 0.0);
    let (v1, a1) = pull(&mut s, 65.0);
    let (v2, a2) = pull(&mut s, 70.0);
    v1 + (v2 - v1) * a1 / (a1 - a2)
}

fn coast(mut s: Stage) -> f64 {
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(&windy(), 0.0, Transform::from_xyz(0.0, HEIGHT, 500.0));
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 30.0);
    s.sim.seconds(10.0);
    s.speed()
}
