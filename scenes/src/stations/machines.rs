//! Things that move: lifts, turntables, the conveyor, the seesaw and crates.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{Character, CharacterMotor};

use super::{
    Sample, Station, Step, Trace, Verdict,
    measure::{after, ahead, never_airborne},
    trace::range,
};
use crate::course::layout::{
    self, APPROACH, CRATE_FRICTION, Crate, LIFT_THICK, LIFT_TOP, LIFT_WAIT, Lift, Turntable,
    conveyor, seesaw,
};

/// Gravity of the course, metres per second squared.
const GRAVITY: f32 = 9.81;

pub(super) fn stations() -> Vec<Station> {
    let mut all: Vec<Station> = layout::lifts().into_iter().map(lift).collect();
    all.extend(layout::turntables().into_iter().map(turntable));
    all.extend([belt(), board()]);
    all.extend(layout::crates().into_iter().map(push));
    all
}

/// The tracked node in a sample; at nowhere when there is none.
fn node(sample: &Sample) -> Transform {
    sample
        .nodes
        .first()
        .copied()
        .unwrap_or(Transform::from_translation(Vec3::NAN))
}

fn lift(lift: Lift) -> Station {
    let (speed, travel) = (lift.speed, lift.travel);
    let ride = LIFT_WAIT + 2.0 * lift.one_way() + 0.5;
    // Once the walker has come to rest on the platform.
    let riding = |trace: &Trace| -> Vec<Sample> { after(trace.step(2), 0.3).to_vec() };
    Station::new(
        lift.name.clone(),
        format!("ride {:.1} m to and fro at {speed} m/s", travel.length()),
        lift.place,
    )
    .track(lift.node.clone())
    .script([
        Step::Wait(0.1),
        Step::walk(Vec3::NEG_Z * APPROACH, 1.4),
        Step::Wait(ride),
    ])
    .ask("foot within 1 cm of the floor at all times", move |trace| {
        let (low, high) = range(&riding(trace), |s| {
            s.foot.y - node(s).translation.y - 0.5 * LIFT_THICK
        });
        Verdict::new(
            low >= -0.01 && high <= 0.01,
            format!("{:+.3} to {:+.3} mm", low * 1e3, high * 1e3),
        )
    })
    .ask(
        "carried exactly: no drift over 0.1 mm across it",
        move |trace| {
            let ticks = riding(trace);
            let across = |s: &Sample| {
                let way = s.foot - node(s).translation;
                Vec2::new(way.x, way.z)
            };
            let Some(first) = ticks.first().map(across) else {
                return Verdict::never("rode");
            };
            let (_, worst) = range(&ticks, |s| across(s).distance(first));
            Verdict::at_most(f64::from(worst), 0.1e-3, format!("{:.4} mm", worst * 1e3))
        },
    )
    .ask("reach the far end and come back", move |trace| {
        let ticks = riding(trace);
        let (low, high) = range(&ticks, |s| s.foot.y);
        // The far end lies between two ticks.
        let slack = 0.01 + travel.y / travel.length() * speed * trace.dt as f32;
        let back = ticks.last().map_or(f32::NAN, |s| s.foot.y);
        Verdict::new(
            high >= LIFT_TOP.y + travel.y - slack && (back - LIFT_TOP.y).abs() < 0.02,
            format!("from {low:.3} to {high:.3} m, back at {back:.3} m"),
        )
    })
    .ask("always on the ground", move |trace| {
        let ticks = riding(trace);
        let off = ticks.iter().filter(|s| !s.on_ground()).count();
        Verdict::new(
            off == 0 && !ticks.is_empty(),
            format!("off it in {off} of {} ticks", ticks.len()),
        )
    })
}

