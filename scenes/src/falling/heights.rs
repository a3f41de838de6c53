//! Stairs, a cliff, and a crowd.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;

use super::{
    FallStation, FallStep, during, greatest, last, least, most,
    stage::{BRICK, Block, CONCRETE},
};
use crate::stations::Verdict;

pub(super) fn stations() -> Vec<FallStation> {
    vec![stairs(), cliff(), crowd()]
}

const GRAVITY: f32 = 9.81;

/// Rise, tread and width of a step, metres, and how many there are.
const STEP: Vec3 = Vec3::new(4.0, 0.19, 0.27);
const STEPS: u16 = 14;

fn stairs() -> FallStation {
    let top = f32::from(STEPS) * STEP.y;
    // From the landing down towards -Z.
    let step = |i: u16| {
        let height = f32::from(STEPS - i) * STEP.y;
        let z = -f32::from(i) * STEP.z - 0.5 * STEP.z;
        Block::on(Vec3::Z * z, Vec3::new(STEP.x, height, STEP.z), CONCRETE)
    };
    let landing = Block::on(Vec3::Z * 1.5, Vec3::new(STEP.x, top, 3.0), BRICK);
    FallStation::new(
        "tumble",
        "pushed off the top of a flight of stairs",
        -50.0,
        5.0,
    )
    .seen(Vec3::new(-6.0, 0.0, -5.5), Vec3::new(0.0, 0.0, -4.0))
    .ground((0..STEPS).map(step).chain([landing]))
    .cast(|scene| {
        let top = f32::from(STEPS) * STEP.y;
        let at = Transform::from_xyz(0.0, top, 0.35);
        scene.person(at, CharacterRagdoll::default());
    })
    .steps([
        FallStep::wait("stands at the edge", 0.5),
        FallStep::once("is pushed into the back with 200 Ns", 9.0, |scene| {
            scene.fall(0);
            scene.hit(0, "chest", Vec3::new(0.0, 30.0, -200.0));
        }),
    ])
    .ask(
        "the push is what it gets: 200 N·s ahead within 10 %",
        |trace| {
            let first = during(trace, 1, 0).take(3);
            let got = greatest(first.map(|(_, f)| -f.momentum.z));
            Verdict::close(got.into(), 200.0, 0.1, format!("{got:.0} N·s"))
        },
    )
    .ask("it tumbles down at least half of the steps", |trace| {
        let low = least(last(trace).map(|f| f.root.y));
        let down = (f32::from(STEPS) * STEP.y - low) / STEP.y;
        Verdict::new(down >= 0.5 * f32::from(STEPS), format!("{down:.1} steps"))
    })
    .ask_whole(0.03, 0.1)
    .ask_at_rest()
}

const HEIGHT: f32 = 8.0;
/// How fast a person runs by default, metres per second.
const SPRINT: f32 = 8.0;

