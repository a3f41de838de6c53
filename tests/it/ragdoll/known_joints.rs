//! What joints of other engines are known to get wrong: limits that bounce, drives that know one kind of
//! joint, learned policies without limits, and gaps under load.

use bevy::{math::Vec2, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::Damping;
use embody_scenes::Sim;

use super::{limits::kinds, support::*};

/// A block, and links of 0.3 m and these masses that hang from it in a row.
fn chain(links: &[(f32, JointProfile)]) -> RagdollProfile {
    let mut profile = arm(JointProfile::default());
    let link = profile.bones.remove(1);
    for (i, (mass, joint)) in links.iter().enumerate() {
        let mut link = link.clone();
        link.name = format!("link{i}");
        link.parent = Some(match i {
            0 => "block".into(),
            _ => format!("link{}", i - 1),
        });
        link.position = Vec3::NEG_Y * 0.3 * i as f32;
        link.mass.share = *mass;
        link.joint = *joint;
        profile.bones.push(link);
    }
    profile
}

fn names(profile: &RagdollProfile) -> Vec<String> {
    let all = profile.bones.iter().skip(1);
    all.map(|bone| bone.name.clone()).collect()
}

/// A chain that hangs from its block.
fn hanging(
    hz: f64,
    profile: RagdollProfile,
    strength: f32,
    change: impl FnOnce(&mut Ragdoll),
) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    let mass = profile.bones.iter().map(|b| b.mass.share).sum();
    let links = names(&profile);
    let mut ragdoll = Ragdoll {
        conditioning: 0.0,
        ..Ragdoll::new(profile, mass)
    };
    change(&mut ragdoll);
    let intent = RagdollIntent {
        mode: RagdollMode::Partial,
        strength,
    };
    let entity = sim.spawn((ragdoll, intent, Transform::from_xyz(0.0, 5.0, 0.0)));
    sim.ticks(1);
    simulate(&mut sim, entity, links.iter().map(String::as_str));
    sim.ticks(1);
    (sim, entity)
}

/// What gravity makes the arm gain in a second where it lies level, radians per second.
const ARM_GAINS: f32 = 52.0;

#[test]
fn an_arm_that_rests_on_a_limit_does_not_bounce_there() {
    let mut findings = Findings::new();
    for hz in RATES {
        for (name, kind, frame) in kinds() {
            for friction in [0.0, 1.0] {
                let joint = JointProfile {
                    kind,
                    frame,
                    friction,
                    ..default()
                };
                // Upside down and aslant: gravity leans the arm on what bounds it.
                let at = Transform::from_rotation(Quat::from_euler(EulerRot::XYZ, 2.6, 0.3, 0.4));
                let (mut sim, _, limb) = hung(hz, joint, 0.0, at);
                // Without any, it would swing along the rim for a long time.
                let damping = Damping {
                    linear_damping: 0.0,
                    angular_damping: 2.0,
                };
                insert(&mut sim, limb, damping);
                sim.seconds(6.0);
                let rests = sim.get::<Transform>(limb).rotation;
                let (mut fastest, mut farthest) = (0.0f32, 0.0f32);
                for _ in 0..hz as usize {
                    sim.ticks(1);
                    fastest = fastest.max(sim.get::<BoneOutput>(limb).spin.length());
                    let now = sim.get::<Transform>(limb).rotation;
                    farthest = farthest.max(now.angle_between(rests).to_degrees());
                }
                let out = sim.get::<BoneOutput>(limb);
                let what = format!("{hz} Hz, {name}, friction {friction}");
                // The engine lets go of a limit for single substeps.
                let substep = (1.0 / 240.0f32).min(0.25 / hz as f32);
                let hums = ARM_GAINS * substep;
                // A thin limb that nothing damps wobbles about itself where the twist is locked apart.
                if friction > 0.0 || name != "condyloid" {
                    findings.at_most(format!("{what}: spin, rad/s"), fastest, hums + 0.05);
                }
                // With friction it may still creep.
                if friction == 0.0 && name != "condyloid" {
                    findings.at_most(format!("{what}: moves, degrees"), farthest, 0.15);
                }
                let off = out.violation.to_degrees();
                findings.at_most(format!("{what}: violation, degrees"), off, 0.5);
            }
        }
    }
}

#[test]
fn a_drive_knows_every_kind_of_joint_in_one_figure() {
    let mut findings = Findings::new();
    let gliding = JointKind::Gliding {
        reach: Vec2::new(0.01, 0.0),
    };
    let others = kinds().into_iter().map(|(_, kind, frame)| (kind, frame));
    for (kind, frame) in others.chain([(gliding, along_arm())]) {
        // Among a ball and a hinge.
        let [first, _, hinge, ..] = kinds();
        let all = [(first.1, first.2), (kind, frame), (hinge.1, hinge.2)];
        let all = all.map(|(kind, frame)| {
            let joint = JointProfile {
                kind,
                frame,
                ..default()
            };
            (1.0, joint)
        });
        let profile = chain(&all);
        for hz in RATES {
            let (mut sim, entity) = hanging(hz, profile.clone(), 1.0, |_| {});
            let turn = Quat::from_rotation_x(0.2);
            let links = names(&profile);
            let turns = links.iter().map(|name| (name.as_str(), turn));
            insert(&mut sim, entity, RagdollPose::from_turns(&profile, turns));
            sim.seconds(3.0);
            for (i, (_, joint)) in all.iter().enumerate() {
                let limb = bone(&sim, entity, &format!("link{i}"));
                let out = sim.get::<BoneOutput>(limb);
                let what = format!("{hz} Hz, {kind:?}, {i}");
                // About X swing hinges, and what is neither twist nor locked.
                let can = !matches!(
                    joint.kind,
                    JointKind::Fixed | JointKind::Gliding { .. } | JointKind::Pivot { .. }
                );
                let error = if can { 0.0 } else { 0.2f32.to_degrees() };
                let is = out.error.to_degrees();
                findings.near(format!("{what}: error, degrees"), is, error, 1.0);
                let off = out.violation.to_degrees();
                findings.at_most(format!("{what}: violation, degrees"), off, 0.5);
            }
            let speed = worst(&sim, entity, |o| o.spin.length());
            findings.at_most(format!("{hz} Hz, {kind:?}: spin, rad/s"), speed, 0.05);
        }
    }
}

