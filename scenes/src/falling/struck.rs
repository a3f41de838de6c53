//! Those who are run into: by a storm of crates, and by a car.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;

use super::{
    FallStation, FallStep, FallTrace, Fallen, Scene, during, greatest, most,
    stage::{Block, CONCRETE, WOOD},
    upright::falls,
};
use crate::stations::Verdict;

pub(super) fn stations() -> Vec<FallStation> {
    vec![storm(), road()]
}

const RADIUS: f32 = 3.0;
const PACE: f32 = 1.3;
/// How long the storm lasts, seconds.
const STORM: f32 = 9.0;

/// Where the walker is on its round.
fn round(time: f32) -> Transform {
    let angle = PACE * time / RADIUS;
    let (sin, cos) = ops::sin_cos(angle);
    Transform::from_xyz(RADIUS * cos, 0.0, -RADIUS * sin)
        .with_rotation(Quat::from_rotation_y(angle))
}

fn storm() -> FallStation {
    FallStation::new(
        "storm",
        "a powered walker, held by its muscles, in a storm of crates",
        -116.0,
        25.0,
    )
    .seen(Vec3::new(0.0, 0.0, 8.5), Vec3::ZERO)
    .cast(|scene| {
        let ragdoll = Ragdoll::default();
        scene.doll(round(0.0), RagdollMode::Powered, ragdoll);
    })
    .steps([
        FallStep::each("walks its round", 2.0, |scene, time| {
            if time <= 0.0 {
                hold_pelvis(scene);
                scene.edit::<RagdollIntent>(0, |intent| intent.strength = 0.5);
            }
            scene.put(0, round(time), PACE);
        }),
        FallStep::each("crates fly at it", STORM, |scene, time| {
            let at = round(2.0 + time);
            scene.put(0, at, PACE);
            let tick = (time * 64.0).round() as u32;
            if tick.is_multiple_of(16) && time < STORM - 1.0 {
                throw(scene, at.translation, tick / 16);
            }
        }),
        FallStep::each("walks on", 3.0, |scene, time| {
            scene.put(0, round(2.0 + STORM + time), PACE);
        }),
    ])
    .ask(
        "walks as its clip does: joints within 8 degrees of it",
        |trace| {
            let (mut sum, mut n) = (0.0, 0.0);
            for (_, f) in during(trace, 0, 0).filter(|(t, _)| *t > 1.0) {
                (sum, n) = (sum + f.error[1], n + 1.0);
            }
            let mean: f32 = (sum / n as f32).to_degrees();
            Verdict::at_most(mean.into(), 8.0, format!("{mean:.2} degrees on the mean"))
        },
    )
    .ask(
        "crates knock it about: a joint is off by 5 degrees more than without",
        |trace| {
            let peak = |step| greatest(during(trace, step, 0).map(|(_, f)| f.error[0]));
            let calm = during(trace, 0, 0).filter(|(t, _)| *t > 1.0);
            let calm = greatest(calm.map(|(_, f)| f.error[0]));
            let got: f32 = peak(1);
            Verdict::new(
                got > calm + 5f32.to_radians(),
                format!(
                    "{:.1} after {:.1} degrees",
                    got.to_degrees(),
                    calm.to_degrees()
                ),
            )
        },
    )
    .ask(
        "a second after the last it walks so again, within 4 degrees, over the crates in its way",
        |trace| {
            let mean = |step| {
                let (mut sum, mut n) = (0.0, 0.0);
                for (_, f) in during(trace, step, 0).filter(|(t, _)| *t > 1.0) {
                    (sum, n) = (sum + f.error[1], n + 1.0);
                }
                (sum / n as f32).to_degrees()
            };
            let (before, after): (f32, f32) = (mean(0), mean(2));
            let got = format!("{after:.2} after {before:.2} degrees on the mean");
            Verdict::at_most((after - before).into(), 4.0, got)
        },
    )
    .ask("nothing is flung away", |trace| {
        let (fastest, when) = most(trace, |f| f.fastest);
        Verdict::at_most(fastest, 20.0, format!("{fastest:.1} m/s, {when}"))
    })
    .ask("no joint parts by more than 60 mm", |trace| {
        let (gap, when) = most(trace, |f| f.gap[0]);
        Verdict::at_most(gap, 0.06, format!("{:.1} mm, {when}", 1e3 * gap))
    })
}

/// The pelvis stays where the clip has it; everything else is held by joints.
fn hold_pelvis(scene: &mut Scene) {
    if let Some(pelvis) = scene.bone(0, "pelvis")
        && let Some(mut control) = scene.world.get_mut::<BoneControl>(pelvis)
    {
        control.pin = 1.0;
    }
}

/// A crate of 10 to 22 kg from somewhere around, aimed where the walker will be.
fn throw(scene: &mut Scene, target: Vec3, number: u32) {
    let angle = 2.4 * number as f32;
    let (sin, cos) = ops::sin_cos(angle);
    let from = target + Vec3::new(4.0 * cos, 1.6, 4.0 * sin);
    let aim = target + Vec3::Y * (0.9 + 0.15 * (number % 4) as f32);
    let time = 0.5;
    let velocity = (aim - from) / time + Vec3::Y * (0.5 * 9.81 * time);
    let mass = 10.0 + 4.0 * (number % 4) as f32;
    scene.crate_(from, 0.28 + 0.04 * (number % 3) as f32, mass, velocity);
}

