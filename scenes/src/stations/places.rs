//! The hill of voxels, the pool and the planet.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{CharacterMotor, MovementMode};

use super::{
    Sample, Station, Step, Verdict,
    measure::{ahead, at_speed, ends_at_height, never_airborne, never_backwards, within_time},
    trace::{duration, range},
};
use crate::course::layout::{APPROACH, planet, pool, voxels};

pub(super) fn stations() -> Vec<Station> {
    vec![hill(), swim(), globe()]
}

fn hill() -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let top = voxels::HEIGHT as f32 * voxels::CUBE;
    let run = voxels::RADIUS as f32 * voxels::CUBE;
    let foot = -voxels::CENTER.z - run;
    let ideal = ops::hypot(run, top) / speed;
    let beyond = foot + 2.0 * run + 1.0;
    Station::new("voxels", "walk over a hill of 25 cm voxels", voxels::PLACE)
        .script([
            Step::Wait(0.3),
            Step::walk(voxels::CENTER, 2.0 * ideal + 2.0),
            Step::Wait(0.4),
            Step::walk(Vec3::NEG_Z * beyond, 2.0 * ideal + 2.0),
        ])
        .ask(
            format!(
                "up in at most 1.5 times the ideal time, {:.2} s",
                1.5 * ideal
            ),
            move |trace| within_time(trace.step(1), ahead, [foot, foot + run - 0.4], 1.5 * ideal),
        )
        .ask(format!("stand {top:.2} m up within 5 mm"), move |trace| {
            ends_at_height(trace.step(2), top, 0.005)
        })
        .ask("never slower than 1 m/s for over 0.1 s", |trace| {
            if trace.step(3).is_empty() {
                return Verdict::never("got over it");
            }
            let mut longest = 0.0f64;
            for step in [1, 3] {
                let mut slow = 0.0f64;
                // Getting going does not count.
                for pair in super::measure::after(trace.step(step), 0.2).windows(2) {
                    let dt = pair[1].time - pair[0].time;
                    let forward = f64::from(ahead(&pair[1]) - ahead(&pair[0])) / dt;
                    slow = if forward < 1.0 { slow + dt } else { 0.0 };
                    longest = longest.max(slow);
                }
            }
            Verdict::at_most(longest, 0.1, format!("{longest:.3} s at most"))
        })
        .ask("never backwards", |trace| {
            let (up, down) = (
                never_backwards(trace.step(1), Vec3::NEG_Z),
                never_backwards(trace.step(3), Vec3::NEG_Z),
            );
            Verdict::new(
                up.pass && down.pass,
                format!("up: {}, down: {}", up.got, down.got),
            )
        })
        .ask("never in the air", |trace| {
            let (up, down) = (never_airborne(trace.step(1)), never_airborne(trace.step(3)));
            Verdict::new(
                up.pass && down.pass,
                format!("up: {}, down: {}", up.got, down.got),
            )
        })
}

fn swim() -> Station {
    let motor = CharacterMotor::default();
    let (walk, swim) = (motor.walk_speed, motor.swim_speed);
    let goal = APPROACH + pool::LENGTH + 1.5;
    let deep = [
        APPROACH + pool::RAMP + 0.5,
        APPROACH + pool::RAMP + pool::BOTTOM - 0.5,
    ];
    let time = 1.5 * (pool::LENGTH / swim + (goal - pool::LENGTH) / walk);
    Station::new(
        "pool",
        "walk into a pool, swim across, walk out",
        pool::PLACE,
    )
    .script([
        Step::Wait(0.3),
        Step::walk(Vec3::NEG_Z * goal, time + 4.0),
        Step::Wait(0.4),
    ])
    .ask(
        format!("swim over the deep at {swim} m/s within 2 %"),
        move |trace| {
            let swims = trace
                .step(1)
                .iter()
                .filter(|s| (deep[0]..deep[1]).contains(&ahead(s)))
                .all(|s| s.mode == MovementMode::Swim);
            let speed = at_speed(trace.step(1), ahead, deep, deep[1] - deep[0], swim, 0.02);
            Verdict::new(
                swims && speed.pass,
                format!(
                    "{}, {}",
                    speed.got,
                    if swims { "swimming" } else { "not swimming" }
                ),
            )
        },
    )
    .ask("head above the water there", move |trace| {
        let over: Vec<Sample> = trace
            .step(1)
            .iter()
            .filter(|s| (deep[0]..deep[1]).contains(&ahead(s)))
            .cloned()
            .collect();
        let (low, _) = range(&over, |s| s.foot.y + s.height + pool::WATER);
        Verdict::new(
            low > 0.0 && !over.is_empty(),
            format!("top of the head {low:+.2} m from the surface"),
        )
    })
    .ask("never through the bottom", |trace| {
        let (low, _) = range(&trace.samples, |s| s.foot.y);
        Verdict::new(low >= -pool::DEPTH - 1e-3, format!("lowest {low:.3} m"))
    })
    .ask(format!("be across in at most {time:.1} s"), move |trace| {
        let took = duration(trace.step(1));
        Verdict::at_most(took, f64::from(time), format!("{took:.2} s"))
    })
    .ask("walk out at the height of the plaza within 5 mm", |trace| {
        let walks = trace
            .last()
            .is_some_and(|s| s.mode == MovementMode::Walk && s.on_ground());
        let height = ends_at_height(trace.step(2), 0.0, 0.005);
        Verdict::new(
            walks && height.pass,
            format!(
                "{}, {}",
                height.got,
                if walks { "walking" } else { "not walking" }
            ),
        )
    })
}

fn globe() -> Station {
    let speed = CharacterMotor::default().walk_speed;
    let round = core::f32::consts::TAU;
    let time = round * planet::RADIUS / speed;
    Station::new("planet", "walk once round a planet", planet::PLACE)
        .script([
            Step::Wait(0.5),
            Step::Orbit {
                axis: Vec3::NEG_X,
                angle: round,
                center: planet::CENTER,
                timeout: 2.0 * time,
            },
            Step::Wait(0.5),
        ])
        .ask(format!("round in {time:.2} s within 2 %"), move |trace| {
            let took = duration(trace.step(1));
            Verdict::close(took, f64::from(time), 0.02, format!("{took:.2} s"))
        })
        .ask("foot on the ground within 1 cm, all round", |trace| {
            let (low, high) = range(trace.step(1), |s| {
                s.foot.distance(planet::CENTER) - planet::RADIUS
            });
            Verdict::new(
                low >= -0.01 && high <= 0.01,
                format!("{:+.2} to {:+.2} mm", low * 1e3, high * 1e3),
            )
        })
        .ask("up follows within 3 degrees", |trace| {
            let (_, worst) = range(trace.step(1), |s| {
                s.up.angle_between(s.foot - planet::CENTER).to_degrees()
            });
            Verdict::at_most(f64::from(worst), 3.0, format!("{worst:.2} degrees at most"))
        })
        .ask(
            "come back to the start within 0.5 m, no drift over 2 cm",
            |trace| {
                let (low, high) = range(trace.step(1), |s| s.foot.x);
                let side = high.max(-low);
                let off = trace.last().map_or(f32::NAN, |s| s.foot.length());
                Verdict::new(
                    off <= 0.5 && side <= 0.02,
                    format!("{off:.3} m from it, {:.2} mm to the side", side * 1e3),
                )
            },
        )
        .ask("never in the air", |trace| never_airborne(trace.step(1)))
}
