//! Kerbs, washboard, rubble.

use bevy::{math::ops, prelude::*};

use super::{
    DriveStation, DriveStep, Figures, GRAVITY, Plan,
    trace::{DriveTrace, mean, range},
};
use crate::{
    course::layout::driving::{KERB, Kerb, kerbs, rubble, washboard},
    stations::Verdict,
};

pub(super) fn stations() -> Vec<DriveStation> {
    let mut all: Vec<DriveStation> = kerbs().into_iter().map(kerb).collect();
    all.extend([waves(), stones()]);
    all
}

/// The reason why a hull does not get over something, if it does not.
fn too_low(figures: &Figures, height: f32) -> Option<String> {
    let clear = figures.clearance();
    (clear < height + 0.03).then(|| {
        format!(
            "its hull is {:.0} cm above the road, this is {:.0} cm high",
            100.0 * clear,
            100.0 * height
        )
    })
}

/// Greatest height of the centre of mass above where it was at the start.
fn rise(trace: &DriveTrace) -> f32 {
    let start = trace.samples.first().map_or(f32::NAN, |s| s.center.y);
    range(&trace.samples, |s| s.center.y).1 - start
}

fn kerb(kerb: Kerb) -> DriveStation {
    let centimetres = 100.0 * kerb.height;
    DriveStation::new(
        format!("kerb_{centimetres:02.0}"),
        format!("over a kerb of {centimetres:.0} cm and down again"),
        kerb.place,
        move |figures| {
            if let Some(why) = too_low(figures, kerb.height) {
                return Err(why);
            }
            // The angle at which the tread meets the edge, and how fast that throws a rigid wheel up.
            let radius = figures.radius();
            let cos = ((radius - kerb.height) / radius).max(0.1);
            let sin = ops::sqrt(1.0 - cos * cos);
            let travel = figures.preset.wheels[0].suspension.travel;
            if travel < 0.5 * kerb.height {
                return Err(format!(
                    "its springs give {:.0} cm, its wheels meet the edge at {:.0} degrees",
                    100.0 * travel,
                    ops::acos(cos).to_degrees()
                ));
            }
            let gentle = ops::sqrt(2.0 * GRAVITY * kerb.height) / (sin * cos);
            let speed = (0.8 * figures.top_speed()).min(4.0).min(0.9 * gentle);
            let end = KERB[0] + KERB[1] + 8.0;
            let most = 2.0 * kerb.height + 0.05;
            Ok(not_thrown(end, speed, 30.0, most))
        },
    )
}

/// Drives across something that must not lift the centre by more than `most`, metres.
fn not_thrown(end: f32, speed: f32, timeout: f32, most: f32) -> Plan {
    Plan::of([DriveStep::ahead(0.0, end, speed, timeout)])
        .ask(
            format!(
                "is not thrown: its centre rises by less than {:.0} cm",
                100.0 * most
            ),
            move |trace| {
                let got = rise(trace);
                Verdict::at_most(got.into(), most.into(), format!("{:.1} cm", 100.0 * got))
            },
        )
        .ask_upright()
}

fn waves() -> DriveStation {
    DriveStation::new(
        "washboard",
        format!(
            "{:.0} m of waves of {:.0} cm",
            washboard::WAVES[1],
            100.0 * washboard::HEIGHT
        ),
        washboard::PLACE,
        |figures| {
            if let Some(why) = too_low(figures, washboard::HEIGHT) {
                return Err(why);
            }
            let speed = (0.8 * figures.top_speed()).min(8.0);
            let end = washboard::WAVES[0] + washboard::WAVES[1];
            let weight = figures.weight();
            Ok(Plan::of([
                DriveStep::ahead(0.0, washboard::WAVES[0] + 4.0, speed, 30.0),
                DriveStep::ahead(washboard::WAVES[0] + 4.0, end - 2.0, speed, 30.0),
                DriveStep::ahead(end - 2.0, end + 8.0, speed, 30.0),
            ])
            .ask(
                "over whole waves the wheels carry its weight within 3 %",
                move |trace| {
                    let got = mean(trace.step(1), |s| s.telemetry.load / weight);
                    Verdict::close(got.into(), 1.0, 0.03, format!("{got:.3} m g"))
                },
            )
            .ask_upright())
        },
    )
}

fn stones() -> DriveStation {
    DriveStation::new(
        "rubble",
        format!("through {} loose stones", rubble::STONES),
        rubble::PLACE,
        |figures| {
            // It pushes stones before it, but those under it must not lift it off its wheels.
            if let Some(why) = too_low(figures, 0.75 * rubble::LARGEST) {
                return Err(why);
            }
            let speed = if figures.leans() { 2.0 } else { 3.0 };
            let end = rubble::FIELD[0] + rubble::FIELD[1] + 9.0;
            let most = rubble::LARGEST + 0.05;
            Ok(not_thrown(end, speed, 40.0, most))
        },
    )
}
