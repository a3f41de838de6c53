//! Bridge, seesaw, ferry, lift.

use bevy::{math::ops, prelude::*};

use super::{
    DriveSample, DriveStation, DriveStep, Plan,
    trace::{DriveTrace, after, end, mean, range},
};
use crate::{
    course::layout::driving::{bridge, car_lift, car_seesaw, ferry},
    stations::Verdict,
};

pub(super) fn stations() -> Vec<DriveStation> {
    vec![planks(), board(), deck(), lift()]
}

fn node(sample: &DriveSample, place: usize) -> Transform {
    sample
        .nodes
        .get(place)
        .copied()
        .unwrap_or(Transform::from_translation(Vec3::NAN))
}

fn planks() -> DriveStation {
    let station = DriveStation::new(
        "bridge",
        "over planks that hang on hinges",
        bridge::PLACE,
        |figures| {
            if figures.mass() > bridge::RATED {
                return Err(format!(
                    "the bridge carries {:.0} t, it weighs {:.1} t",
                    bridge::RATED / 1e3,
                    figures.mass() / 1e3
                ));
            }
            let far = bridge::END + bridge::RAMP[2];
            let high = bridge::HEIGHT;
            let line = [
                Vec3::ZERO,
                Vec3::NEG_Z * bridge::RAMP[0],
                Vec3::new(0.0, high, -bridge::RAMP[0] - bridge::RAMP[1]),
                Vec3::new(0.0, high, -far),
                Vec3::new(0.0, 0.0, -far - bridge::RAMP[1]),
                Vec3::new(0.0, 0.0, -far - bridge::RAMP[1] - 6.0),
            ];
            let speed = (0.8 * figures.top_speed()).min(4.0);
            Ok(Plan::of([DriveStep::follow(&line, speed, 40.0)])
                .ask(
                    "the planks bear it: none lower than 0.5 m above the ground",
                    |trace| {
                        let lowest = |s: &DriveSample| {
                            s.nodes
                                .iter()
                                .map(|n| n.translation.y)
                                .fold(f32::INFINITY, f32::min)
                        };
                        let (low, _) = range(&trace.samples, lowest);
                        Verdict::new(low > 0.5, format!("{low:.2} m"))
                    },
                )
                .ask("no plank parts from the next by more than 5 cm", |trace| {
                    let gap = |s: &DriveSample| {
                        s.nodes
                            .windows(2)
                            .map(|pair| {
                                let end = Vec3::Z * (0.5 * bridge::PLANK.z);
                                pair[0]
                                    .transform_point(-end)
                                    .distance(pair[1].transform_point(end))
                            })
                            .fold(0.0, f32::max)
                    };
                    let (_, most) = range(&trace.samples, gap);
                    Verdict::at_most(most.into(), 0.05, format!("{:.1} cm", 100.0 * most))
                })
                .ask_upright())
        },
    );
    (0..bridge::PLANKS).fold(station, |station, i| {
        station.track(format!("bridge.plank.{i}"))
    })
}

fn board() -> DriveStation {
    DriveStation::new(
        "car_seesaw",
        "over a board on a hinge until it tips",
        car_seesaw::PLACE,
        |figures| {
            let half = 0.5 * car_seesaw::SIZE.z;
            let hinge = -car_seesaw::HINGE.z;
            let speed = (0.7 * figures.top_speed()).min(2.5);
            let end = hinge + half + car_seesaw::RAMP + 7.0;
            // Positive while the end towards the start is down.
            let tilt =
                |s: &DriveSample| -ops::asin((node(s, 0).rotation * Vec3::Z).y.clamp(-1.0, 1.0));
            let most = car_seesaw::TILT;
            Ok(Plan::of([DriveStep::ahead(0.0, end, speed, 40.0)])
                .ask(
                    "the near end is down until it has passed the hinge",
                    move |trace| {
                        let before: Vec<DriveSample> = trace
                            .samples
                            .iter()
                            .filter(|s| s.time > 0.5 && -s.center.z < hinge - 0.4)
                            .cloned()
                            .collect();
                        let (low, _) = range(&before, tilt);
                        Verdict::new(
                            low > 0.8 * most,
                            format!("{:+.1} degrees", low.to_degrees()),
                        )
                    },
                )
                .ask("then the far end goes down", move |trace| {
                    let (low, _) = range(&trace.samples, tilt);
                    Verdict::new(
                        low < -0.8 * most,
                        format!("{:+.1} degrees", low.to_degrees()),
                    )
                })
                .ask_upright())
        },
    )
    .track(car_seesaw::BOARD)
}

