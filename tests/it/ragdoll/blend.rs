//! What is shown lies between animation and physics.

use std::collections::HashMap;

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A figure whose bones show the joints of a skeleton below it. Between chest and neck is a joint
/// without a bone.
fn skinned(hz: f64, mode: RagdollMode, at: Vec3) -> (Sim, Entity, HashMap<String, Entity>) {
    let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, at);
    let joints = skeleton(&mut sim, entity);
    (sim, entity, joints)
}

fn skeleton(sim: &mut Sim, entity: Entity) -> HashMap<String, Entity> {
    sim.ticks(1);
    let profile = sim.get::<Ragdoll>(entity).profile;
    let mut joints: HashMap<String, Entity> = HashMap::new();
    // The profile lists parents before children.
    for planned in &profile.bones {
        let (above, from) = match &planned.parent {
            Some(parent) => (joints[parent], profile.bone(parent).unwrap().position),
            None => (entity, Vec3::ZERO),
        };
        let mut local = Transform::from_translation(planned.position - from);
        let mut above = above;
        if planned.name == "neck" {
            let half = local.translation * 0.5;
            let between = sim.spawn((Transform::from_translation(half), ChildOf(above)));
            joints.insert("between".into(), between);
            local.translation -= half;
            above = between;
        }
        let joint = sim.spawn((local, ChildOf(above)));
        let part = bone(sim, entity, &planned.name);
        insert(sim, part, BoneJoint::new(joint));
        joints.insert(planned.name.clone(), joint);
    }
    joints
}

fn locals(sim: &Sim, joints: &HashMap<String, Entity>) -> Vec<Transform> {
    let mut names: Vec<&String> = joints.keys().collect();
    names.sort();
    names
        .iter()
        .map(|n| sim.get::<Transform>(joints[*n]))
        .collect()
}

fn shown(sim: &Sim, entity: Entity, name: &str) -> f32 {
    let order = sim.get::<RagdollBone>(bone(sim, entity, name)).order;
    sim.get::<RagdollState>(entity).bones[order].shown
}

fn angle(q: Quat) -> f32 {
    q.to_axis_angle()
        .1
        .min(core::f32::consts::TAU - q.to_axis_angle().1)
}

#[test]
fn physics_fades_in_and_out_in_the_times_asked_for() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity, _) = skinned(hz, RagdollMode::HitBoxes, Vec3::Y * 30.0);
        edit::<Ragdoll>(&mut sim, entity, |r| {
            r.blend.fade_in = 0.2;
            r.blend.fade_out = 0.5;
            r.fade = 0.0;
        });
        let _ = skeleton(&mut sim, entity);
        sim.ticks(2);
        findings.near(
            format!("{hz} Hz: animated"),
            shown(&sim, entity, "chest"),
            0.0,
            0.0,
        );
        ask(&mut sim, entity, RagdollMode::Limp);
        let tick = sim.dt();
        for time in [0.1f32, 0.1] {
            sim.seconds(f64::from(time));
        }
        findings.near(
            format!("{hz} Hz: faded in"),
            shown(&sim, entity, "chest"),
            1.0,
            1.0e-4,
        );
        ask(&mut sim, entity, RagdollMode::HitBoxes);
        sim.seconds(0.2);
        findings.near(
            format!("{hz} Hz: fading out"),
            shown(&sim, entity, "chest"),
            0.6,
            2.1 * tick,
        );
        sim.seconds(0.4);
        findings.near(
            format!("{hz} Hz: faded out"),
            shown(&sim, entity, "chest"),
            0.0,
            0.0,
        );
        // Half way in, by a tick.
        ask(&mut sim, entity, RagdollMode::Limp);
        sim.seconds(0.1);
        findings.near(
            format!("{hz} Hz: half"),
            shown(&sim, entity, "chest"),
            0.5,
            5.1 * tick,
        );
    }
}

