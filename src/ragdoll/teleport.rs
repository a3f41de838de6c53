//! A figure that is put elsewhere is there, with all its bones.

use bevy::{prelude::*, transform::helper::TransformHelper};

use super::{
    bone::{Bones, RagdollBone},
    pose::BonePose,
    state::RagdollState,
};
use crate::Teleported;

/// Where something is when the frame that it is in has gone from one pose to another.
fn moved(pose: BonePose, from: &BonePose, to: &BonePose) -> BonePose {
    let turn = to.rotation * from.rotation.inverse();
    BonePose {
        position: to.position + turn * (pose.position - from.position),
        rotation: (turn * pose.rotation).normalize(),
    }
}

/// Takes the bones of a teleported ragdoll along. Their velocities stay as they are.
pub(super) fn carry(
    jumped: On<Teleported>,
    helper: TransformHelper,
    mut commands: Commands,
    mut ragdolls: Query<(&mut RagdollState, &Bones)>,
    mut bones: Query<(&RagdollBone, &Transform)>,
) {
    let Ok((mut state, tied)) = ragdolls.get_mut(jumped.entity) else {
        return;
    };
    let Ok(global) = helper.compute_global_transform(jumped.entity) else {
        return;
    };
    let (_, rotation, position) = global.to_scale_rotation_translation();
    let (from, to) = (state.figure, BonePose { position, rotation });
    if !to.is_sound() {
        return;
    }
    let state = &mut *state;
    state.figure = to;
    let turn = to.rotation * from.rotation.inverse();
    for bone in &mut state.bones {
        bone.place = moved(bone.place, &from, &to);
        bone.target = bone.target.map(|pose| moved(pose, &from, &to));
        for way in [
            &mut bone.offset.position,
            &mut bone.offset.velocity,
            &mut bone.offset.rotation,
            &mut bone.offset.spin,
        ] {
            *way = turn * *way;
        }
    }
    for entity in tied.iter() {
        let Ok((bone, at)) = bones.get_mut(entity) else {
            continue;
        };
        if state
            .bones
            .get(bone.order)
            .is_none_or(|b| b.target.is_none())
        {
            continue;
        }
        let pose = BonePose {
            position: at.translation,
            rotation: at.rotation,
        };
        let pose = moved(pose, &from, &to);
        let at = Transform::from_translation(pose.position).with_rotation(pose.rotation);
        commands.entity(entity).try_insert(at);
        commands.trigger(Teleported { entity });
    }
}
