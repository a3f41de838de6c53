//! Oval, skid pad, drag strip, ice.

use bevy::{math::ops, prelude::*};
use bevy_embody::vehicle::Differential;

use super::{
    DriveSample, DriveStation, DriveStep, Figures, GRAVITY, Plan,
    trace::{DriveTrace, end, mean, range},
};
use crate::{
    course::layout::driving::{GROUND, drag, ice, oval, skid_pad},
    stations::Verdict,
};

pub(super) fn stations() -> Vec<DriveStation> {
    vec![bank(), pad(), strip(), slippery()]
}

fn bank() -> DriveStation {
    DriveStation::new(
        "oval",
        "a lap of the oval with its 30 degree banks",
        oval::PLACE,
        |figures| {
            let speed = oval::balanced_speed().min(0.9 * figures.top_speed());
            let (sin, cos) = ops::sin_cos(oval::BANK.to_radians());
            let out = speed * speed / oval::radius();
            let lean = (GRAVITY * sin - out * cos) / (GRAVITY * cos + out * sin);
            if lean > 0.75 * figures.tipping() {
                return Err(format!(
                    "too slow for the bank: at {speed:.1} m/s {lean:.2} g pull it down, at {:.2} g it tips",
                    figures.tipping()
                ));
            }
            let line = oval::middle_line();
            let time = oval::LENGTH / speed * 1.4 + 15.0;
            let lap = DriveStep::follow(&line, speed, time);
            let weight = figures.weight();
            Ok(Plan::of([lap])
                .ask("keeps within 2.5 m of the middle of the lane", {
                    move |trace| {
                        let off = |s: &DriveSample| {
                            let nearest = line
                                .windows(2)
                                .map(|pair| distance_to(s.pose.translation, pair[0], pair[1]));
                            nearest.fold(f32::INFINITY, f32::min)
                        };
                        let (_, most) = range(&trace.samples, off);
                        Verdict::at_most(f64::from(most), 2.5, format!("{most:.2} m off it"))
                    }
                })
                .ask(
                    "in the banks the wheels carry m (g cos + v²/r sin) within 3 %",
                    move |trace| {
                        let (sin, cos) = ops::sin_cos(oval::BANK.to_radians());
                        let inside = |s: &&DriveSample| {
                            let at = s.pose.translation + oval::PLACE.origin - GROUND;
                            at.z.abs() > 0.5 * oval::STRAIGHT + 0.85 * oval::INNER
                        };
                        let banked = || trace.samples.iter().filter(inside);
                        let got = mean(banked(), |s| s.telemetry.load / weight);
                        let wanted = mean(banked(), |s| {
                            let at = s.pose.translation + oval::PLACE.origin - GROUND;
                            let middle = 0.5 * oval::STRAIGHT * at.z.signum();
                            let radius = ops::hypot(at.x, at.z - middle);
                            cos + sin * s.velocity.length_squared() / (radius * GRAVITY)
                        });
                        Verdict::close(
                            got.into(),
                            wanted.into(),
                            0.03,
                            format!("{got:.3} m g for {wanted:.3} m g"),
                        )
                    },
                )
                .ask_upright())
        },
    )
}

/// Distance of a point from a piece of a line, across.
fn distance_to(point: Vec3, a: Vec3, b: Vec3) -> f32 {
    let way = b - a;
    let t = ((point - a).dot(way) / way.length_squared().max(1e-9)).clamp(0.0, 1.0);
    point.distance(a + way * t)
}

fn circle(radius: f32, laps: f32) -> Vec<Vec3> {
    let pieces = (96.0 * laps) as usize;
    (0..=pieces)
        .map(|i| {
            let (sin, cos) = ops::sin_cos(core::f32::consts::TAU * i as f32 / 96.0);
            skid_pad::CENTER + Vec3::new(cos, 0.0, -sin) * radius
        })
        .collect()
}

fn radius_of(sample: &DriveSample) -> f32 {
    let way = sample.pose.translation - skid_pad::CENTER;
    ops::hypot(way.x, way.z)
}

