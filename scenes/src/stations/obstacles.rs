//! Corners, pillars, the crawl tunnel and the ladder.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{Character, CharacterMotor, MovementMode, Stance};

use super::{
    Station, Step, Verdict,
    measure::{after, ahead, at_speed, ends_at_height},
    trace::range,
};
use crate::course::layout::{self, APPROACH, CORNER_APEX, Corner, crawl, ladder, pillars};

pub(super) fn stations() -> Vec<Station> {
    let mut all: Vec<Station> = layout::corners().into_iter().map(corner).collect();
    all.extend([wood(), tunnel(), rungs()]);
    all
}

fn corner(corner: Corner) -> Station {
    let radius = Character::default().shape.radius();
    let apex = CORNER_APEX.z + radius / ops::sin(0.5 * corner.degrees.to_radians());
    // A little off the middle, so that the two walls press differently.
    let (sin, cos) = ops::sin_cos(5f32.to_radians());
    let hold = |seconds| Step::Hold {
        movement: Vec3::new(sin, 0.0, -cos),
        seconds,
    };
    Station::new(
        corner.name.clone(),
        format!("press into a corner of {:.0} degrees", corner.degrees),
        corner.place,
    )
    .script([Step::Wait(0.3), hold(2.5), hold(3.4)])
    .ask("get where both walls touch within 2 cm", move |trace| {
        let Some(last) = trace.last() else {
            return Verdict::never("got there");
        };
        let gap = Vec2::new(last.foot.x, last.foot.z - apex).length();
        Verdict::at_most(f64::from(gap), 0.02, format!("{:.2} mm off", gap * 1e3))
    })
    .ask("stay there within 0.1 mm after 5 ticks", |trace| {
        let ticks = trace.step(2);
        super::measure::stays(ticks.get(5..).unwrap_or_default(), 0.1e-3)
    })
}

fn wood() -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let radius = Character::default().shape.radius();
    let time = 1.5 * pillars::GOAL.length() / speed;
    Station::new(
        "pillars",
        "walk straight at a goal behind a wood of pillars",
        pillars::PLACE,
    )
    .script([Step::Wait(0.3), Step::walk(pillars::GOAL, 2.0 * time)])
    .ask(
        format!("get there in at most 1.5 times the straight time, {time:.2} s"),
        move |trace| {
            let took = super::trace::duration(trace.step(1));
            Verdict::at_most(took, f64::from(time), format!("{took:.2} s"))
        },
    )
    .ask("never more than 1 mm inside a pillar", move |trace| {
        let (nearest, _) = range(&trace.samples, |sample| {
            pillars::all()
                .into_iter()
                .map(|p| Vec2::new(sample.foot.x - p.x, sample.foot.z - p.z).length())
                .fold(f32::INFINITY, f32::min)
        });
        let gap = nearest - pillars::RADIUS - radius;
        Verdict::new(gap >= -1e-3, format!("nearest {:+.2} mm", gap * 1e3))
    })
}

fn tunnel() -> Station {
    let character = Character::default();
    let motor = CharacterMotor::default();
    let (radius, tall) = (character.shape.radius(), character.shape.height());
    let (low, slow) = (character.crouch_height, motor.crouch_speed);
    let middle = APPROACH + 0.5 * crawl::LENGTH;
    let beyond = APPROACH + crawl::LENGTH + 1.2;
    let time = 1.5 * beyond / slow + 1.0;
    Station::new("crawl", "get through a tunnel 1.1 m high", crawl::PLACE)
        .script([
            Step::Wait(0.3),
            Step::ahead(1.2),
            Step::Take(Stance::Crouch),
            Step::walk(Vec3::NEG_Z * middle, time),
            Step::Take(Stance::Stand),
            Step::Wait(0.6),
            Step::Take(Stance::Crouch),
            Step::walk(Vec3::NEG_Z * beyond, time),
            Step::Take(Stance::Stand),
            Step::Wait(0.5),
        ])
        .ask("standing, be stopped by the roof", move |trace| {
            let (_, furthest) = range(trace.step(1), ahead);
            let limit = APPROACH - radius;
            Verdict::at_most(
                f64::from((furthest - limit).abs()),
                0.02,
                format!("stopped {:+.1} mm from it", (limit - furthest) * 1e3),
            )
        })
        .ask(
            format!("crouch to {low} m and go at {slow} m/s within 1 %"),
            move |trace| {
                let way = [APPROACH + 0.5, middle - 0.4];
                let speed = at_speed(trace.step(3), ahead, way, way[1] - way[0], slow, 0.01);
                let height = trace.step(3).last().map_or(f32::NAN, |s| s.height);
                Verdict::new(
                    speed.pass && (height - low).abs() < 1e-3,
                    format!("{height:.3} m, {}", speed.got),
                )
            },
        )
        .ask("be refused to stand up inside", |trace| {
            let ticks = after(trace.step(5), 0.1);
            let (_, highest) = range(ticks, |s| s.height);
            let refused = ticks.iter().filter(|s| s.refused).count();
            Verdict::new(
                highest <= crawl::HEIGHT && refused == ticks.len() && refused > 0,
                format!(
                    "{highest:.3} m, refused in {refused} of {} ticks",
                    ticks.len()
                ),
            )
        })
        .ask(format!("stand {tall} m tall behind it"), move |trace| {
            let height = trace.last().map_or(f32::NAN, |s| s.height);
            Verdict::at_most(
                f64::from((height - tall).abs()),
                1e-3,
                format!("{height:.3} m"),
            )
        })
}

fn rungs() -> Station {
    let speed = CharacterMotor::default().climb_speed;
    let time = APPROACH + 1.5 * ladder::LEDGE / (0.5 * speed) + 2.0;
    Station::new("ladder", "climb a ladder to a ledge 4 m up", ladder::PLACE)
        .script([
            Step::Wait(0.3),
            Step::Walk {
                to: Vec3::NEG_Z * (APPROACH + 1.2),
                within: 0.3,
                up: 1.0,
                timeout: time,
            },
            Step::Wait(0.4),
        ])
        .ask("hold on to the ladder", |trace| {
            let ticks = trace.step(1);
            let climbing = ticks
                .iter()
                .filter(|s| s.mode == MovementMode::Climb)
                .count();
            Verdict::new(
                climbing > 0,
                format!("in {climbing} of {} ticks", ticks.len()),
            )
        })
        .ask(
            format!("climb at {speed} m/s, at least half of it"),
            move |trace| {
                let height = |s: &super::Sample| s.foot.y;
                let (from, to) = (0.8, ladder::LEDGE - 0.8);
                match (
                    super::trace::crossing(trace.step(1), height, from),
                    super::trace::crossing(trace.step(1), height, to),
                ) {
                    (Some(start), Some(end)) => {
                        let got = (to - from) / (end - start) as f32;
                        Verdict::new(
                            got >= 0.5 * speed && got <= 1.01 * speed,
                            format!("{got:.2} m/s"),
                        )
                    }
                    _ => Verdict::never("got up"),
                }
            },
        )
        .ask("stand on the ledge within 5 mm", |trace| {
            ends_at_height(trace.step(2), ladder::LEDGE, 0.005)
        })
        .ask("walk again there", |trace| {
            let last = trace.last();
            let mode = last.map(|s| s.mode);
            let standing = last.is_some_and(super::Sample::on_ground);
            Verdict::new(
                mode == Some(MovementMode::Walk) && standing,
                format!("{mode:?}, on ground: {standing}"),
            )
        })
}
