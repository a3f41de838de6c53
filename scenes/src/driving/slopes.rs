//! Hills along and across, jump, loop.

use bevy::{math::ops, prelude::*};

use super::{DriveSample, DriveStation, DriveStep, Figures, GRAVITY, Plan, trace::end};
use crate::{
    course::layout::driving::{HILL_TOP, Hill, hills, jump, looping},
    stations::Verdict,
};

pub(super) fn stations() -> Vec<DriveStation> {
    let mut all = Vec::new();
    all.extend(hills().into_iter().map(along));
    all.extend(hills().into_iter().map(across));
    all.extend([flight(), looping_station()]);
    all
}

fn middle(hill: &Hill, turn: Quat) -> Transform {
    let at = hill.middle();
    Transform::from_xyz(0.0, at.y, -at.x)
        .with_rotation(Quat::from_rotation_x(hill.degrees.to_radians()) * turn)
}

/// How far it moved in the last three seconds of a step, metres.
fn crept(ticks: &[DriveSample]) -> f32 {
    let ticks = end(ticks, 3.0);
    match (ticks.first(), ticks.last()) {
        (Some(a), Some(b)) => a.pose.translation.distance(b.pose.translation),
        _ => f32::NAN,
    }
}

/// Asks that it stands, or that it slides; `holds` is what it holds with while nothing slides, and
/// when everything does.
fn ask_hold(plan: Plan, holds: [f32; 2], pull: f32) -> Result<Plan, String> {
    let [held, kept] = holds;
    if kept > 1.05 * pull {
        Ok(plan.ask("braked, it moves less than 2 mm in 3 s", |trace| {
            let way = crept(trace.step(0));
            Verdict::at_most(way.into(), 2e-3, format!("{:.3} mm", way * 1e3))
        }))
    } else if held < 0.95 * pull {
        Ok(plan.ask(
            format!("braked, it slides: {held:.0} N hold {pull:.0} N"),
            |trace| {
                let way = crept(trace.step(0));
                Verdict::new(way > 0.2, format!("{way:.2} m"))
            },
        ))
    } else {
        // What it does then hangs on how softly it was put there.
        Err(format!(
            "neither stands nor slides for certain: {pull:.0} N pull, its tyres hold {held:.0} N before they slide and {kept:.0} N after"
        ))
    }
}

fn along(hill: Hill) -> DriveStation {
    let slope = hill.degrees.to_radians();
    DriveStation::new(
        format!("hill_{:.0}", hill.degrees),
        format!("stand on a slope of {:.0} degrees, and climb", hill.degrees),
        hill.place,
        move |figures| {
            let pull = figures.weight() * ops::sin(slope);
            // Also with its wheels spinning, as they do when the clutch bites.
            let spinning = Figures::sliding(&figures.preset.wheels[0].tire.along);
            let grip = spinning * figures.grip(slope, 0.0, |w| w.driven).x;
            let engine = 0.9 * figures.launch_force();
            // At the edges of the slope an axle loses some of its load.
            let climbs = grip.min(engine) > 1.15 * pull;
            let mut steps = vec![DriveStep::brake(5.0)];
            let held = figures.braking(slope);
            let (from, top) = (hill.middle(), hill.top());
            if climbs && held[1] > 1.05 * pull {
                let line = [
                    Vec3::new(0.0, from.y, -from.x),
                    Vec3::new(0.0, top.y, -top.x),
                    Vec3::new(0.0, top.y, -top.x - 0.6 * HILL_TOP),
                ];
                steps.push(DriveStep::follow(&line, 4.0, 20.0));
            }
            let climbing = steps.len() > 1;
            let plan = ask_hold(Plan::of(steps), held, pull)?;
            Ok(if climbing {
                plan.ask("starts uphill and gets to the top", move |trace| {
                    let end = trace.last().map_or(f32::NAN, |s| s.pose.translation.y);
                    Verdict::new(end > top.y - 0.3, format!("at {end:.1} of {:.1} m", top.y))
                })
            } else {
                plan
            })
        },
    )
    .from(middle(&hill, Quat::IDENTITY))
}

fn across(hill: Hill) -> DriveStation {
    let slope = hill.degrees.to_radians();
    DriveStation::new(
        format!("side_{:.0}", hill.degrees),
        format!("stand across a slope of {:.0} degrees", hill.degrees),
        hill.place,
        move |figures| {
            let (sin, cos) = ops::sin_cos(slope);
            let pull = figures.weight() * sin;
            // The springs give on the lower side, which brings the centre further out, and swing when it is
            // set down.
            let tipping = 0.72 * figures.tipping();
            if tipping < ops::tan(slope) {
                return Err(format!(
                    "tips over: half its track is {:.2} of its centre's height, the slope's tangent {:.2}",
                    figures.tipping(),
                    ops::tan(slope)
                ));
            }
            if figures.leans() {
                // Two wheels in line: the control leans it to where the load is.
                let held = figures.grip(0.0, 0.0, |_| true).y * cos;
                return ask_hold(Plan::of([DriveStep::brake(5.0)]), [held; 2], pull);
            }
            // The lower wheels carry more, and tyres under load hold less of it.
            let shift = figures.weight() * sin / figures.tipping() / figures.preset.wheels.len() as f32;
            let held: f32 = figures
                .preset
                .wheels
                .iter()
                .zip(figures.loads(0.0, 0.0))
                .flat_map(|(wheel, load)| {
                    let load = load * cos;
                    [load + shift, load - shift]
                        .map(|n| 0.5 * Figures::friction(wheel, n.max(0.0)).y * n.max(0.0))
                })
                .sum();
            let sliding = Figures::sliding(&figures.preset.wheels[0].tire.across);
            ask_hold(Plan::of([DriveStep::brake(5.0)]), [held, sliding * held], pull)
        },
    )
    .from(middle(&hill, Quat::from_rotation_y(-core::f32::consts::FRAC_PI_2)))
}