fn pad() -> DriveStation {
    DriveStation::new(
        "skid_pad",
        "the circle of 20 m",
        skid_pad::PLACE,
        |figures| {
            let radius = skid_pad::CIRCLES[1];
            // What tyres, tipping and lean allow, in g.
            let tires = figures.grip(0.0, 0.0, |_| true).y / figures.weight();
            let lean = if figures.leans() { 0.8 } else { f32::INFINITY };
            // Half of the tyres' grip goes into turning tracks against their own length.
            let scrub = if figures.tracked() {
                0.35 * tires
            } else {
                f32::INFINITY
            };
            // Turning shifts load to the outer wheels, and tyres under load hold less of it.
            let tires = tires * {
                let tire = &figures.preset.wheels[0].tire;
                let mean = figures.weight() / figures.preset.wheels.len() as f32;
                let shift = if figures.leans() {
                    0.0
                } else {
                    tires / figures.tipping()
                };
                let loaded = mean / tire.nominal_load;
                let plain = 1.0 - tire.load_sensitivity * (loaded - 1.0);
                (plain - tire.load_sensitivity * loaded * shift * shift) / plain
            };
            let limit = tires.min(0.75 * figures.tipping()).min(lean).min(scrub);
            let top = 0.9 * figures.top_speed();
            let steady = ops::sqrt(0.7 * limit * GRAVITY * radius).min(top);
            let most = ops::sqrt(1.2 * tires * GRAVITY * radius);
            // A rigid axle scrubs in every turn, so it never has all of its grip to the side.
            let rigid = figures.preset.vehicle.drivetrain.as_ref().is_some_and(|d| {
                d.axles
                    .iter()
                    .any(|axle| axle.differential == Differential::Locked)
            });
            let slides = limit == tires && most < top && !figures.leans() && !rigid;
            let mut steps = vec![DriveStep::follow(
                &circle(radius, 1.4),
                steady,
                9.0 * radius / steady + 15.0,
            )];
            if slides {
                // Faster by and by, until it does not hold the circle any more.
                let laps = circle(radius, 3.0);
                let count = 12;
                for i in 0..count {
                    let from = (0.4 * 96.0) as usize + 16 * i;
                    let part = i as f32 / (count - 1) as f32;
                    let speed = ops::sqrt((0.8 + 0.2 * part) * tires * GRAVITY * radius);
                    steps.push(DriveStep::follow(&laps[from..=from + 16], speed, 15.0));
                }
            }
            let asked = steady * steady / (radius * GRAVITY);
            let plan = Plan::of(steps).ask(
                format!("at {asked:.2} g holds the circle within 1.5 m"),
                move |trace| {
                    let ticks = end(trace.step(0), 3.0);
                    let (near, far) = range(ticks, radius_of);
                    let off = (near - radius).abs().max((far - radius).abs());
                    let got = mean(ticks, |s| {
                        s.velocity.length_squared() / (radius_of(s) * GRAVITY)
                    });
                    Verdict::new(
                        off <= 1.5 && (got / asked - 1.0).abs() < 0.15,
                        format!("{near:.2} to {far:.2} m at {got:.2} g"),
                    )
                },
            );
            let plan = if slides {
                plan.ask("at its limit it corners with µ g, less what its steered wheels' angle takes, within 12 %", move |trace| {
                    let side = |s: &DriveSample| s.telemetry.acceleration.x.abs() / GRAVITY;
                    let second = (1.0 / trace.dt) as usize;
                    let got = trace
                        .samples
                        .windows(second)
                        .step_by(4)
                        .map(|ticks| mean(ticks, side))
                        .fold(0.0, f32::max);
                    Verdict::close(got.into(), tires.into(), 0.12, format!("{got:.3} g for {tires:.3} g"))
                })
            } else {
                plan
            };
            Ok(plan.ask_upright())
        },
    )
}

