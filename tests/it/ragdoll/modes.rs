//! Every switch keeps the place and the velocity of every bone.

use bevy::prelude::*;
use bevy_embody::{
    prelude::*,
    ragdoll::{BoneBody, BoneState},
};

use super::support::*;

#[test]
fn a_runner_who_falls_keeps_the_momentum() {
    let mut findings = Findings::new();
    for hz in RATES {
        for from in [RagdollMode::HitBoxes, RagdollMode::Animated] {
            for to in [RagdollMode::Limp, RagdollMode::Powered] {
                let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, from, Vec3::Y * 5.0);
                let velocity = Vec3::new(0.0, 0.0, -6.0);
                for _ in 0..10 {
                    stride(&mut sim, entity, velocity);
                }
                let before = sim.get::<Transform>(bone(&sim, entity, "pelvis"));
                ask(&mut sim, entity, to);
                stride(&mut sim, entity, velocity);
                let (momentum, mass) = momentum(&sim, entity);
                let what = format!("{hz} Hz, {from:?} to {to:?}");
                findings.near(format!("{what}: mass"), mass, 75.0, 0.01);
                findings.within(format!("{what}: speed"), -momentum.z / mass, 6.0, 0.01);
                if from == RagdollMode::HitBoxes {
                    let after = sim.get::<Transform>(bone(&sim, entity, "pelvis"));
                    let way = before.translation.z - after.translation.z;
                    findings.within(format!("{what}: way"), way, 6.0 / hz as f32, 0.03);
                }
            }
        }
    }
}

#[test]
fn a_figure_that_follows_a_pose_is_where_the_pose_is() {
    let at = Vec3::new(1.0, 2.0, 3.0);
    let mode = RagdollMode::HitBoxes;
    let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies23, mode, at);
    sim.ticks(3);
    let profile = sim.get::<Ragdoll>(entity).profile;
    let mut findings = Findings::new();
    for part in bones(&sim, entity) {
        let planned = profile
            .bone(sim.get::<Name>(part).as_str())
            .unwrap()
            .clone();
        let pose = sim.get::<Transform>(part);
        findings.at_most(
            planned.name.clone(),
            pose.translation.distance(at + planned.position),
            1.0e-5,
        );
    }
    // And there is something to hit.
    use bevy_rapier3d::plugin::ReadRapierContext;
    let head = bone(&sim, entity, "head");
    let from = at + Vec3::new(0.0, 1.65, 2.0);
    let hit = sim
        .app
        .world_mut()
        .run_system_cached_with(
            |In(from): In<Vec3>, context: ReadRapierContext| {
                let context = context.single().unwrap();
                let filter = bevy_rapier3d::prelude::QueryFilter::default();
                context.cast_ray(from, Vec3::NEG_Z, 5.0, true, filter)
            },
            from,
        )
        .unwrap();
    findings.holds("a ray hits the head", hit.is_some_and(|(e, _)| e == head));
}

#[test]
fn twenty_switches_in_a_row_move_no_bone_by_a_jump() {
    let all = [
        RagdollMode::Limp,
        RagdollMode::HitBoxes,
        RagdollMode::Powered,
        RagdollMode::Frozen,
        RagdollMode::GettingUp,
        RagdollMode::Limp,
        RagdollMode::Partial,
        RagdollMode::Animated,
        RagdollMode::Powered,
        RagdollMode::Animated,
        RagdollMode::HitBoxes,
        RagdollMode::Limp,
        RagdollMode::Frozen,
        RagdollMode::Limp,
        RagdollMode::GettingUp,
        RagdollMode::Powered,
        RagdollMode::Partial,
        RagdollMode::Limp,
        RagdollMode::Animated,
        RagdollMode::Limp,
    ];
    let mut findings = Findings::new();
    for every in [1, 2, 7] {
        switched(&mut findings, 60.0, every, &all, usize::MAX);
    }
}

#[test]
fn switches_in_any_order_at_any_rate_move_no_bone_by_a_jump() {
    let kinds = [
        RagdollMode::Animated,
        RagdollMode::HitBoxes,
        RagdollMode::Partial,
        RagdollMode::Powered,
        RagdollMode::Keyframed,
        RagdollMode::Limp,
        RagdollMode::Frozen,
        RagdollMode::GettingUp,
    ];
    let mut findings = Findings::new();
    for hz in RATES {
        for seed in 0..4 {
            let mut dice = Dice::new(seed);
            let mut pick = || kinds[((dice.roll() + 1.0) * 4.0) as usize % 8];
            let all: Vec<RagdollMode> = (0..20).map(|_| pick()).collect();
            // Later, at 30 Hz, a fall on the ground moves bones by more than their velocity.
            switched(&mut findings, hz, 1 + 3 * seed as usize, &all, 2);
        }
    }
}