/// How far it moved on what carries it since the first of these ticks, metres, along and across.
fn drift(ticks: &[DriveSample]) -> f32 {
    let spot = |s: &DriveSample| {
        let way = s.pose.translation - node(s, 0).translation;
        Vec2::new(way.x, way.z)
    };
    let Some(first) = ticks.first().map(spot) else {
        return f32::NAN;
    };
    range(ticks, |s| spot(s).distance(first)).1
}

fn ask_carried(
    plan: Plan,
    weight: f32,
    speed: f32,
    moving: fn(&DriveTrace) -> &[DriveSample],
) -> Plan {
    plan.ask("carried: at the end within 2 mm of its spot", |trace| {
        let ticks = after(trace.step(0), 1.0);
        let ends: Vec<DriveSample> = ticks
            .first()
            .into_iter()
            .chain(ticks.last())
            .cloned()
            .collect();
        let way = drift(&ends);
        Verdict::at_most(way.into(), 2e-3, format!("{:.3} mm", 1e3 * way))
    })
    .ask(
        "on the way never further from it than a tick's way",
        move |trace| {
            let way = drift(after(trace.step(0), 1.0));
            let tick = f64::from(speed) * trace.dt;
            Verdict::at_most(
                way.into(),
                tick,
                format!("{:.1} mm, a tick is {:.1} mm", 1e3 * way, 1e3 * tick),
            )
        },
    )
    .ask(
        "at constant speed the wheels carry its weight within 0.5 %",
        move |trace| {
            let got = mean(moving(trace), |s| s.telemetry.load / weight);
            Verdict::close(got.into(), 1.0, 0.005, format!("{got:.4} m g"))
        },
    )
}

fn deck() -> DriveStation {
    let arrival = ferry::WAIT + ferry::CROSSING;
    DriveStation::new(
        "ferry",
        format!("ride {:.0} m on a ferry and drive off", ferry::TRAVEL),
        ferry::PLACE,
        move |figures| {
            if figures.preset.hull.z > ferry::DECK.z {
                return Err("longer than the deck".into());
            }
            let end = ferry::TRAVEL + 0.5 * ferry::DECK.z + ferry::DOCK[0] + ferry::DOCK[1] + 4.0;
            let speed = (0.8 * figures.top_speed()).min(4.0);
            let plan = Plan::of([
                DriveStep::brake(arrival + 0.3),
                DriveStep::ahead(ferry::TRAVEL, end, speed, 40.0),
            ]);
            let plan = ask_carried(plan, figures.weight(), ferry::SPEED, |trace| {
                // Half a second after it got to its speed, until it slows down.
                let ticks = after(trace.step(0), f64::from(ferry::WAIT + ferry::RAMP) + 0.5);
                let at_speed = ferry::TRAVEL / ferry::SPEED - ferry::RAMP - 0.5;
                &ticks[..((f64::from(at_speed) / trace.dt) as usize).min(ticks.len())]
            });
            Ok(plan.ask_upright())
        },
    )
    .from(Transform::from_xyz(0.0, ferry::TOP, 0.0))
    .track(ferry::NODE)
}

fn lift() -> DriveStation {
    let arrival = car_lift::WAIT + car_lift::RISE;
    DriveStation::new(
        "car_lift",
        format!(
            "rise {:.0} m at {:.0} m/s and drive off",
            car_lift::TRAVEL,
            car_lift::SPEED
        ),
        car_lift::PLACE,
        move |figures| {
            if figures.preset.hull.z > car_lift::SIZE.z {
                return Err("longer than the platform".into());
            }
            let high = car_lift::TOP + car_lift::TRAVEL;
            let edge = 0.5 * car_lift::SIZE.z + car_lift::DECK[0];
            let line = [
                Vec3::Y * high,
                Vec3::new(0.0, high, -edge),
                Vec3::NEG_Z * (edge + car_lift::DECK[1]),
                Vec3::NEG_Z * (edge + car_lift::DECK[1] + 6.0),
            ];
            let speed = (0.8 * figures.top_speed()).min(4.0);
            let plan = Plan::of([
                DriveStep::brake(arrival + 0.5),
                DriveStep::follow(&line, speed, 40.0),
            ]);
            let plan = ask_carried(plan, figures.weight(), car_lift::SPEED, |trace| {
                // The swing of the start has died away in the last second before it slows down.
                let ticks = trace.step(0);
                let rest = f64::from(car_lift::RAMP) + 0.6;
                let count = ticks.len().saturating_sub((rest / trace.dt) as usize);
                end(&ticks[..count], 1.0)
            });
            Ok(plan.ask_upright())
        },
    )
    .from(Transform::from_xyz(0.0, car_lift::TOP, 0.0))
    .track(car_lift::NODE)
}