fn strip() -> DriveStation {
    DriveStation::new(
        "drag",
        format!("{:.0} m from a standstill", drag::LENGTH),
        drag::PLACE,
        |figures| {
            let sprint = figures.sprint(drag::LENGTH);
            let run = DriveStep::ahead(0.0, drag::LENGTH, f32::INFINITY, 1.5 * sprint.time + 5.0);
            Ok(Plan::of([run])
                .ask(
                    format!(
                        "takes {:.2} s by mass, power and grip, within 6 %",
                        sprint.time
                    ),
                    move |trace| {
                        let moves = trace.samples.iter().find(|s| s.telemetry.speed > 0.05);
                        match (moves, trace.last()) {
                            (Some(first), Some(last)) => {
                                let got = last.time - first.time;
                                Verdict::close(
                                    got,
                                    sprint.time.into(),
                                    0.06,
                                    format!("{got:.2} s, {:.0} km/h", 3.6 * last.telemetry.speed),
                                )
                            }
                            _ => Verdict::never("moved"),
                        }
                    },
                )
                .ask("stays within 1 m of its line", |trace| {
                    let (low, high) = range(&trace.samples, |s| s.pose.translation.x);
                    let off = high.max(-low);
                    Verdict::at_most(off.into(), 1.0, format!("{off:.2} m off it"))
                }))
        },
    )
}

/// Deceleration between 80 and 20 % of the speed at which a stop begins, metres per second squared.
fn braking(trace: &DriveTrace, step: usize) -> Option<f32> {
    let ticks = trace.step(step);
    let speed = |s: &DriveSample| s.velocity.length();
    let begin = speed(ticks.first()?);
    let at = |part: f32| ticks.iter().find(|s| speed(s) <= part * begin);
    let (a, b) = (at(0.8)?, at(0.2)?);
    let way = a.pose.translation.distance(b.pose.translation);
    Some((speed(a) * speed(a) - speed(b) * speed(b)) / (2.0 * way))
}

fn slippery() -> DriveStation {
    DriveStation::new(
        "ice",
        "brake on wet ground and on ice",
        ice::PLACE,
        |figures| {
            let speed = (0.85 * figures.top_speed()).min(7.0);
            let timeout = 60.0 / speed + 15.0;
            let steps = [
                DriveStep::ahead(0.0, ice::WET[0] + 6.0, speed, timeout),
                DriveStep::Stop { timeout: 20.0 },
                DriveStep::ahead(ice::WET[0] + 6.0, ice::ICE[0] + 8.0, speed, 1.5 * timeout),
                DriveStep::Stop { timeout: 60.0 },
            ];
            // All wheels locked, or only those that have brakes.
            let wanted = |figures: &Figures, surface: f32| {
                let tire = &figures.preset.wheels[0].tire;
                let part = Figures::sliding(&tire.along) * surface;
                let mut slowing = 0.0;
                for _ in 0..20 {
                    let locked = figures.grip(0.0, -slowing, |w| figures.foot_brake(w) > 0.0);
                    let rolling: f32 = figures
                        .preset
                        .wheels
                        .iter()
                        .zip(figures.loads(0.0, -slowing))
                        .filter(|(w, _)| figures.foot_brake(w) == 0.0)
                        .map(|(_, load)| tire.rolling_resistance * load)
                        .sum();
                    slowing = (locked.x * part + rolling) / figures.mass();
                }
                slowing
            };
            let [wet, icy] = [ice::WET_FRICTION, ice::ICE_FRICTION].map(|mu| wanted(figures, mu));
            let judge = move |step: usize, wanted: f32| {
                move |trace: &DriveTrace| match braking(trace, step) {
                    Some(got) => {
                        Verdict::close(got.into(), wanted.into(), 0.1, format!("{got:.2} m/s²"))
                    }
                    None => Verdict::never("stopped"),
                }
            };
            let all = figures
                .preset
                .wheels
                .iter()
                .all(|w| figures.foot_brake(w) > 0.0);
            let plan = Plan::of(steps).ask(
                format!("locked on wet ground slows by {wet:.2} m/s² within 10 %"),
                judge(1, wet),
            );
            // With nothing but the rear wheels locked it turns round on the ice.
            if !all {
                return Ok(plan);
            }
            Ok(plan
                .ask(
                    format!("locked on ice slows by {icy:.2} m/s² within 10 %"),
                    judge(3, icy),
                )
                .ask(
                    format!("stops {:.1} times as long on ice within 10 %", wet / icy),
                    move |trace| match (braking(trace, 1), braking(trace, 3)) {
                        (Some(a), Some(b)) => Verdict::close(
                            f64::from(a / b),
                            f64::from(wet / icy),
                            0.1,
                            format!("{:.2} times", a / b),
                        ),
                        _ => Verdict::never("stopped"),
                    },
                )
                .ask_upright())
        },
    )
}