#[test]
fn what_follows_the_animation_is_shown_as_it_is_animated() {
    let (mut sim, _, joints) = skinned(60.0, RagdollMode::HitBoxes, Vec3::Y);
    let mut findings = Findings::new();
    for n in 0..10 {
        let turn = Quat::from_rotation_x(0.05 * n as f32);
        edit::<Transform>(&mut sim, joints["thigh_l"], |t| t.rotation = turn);
        let before = locals(&sim, &joints);
        sim.ticks(1);
        findings.same(format!("joints, {n}"), &before, &locals(&sim, &joints));
    }
}

#[test]
fn a_bone_shown_by_half_is_half_way_between_animation_and_physics() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity, joints) = skinned(hz, RagdollMode::HitBoxes, Vec3::Y * 0.5);
        sim.floor(0.0);
        for part in bones(&sim, entity) {
            edit::<BoneControl>(&mut sim, part, |c| c.blend = 0.5);
        }
        let animated = locals(&sim, &joints);
        ask(&mut sim, entity, RagdollMode::Limp);
        sim.seconds(1.0);
        let profile = sim.get::<Ragdoll>(entity).profile;
        let mut largest = 0.0f32;
        for planned in &profile.bones {
            let Some(parent) = &planned.parent else {
                continue;
            };
            let turn = |name: &str| sim.get::<Transform>(bone(&sim, entity, name)).rotation;
            let by_physics = turn(parent).inverse() * turn(&planned.name);
            let local = sim.get::<Transform>(joints[&planned.name]);
            // The animation has no turns.
            let (whole, half) = (angle(by_physics), angle(local.rotation));
            largest = largest.max(whole);
            let what = format!("{hz} Hz: {}: turn, rad", planned.name);
            findings.near(what, half, whole * 0.5, 2.0e-3);
        }
        findings.at_least(format!("{hz} Hz: largest turn, rad"), largest, 0.3);
        // Lengths are kept, and what has no bone is as it was animated.
        for (before, after) in animated.iter().zip(locals(&sim, &joints)) {
            let root = joints["pelvis"];
            if sim.get::<Transform>(root) != after {
                findings.near(
                    "length",
                    before.translation.distance(after.translation),
                    0.0,
                    0.0,
                );
            }
        }
        findings.same(
            "the joint without a bone",
            &[Quat::IDENTITY],
            &[sim.get::<Transform>(joints["between"]).rotation],
        );
    }
}

#[test]
fn a_skeleton_shown_by_physics_alone_is_where_the_bones_are() {
    let (mut sim, entity, joints) = skinned(60.0, RagdollMode::Limp, Vec3::Y * 0.5);
    sim.floor(0.0);
    sim.seconds(1.5);
    let mut findings = Findings::new();
    for (name, joint) in &joints {
        if name == "between" {
            continue;
        }
        let part = sim.get::<Transform>(bone(&sim, entity, name));
        let joint = sim.get::<GlobalTransform>(*joint);
        let off = joint.translation().distance(part.translation);
        findings.at_most(format!("{name}: off, m"), off, 0.005);
        let turned = angle(joint.rotation().inverse() * part.rotation);
        findings.at_most(format!("{name}: turned, rad"), turned, 2.0e-3);
    }
}

#[test]
fn the_muscles_aim_at_the_animation_and_not_at_what_is_shown() {
    let (mut sim, entity, joints) = skinned(60.0, RagdollMode::Powered, Vec3::Y * 1.0);
    sim.floor(0.0);
    let animated = locals(&sim, &joints);
    let asked = |sim: &Sim| -> Vec<Quat> {
        let bones = sim.get::<RagdollState>(entity).bones;
        bones
            .iter()
            .filter_map(|b| b.target.map(|t| t.rotation))
            .collect()
    };
    sim.ticks(1);
    let before = asked(&sim);
    for part in bones(&sim, entity) {
        edit::<BoneControl>(&mut sim, part, |c| c.blend = 0.7);
    }
    // It falls over meanwhile.
    sim.seconds(2.0);
    let mut findings = Findings::new();
    let apart = locals(&sim, &joints) != animated;
    findings.holds("what is shown is not what is animated", apart);
    for (a, b) in before.iter().zip(asked(&sim)) {
        findings.at_most("asked for otherwise, rad", angle(a.inverse() * b), 1.0e-3);
    }
    // And what was animated is shown again in the end.
    ask(&mut sim, entity, RagdollMode::HitBoxes);
    sim.seconds(2.0);
    findings.same("joints", &animated, &locals(&sim, &joints));
}