/// The figure that motions are learned with, 45 kg and 1.62 m: a tree of balls, knees and elbows hinges.
fn learner() -> Ragdoll {
    let mut profile = RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.62);
    let shares = [
        ("pelvis", 6.0, 0.0),
        ("chest", 14.0, 200.0),
        ("head", 2.0, 50.0),
        ("thigh", 4.5, 200.0),
        ("shin", 3.0, 150.0),
        ("foot", 1.0, 90.0),
        ("upper_arm", 1.5, 100.0),
        ("forearm", 1.0, 60.0),
        ("hand", 0.5, 10.0),
    ];
    for bone in &mut profile.bones {
        let of = shares.iter().find(|(name, ..)| bone.name.starts_with(name));
        if let Some((_, share, torque)) = of {
            bone.mass.share = *share;
            bone.joint.max_torque = *torque;
        }
    }
    Ragdoll::new(profile, 45.0)
}

#[test]
fn a_policy_thirty_times_a_second_gets_no_joint_beyond_its_limits() {
    let mut findings = Findings::new();
    // As learners run it: several ticks of physics for each step of the policy.
    for hz in [240.0] {
        let mut sim = Sim::new(hz);
        ground(&mut sim);
        let ragdoll = learner();
        let profile = ragdoll.profile.clone();
        let mode = RagdollMode::Powered;
        let entity = figure(&mut sim, ragdoll, mode, Vec3::Y * 0.05);
        sim.ticks(2);
        let mut dice = Dice::new(17);
        let (mut off, mut gap) = (0.0f32, 0.0f32);
        let (every, steps) = ((hz / 30.0) as usize, 15);
        let mut from = RagdollPose::from_turns(&profile, []);
        let mut to = from.clone();
        for tick in 0..(hz * 8.0) as usize {
            let (step, at_step) = (tick / every, tick % every == 0);
            if at_step && step % steps == 0 {
                // From anywhere to anywhere within the limits, each half a second.
                from = core::mem::replace(&mut to, random_pose(&profile, &mut dice, 1.0));
            }
            if at_step {
                let part = (step % steps + 1) as f32 / steps as f32;
                let both = from.bones.iter().zip(&to.bones);
                let bones = both.map(|(a, b)| BonePose {
                    position: a.position.lerp(b.position, part),
                    rotation: a.rotation.slerp(b.rotation, part),
                });
                let bones = bones.collect();
                insert(&mut sim, entity, RagdollPose { bones });
            }
            sim.ticks(1);
            off = off.max(worst(&sim, entity, |o| o.violation.to_degrees()));
            gap = gap.max(worst(&sim, entity, |o| o.gap));
        }
        findings.at_most(format!("{hz} Hz: violation, degrees"), off, 5.0);
        findings.at_most(format!("{hz} Hz: gap, m"), gap, 0.015);
        findings.holds(format!("{hz} Hz: finite"), finite(&sim, entity));
    }
}

#[test]
fn joints_hold_together_under_a_load_of_fifty_kilograms_that_is_kicked() {
    let mut findings = Findings::new();
    let free = JointProfile {
        kind: JointKind::Ball {
            swing: Vec2::splat(2.8),
            center: Vec2::ZERO,
            twist: Vec2::splat(1.0) * Vec2::new(-1.0, 1.0),
        },
        frame: along_arm(),
        friction: 0.0,
        ..default()
    };
    let links = [2.0, 1.2, 0.5, 50.0].map(|mass| (mass, free));
    for hz in RATES {
        for conditioning in [0.0, 1.0] {
            let change = |r: &mut Ragdoll| r.conditioning = conditioning;
            let (mut sim, entity) = hanging(hz, chain(&links), 0.0, change);
            sim.seconds(2.0);
            let what = format!("{hz} Hz, conditioned by {conditioning}");
            let gap = worst(&sim, entity, |o| o.gap);
            findings.at_most(format!("{what}: gap at rest, m"), gap, 0.005);
            let load = bone(&sim, entity, "link3");
            let point = sim.position(load) + Vec3::NEG_Y * 0.15;
            hit(&mut sim, load, point, Vec3::X * 4.0 * 50.0);
            let mut widest = 0.0f32;
            for _ in 0..(hz * 3.0) as usize {
                sim.ticks(1);
                widest = widest.max(worst(&sim, entity, |o| o.gap));
            }
            findings.at_most(format!("{what}: gap after the kick, m"), widest, 0.015);
        }
    }
}