/// Ticks of the longest time with all wheels in the air.
fn flown(samples: &[DriveSample]) -> &[DriveSample] {
    let flying = |s: &DriveSample| s.telemetry.grounded == 0;
    let mut best = 0..0;
    let mut from = None;
    for (i, sample) in samples.iter().enumerate() {
        match (flying(sample), from) {
            (true, None) => from = Some(i),
            (true, Some(start)) if i + 1 - start > best.len() => best = start..i + 1,
            (false, _) => from = None,
            _ => {}
        }
    }
    &samples[best]
}

fn flight() -> DriveStation {
    DriveStation::new(
        "jump",
        format!("jump a gap of {:.0} m", jump::GAP),
        jump::PLACE,
        |figures| {
            let speed = 16.0;
            let reach = figures.sprint(jump::RUN_UP).speed;
            if reach < 1.02 * speed {
                return Err(format!(
                    "too slow: {reach:.1} m/s after {:.0} m of run-up, {speed:.0} m/s needed",
                    jump::RUN_UP
                ));
            }
            if figures.clearance_in(jump::RADIUS) < 0.0 {
                return Err("its hull would scrape on the kicker".into());
            }
            let lip = jump::lip();
            let end = jump::RUN_UP + lip.x + jump::GAP + jump::landing() + 25.0;
            Ok(Plan::of([DriveStep::ahead(0.0, end, speed, 30.0)])
                .ask("in flight it falls with g within 2 %", |trace| {
                    let air = flown(&trace.samples);
                    // The first and the last tick still have a foot on the ground.
                    match air {
                        [_, first, .., last, _] => {
                            let got = f64::from(first.velocity.y - last.velocity.y)
                                / (last.time - first.time);
                            Verdict::close(
                                got,
                                GRAVITY.into(),
                                0.02,
                                format!("{got:.2} m/s² for {:.2} s", last.time - first.time),
                            )
                        }
                        _ => Verdict::never("flew"),
                    }
                })
                .ask(format!("flies further than {:.0} m", jump::GAP), |trace| {
                    let air = flown(&trace.samples);
                    let way = match (air.first(), air.last()) {
                        (Some(a), Some(b)) => b.ahead() - a.ahead(),
                        _ => 0.0,
                    };
                    Verdict::new(way > jump::GAP, format!("{way:.1} m"))
                })
                .ask_upright())
        },
    )
}

fn looping_station() -> DriveStation {
    DriveStation::new(
        "loop",
        format!("through a loop {:.0} m high", looping::height()),
        looping::PLACE,
        |figures| {
            if figures.leans() {
                return Err("its lean control keeps it upright, and a loop is upside down".into());
            }
            let least = looping::least_speed();
            let wanted = 1.06 * least;
            let reach = figures.sprint(looping::RUN_UP).speed;
            if reach < 1.01 * wanted {
                return Err(format!(
                    "too slow: {reach:.1} m/s after {:.0} m of run-up, √(g r + 2 g h) is {least:.1} m/s",
                    looping::RUN_UP
                ));
            }
            // Half way up the band is tighter than at its foot, and the speed still presses.
            let tight = 0.4 * looping::RADII[0] + 0.6 * looping::RADII[1];
            let room = figures.clearance_in(tight);
            if room < 0.0 {
                return Err(format!(
                    "its hull would scrape: {:.2} m of overhang in a radius of {tight:.0} m lack {:.2} m of room",
                    figures.overhang(),
                    -room
                ));
            }
            let mut line: Vec<Vec3> = vec![Vec3::ZERO];
            line.extend(looping::line().into_iter().map(|(point, _)| point));
            line.push(Vec3::new(looping::SHIFT, 0.0, -looping::RUN_UP - 45.0));
            let radius = looping::RADII[1];
            Ok(Plan::of([DriveStep::follow(&line, wanted, 40.0)])
                .ask(
                    format!("enters with more than √(g r + 2 g h) = {least:.1} m/s"),
                    move |trace| {
                        let entry = trace.samples.iter().find(|s| s.ahead() > looping::RUN_UP);
                        let got = entry.map_or(f32::NAN, |s| s.velocity.length());
                        Verdict::new(got > least, format!("{got:.1} m/s"))
                    },
                )
                .ask("at the top v² > g r, and the wheels press", move |trace| {
                    let Some(top) = trace
                        .samples
                        .iter()
                        .max_by(|a, b| a.pose.translation.y.total_cmp(&b.pose.translation.y))
                    else {
                        return Verdict::never("drove");
                    };
                    let v = top.velocity.length();
                    Verdict::new(
                        top.upright() < -0.8
                            && v * v > GRAVITY * (radius - 1.0)
                            && top.telemetry.load > 0.0,
                        format!(
                            "{v:.1} m/s, {:.1} m up, load {:.0} N",
                            top.pose.translation.y, top.telemetry.load
                        ),
                    )
                })
                .ask_upright())
        },
    )
}
