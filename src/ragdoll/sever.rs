//! Joints that part: a limb is cut off, or torn off by a load that lasts, and put on again.
//!
//! What is cut off keeps its place and its velocity. It is limp and simulated from then on, whatever the
//! rest of the figure does, until it is put on again.

use bevy::prelude::*;

use super::{
    bone::{BoneOf, BoneTies, Bones, RagdollBone},
    plan::RagdollPlan,
    pose::BonePose,
    state::{BoneBody, RagdollState},
};
use crate::backend::{
    handles::{RapierContextEntityLink, RapierRigidBodyHandle},
    joints::JointWorlds,
};

/// Trigger it on a bone to cut it off from the bone that bears it, with all that it bears.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Dismember {
    /// The bone.
    pub entity: Entity,
}

/// Trigger it on a bone that was cut off to put it on again. Where the figure is simulated it is at its
/// joint at once, with all that it bears; where it follows a pose it comes there over
/// [`Ragdoll::fade`](super::Ragdoll::fade).
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Reattach {
    /// The bone.
    pub entity: Entity,
}

/// A joint gave way to its load; see [`JointBreak`](super::JointBreak).
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct JointBroke {
    /// The bone that was torn off.
    pub entity: Entity,
    /// The ragdoll.
    pub ragdoll: Entity,
    /// The force on its joint in the last tick, newtons.
    pub force: f32,
}

/// Whether a bone hangs on a joint that has parted, its own or one above.
pub(crate) fn is_cut(plan: &RagdollPlan, state: &RagdollState, bone: usize) -> bool {
    let mut at = Some(bone);
    while let Some(i) = at {
        if state.bones.get(i).is_some_and(|b| b.severed) {
            return true;
        }
        at = plan.bones.get(i).and_then(|b| b.parent);
    }
    false
}

pub(super) fn note_cut(
    cut: On<Dismember>,
    bones: Query<(&RagdollBone, &BoneOf)>,
    ragdolls: Query<(&RagdollPlan, &mut RagdollState)>,
) {
    mark(cut.entity, true, &bones, ragdolls);
}

pub(super) fn note_joined(
    joined: On<Reattach>,
    bones: Query<(&RagdollBone, &BoneOf)>,
    ragdolls: Query<(&RagdollPlan, &mut RagdollState)>,
) {
    mark(joined.entity, false, &bones, ragdolls);
}

fn mark(
    entity: Entity,
    severed: bool,
    bones: &Query<(&RagdollBone, &BoneOf)>,
    mut ragdolls: Query<(&RagdollPlan, &mut RagdollState)>,
) {
    let found = bones.get(entity).ok();
    let found = found.and_then(|(bone, of)| Some((bone, ragdolls.get_mut(of.0).ok()?)));
    let Some((bone, (plan, mut state))) = found else {
        tracing::warn!("{entity}: it was to be cut off or put on, but is no bone of a ragdoll");
        return;
    };
    if plan
        .bones
        .get(bone.order)
        .is_none_or(|b| b.parent.is_none())
    {
        tracing::warn!("{entity}: the root of a ragdoll cannot be cut off");
        return;
    }
    if let Some(bone) = state.bones.get_mut(bone.order) {
        bone.severed = severed;
        bone.strained = 0.0;
    }
    state.still = 0.0;
}

/// A bone as the physics world knows it.
type TiedBone<'a> = (
    &'a RagdollBone,
    &'a RapierContextEntityLink,
    &'a RapierRigidBodyHandle,
    &'a mut BoneTies,
);

/// Parts joints and makes them again.
pub(super) fn part(
    mut worlds: JointWorlds,
    mut ragdolls: Query<(&RagdollPlan, &mut RagdollState, &Bones), Changed<RagdollState>>,
    mut bones: Query<TiedBone>,
) {
    for (plan, mut state, tied) in &mut ragdolls {
        if !plan.told || state.bones.len() != plan.bones.len() {
            continue;
        }
        for entity in tied.iter() {
            let Ok((bone, link, handle, ties)) = bones.get(entity) else {
                continue;
            };
            let (i, link, handle) = (bone.order, *link, *handle);
            let Some(p) = plan.bones.get(i).and_then(|bone| bone.parent) else {
                continue;
            };
            let severed = state.bones[i].severed;
            if severed != ties.limit.is_some() {
                continue;
            }
            let parent = bones.iter_many(tied.iter()).find(|b| b.0.order == p);
            let Some(parent) = parent.map(|b| *b.2) else {
                continue;
            };
            if !severed {
                put_back(
                    &mut worlds,
                    plan,
                    &mut state,
                    tied,
                    &bones,
                    i,
                    &link,
                    &parent,
                );
            }
            let Ok((.., mut ties)) = bones.get_mut(entity) else {
                continue;
            };
            if severed {
                let held = [ties.limit.take(), ties.soft.take(), ties.drive.take()];
                for joint in held.into_iter().flatten() {
                    worlds.untie(&link, joint);
                }
                // They lie in each other at the joint, and would burst apart.
                ties.apart = worlds.ignore(&link, &parent, &handle);
            } else {
                if let Some(joint) = ties.apart.take() {
                    worlds.untie(&link, joint);
                }
                tie_bone(&mut worlds, plan, i, &link, &parent, &handle, &mut ties);
            }
            worlds.wake(&link, &handle);
            worlds.wake(&link, &parent);
        }
    }
}