#[test]
fn a_figure_that_goes_with_its_root_is_shown_without_sliding_when_it_comes_back() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let entity = human(
            &mut sim,
            HumanoidDetail::Bodies19,
            RagdollMode::HitBoxes,
            Vec3::ZERO,
        );
        insert(&mut sim, entity, FollowRoot);
        let joints = skeleton(&mut sim, entity);
        for _ in 0..(hz * 0.4) as usize {
            let way = Vec3::NEG_Z * 5.0 * sim.dt();
            edit::<Transform>(&mut sim, entity, |t| t.translation += way);
            sim.ticks(1);
        }
        ask(&mut sim, entity, RagdollMode::Limp);
        sim.seconds(3.0);
        let pelvis = sim.position(bone(&sim, entity, "pelvis"));
        let at = sim.position(entity);
        findings.at_least(format!("{hz} Hz: thrown, m"), -pelvis.z, 2.0);
        let beside = Vec2::new(pelvis.x - at.x, pelvis.z - at.z).length();
        findings.at_most(
            format!("{hz} Hz: figure beside its pelvis, m"),
            beside,
            0.02,
        );
        findings.near(format!("{hz} Hz: figure above ground, m"), at.y, 0.0, 0.02);
        ask(&mut sim, entity, RagdollMode::GettingUp);
        let place = |sim: &Sim| sim.get::<GlobalTransform>(joints["pelvis"]).translation();
        let mut last = place(&sim);
        let (mut fastest, mut aside) = (0.0f32, 0.0f32);
        for _ in 0..(hz * 1.5) as usize {
            sim.ticks(1);
            let now = place(&sim);
            fastest = fastest.max(now.distance(last) / sim.dt());
            aside = aside.max(Vec2::new(now.x - pelvis.x, now.z - pelvis.z).length());
            last = now;
        }
        findings.at_most(format!("{hz} Hz: fastest shown, m/s"), fastest, 4.0);
        findings.at_most(format!("{hz} Hz: shown aside, m"), aside, 0.05);
        findings.near(format!("{hz} Hz: it stands, m"), last.y, 0.53 * 1.75, 0.02);
    }
}

#[test]
fn what_is_animated_again_is_to_the_bit_as_the_animation_has_it() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity, joints) = skinned(hz, RagdollMode::HitBoxes, Vec3::Y * 20.0);
        // Some joints stand still, others are written again and again.
        let wave = |sim: &mut Sim, tick: usize| {
            let turn = Quat::from_rotation_x(0.3 + 0.01 * tick as f32);
            edit::<Transform>(sim, joints["upper_arm_l"], |t| t.rotation = turn);
        };
        sim.ticks(2);
        wave(&mut sim, 0);
        sim.ticks(1);
        let before = locals(&sim, &joints);
        for mode in [RagdollMode::Limp, RagdollMode::Powered, RagdollMode::Frozen] {
            ask(&mut sim, entity, mode);
            for tick in 0..(hz * 0.4) as usize {
                wave(&mut sim, tick);
                sim.ticks(1);
            }
            let away = locals(&sim, &joints);
            findings.holds(format!("{hz} Hz, {mode:?}: it was away"), away != before);
            ask(&mut sim, entity, RagdollMode::Animated);
            for tick in 0..(hz * 1.2) as usize {
                wave(&mut sim, tick);
                sim.ticks(1);
            }
            // The last word of the animation, with or without another tick of it.
            for again in [true, false] {
                if again {
                    wave(&mut sim, 0);
                }
                sim.ticks(1);
                let now = locals(&sim, &joints);
                findings.same(format!("{hz} Hz, {mode:?}: joints"), &before, &now);
            }
        }
    }
}
