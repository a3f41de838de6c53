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
    /// The bone that bears all simulated bones that it is tied to.
    group: usize,
    /// Of that bone: mass of the group, and the sum of its pins.
    group_mass: f32,
    group_pins: f32,
    /// Mass that a pin on the bone holds, kilograms.
    pub pinned: f32,
}

/// Shares the mass of what is tied together out to the pins that hold it, by their strength.
pub(super) fn share_pins(plan: &RagdollPlan, slots: &[Option<Slot>], carried: &mut Vec<Carried>) {
    let simulated = |i: usize| (slots[i].as_ref()).filter(|s| s.body == BoneBody::Dynamic);
    carried.clear();
    carried.resize(plan.bones.len(), Carried::default());
    for (i, bone) in plan.bones.iter().enumerate() {
        let Some(slot) = simulated(i) else { continue };
        let above = bearer(plan, slots, i).filter(|p| simulated(*p).is_some());
        // Parents come first.
        let group = above.map_or(i, |p| carried[p].group);
        carried[i].group = group;
        carried[group].group_mass += bone.mass;
        carried[group].group_pins += slot.pin;
    }
    for i in 0..carried.len() {
        let Some(slot) = simulated(i).filter(|s| s.pin > 0.0) else {
            continue;
        };
        let group = carried[carried[i].group];
        carried[i].pinned = group.group_mass * slot.pin / group.group_pins;
    }
}

/// Adds the torques by which driven joints bear the weight of what hangs on them, where they hang from a
/// bone that is held. `carried` comes from [`share_pins`].
pub(super) fn bear_weight(
    config: &Ragdoll,
    plan: &RagdollPlan,
    slots: &[Option<Slot>],
    gravity: Vec3,
    carried: &mut [Carried],
    forces: &mut Vec<BoneForce>,
) {
    let bears = config.drive.gravity;
    if !(bears > 0.0) {
        return;
    }
    // Far from the origin of the world, moments about it have no digits left for the figure.
    let Some(origin) = slots.iter().flatten().next().map(|s| s.motion.position) else {
        return;
    };
    for (i, (bone, slot)) in plan.bones.iter().zip(slots).enumerate() {
        let parent = bearer(plan, slots, i).and_then(|p| slots[p].as_ref().zip(carried.get(p)));
        let held = parent.is_some_and(|(parent, c)| {
            parent.body != BoneBody::Dynamic || parent.pin > 0.0 || c.held
        });
        let dynamic = slot.filter(|s| s.body == BoneBody::Dynamic);
        let mass = dynamic.map_or(0.0, |_| bone.mass);
        carried[i].mass = mass;
        carried[i].moment = dynamic.map_or(Vec3::ZERO, |s| (s.motion.center - origin) * mass);
        carried[i].held = held && dynamic.is_some();
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
        let arm = c.moment - (slot.motion.position - origin) * c.mass;
        let torque = arm.cross(gravity) * (-bears * slot.strength);
        let torque = torque.clamp_length_max(most);
        carried[i].torque += torque;
        carried[p].torque -= torque;
    }
    for (slot, c) in slots.iter().zip(carried.iter()) {
        let Some(slot) = slot.filter(|s| s.body == BoneBody::Dynamic) else {
            continue;
        };
        let force = if slot.pin > 0.0 {
            // A weak pin bears as much less.
            gravity * (-bears * c.pinned * slot.pin)
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