/// Ties a bone to the one that bears it.
pub(super) fn tie_bone(
    worlds: &mut JointWorlds,
    plan: &RagdollPlan,
    bone: usize,
    link: &RapierContextEntityLink,
    parent: &RapierRigidBodyHandle,
    handle: &RapierRigidBodyHandle,
    ties: &mut BoneTies,
) {
    let planned = &plan.bones[bone];
    let (rows, soft) = planned.split();
    let frames = &planned.frames;
    ties.limit = worlds.tie(link, parent, handle, frames, &rows, None);
    ties.soft =
        soft.and_then(|(rows, spring)| worlds.tie(link, parent, handle, frames, &rows, spring));
    ties.drive = worlds.motorize(link, parent, handle, frames);
}

/// Takes a limb to its joint as one piece, turned no farther than its limits, to go along with the bone
/// that bears it.
fn put_back(
    worlds: &mut JointWorlds,
    plan: &RagdollPlan,
    state: &mut RagdollState,
    tied: &Bones,
    bones: &Query<TiedBone>,
    limb: usize,
    link: &RapierContextEntityLink,
    parent: &RapierRigidBodyHandle,
) {
    let planned = &plan.bones[limb];
    let Some(of) = worlds.motion(link, parent).filter(|m| m.dynamic) else {
        return;
    };
    let own = state.bones[limb].place;
    let joint = of.position + of.rotation * planned.frames.anchor1;
    let rotation = of.rotation * planned.within_limits(of.rotation.inverse() * own.rotation);
    let turn = (rotation * own.rotation.inverse()).normalize();
    for (bone, _, handle, _) in bones.iter_many(tied.iter()) {
        let mut at = Some(bone.order);
        while let Some(i) = at
            && i != limb
        {
            // What is cut off from the limb stays where it is.
            at = plan.bones[i].parent.filter(|_| !state.bones[i].severed);
        }
        let known = &mut state.bones[bone.order];
        if at.is_none() || known.body != BoneBody::Dynamic {
            continue;
        }
        let place = BonePose {
            position: joint + turn * (known.place.position - own.position),
            rotation: (turn * known.place.rotation).normalize(),
        };
        let velocity = of.velocity + of.spin.cross(place.position - of.center);
        let to = Some((place.position, place.rotation));
        worlds.place(link, handle, to, velocity, of.spin);
        known.place = place;
        known.velocity = velocity;
        known.spin = of.spin;
    }
}

/// Counts for how long joints bear more than they can, and parts them.
pub(super) fn strain(
    time: Res<Time>,
    mut commands: Commands,
    worlds: JointWorlds,
    mut ragdolls: Query<(Entity, &RagdollPlan, &mut RagdollState, &Bones)>,
    bones: Query<(&RagdollBone, &RapierContextEntityLink, &BoneTies)>,
) {
    let dt = time.delta_secs();
    for (ragdoll, plan, mut state, tied) in &mut ragdolls {
        if !plan.breakable || !(dt > 0.0) {
            continue;
        }
        for entity in tied.iter() {
            let Ok((bone, link, ties)) = bones.get(entity) else {
                continue;
            };
            let Some(breaks) = plan.bones.get(bone.order).and_then(|b| b.joint.breaks) else {
                continue;
            };
            let Some(known) = state.bypass_change_detection().bones.get_mut(bone.order) else {
                continue;
            };
            let Some(joint) = ties.limit.filter(|_| known.body == BoneBody::Dynamic) else {
                continue;
            };
            let substeps = worlds.substeps(link) + plan.extra_substeps as f32;
            let force = worlds.load(link, joint) * substeps / dt;
            if !(force >= breaks.force) {
                known.strained = 0.0;
                continue;
            }
            known.strained += dt;
            // By a hair less, so that a round time is a round number of ticks.
            if known.strained >= breaks.time - 1.0e-4 {
                state.bones[bone.order].severed = true;
                commands.trigger(JointBroke {
                    entity,
                    ragdoll,
                    force,
                });
            }
        }
    }
}
