//! Bones that are sent to their pose by velocities.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Walks straight on while both arms and legs swing.
fn step(sim: &mut Sim, entity: Entity, tick: usize, speed: f32) {
    let profile = sim.get::<Ragdoll>(entity).profile;
    let time = tick as f32 * sim.dt();
    let swing = 0.6 * ops::sin(time * 6.0);
    let pose = RagdollPose::from_turns(
        &profile,
        [
            ("thigh_l", Quat::from_rotation_x(swing)),
            ("thigh_r", Quat::from_rotation_x(-swing)),
            ("upper_arm_l", Quat::from_rotation_x(-swing)),
            ("upper_arm_r", Quat::from_rotation_x(swing)),
        ],
    );
    insert(sim, entity, pose);
    stride(sim, entity, Vec3::NEG_Z * speed);
}

/// Greatest distance of a bone from where the pose has it.
fn off(sim: &Sim, entity: Entity) -> f32 {
    let state = sim.get::<RagdollState>(entity);
    let off = |b: &BoneState| {
        b.target
            .map_or(0.0, |t| t.position.distance(b.place.position))
    };
    state.bones.iter().map(off).fold(0.0, f32::max)
}

use bevy_embody::ragdoll::BoneState;

#[test]
fn with_nothing_in_the_way_every_bone_is_where_the_pose_is() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Keyframed;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y);
        let mut worst = 0.0f32;
        for tick in 0..(hz * 2.0) as usize {
            step(&mut sim, entity, tick, 2.0);
            if tick > 3 {
                worst = worst.max(off(&sim, entity));
            }
        }
        findings.at_most(format!("{hz} Hz: farthest bone, m"), worst, 0.01);
    }
}

#[test]
fn what_is_loose_is_shoved_aside_and_what_is_fixed_holds_until_the_way_is_free() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Keyframed;
        let (mut sim, entity) = above_ground(hz, HumanoidDetail::Bodies19, mode, 0.05);
        let crate_ = sim.dynamic(
            Collider::cuboid(0.2, 0.2, 0.2),
            Transform::from_xyz(0.0, 0.2, -1.0),
            5.0,
        );
        // A bar at the height of the head.
        let bar = sim.block(Vec3::new(0.0, 1.6, -3.0), Vec3::new(2.0, 0.1, 0.1));
        let mut worst = 0.0f32;
        for tick in 0..(hz * 2.6) as usize {
            step(&mut sim, entity, tick, 1.2);
            for out in outputs(&sim, entity) {
                worst = worst.max(out.velocity.length());
            }
        }
        findings.at_least(
            format!("{hz} Hz: way of the crate, m"),
            -1.0 - sim.position(crate_).z,
            0.5,
        );
        findings.at_most(format!("{hz} Hz: fastest bone, m/s"), worst, 12.0);
        sim.app.world_mut().despawn(bar);
        for tick in 0..(hz * 0.5) as usize {
            step(&mut sim, entity, tick, 0.0);
        }
        findings.at_most(
            format!("{hz} Hz: error once it is free, m"),
            off(&sim, entity),
            0.03,
        );
        findings.holds("finite", finite(&sim, entity));
    }
}

#[test]
fn a_figure_that_was_animated_elsewhere_is_keyframed_from_where_it_was_animated_to() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Animated;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, mode, Vec3::Y * 2.0);
        sim.ticks(2);
        // Far from where its bodies were built.
        edit::<Transform>(&mut sim, entity, |t| {
            *t = Transform::from_xyz(7.0, 3.0, -4.0).with_rotation(Quat::from_rotation_y(1.5));
        });
        sim.ticks(3);
        ask(&mut sim, entity, RagdollMode::Keyframed);
        for tick in 0..3 {
            sim.ticks(1);
            let what = format!("{hz} Hz, {tick}: off, m");
            findings.at_most(what, off(&sim, entity), 0.005);
        }
    }
}

#[test]
fn a_keyframed_figure_does_not_run_away_from_itself() {
    let mut findings = Findings::new();
    for mode in [RagdollMode::Keyframed, RagdollMode::Partial] {
        let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies15, mode, Vec3::Y * 2.0);
        insert(&mut sim, entity, FollowRoot);
        let profile = sim.get::<Ragdoll>(entity).profile;
        // The pose leans, and stands off its origin.
        let mut pose = RagdollPose::from_turns(&profile, [("pelvis", Quat::from_rotation_x(0.4))]);
        for bone in &mut pose.bones {
            bone.position += Vec3::new(0.2, 0.3, 0.1);
        }
        insert(&mut sim, entity, pose);
        sim.ticks(1);
        for part in bones(&sim, entity) {
            edit::<BoneControl>(&mut sim, part, |c| {
                c.simulated = true;
                c.pin = 1.0;
            });
        }
        sim.seconds(1.0);
        let way = sim.position(entity).distance(Vec3::Y * 2.0);
        findings.at_most(format!("{mode:?}: way of the figure, m"), way, 0.0);
    }
}
