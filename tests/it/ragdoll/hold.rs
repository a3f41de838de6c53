//! Driven figures take the pose that they are asked to take.

use core::f32::consts::PI;

use bevy::math::Vec2;
use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Mean and largest error of all joints, degrees.
fn errors(sim: &Sim, ragdoll: Entity) -> (f32, f32) {
    let all: Vec<f32> = outputs(sim, ragdoll)
        .iter()
        .map(|o| o.error.to_degrees())
        .collect();
    let sum: f32 = all.iter().sum();
    (
        sum / (all.len() - 1) as f32,
        all.iter().copied().fold(0.0, f32::max),
    )
}

fn held(hz: f64, change: impl FnOnce(&mut Ragdoll)) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies23, 1.75);
    // An elbow bends about its own axis only.
    let elbow = profile.bone("forearm_l").unwrap().joint.frame * Vec3::X;
    let pose = RagdollPose::from_turns(
        &profile,
        [
            ("upper_arm_l", Quat::from_rotation_x(1.2)),
            ("forearm_l", Quat::from_axis_angle(elbow, 0.8)),
            ("upper_arm_r", Quat::from_rotation_z(1.0)),
            ("thigh_l", Quat::from_rotation_x(1.0)),
            ("shin_l", Quat::from_rotation_x(-0.9)),
            ("chest", Quat::from_rotation_x(-0.1)),
        ],
    );
    let mut ragdoll = Ragdoll::new(profile, 75.0);
    change(&mut ragdoll);
    let intent = RagdollIntent {
        mode: RagdollMode::Partial,
        strength: 1.0,
    };
    let entity = sim.spawn((ragdoll, intent, pose, Transform::from_xyz(0.0, 3.0, 0.0)));
    sim.ticks(1);
    let root = bone(&sim, entity, "pelvis");
    for part in bones(&sim, entity) {
        if part != root {
            edit::<BoneControl>(&mut sim, part, |c| c.simulated = true);
        }
    }
    (sim, entity)
}

#[test]
fn a_figure_held_by_its_pelvis_keeps_its_pose_under_gravity() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity) = held(hz, |_| {});
        sim.seconds(5.0);
        let (mean, largest) = errors(&sim, entity);
        findings.at_most(format!("{hz} Hz: mean error, degrees"), mean, 1.0);
        findings.at_most(format!("{hz} Hz: largest error, degrees"), largest, 3.0);
        let speed = worst(&sim, entity, |o| o.velocity.length());
        findings.at_most(format!("{hz} Hz: fastest bone, m/s"), speed, 0.05);
        let gap = worst(&sim, entity, |o| o.gap);
        findings.at_most(format!("{hz} Hz: gap, m"), gap, 0.002);
    }
}

#[test]
fn without_the_torque_that_bears_weight_a_figure_sags() {
    let (mut sim, entity) = held(60.0, |r| r.drive.gravity = 0.0);
    sim.seconds(5.0);
    let (sagging, _) = errors(&sim, entity);
    let (mut sim, entity) = held(60.0, |_| {});
    sim.seconds(5.0);
    let (bearing, _) = errors(&sim, entity);
    let mut findings = Findings::new();
    findings.at_least("times as much", sagging / bearing, 1.5);
}