fn cliff() -> FallStation {
    FallStation::new("cliff", "a run off an edge 8 m high", -84.0, 20.0)
        .seen(Vec3::new(16.0, 0.0, -9.0), Vec3::new(0.0, 0.0, -3.0))
        .ground([Block::on(
            Vec3::Z * 5.0,
            Vec3::new(6.0, HEIGHT, 10.0),
            BRICK,
        )])
        .cast(|scene| {
            let at = Transform::from_xyz(0.0, HEIGHT, 8.0);
            scene.person(at, CharacterRagdoll::default());
        })
        .steps([
            FallStep::each("runs to the edge", 1.25, |scene, _| {
                scene.walk(0, Vec3::NEG_Z, true);
            }),
            FallStep::once("falls", 7.0, |scene| {
                scene.fall(0);
                scene.walk(0, Vec3::ZERO, false);
            }),
        ])
        .ask(
            "runs, and keeps 95 % of its momentum as it lets go",
            |trace| {
                // What all its bones have in the last tick of the run, and in the first of the fall.
                let before = during(trace, 1, 0).next().map(|(_, f)| f.velocity());
                let after = during(trace, 1, 0).nth(1).map(|(_, f)| f.velocity());
                let (Some(before), Some(after)) = (before, after) else {
                    return Verdict::never("ran");
                };
                let part = after.dot(before) / before.length_squared();
                Verdict::new(
                    (0.95..1.01).contains(&part) && before.length() > 5.0,
                    format!(
                        "{:.2} of {:.2} m/s",
                        after.dot(before.normalize()),
                        before.length()
                    ),
                )
            },
        )
        .ask(
            "falls as the closed form with its damping has it, within 1 %",
            |trace| {
                // From the first tick of the fall to the last in which nothing touches.
                let mut fall = during(trace, 1, 0).skip(1);
                let Some((start, first)) = fall.next() else {
                    return Verdict::never("fell");
                };
                let end = fall.take_while(|(_, f)| f.sunk < -0.05).last();
                let Some((time, end)) = end else {
                    return Verdict::never("was in the air");
                };
                let gained = first.velocity().y - end.velocity().y;
                let (time, damping) = ((time - start) as f32, Ragdoll::default().damping);
                let limit = GRAVITY / damping + first.velocity().y;
                let expected = limit * (1.0 - ops::exp(-damping * time));
                Verdict::new(
                    (gained - expected).abs() < 0.01 * expected && expected > 6.0,
                    format!("{gained:.2} of {expected:.2} m/s"),
                )
            },
        )
        .ask("lands beyond the edge, where its speed takes it", |trace| {
            let far = least(last(trace).map(|f| -f.root.z));
            let time = ops::sqrt(2.0 * HEIGHT / GRAVITY);
            Verdict::new(
                far > 0.5 * SPRINT * time && far < SPRINT * time + 5.0,
                format!("{far:.1} m from the edge"),
            )
        })
        .ask("asleep at most 4 s after the impact", |trace| {
            let touches = during(trace, 1, 0).find(|(_, f)| f.root.y < 1.0);
            let wakes = during(trace, 1, 0).filter(|(_, f)| f.simulated[1] > 0);
            let (Some((hit, _)), Some((until, _))) = (touches, wakes.last()) else {
                return Verdict::never("hit the ground");
            };
            Verdict::at_most(until - hit, 4.0, format!("{:.1} s", until - hit))
        })
        .ask_whole(0.05, 0.15)
        .ask_at_rest()
}

const CROWD: [u16; 2] = [10, 5];

fn crowd() -> FallStation {
    FallStation::new("crowd", "fifty fall over each other", -84.0, -16.0)
        .seen(Vec3::new(2.5, 0.0, 6.5), Vec3::X * 2.0)
        .cast(|scene| {
            for x in 0..CROWD[0] {
                for z in 0..CROWD[1] {
                    let at = Vec3::new(
                        0.62 * (f32::from(x) - 4.5),
                        0.25 + 0.2 * f32::from((x + 2 * z) % 4),
                        0.75 * (f32::from(z) - 2.0),
                    );
                    let turn = Quat::from_rotation_y(f32::from(7 * x + 3 * z));
                    let at = Transform::from_translation(at).with_rotation(turn);
                    let mut ragdoll = Ragdoll::default();
                    ragdoll.rest.freeze_after = Some(1.0);
                    scene.doll(at, RagdollMode::Limp, ragdoll);
                }
            }
        })
        .steps([FallStep::wait("all let go at once", 9.0)])
        .ask("everyone lies in the end", |trace| {
            let high = greatest(last(trace).map(|f| f.head.y));
            Verdict::at_most(high.into(), 1.1, format!("highest head at {high:.2} m"))
        })
        .ask("everyone is frozen within 8 s", |trace| {
            let frozen = |f: &&super::Fallen| f.mode == RagdollMode::Frozen;
            let count = last(trace).filter(frozen).count();
            let all = usize::from(CROWD[0] * CROWD[1]);
            Verdict::new(count == all, format!("{count} of {all}"))
        })
        .ask(
            "mean gap of all joints at most 0.3 mm in the end",
            |trace| {
                let n = last(trace).count() as f32;
                let gap = last(trace).map(|f| f.gap[1]).sum::<f32>() / n;
                Verdict::at_most(gap.into(), 3e-4, format!("{:.3} mm", 1e3 * gap))
            },
        )
        .ask("nobody is ever faster than the fall makes them", |trace| {
            let (fastest, when) = most(trace, |f| f.velocity().length());
            Verdict::at_most(fastest, 6.0, format!("{fastest:.1} m/s, {when}"))
        })
        .ask_whole(0.05, 0.06)
}