fn turntable(table: Turntable) -> Station {
    let turns: f32 = if table.rate < 1.0 { 3.0 } else { 10.0 };
    let stand = table.start();
    let radius = stand.z;
    Station::new(
        table.name.clone(),
        format!(
            "stand on a table of {} turns per second for {turns:.0} turns",
            table.rate
        ),
        table.place,
    )
    .from(stand)
    .track(table.node.clone())
    .script([Step::Wait(0.5), Step::Wait(turns / table.rate)])
    .ask(
        format!("stay {radius:.2} m from the axis within 1 mm"),
        |trace| {
            let (low, high) = range(trace.step(1), |s| {
                let way = s.foot - node(s).translation;
                Vec2::new(way.x, way.z).length()
            });
            Verdict::at_most(
                f64::from(high - low),
                1e-3,
                format!(
                    "{:.3} to {:.3} m, {:.3} mm apart",
                    low,
                    high,
                    (high - low) * 1e3
                ),
            )
        },
    )
    .ask("stay on its spot of the table within 1 mm", |trace| {
        let ticks = trace.step(1);
        let spot = |s: &Sample| {
            let node = node(s);
            node.rotation.inverse() * (s.foot - node.translation)
        };
        let Some(first) = ticks.first().map(spot) else {
            return Verdict::never("stood");
        };
        let (_, worst) = range(ticks, |s| spot(s).distance(first));
        Verdict::at_most(f64::from(worst), 1e-3, format!("{:.3} mm off", worst * 1e3))
    })
    .ask("never in the air", |trace| never_airborne(trace.step(1)))
}

fn belt() -> Station {
    let walk = CharacterMotor::default().walk_speed;
    let belt = conveyor::SPEED;
    // Mean speed ahead from a while after the beginning of a step.
    let speed = |trace: &Trace, step: usize| -> Option<f64> {
        let ticks = after(trace.step(step), 0.3);
        let (first, last) = (ticks.first()?, ticks.last()?);
        (ticks.len() > 2).then(|| f64::from(ahead(last) - ahead(first)) / (last.time - first.time))
    };
    let asked = move |step: usize, wanted: f32| {
        move |trace: &Trace| match speed(trace, step) {
            Some(got) => {
                Verdict::close(got, f64::from(wanted), 0.01, format!("{got:.3} m/s ahead"))
            }
            None => Verdict::never("was on the belt"),
        }
    };
    Station::new(
        "conveyor",
        format!("stand, walk with and walk against a belt of {belt} m/s"),
        conveyor::PLACE,
    )
    .script([
        Step::Wait(0.3),
        Step::walk(Vec3::NEG_Z * (APPROACH + 1.5), 2.0),
        Step::Wait(1.5),
        Step::Hold {
            movement: Vec3::Z,
            seconds: 1.0,
        },
        Step::Wait(0.5),
        Step::ahead(0.9),
    ])
    .ask(
        format!("standing, be carried at {belt} m/s within 1 %"),
        asked(2, belt),
    )
    .ask(
        format!("against it, go at {} m/s within 1 %", walk - belt),
        asked(3, belt - walk),
    )
    .ask(
        format!("with it, go at {} m/s within 1 %", walk + belt),
        asked(5, belt + walk),
    )
    .ask("never in the air on the belt", |trace| {
        never_airborne(trace.steps(2..6))
    })
    .ask("no drift to the side over 1 mm", |trace| {
        let (low, high) = range(trace.steps(1..6), |s| s.foot.x);
        Verdict::at_most(
            f64::from(high - low),
            1e-3,
            format!("{:.3} mm", (high - low) * 1e3),
        )
    })
}

fn board() -> Station {
    let z = seesaw::HINGE.z;
    let arm = 0.34 * seesaw::SIZE.z;
    // Positive when the end towards the start is down.
    let tilt = |samples: &[Sample]| {
        samples
            .last()
            .map_or(f32::NAN, |s| -ops::asin((node(s).rotation * Vec3::Z).y))
    };
    Station::new(
        "seesaw",
        "walk over a board on a hinge until it tips",
        seesaw::PLACE,
    )
    .track(seesaw::BOARD)
    .script([
        Step::Wait(0.5),
        Step::walk(Vec3::NEG_Z * (-z - arm), 4.0),
        Step::Wait(0.8),
        Step::walk(Vec3::NEG_Z * (-z + arm), 4.0),
        Step::Wait(1.5),
        Step::walk(Vec3::NEG_Z * (-z + 0.5 * seesaw::SIZE.z + 0.4), 4.0),
    ])
    .ask("the near end is down under the walker", move |trace| {
        let got = tilt(trace.step(2));
        Verdict::new(
            got >= 0.9 * seesaw::TILT,
            format!("{:+.1} degrees", got.to_degrees()),
        )
    })
    .ask("behind the hinge, the far end goes down", move |trace| {
        let got = tilt(trace.step(4));
        Verdict::new(
            got <= -0.9 * seesaw::TILT,
            format!("{:+.1} degrees", got.to_degrees()),
        )
    })
    .ask("stand on the board, not in it", |trace| {
        let Some(last) = trace.step(4).last() else {
            return Verdict::never("was on it");
        };
        let node = node(last);
        let radius = Character::default().shape.radius();
        let ball = last.foot + Vec3::Y * radius;
        let above =
            (node.rotation.inverse() * (ball - node.translation)).y - 0.5 * seesaw::SIZE.y - radius;
        Verdict::at_most(
            f64::from(above.abs()),
            0.01,
            format!("{:+.2} mm from its top", above * 1e3),
        )
    })
}

