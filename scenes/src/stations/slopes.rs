//! Ramps and funnels.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{Character, CharacterMotor, GroundState};

use super::{
    Sample, Station, Step, Verdict,
    measure::{after, ahead, at_speed, ends_at_height, never_airborne, stays},
    trace::range,
};
use crate::course::layout::{self, APPROACH, FUNNEL_BOTTOM, FUNNEL_DEGREES, Funnel, Ramp};

/// Gravity of the course, metres per second squared.
const GRAVITY: f32 = 9.81;

pub(super) fn stations() -> Vec<Station> {
    let limit = Character::default().max_slope;
    layout::ramps()
        .into_iter()
        .map(|ramp| {
            if ramp.angle() <= limit {
                gentle(ramp)
            } else {
                steep(ramp)
            }
        })
        .chain(layout::funnels().into_iter().map(funnel))
        .collect()
}

fn gentle(ramp: Ramp) -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let radius = Character::default().shape.radius();
    let (cos, top, run) = (ops::cos(ramp.angle()), ramp.top, ramp.run);
    let way = [APPROACH + 0.25 * run, APPROACH + 0.75 * run];
    let goal = APPROACH + run + 1.0;
    let time = 2.0 * (goal + top) / speed + 1.0;
    let middle = ramp.capsule_on(radius, 0.5 * top);
    Station::new(
        ramp.name.clone(),
        format!(
            "walk up, stand on and walk down {:.0} degrees",
            ramp.degrees
        ),
        ramp.place,
    )
    .script([
        Step::Wait(0.3),
        Step::walk(Vec3::NEG_Z * goal, time),
        Step::Wait(0.4),
        Step::Place(middle + Vec3::Y * 0.001),
        Step::Wait(3.5),
        Step::Place(Vec3::new(0.0, top, -APPROACH - run - 0.8)),
        Step::Wait(0.3),
        Step::walk(Vec3::ZERO, time),
    ])
    .ask(
        format!("up at {speed} m/s along the slope within 1 %"),
        move |trace| at_speed(trace.step(1), ahead, way, 0.5 * run / cos, speed, 0.01),
    )
    .ask(format!("stand {top:.3} m up within 5 mm"), move |trace| {
        ends_at_height(trace.step(2), top, 0.005)
    })
    .ask("stand on the slope for 3 s, drift under 0.05 mm", |trace| {
        stays(after(trace.step(4), 0.5), 0.05e-3)
    })
    .ask(
        format!("down at {speed} m/s along the slope within 1 %"),
        move |trace| {
            let back = |s: &Sample| -ahead(s);
            at_speed(
                trace.step(7),
                back,
                [-way[1], -way[0]],
                0.5 * run / cos,
                speed,
                0.01,
            )
        },
    )
    .ask("never in the air", |trace| {
        let (up, down) = (never_airborne(trace.step(1)), never_airborne(trace.step(7)));
        Verdict::new(
            up.pass && down.pass,
            format!("up: {}, down: {}", up.got, down.got),
        )
    })
}

fn steep(ramp: Ramp) -> Station {
    let radius = Character::default().shape.radius();
    let (sin, cos) = ops::sin_cos(ramp.angle());
    let high = ramp.capsule_on(radius, 0.85 * ramp.top);
    let down = Vec3::new(0.0, -sin, cos);
    let asked = GRAVITY * sin;
    Station::new(
        ramp.name.clone(),
        format!("fail to walk up {:.0} degrees and slide down", ramp.degrees),
        ramp.place,
    )
    .script([
        Step::Wait(0.3),
        Step::ahead(2.0),
        Step::Wait(0.2),
        Step::Place(high),
        Step::Wait(0.6),
        Step::Place(high),
        Step::Wait(0.2),
        Step::Jump(0.25),
    ])
    .ask("not climb it: foot under 0.1 m", |trace| {
        let (_, highest) = range(trace.step(1), |s| s.foot.y);
        Verdict::at_most(
            f64::from(highest),
            0.1,
            format!(
                "{:.3} m, {:.2} m ahead",
                highest,
                trace.step(1).last().map_or(0.0, ahead)
            ),
        )
    })
    .ask(
        format!("slide at g sin = {asked:.3} m/s² within 2 %"),
        move |trace| {
            let ticks = after(trace.step(4), 0.15);
            let speed = |pair: &[Sample]| {
                f64::from((pair[1].foot - pair[0].foot).dot(down)) / (pair[1].time - pair[0].time)
            };
            let pairs: Vec<&[Sample]> = ticks.windows(2).collect();
            match (pairs.first(), pairs.last()) {
                (Some(first), Some(last)) if pairs.len() > 4 => {
                    let got = (speed(last) - speed(first)) / (last[0].time - first[0].time);
                    Verdict::close(got, f64::from(asked), 0.02, format!("{got:.3} m/s²"))
                }
                _ => Verdict::never("slid"),
            }
        },
    )
    .ask("not jump from it", |trace| {
        let ticks = trace.step(7);
        let first = ticks.first().map_or(f32::NAN, |s| s.foot.y);
        let (_, highest) = range(ticks, |s| s.foot.y);
        Verdict::at_most(
            f64::from(highest - first),
            1e-3,
            format!("rose {:.1} mm", (highest - first) * 1e3),
        )
    })
}

fn funnel(funnel: Funnel) -> Station {
    let radius = Character::default().shape.radius();
    let jump = CharacterMotor::default().jump_height;
    // A ball that touches all walls.
    let rest = FUNNEL_BOTTOM + radius / ops::cos(FUNNEL_DEGREES.to_radians()) - radius;
    Station::new(
        funnel.name.clone(),
        format!(
            "fall between {} walls of {FUNNEL_DEGREES:.0} degrees",
            funnel.walls
        ),
        funnel.place,
    )
    .from(funnel.start())
    .script([Step::Wait(2.5), Step::Wait(1.5), Step::Jump(0.9)])
    .ask(
        format!("come to rest at {rest:.3} m within 1 cm"),
        move |trace| ends_at_height(trace.step(1), rest, 0.01),
    )
    .ask("stand still within 1 mm", |trace| {
        stays(trace.step(1), 1e-3)
    })
    .ask("count as ground, with no speed of falling left", |trace| {
        let ticks = trace.step(1);
        let standing = ticks
            .iter()
            .filter(|s| s.ground == GroundState::OnGround)
            .count();
        let (_, fastest) = range(ticks, |s| s.velocity.length());
        Verdict::new(
            standing == ticks.len() && !ticks.is_empty() && fastest <= 0.05,
            format!(
                "on ground in {standing} of {} ticks, {fastest:.3} m/s",
                ticks.len()
            ),
        )
    })
    .ask(
        format!("jump {jump} m high from there within 2 cm"),
        move |trace| {
            // The samples of a step begin after its first tick.
            let (low, _) = range(trace.step(1), |s| s.foot.y);
            let (_, high) = range(trace.step(2), |s| s.foot.y);
            Verdict::at_most(
                f64::from((high - low - jump).abs()),
                0.02,
                format!("{:.3} m", high - low),
            )
        },
    )
}
