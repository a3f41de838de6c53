//! Bones that are sent to their pose by velocities.

use bevy::prelude::*;

use super::{
    config::Ragdoll,
    math::rotation::angular_velocity,
    plan::PlannedBone,
    tick::{BoneForce, Slot},
};
use crate::backend::joints::JointWorlds;

/// Gives a bone the velocity that takes it to its pose in this tick, and bears its weight meanwhile.
pub(super) fn send_by_velocity(
    worlds: &mut JointWorlds,
    config: &Ragdoll,
    bone: &PlannedBone,
    slot: &Slot,
    gravity: Vec3,
    dt: f32,
    forces: &mut Vec<BoneForce>,
) {
    forces.push(BoneForce {
        link: slot.link,
        handle: slot.handle,
        force: gravity * -bone.mass,
        torque: Vec3::ZERO,
    });
    let (to, now) = (&slot.target, &slot.motion);
    // Its centre goes straight there, whatever the turn about it.
    let center = to.position + to.rotation * bone.center;
    let velocity = (center - now.center) / dt;
    let spin = angular_velocity(now.rotation, to.rotation, dt);
    worlds.set_velocity(
        &slot.link,
        &slot.handle,
        velocity.clamp_length_max(config.keyframe_speed),
        spin.clamp_length_max(config.max_spin),
    );
}