#[test]
fn a_joint_reaches_its_pose_from_any_rotation_up_to_170_degrees() {
    let mut findings = Findings::new();
    let mut dice = Dice::new(5);
    let free = JointKind::Ball {
        swing: Vec2::splat(3.07),
        center: Vec2::ZERO,
        twist: Vec2::new(-PI, PI),
    };
    let joint = JointProfile {
        kind: free,
        frame: along_arm(),
        max_torque: f32::INFINITY,
        ..default()
    };
    for degrees in [60.0f32, 120.0, 150.0, 170.0] {
        let mut largest = 0.0f32;
        for _ in 0..30 {
            let mut sim = Sim::new(60.0);
            let mut ragdoll = Ragdoll {
                conditioning: 0.0,
                ..Ragdoll::new(arm(joint), 4.0)
            };
            ragdoll.drive.frequency = 6.0;
            let turn = Quat::from_axis_angle(dice.direction(), degrees.to_radians());
            let pose = RagdollPose::from_turns(&ragdoll.profile, [("arm", turn)]);
            let intent = RagdollIntent {
                mode: RagdollMode::Partial,
                strength: 1.0,
            };
            let entity = sim.spawn((ragdoll, intent, Transform::default()));
            sim.ticks(1);
            let limb = bone(&sim, entity, "arm");
            edit::<BoneControl>(&mut sim, limb, |c| c.simulated = true);
            sim.ticks(1);
            // The pose jumps: from here on no velocity is asked for.
            insert(&mut sim, entity, pose);
            sim.seconds(3.0);
            // The limits leave out a cone of four degrees straight up.
            largest = largest.max(sim.get::<BoneOutput>(limb).error.to_degrees());
        }
        findings.at_most(format!("{degrees} degrees: error"), largest, 1.0);
    }
}

#[test]
fn a_pose_beyond_the_limits_is_taken_as_far_as_they_go_and_lets_it_sleep() {
    let mut sim = Sim::new(60.0);
    let joint = JointProfile {
        kind: JointKind::Hinge {
            min: -0.5,
            max: 0.5,
        },
        ..default()
    };
    let ragdoll = Ragdoll::new(arm(joint), 4.0);
    let pose = RagdollPose::from_turns(&ragdoll.profile, [("arm", Quat::from_rotation_x(1.4))]);
    let intent = RagdollIntent {
        mode: RagdollMode::Partial,
        strength: 1.0,
    };
    let entity = sim.spawn((ragdoll, intent, pose, Transform::default()));
    sim.ticks(1);
    let limb = bone(&sim, entity, "arm");
    edit::<BoneControl>(&mut sim, limb, |c| c.simulated = true);
    sim.seconds(5.0);
    let out = sim.get::<BoneOutput>(limb);
    let mut findings = Findings::new();
    findings.near(
        "error, degrees",
        out.error.to_degrees(),
        (0.9f32).to_degrees(),
        1.0,
    );
    findings.at_most("violation, degrees", out.violation.to_degrees(), 0.5);
    findings.holds("it sleeps", out.asleep);
}

#[test]
fn a_powered_figure_pinned_by_its_pelvis_stays_where_it_is() {
    let mut findings = Findings::new();
    for hz in RATES {
        let at = Vec3::Y * 3.0;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies23, RagdollMode::Powered, at);
        sim.ticks(1);
        let pelvis = bone(&sim, entity, "pelvis");
        edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
        let start = sim.position(pelvis);
        sim.seconds(3.0);
        let off = sim.position(pelvis).distance(start);
        findings.at_most(format!("{hz} Hz: way of the pelvis, m"), off, 0.01);
        let (mean, largest) = errors(&sim, entity);
        findings.at_most(format!("{hz} Hz: mean error, degrees"), mean, 1.0);
        findings.at_most(format!("{hz} Hz: largest error, degrees"), largest, 3.0);
        edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 0.0);
        sim.seconds(0.3);
        let fallen = start.y - sim.position(pelvis).y;
        findings.within(format!("{hz} Hz: falls when let go, m"), fallen, 0.44, 0.15);
    }
}

#[test]
fn a_pin_bears_what_hangs_on_it_and_nothing_that_was_cut_off() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Powered;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, mode, Vec3::Y * 60.0);
        sim.ticks(1);
        let [pelvis, thigh] = ["pelvis", "thigh_l"].map(|n| bone(&sim, entity, n));
        for part in [pelvis, thigh] {
            edit::<BoneControl>(&mut sim, part, |c| c.pin = 1.0);
        }
        sim.ticks(2);
        // Cut off, the thigh is pinned no more, and what is left is lighter.
        sim.app.world_mut().trigger(Dismember { entity: thigh });
        sim.ticks(2);
        let start = sim.position(pelvis);
        sim.seconds(2.0);
        let off = sim.position(pelvis).distance(start);
        findings.at_most(format!("{hz} Hz: way of the pelvis, m"), off, 0.003);
    }
}
