//! Baking: a figure that lies for good becomes a pose, without bodies, joints or cost.

use bevy::{prelude::*, transform::helper::TransformHelper};

use super::{
    blend::{AnimatedJoint, BoneJoint},
    bone::Bones,
    config::Ragdoll,
    plan::RagdollPlan,
    pose::{BonePose, RagdollPose},
    state::RagdollState,
};

/// Trigger it to make a static pose of a ragdoll: its bodies go, its skeleton stays as it is shown, and
/// its [`RagdollPose`] is the pose in which it lies. Stop the animation that moves the skeleton.
///
/// With a [`Ragdoll`] again it goes on from that pose.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct BakeRagdoll {
    /// The ragdoll.
    pub entity: Entity,
}

pub(super) fn bake(
    baked: On<BakeRagdoll>,
    mut commands: Commands,
    helper: TransformHelper,
    mut ragdolls: Query<(&RagdollPlan, &RagdollState, &mut RagdollPose)>,
) {
    let entity = baked.entity;
    let (Ok((plan, state, mut pose)), Ok(figure)) = (
        ragdolls.get_mut(entity),
        helper.compute_global_transform(entity),
    ) else {
        tracing::warn!("{entity}: it was to be baked, but is no ragdoll");
        return;
    };
    let (_, rotation, translation) = figure.to_scale_rotation_translation();
    let back = rotation.inverse();
    // What has not been anywhere yet stays as it is asked for.
    let been = plan.bones.iter().zip(&state.bones);
    for (bone, known) in been.filter(|(_, known)| known.target.is_some()) {
        if pose.bones.len() < plan.bones.len() {
            let asked = pose.bones.len();
            pose.bones.resize(plan.bones.len(), BonePose::default());
            for planned in plan.bones.iter().filter(|b| b.index >= asked) {
                pose.bones[planned.index] = planned.bind;
            }
        }
        if let Some(pose) = pose.bones.get_mut(bone.index) {
            *pose = BonePose {
                position: back * (known.place.position - translation),
                rotation: (back * known.place.rotation).normalize(),
            };
        }
    }
    commands.entity(entity).remove::<Ragdoll>();
}

/// What is no ragdoll any more has no bones.
pub(super) fn unmake(
    removed: On<Remove, Ragdoll>,
    mut commands: Commands,
    ragdolls: Query<&Bones>,
    joints: Query<&BoneJoint>,
    mut states: Query<&mut RagdollState>,
) {
    // What was is nothing to go on from: the entity may be elsewhere when it is a ragdoll again.
    if let Ok(mut state) = states.get_mut(removed.entity) {
        *state = RagdollState::default();
    }
    if let Ok(tied) = ragdolls.get(removed.entity) {
        for bone in tied.iter() {
            if let Ok(joint) = joints.get(bone)
                && let Ok(mut joint) = commands.get_entity(joint.joint)
            {
                joint.try_remove::<AnimatedJoint>();
            }
            if let Ok(mut bone) = commands.get_entity(bone) {
                bone.try_despawn();
            }
        }
    }
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<RagdollPlan>();
    }
}