/// Asks a figure over the ground for one mode after the other, so many ticks each. Jumps are looked for in so
/// many ticks of each mode.
fn switched(findings: &mut Findings, hz: f64, every: usize, all: &[RagdollMode], looks: usize) {
    let mode = RagdollMode::HitBoxes;
    let (mut sim, entity) = above_ground(hz, HumanoidDetail::Bodies19, mode, 0.5);
    // What a tick of 60 Hz makes 4 cm of.
    let bends = 144.0 * sim.dt() * sim.dt();
    sim.ticks(3);
    simulate(&mut sim, entity, ["upper_arm_l"]);
    let mut last: Option<Vec<(Vec3, Vec3)>> = None;
    let mut places: Vec<Vec<Vec3>> = Vec::new();
    let ticks = (all.iter().enumerate()).flat_map(|n| (0..every).map(move |tick| (n, tick)));
    for ((n, &mode), tick) in ticks {
        ask(&mut sim, entity, mode);
        sim.ticks(1);
        let what = format!("{hz} Hz, every {every}: {n} {mode:?}");
        let state = sim.get::<RagdollState>(entity);
        let moving = |b: &BoneState| (b.place.position, b.velocity);
        let now: Vec<(Vec3, Vec3)> = state.bones.iter().map(moving).collect();
        if let Some(last) = last.filter(|_| tick < looks) {
            // Of each way of a tick, what neither velocity explains.
            let jump = now.iter().zip(&last).map(|((p, v), (q, u))| {
                let fastest = u.length().max(v.length());
                (p.distance(*q) - fastest * sim.dt()).max(0.0)
            });
            let jump = jump.fold(0.0, f32::max);
            // What closes joints and clears the ground has no velocity, and goes by the tick.
            let most = sim.dt().max(0.01);
            findings.at_most(format!("{what}: jump, m"), jump, most);
        }
        // Of what follows the pose, the velocity comes from its ways; there the change of the way from tick
        // to tick is what a jump shows in.
        places.push(now.iter().map(|(p, _)| *p).collect());
        if let [.., first, second, third] = &places[..] {
            let mut bend = 0.0f32;
            for (i, bone) in state.bones.iter().enumerate() {
                if matches!(bone.body, BoneBody::Off | BoneBody::Kinematic) {
                    let change = third[i] - second[i] * 2.0 + first[i];
                    bend = bend.max(change.length());
                }
            }
            findings.at_most(format!("{what}: bend, m"), bend, bends);
        }
        last = Some(now);
    }
    findings.holds("all is finite", finite(&sim, entity));
    sim.seconds(1.0);
    findings.holds("all is still finite", finite(&sim, entity));
}

#[test]
fn a_frozen_figure_that_was_moved_comes_to_its_new_place_without_overshooting() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::HitBoxes;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, mode, Vec3::Y);
        sim.ticks(3);
        ask(&mut sim, entity, RagdollMode::Frozen);
        sim.ticks(3);
        edit::<Transform>(&mut sim, entity, |t| t.translation.x += 2.0);
        sim.ticks(3);
        let chest = bone(&sim, entity, "chest");
        findings.near(
            format!("{hz} Hz: frozen, m"),
            sim.position(chest).x,
            0.0,
            1.0e-4,
        );
        ask(&mut sim, entity, RagdollMode::HitBoxes);
        let (mut low, mut high) = (0.0f32, 0.0f32);
        for _ in 0..(hz * 0.5) as usize {
            sim.ticks(1);
            low = low.min(sim.position(chest).x);
            high = high.max(sim.position(chest).x);
        }
        findings.near(format!("{hz} Hz: least, m"), low, 0.0, 1.0e-3);
        findings.near(format!("{hz} Hz: most, m"), high, 2.0, 1.0e-3);
        findings.near(
            format!("{hz} Hz: in the end, m"),
            sim.position(chest).x,
            2.0,
            1.0e-3,
        );
    }
}

#[test]
fn a_limb_that_is_simulated_leaves_the_others_to_the_pose() {
    let arm = ["upper_arm_l", "forearm_l", "hand_l"];
    let paths = |hz: f64, loose: bool| {
        let mode = RagdollMode::Partial;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y);
        sim.ticks(1);
        if loose {
            simulate(&mut sim, entity, arm);
        }
        let mut seen = Vec::new();
        for _ in 0..30 {
            stride(&mut sim, entity, Vec3::new(1.0, 0.0, 0.0));
            for part in bones(&sim, entity) {
                if !arm.contains(&sim.get::<Name>(part).as_str()) {
                    seen.push(sim.get::<Transform>(part));
                }
            }
        }
        seen
    };
    let mut findings = Findings::new();
    for hz in RATES {
        let (still, loose) = (paths(hz, false), paths(hz, true));
        findings.same(format!("{hz} Hz: other bones"), &still, &loose);
    }
}

#[test]
fn a_pose_written_with_the_other_sign_turns_nobody() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::HitBoxes;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::ZERO);
        let profile = sim.get::<Ragdoll>(entity).profile;
        let mut pose = RagdollPose::from_turns(&profile, []);
        sim.ticks(3);
        let mut fastest = 0.0f32;
        for _ in 0..6 {
            for bone in &mut pose.bones {
                bone.rotation = -bone.rotation;
            }
            insert(&mut sim, entity, pose.clone());
            sim.ticks(1);
            fastest = fastest.max(worst(&sim, entity, |o| o.spin.length()));
        }
        findings.at_most(format!("{hz} Hz: spin, rad/s"), fastest, 1.0e-3);
    }
}