fn push(item: Crate) -> Station {
    let character = Character::default();
    let walk = CharacterMotor::default().walk_speed;
    let strength = character.push_strength;
    let weight = CRATE_FRICTION * item.mass * GRAVITY;
    let start = item.center().z;
    let moved = move |s: &Sample| start - node(s).translation.z;
    let speed = move |pair: &[Sample]| {
        f64::from(moved(&pair[1]) - moved(&pair[0])) / (pair[1].time - pair[0].time)
    };
    let station = Station::new(
        item.name.clone(),
        format!(
            "push a crate of {} kg with {strength:.0} N against {weight:.0} N",
            item.mass
        ),
        item.place,
    )
    .track(item.node.clone())
    .script([Step::Wait(0.5), Step::ahead(3.0)])
    .ask("never more than 1 cm inside the crate", {
        let radius = character.shape.radius();
        let half = 0.5 * item.size;
        move |trace| {
            let (nearest, _) = range(trace.step(1), |s| {
                let node = node(s);
                let axis = s.foot + Vec3::Y * half;
                let local = node.rotation.inverse() * (axis - node.translation);
                (local.abs() - Vec3::splat(half)).max(Vec3::ZERO).length() - radius
            });
            Verdict::new(
                nearest >= -0.01,
                format!("nearest {:+.2} mm", nearest * 1e3),
            )
        }
    });
    if weight > strength {
        return station.ask("it does not move 1 mm", move |trace| {
            let (low, high) = range(trace.step(1), moved);
            let most = high.abs().max(low.abs());
            Verdict::at_most(f64::from(most), 1e-3, format!("moved {:.3} mm", most * 1e3))
        });
    }
    let acceleration = f64::from((strength - weight) / item.mass);
    let bound = 1.1 * f64::from(walk);
    let station = station.ask(
        format!("not shot away: never over {bound:.1} m/s"),
        move |trace| {
            let most = trace
                .step(1)
                .windows(2)
                .map(speed)
                .reduce(f64::max)
                .unwrap_or(f64::NAN);
            Verdict::at_most(most, bound, format!("{most:.2} m/s at most"))
        },
    );
    // Light crates reach the walker's speed, heavy ones are still getting there after two seconds.
    if acceleration * 2.0 > f64::from(walk) {
        station.ask(
            format!("goes with the walker at {walk} m/s within 5 %"),
            move |trace| {
                let ticks = after(trace.step(1), 2.0);
                match (ticks.first(), ticks.last()) {
                    (Some(first), Some(last)) if ticks.len() > 2 => {
                        let got = f64::from(moved(last) - moved(first)) / (last.time - first.time);
                        Verdict::close(got, f64::from(walk), 0.05, format!("{got:.3} m/s"))
                    }
                    _ => Verdict::never("was pushed"),
                }
            },
        )
    } else {
        station.ask(
            format!("speeds up by the force balance, {acceleration:.2} m/s², within 5 %"),
            move |trace| {
                let ticks = trace.step(1);
                let Some(first) = ticks.windows(2).position(|pair| speed(pair) > 0.01) else {
                    return Verdict::never("moved");
                };
                let pushed: Vec<&[Sample]> = after(&ticks[first..], 0.4).windows(2).collect();
                let count = (1.2 / trace.dt) as usize;
                match (pushed.first(), pushed.get(count)) {
                    (Some(a), Some(b)) => {
                        let got = (speed(b) - speed(a)) / (b[0].time - a[0].time);
                        Verdict::close(got, acceleration, 0.05, format!("{got:.3} m/s²"))
                    }
                    _ => Verdict::never("was pushed for long enough"),
                }
            },
        )
    }
}