const SPEED: f32 = 9.0;

fn road() -> FallStation {
    let lane = Block {
        at: Transform::from_xyz(-8.0, -0.045, 0.0),
        size: Vec3::new(60.0, 0.1, 7.0),
        color: [0.24, 0.25, 0.27],
    };
    let curb = |z: f32| {
        Block::on(
            Vec3::new(-8.0, 0.0, z),
            Vec3::new(60.0, 0.06, 0.3),
            CONCRETE,
        )
    };
    let bench = Block::on(Vec3::new(2.0, 0.0, 6.0), Vec3::new(1.6, 0.45, 0.4), WOOD);
    FallStation::new(
        "road",
        "a car runs into a walker, who falls, gets up and walks on",
        -90.0,
        -46.0,
    )
    .seen(Vec3::new(6.0, 0.0, 8.0), Vec3::ZERO)
    .ground([lane, curb(-3.6), curb(3.6), bench])
    .cast(|scene| {
        let at = Transform::from_xyz(0.0, 0.0, 4.6);
        scene.person(at, falls(150.0));
        let turn = Quat::from_rotation_y(-core::f32::consts::FRAC_PI_2);
        let at = Transform::from_xyz(-26.0, 0.01, 0.4).with_rotation(turn);
        scene.car("hatchback", at);
    })
    .steps([
        FallStep::each("a car comes", 2.0, |scene, _| drive(scene, SPEED)),
        FallStep::each("somebody steps onto the road", 3.6, |scene, _| {
            let hit = fell(scene);
            scene.walk(0, if hit { Vec3::ZERO } else { 0.5 * Vec3::NEG_Z }, false);
            drive(scene, if hit { 0.0 } else { SPEED });
        }),
        FallStep::each("the car stops; they get up", 7.5, |scene, _| {
            drive(scene, 0.0);
            scene.walk(0, Vec3::ZERO, false);
        }),
        FallStep::each("they walk on", 3.0, |scene, _| {
            drive(scene, 0.0);
            scene.walk(0, 0.5 * Vec3::NEG_Z, false);
        }),
    ])
    .ask("the car is fast when it comes", |trace| {
        let first = hit_at(trace);
        let speed = first.and_then(|n| trace.samples[n.saturating_sub(2)].car);
        let speed = speed.map_or(f32::NAN, |car| car.1);
        Verdict::new(speed > 5.0, format!("{speed:.1} m/s"))
    })
    .ask("it throws the walker down, and along", |trace| {
        let Some(n) = hit_at(trace) else {
            return Verdict::never("was hit");
        };
        let after = &trace.samples[n..(n + 16).min(trace.samples.len())];
        let thrown = greatest(after.iter().map(|s| s.figures[0].velocity().x));
        Verdict::new(
            (0.3 * SPEED..1.6 * SPEED).contains(&thrown),
            format!("{thrown:.1} m/s"),
        )
    })
    .ask("the car is slowed by what it hit, not stopped", |trace| {
        let Some(n) = hit_at(trace) else {
            return Verdict::never("was hit");
        };
        let speed = |n: usize| {
            trace
                .samples
                .get(n)
                .and_then(|s| s.car)
                .map_or(f32::NAN, |c| c.1)
        };
        let lost = speed(n.saturating_sub(2)) - speed(n + 4);
        Verdict::new(
            (0.0..0.3 * SPEED).contains(&lost),
            format!("{lost:.2} m/s lost in 4 ticks"),
        )
    })
    .ask("they stand again", |trace| {
        let Some((_, f)) = during(trace, 2, 0).last() else {
            return Verdict::never("was there");
        };
        let height = f.head.y - f.foot.y;
        Verdict::new(
            f.phase == BodyPhase::Upright && height > 1.4,
            format!("{:?}, head {height:.2} m above the ground", f.phase),
        )
    })
    .ask("and walk on: 2 m in 3 s", |trace| {
        let places: Vec<Vec3> = during(trace, 3, 0).map(|(_, f)| f.foot).collect();
        let (Some(first), Some(end)) = (places.first(), places.last()) else {
            return Verdict::never("walked");
        };
        let way = first.distance(*end);
        Verdict::new(way > 2.0, format!("{way:.2} m"))
    })
    .ask_whole(0.08, 0.1)
}

/// Whether the walker has been thrown down.
fn fell(scene: &Scene) -> bool {
    let state = scene.world.get::<CharacterRagdollState>(scene.figure(0));
    state.is_some_and(|state| state.phase != BodyPhase::Upright)
}

/// The tick in which the walker fell.
fn hit_at(trace: &FallTrace) -> Option<usize> {
    let down = |f: &Fallen| f.phase == BodyPhase::Down;
    trace
        .samples
        .iter()
        .position(|s| s.figures.first().is_some_and(down))
}

/// Holds a speed, or stands on the brake.
fn drive(scene: &mut Scene, speed: f32) {
    let Some(car) = scene.crew.car else { return };
    let now = scene
        .world
        .get::<VehicleTelemetry>(car)
        .map_or(0.0, |t| t.speed);
    if let Some(mut intent) = scene.world.get_mut::<VehicleIntent>(car) {
        intent.throttle = if speed > 0.0 {
            (0.5 * (speed - now)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        intent.brake = if speed > 0.0 { 0.0 } else { 1.0 };
    }
}
