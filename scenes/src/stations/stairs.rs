//! Stairs, straight and spiral.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{Character, CharacterMotor};

use super::{
    Station, Step, Verdict,
    measure::{ahead, ends_at_height, never_airborne, never_backwards, within_time},
    trace::crossing,
};
use crate::course::layout::{self, APPROACH, Flight, STAIR_TOP, spiral};

pub(super) fn stations() -> Vec<Station> {
    let mut all: Vec<Station> = layout::flights().into_iter().map(flight).collect();
    all.push(round());
    all
}

fn flight(flight: Flight) -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let radius = Character::default().shape.radius();
    // From where the walker meets the first riser to the last edge.
    let way = [APPROACH - radius, APPROACH + flight.run()];
    let ideal = (flight.pitch_line() + radius) / speed;
    let top = Vec3::NEG_Z * (APPROACH + flight.run() + 1.2);
    let kind = if flight.boxes { "boxes" } else { "a mesh" };
    let describe = format!(
        "walk up and down {} steps of {:.2} m by {:.2} m, {kind}",
        flight.steps, flight.rise, flight.tread
    );
    Station::new(flight.name, describe, flight.place)
        .script([
            Step::Wait(0.3),
            Step::walk(top, 2.0 * ideal + 2.0),
            Step::Wait(0.4),
            Step::walk(Vec3::ZERO, 2.0 * ideal + 2.0),
            Step::Wait(0.2),
        ])
        .ask(
            format!(
                "up in at most 1.5 times the ideal time, {:.3} s",
                1.5 * ideal
            ),
            move |trace| within_time(trace.step(1), ahead, way, 1.5 * ideal),
        )
        .ask(format!("stand {STAIR_TOP:.1} m up within 5 mm"), |trace| {
            ends_at_height(trace.step(2), STAIR_TOP, 0.005)
        })
        .ask(
            format!(
                "down in at most 1.5 times the ideal time, {:.3} s",
                1.5 * ideal
            ),
            move |trace| {
                let back = |s: &super::Sample| -ahead(s);
                within_time(trace.step(3), back, [-way[1], -way[0]], 1.5 * ideal)
            },
        )
        .ask("never in the air on the way up", |trace| {
            never_airborne(trace.step(1))
        })
        .ask("never in the air on the way down", |trace| {
            never_airborne(trace.step(3))
        })
        .ask("never backwards", |trace| {
            let up = never_backwards(trace.step(1), Vec3::NEG_Z);
            let down = never_backwards(trace.step(3), Vec3::Z);
            Verdict::new(
                up.pass && down.pass,
                format!("up: {}, down: {}", up.got, down.got),
            )
        })
}

fn round() -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let top = spiral::RISE * spiral::STEPS as f32;
    let arc = spiral::WALK * spiral::STEP_DEGREES.to_radians();
    let length = spiral::STEPS as f32 * ops::hypot(arc, spiral::RISE);
    let ideal = length / speed;
    let mut script = vec![Step::Wait(0.3)];
    // One point per step, on the walking line; the last is on the landing.
    for i in 0..=spiral::STEPS {
        let degrees = spiral::STEP_DEGREES * (i as f32 + 0.5);
        let to = spiral::on_circle(spiral::WALK, degrees, 0.0);
        script.push(Step::walk(to, 3.0));
    }
    let last = script.len();
    script.push(Step::Wait(0.4));
    Station::new("stairs_spiral", "walk up a spiral stair", spiral::PLACE)
        .script(script)
        .ask(format!("stand {top:.1} m up within 5 mm"), move |trace| {
            ends_at_height(trace.step(last), top, 0.005)
        })
        .ask(
            format!(
                "up in at most 1.5 times the ideal time, {:.3} s",
                1.5 * ideal
            ),
            move |trace| {
                let ticks = trace.steps(1..last);
                let height = |s: &super::Sample| s.foot.y;
                match (
                    crossing(ticks, height, 0.01),
                    crossing(ticks, height, top - 0.01),
                ) {
                    (Some(start), Some(end)) => Verdict::at_most(
                        end - start,
                        f64::from(1.5 * ideal),
                        format!("{:.3} s", end - start),
                    ),
                    _ => Verdict::never("got up"),
                }
            },
        )
        .ask("never in the air", move |trace| {
            never_airborne(trace.steps(1..last))
        })
        .ask("never lower than before", move |trace| {
            never_backwards(trace.steps(1..last), Vec3::Y)
        })
}
