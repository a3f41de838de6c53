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
/// Time before a figure is put back again, seconds: what bursts each time anew must go on somehow.
const SPARED: f32 = 0.5;
/// Figures with more bones are not put back.
const MOST_BONES: usize = 64;

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

/// Velocity of the centre of mass of all that hangs together with a bone, metres per second: before the tick
/// or after it, whichever is slower, for a burst gives no speed.
fn common(
    plan: &RagdollPlan,
    state: &RagdollState,
    motions: &[Option<BodyMotion>],
    bone: usize,
) -> Vec3 {
    let whole = |bone: usize| {
        let mut at = bone;
        while let Some(parent) = plan.bones[at].parent.filter(|_| !state.bones[at].severed) {
            at = parent;
        }
        at
    };
    let of = whole(bone);
    let (mut mass, mut before, mut after) = (0.0, Vec3::ZERO, Vec3::ZERO);
    for (i, planned) in plan
        .bones
        .iter()
        .enumerate()
        .filter(|(i, _)| whole(*i) == of)
    {
        if let Some(motion) = motions[i].as_ref().filter(|m| m.dynamic) {
            mass += planned.mass;
            before += state.bones[i].velocity * planned.mass;
            after += motion.velocity * planned.mass;
        }
    }
    let slower = if after.length_squared() < before.length_squared() {
        after
    } else {
        before
    };
    slower / f32::max(mass, f32::MIN_POSITIVE)
}

/// A small bone wedged between others may get an impulse from the solver, within a tick, that tears the
/// figure to pieces. One that was whole before is put back to where it was, all of it at one speed, which
/// leaves nothing to burst it again.
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
    if now <= BURST || widest(plan, state, |i| Some(state.bones[i].place)) > 0.5 * BURST {
        return false;
    }
    if plan.bones.len() > MOST_BONES {
        return false;
    }
    let mut velocities = [Vec3::ZERO; MOST_BONES];
    for (i, velocity) in velocities.iter_mut().enumerate().take(plan.bones.len()) {
        *velocity = common(plan, state, motions, i);
    }
    for (i, velocity) in velocities.into_iter().enumerate().take(plan.bones.len()) {
        if let Some(motion) = motions[i].as_mut().filter(|m| m.dynamic)
            && let Some((link, handle)) = at(i)
        {
            let BonePose { position, rotation } = state.bones[i].place;
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
    time: Res<Time>,
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
        let spared = (state.spared - time.delta_secs()).max(0.0);
        let whole =
            spared > 0.0 || !put_back(&mut worlds, plan, &state, &mut motions, |i| handles[i]);
        state.bypass_change_detection().spared = if whole { spared } else { SPARED };
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
