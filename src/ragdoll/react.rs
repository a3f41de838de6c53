//! After the physics step: where each bone is, and how well its joint holds.

use bevy::prelude::*;

use super::{
    bone::{BoneOutput, Bones, RagdollBone},
    intent::RagdollMode,
    math::rotation::angle,
    plan::RagdollPlan,
    pose::BonePose,
    state::{BoneBody, BoneState, RagdollState},
};
use crate::backend::{
    handles::{RapierContextEntityLink, RapierRigidBodyHandle},
    joints::{BodyMotion, JointWorlds},
};

/// Remembers every bone's motion and measures its joint.
pub(super) fn observe(
    worlds: JointWorlds,
    mut ragdolls: Query<(&RagdollPlan, &mut RagdollState, &Bones)>,
    mut bones: Query<(
        &RagdollBone,
        &RapierContextEntityLink,
        &RapierRigidBodyHandle,
        &mut BoneOutput,
    )>,
    mut motions: Local<Vec<Option<BodyMotion>>>,
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
        for (bone, link, handle, _) in bones.iter_many(tied.iter()) {
            if let Some(motion) = motions.get_mut(bone.order) {
                *motion = worlds.motion(link, handle);
            }
        }
        for entity in tied.iter() {
            let Ok((bone, _, _, mut output)) = bones.get_mut(entity) else {
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
