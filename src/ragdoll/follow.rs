//! The figure goes where its root is thrown, so that what hangs on its entity (camera, skeleton, capsule)
//! is there, and what is shown never has to slide back.

use bevy::prelude::*;

use super::{
    intent::RagdollMode,
    plan::RagdollPlan,
    pose::BonePose,
    sever::is_cut,
    state::{BoneBody, RagdollState},
    up::RagdollUp,
};

/// On a ragdoll: while it is limp, or powered without a pin, its entity is moved along after each tick: to
/// the height of its lowest bone, below the root, facing as the root does.
///
/// Only for ragdolls at the top level of the world. Where bones are sent to places in the world
/// ([`Keyframed`](super::RagdollMode::Keyframed), pins, [`Partial`](super::RagdollMode::Partial)), the
/// entity stays: it says where those places are.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct FollowRoot;

/// Where a figure faces whose root is turned so: level, unit length. `None` when it lies on its side.
///
/// It is across the root's own left-to-right axis, so that it does not change as the figure falls on its
/// face or on its back.
pub(crate) fn heading(root: Quat, bind: Quat, up: Vec3) -> Option<Vec3> {
    let right = root * bind.inverse() * Vec3::X;
    let ahead = up.cross(right);
    (ahead.length_squared() > 0.09).then(|| ahead.normalize())
}

/// The rotation of a figure that faces so; level, unit length.
pub(crate) fn facing(ahead: Vec3, up: Vec3) -> Quat {
    Quat::from_mat3(&Mat3::from_cols(ahead.cross(up), up, -ahead)).normalize()
}

/// The part of a direction across up, unit length.
fn level(v: Vec3, up: Vec3) -> Vec3 {
    let across = v.reject_from_normalized(up).try_normalize();
    across.unwrap_or_else(|| up.any_orthonormal_vector())
}

/// A point at another height.
pub(crate) fn at_height(p: Vec3, up: Vec3, height: f32) -> Vec3 {
    p + up * (height - p.dot(up))
}

/// The lowest point along up of all bones that are not cut off.
pub(crate) fn lowest(plan: &RagdollPlan, state: &RagdollState, up: Vec3) -> f32 {
    let mut low = f32::MAX;
    for (i, bone) in plan.bones.iter().enumerate() {
        if is_cut(plan, state, i) {
            continue;
        }
        let place = state.bones[i].place;
        let down = place.rotation.inverse() * -up;
        low = low.min(place.position.dot(up) - bone.shape.reach(down));
    }
    low
}

/// Moves figures to their roots.
pub(super) fn follow(
    mut ragdolls: Query<
        (&mut Transform, &RagdollUp, &RagdollPlan, &mut RagdollState),
        (With<FollowRoot>, Without<ChildOf>),
    >,
) {
    for (mut transform, up, plan, mut state) in &mut ragdolls {
        let up = up.direction();
        let (Some(planned), Some(root)) = (plan.bones.first(), state.bones.first()) else {
            continue;
        };
        let goes = matches!(state.mode, RagdollMode::Limp | RagdollMode::Powered);
        if !goes || root.body != BoneBody::Dynamic || state.bones.len() != plan.bones.len() {
            continue;
        }
        // A pin that is asked for holds only while the figure is driven.
        if state.bones.iter().any(|bone| bone.pin > 0.0) {
            continue;
        }
        let place = root.place;
        let ahead = heading(place.rotation, planned.bind.rotation, up)
            .unwrap_or_else(|| level(transform.rotation * Vec3::NEG_Z, up));
        let rotation = facing(ahead, up);
        let low = lowest(plan, &state, up);
        let below = place.position - rotation * planned.bind.position;
        let translation = at_height(below, up, low);
        if translation.is_finite() && rotation.is_finite() {
            state.bypass_change_detection().figure = BonePose {
                position: translation,
                rotation,
            };
            transform.set_if_neq(Transform {
                translation,
                rotation,
                scale: transform.scale,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn a_figure_that_falls_on_its_face_or_its_back_still_faces_the_same_way() {
        for yaw in [0.0f32, 0.7, 2.5] {
            let turn = Quat::from_rotation_y(yaw);
            let ahead = turn * Vec3::NEG_Z;
            for pitch in [-FRAC_PI_2, -0.6, 0.0, 0.9, FRAC_PI_2] {
                let root = turn * Quat::from_rotation_x(pitch);
                let found = heading(root, Quat::IDENTITY, Vec3::Y);
                assert!(
                    found.is_some_and(|f| f.distance(ahead) < 1.0e-5),
                    "{yaw} {pitch}"
                );
            }
            let side = turn * Quat::from_rotation_z(FRAC_PI_2);
            assert_eq!(heading(side, Quat::IDENTITY, Vec3::Y), None);
        }
    }

    #[test]
    fn a_figure_stands_along_up_and_faces_ahead_whatever_up_is() {
        for up in [Vec3::Y, Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, -0.48, 0.64)] {
            let ahead = level(Vec3::new(0.3, 0.5, -0.9), up);
            let turn = facing(ahead, up);
            assert!((turn * Vec3::Y).distance(up) < 1.0e-5, "{up}");
            assert!((turn * Vec3::NEG_Z).distance(ahead) < 1.0e-5, "{up}");
            let raised = at_height(Vec3::new(1.0, 2.0, 3.0), up, 7.0);
            assert!((raised.dot(up) - 7.0).abs() < 1.0e-5, "{up}");
        }
        assert_eq!(facing(Vec3::NEG_Z, Vec3::Y), Quat::IDENTITY);
    }
}
