//! Suspension: sag, swing, drops.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::reference::{G, HEIGHT, MASS, Plan, RADIUS, SAG, plane, uphill};

use super::{Case, Stage, case, ground::platform, mean, nothing, peak};

pub const CASES: &[Case] = &[
    case("vehicle A1", "static sag", "m", 0.110_44, 0.005, sag),
    case(
        "vehicle A1",
        "load of a front wheel, centre 0.2 m ahead",
        "N",
        4204.3,
        0.005,
        front_load,
    ),
    case(
        "vehicle A1",
        "sum of loads on 20 degrees",
        "N",
        13_827.6,
        0.001,
        slope_loads,
    ),
    case(
        "vehicle A1",
        "sag on a lift that rises at 2 m/s",
        "m",
        0.110_44,
        0.005,
        |s| lift(s, 2.0),
    ),
    case(
        "vehicle A1",
        "sag on a lift that sinks at 2 m/s",
        "m",
        0.110_44,
        0.005,
        |s| lift(s, -2.0),
    ),
    Case {
        // In parts of the sag.
        scale: Some(1.0),
        ..case(
            "vehicle A2",
            "overshoot of a quarter car, of its sag",
            "",
            0.163,
            0.02,
            overshoot,
        )
    },
    case(
        "vehicle A2",
        "time of its peak",
        "s",
        0.385,
        0.03,
        peak_time,
    ),
    // (m g + √((m g)² + 2 k m g H)) / k with k = 133 240 N/m of all springs.
    case(
        "vehicle A3",
        "compression by a drop of 0.5 m, undamped",
        "m",
        0.460_64,
        0.03,
        |s| undamped(s, 0.5),
    ),
    case(
        "vehicle A3",
        "compression by a drop of 1 m, undamped",
        "m",
        0.593_22,
        0.03,
        |s| undamped(s, 1.0),
    ),
    case(
        "vehicle A3",
        "compression by a drop of 2 m, undamped",
        "m",
        0.784_20,
        0.03,
        |s| undamped(s, 2.0),
    ),
    nothing(
        "vehicle A3",
        "hull in the ground after a drop of 2 m",
        "mm",
        20.0,
        |s| drop(s, 2.0).sunk,
    ),
    nothing(
        "vehicle A3",
        "hull in the ground after a drop of 10 m",
        "mm",
        20.0,
        |s| drop(s, 10.0).sunk,
    ),
    nothing(
        "vehicle A3",
        "rebound above its rest, of a drop of 2 m",
        "",
        1.0,
        |s| drop(s, 2.0).rebound,
    ),
    case(
        "vehicle A3",
        "height 3 s after a drop of 10 m",
        "m",
        0.55,
        0.01,
        |s| drop(s, 10.0).height,
    ),
    nothing(
        "vehicle A3",
        "centre in the ground after an impact at 30 m/s",
        "mm",
        0.0,
        |s| impact(s, 30.0),
    ),
    nothing(
        "vehicle A3",
        "centre in the ground after an impact at 100 m/s",
        "mm",
        0.0,
        |s| impact(s, 100.0),
    ),
];

fn sag(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    mean(&s.compressions())
}

fn front_load(mut s: Stage) -> f64 {
    let mut plan = Plan::reference();
    plan.mass.center.z = -0.2;
    s.park(&plan, 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    mean(&s.loads()[..2])
}

fn slope_loads(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, uphill(20.0));
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(5.0);
    s.loads().iter().sum()
}

fn lift(mut s: Stage, speed: f32) -> f64 {
    platform(&mut s, Vec3::Y * speed);
    s.sim.seconds(5.0);
    mean(&s.compressions())
}

/// The path of the compression after the car is let go with slack springs.
fn step_response(s: &mut Stage) -> Vec<f64> {
    let plan = Plan::reference().suspension(|spring| spring.stop_stiffness = 0.0);
    plane(&mut s.sim, Quat::IDENTITY);
    // A little above the ground the wheels would still fall; so exactly at it.
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT + SAG, 0.0));
    let start = f64::from(s.pose().translation.y);
    let fallen = f64::from(HEIGHT + SAG) - start;
    let ticks = (1.2 / f64::from(s.sim.dt())) as usize;
    let mut path = vec![fallen];
    for _ in 0..ticks {
        s.sim.ticks(1);
        path.push(f64::from(HEIGHT + SAG - s.pose().translation.y));
    }
    path
}

fn overshoot(mut s: Stage) -> f64 {
    let path = step_response(&mut s);
    peak(&path).0 / f64::from(SAG) - 1.0
}

fn peak_time(mut s: Stage) -> f64 {
    let path = step_response(&mut s);
    // The first value of the path is that after one tick.
    (peak(&path).1 + 1.0) * f64::from(s.sim.dt())
}

/// Greatest compression of springs that are long enough for it and have neither damper nor stop.
fn undamped(mut s: Stage, height: f32) -> f64 {
    let travel = 1.2;
    let plan = Plan::reference()
        .suspension(|spring| {
            spring.travel = travel;
            spring.stop_stiffness = 0.0;
            spring.damping = Damper::Ratio {
                bump: 0.0,
                rebound: 0.0,
            };
        })
        .wheel(|_, wheel| wheel.attachment.y = 0.0);
    plane(&mut s.sim, Quat::IDENTITY);
    // The hubs hang the travel below the origin, a radius above the ground.
    let touch = travel + RADIUS;
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, touch + height, 0.0));
    let mut path = Vec::new();
    for _ in 0..(1.5 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        path.push(f64::from(touch - s.pose().translation.y));
    }
    peak(&path).0
}

/// What a drop led to.
struct Dropped {
    /// How deep the hull was in the ground, millimetres.
    sunk: f64,
    /// How far it came up again above its rest, in parts of the drop.
    rebound: f64,
    /// Where it stood after three seconds, metres.
    height: f64,
}

fn drop(mut s: Stage, height: f32) -> Dropped {
    plane(&mut s.sim, Quat::IDENTITY);
    let at = Transform::from_xyz(0.0, HEIGHT + SAG + height, 0.0);
    s.spawn(&Plan::reference(), 0.0, at);
    let fall = (2.0 * height / G).sqrt();
    let (mut sunk, mut rebound) = (0.0f32, 0.0f32);
    let dt = s.sim.dt();
    let mut t = dt;
    while t < fall + 3.0 {
        s.sim.ticks(1);
        t += dt;
        let y = s.pose().translation.y;
        // The hull's underside is 0.1 m below the origin.
        sunk = sunk.max(0.1 - y);
        if t > fall + 0.3 {
            rebound = rebound.max((y - HEIGHT) / height);
        }
    }
    Dropped {
        sunk: 1000.0 * f64::from(sunk),
        rebound: rebound.into(),
        height: s.pose().translation.y.into(),
    }
}

/// How deep the centre of a car was in the ground that hit it at this speed, millimetres.
fn impact(mut s: Stage, speed: f32) -> f64 {
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(&Plan::reference(), 0.0, Transform::from_xyz(0.0, 20.0, 0.0));
    s.push(Vec3::NEG_Y * speed);
    let mut deepest = 0.0f32;
    for _ in 0..(3.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        let y = s.pose().translation.y;
        if !y.is_finite() {
            return f64::NAN;
        }
        deepest = deepest.max(-y);
    }
    1000.0 * f64::from(deepest)
}

// What the numbers above are of.
const _: () = assert!(G > 9.8 && G < 9.82 && MASS == 1500.0);
