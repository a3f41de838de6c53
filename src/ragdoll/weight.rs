//! The weight of what hangs on driven joints, borne by torques worked out for the pose.

use bevy::prelude::*;

use super::{
    config::Ragdoll,
    plan::RagdollPlan,
    state::BoneBody,
    tick::{BoneForce, Slot, bearer},
};

/// What hangs on a bone.
#[derive(Clone, Copy, Default)]
pub(super) struct Carried {
    mass: f32,
    /// Mass times centre, world.
    moment: Vec3,
    /// Whether it hangs from a bone that is held.
    held: bool,
    /// On the bone, from all its joints.
    torque: Vec3,
}

/// Adds the torques by which driven joints bear the weight of what hangs on them, where they hang from a
/// bone that is held.
pub(super) fn bear_weight(
    config: &Ragdoll,
    plan: &RagdollPlan,
    slots: &[Option<Slot>],
    gravity: Vec3,
    carried: &mut Vec<Carried>,
    forces: &mut Vec<BoneForce>,
) {
    let bears = config.drive.gravity;
    if !(bears > 0.0) {
        return;
    }
    carried.clear();
    for (i, (bone, slot)) in plan.bones.iter().zip(slots).enumerate() {
        let parent = bearer(plan, slots, i).and_then(|p| slots[p].as_ref().zip(carried.get(p)));
        let held = parent.is_some_and(|(parent, c)| {
            parent.body != BoneBody::Dynamic || parent.pin > 0.0 || c.held
        });
        let dynamic = slot.filter(|s| s.body == BoneBody::Dynamic);
        let mass = dynamic.map_or(0.0, |_| bone.mass);
        carried.push(Carried {
            mass,
            moment: dynamic.map_or(Vec3::ZERO, |s| s.motion.center * mass),
            held: held && dynamic.is_some(),
            torque: Vec3::ZERO,
        });
    }
    for i in (0..plan.bones.len()).rev() {
        let Some(p) = bearer(plan, slots, i) else {
            continue;
        };
        let c = carried[i];
        carried[p].mass += c.mass;
        carried[p].moment += c.moment;
    }
    for (i, (bone, slot)) in plan.bones.iter().zip(slots).enumerate() {
        let (Some(slot), Some(p), c) = (slot, bearer(plan, slots, i), carried[i]) else {
            continue;
        };
        if !c.held || slot.strength <= 0.0 {
            continue;
        }
        let most = bone.joint.max_torque * config.drive.torque * slot.strength;
        let arm = c.moment - slot.motion.position * c.mass;
        let torque = arm.cross(gravity) * (-bears * slot.strength);
        let torque = torque.clamp_length_max(most);
        carried[i].torque += torque;
        carried[p].torque -= torque;
    }
    let pins = slots.iter().flatten().filter(|s| s.pin > 0.0).count();
    for (slot, c) in slots.iter().zip(carried.iter()) {
        let Some(slot) = slot.filter(|s| s.body == BoneBody::Dynamic) else {
            continue;
        };
        let force = if slot.pin > 0.0 {
            gravity * (-bears * plan.mass / pins as f32)
        } else {
            Vec3::ZERO
        };
        if force != Vec3::ZERO || c.torque != Vec3::ZERO {
            forces.push(BoneForce {
                link: slot.link,
                handle: slot.handle,
                force,
                torque: c.torque,
            });
        }
    }
}
