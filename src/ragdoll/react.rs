//! After the physics step: where each bone is, and how well its joint holds.

use bevy::prelude::*;

use super::{
    bone::{BoneOutput, Bones, RagdollBone},
    intent::RagdollMode,
    math::rotation::angle,
    plan::{PlannedBone, RagdollPlan},
    pose::BonePose,
    state::{BoneBody, BoneState, RagdollState},
};
use crate::backend::{
    handles::{RapierContextEntityLink, RapierRigidBodyHandle},
    joints::{BodyMotion, JointWorlds},
};

/// A joint whose sides part by more than this within a tick was not drawn apart but burst, metres.
const BURST: f32 = 0.25;

/// The widest gap between the sides of the joints, metres, by where each bone is.
fn widest(
    plan: &RagdollPlan,
    state: &RagdollState,
    place: impl Fn(usize) -> Option<BonePose>,
) -> f32 {
    let gap = |(i, planned): (usize, &PlannedBone)| {
        let parent = planned.parent.filter(|_| !state.bones[i].severed)?;
        let (own, of) = (place(i)?, place(parent)?);
        let pivot = of.position + of.rotation * planned.frames.anchor1;
        Some(pivot.distance(own.position))
    };
    let gaps = plan.bones.iter().enumerate().filter_map(gap);
    gaps.fold(0.0, |most, gap| if gap > most { gap } else { most })
}

/// A small bone wedged between others may get an impulse from the solver, within a tick, that tears the
/// figure to pieces. One that was whole before is put back to where it was, each part at the speed of the
/// bone that bears it, which leaves nothing to burst it again.
fn put_back(
    worlds: &mut JointWorlds,
    plan: &RagdollPlan,
    state: &RagdollState,
    motions: &mut [Option<BodyMotion>],
    at: impl Fn(usize) -> Option<(RapierContextEntityLink, RapierRigidBodyHandle)>,
) -> bool {
    let now = widest(plan, state, |i| {
        let motion = motions[i].as_ref()?;
        Some(BonePose {
            position: motion.position,
            rotation: motion.rotation,
        })
    });
    if now <= BURST || widest(plan, state, |i| Some(state.bones[i].place)) > 0.2 * BURST {
        return false;
    }
    for (i, planned) in plan.bones.iter().enumerate() {
        let known = &state.bones[i];
        let bearer = planned.parent.filter(|_| !known.severed);
        let velocity = match bearer.and_then(|p| motions[p]) {
            Some(parent) => parent.velocity,
            None => known.velocity,
        };
        if let Some(motion) = motions[i].as_mut().filter(|m| m.dynamic)
            && let Some((link, handle)) = at(i)
        {
            let BonePose { position, rotation } = known.place;
            let arm = motion.rotation.inverse() * (motion.center - motion.position);
            *motion = BodyMotion {
                position,
                rotation,
                center: position + rotation * arm,
                velocity,
                spin: Vec3::ZERO,
                ..*motion
            };
            let place = Some((position, rotation));
            worlds.place(&link, &handle, place, velocity, Vec3::ZERO);
        }
    }
    true
}

/// Remembers every bone's motion and measures its joint.
pub(super) fn observe(
    mut worlds: JointWorlds,
    mut ragdolls: Query<(&RagdollPlan, &mut RagdollState, &Bones)>,
    mut bones: Query<(
        &RagdollBone,
        &RapierContextEntityLink,
        &RapierRigidBodyHandle,
        &mut BoneOutput,
        &mut Transform,
    )>,
    mut motions: Local<Vec<Option<BodyMotion>>>,
    mut handles: Local<Vec<Option<(RapierContextEntityLink, RapierRigidBodyHandle)>>>,
) {
    for (plan, mut state, tied) in &mut ragdolls {
        let count = plan.bones.len();
        if count == 0 || !plan.told || state.bones.len() != count {
            continue;
        }
        let settled = |b: &BoneState| b.body == BoneBody::Fixed && b.velocity == Vec3::ZERO;
        if state.mode == RagdollMode::Frozen && state.age > 0.0 && state.bones.iter().all(settled) {
            continue;
        }
        motions.clear();
        motions.resize(count, None);
        handles.clear();
        handles.resize(count, None);
        for (bone, link, handle, ..) in bones.iter_many(tied.iter()) {
            // Of two, the first is driven.
            if let Some(motion @ None) = motions.get_mut(bone.order) {
                *motion = worlds.motion(link, handle);
                handles[bone.order] = Some((*link, *handle));
            }
        }
        let whole = !put_back(&mut worlds, plan, &state, &mut motions, |i| handles[i]);
        for entity in tied.iter() {
            let Ok((bone, _, _, mut output, mut transform)) = bones.get_mut(entity) else {
                continue;
            };
            let i = bone.order;
            let Some(motion) = motions.get(i).copied().flatten() else {
                continue;
            };
            let known = &state.bones[i];
            if known.body == BoneBody::Off {
                continue;
            }
            if motion.sleeping && output.asleep && output.simulated == motion.dynamic {
                continue;
            }
            if !whole && motion.dynamic {
                transform.translation = motion.position;
                transform.rotation = motion.rotation;
            }
            let planned = &plan.bones[i];
            let moves = known.body != BoneBody::Fixed;
            let velocity = motion.origin_velocity();
            let (velocity, spin) = if moves {
                (velocity, motion.spin)
            } else {
                (Vec3::ZERO, Vec3::ZERO)
            };
            let mut measured = BoneOutput {
                velocity,
                spin,
                simulated: motion.dynamic,
                asleep: motion.sleeping,
                ..default()
            };
            let parent = planned.parent.filter(|_| !known.severed);
            if let Some((p, parent)) = parent.and_then(|p| Some((p, motions[p]?))) {
                let pivot = parent.position + parent.rotation * planned.frames.anchor1;
                measured.gap = pivot.distance(motion.position);
                let q = planned.joint_rotation(parent.rotation, motion.rotation);
                measured.violation = planned.joint.kind.violation(q);
                if let (Some(own), Some(of)) = (known.target, state.bones[p].target) {
                    let asked = of.rotation.inverse() * own.rotation;
                    let is = parent.rotation.inverse() * motion.rotation;
                    measured.error = angle(asked.inverse() * is);
                }
            }
            *output = measured;
            let remembered = &mut state.bypass_change_detection().bones[i];
            remembered.place = BonePose {
                position: motion.position,
                rotation: motion.rotation,
            };
            remembered.velocity = velocity;
            remembered.spin = spin;
        }
    }
}
