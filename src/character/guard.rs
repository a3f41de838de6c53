//! Numbers that are none, kept out of the physics world.

use bevy::prelude::*;

use super::{
    body::{CharacterBody, warn_bad},
    config::Character,
    intent::CharacterIntent,
    output::CharacterSnapshot,
    state::CharacterState,
};

/// What a scale of zero is raised to: it has no rotation.
const LEAST_SCALE: f32 = 1.0e-3;

/// Puts characters whose transform is none back to where they last were, and tells once of each bad
/// transform or intent.
pub(super) fn keep_finite(
    mut characters: Query<
        (
            Entity,
            &Character,
            Ref<CharacterIntent>,
            &mut Transform,
            &mut CharacterState,
            &mut CharacterBody,
            &mut CharacterSnapshot,
        ),
        Or<(
            Changed<Transform>,
            Changed<CharacterIntent>,
            Changed<Character>,
            Changed<CharacterState>,
        )>,
    >,
) {
    for (entity, config, intent, mut transform, mut state, mut body, mut snapshot) in
        &mut characters
    {
        let margin = super::body::margin(&config.shape);
        if snapshot.margin != margin && margin.is_finite() {
            snapshot.margin = margin;
        }
        let placed = transform.translation.is_finite() && transform.rotation.is_normalized();
        let scaled = transform.scale.is_finite() && transform.scale.cmpne(Vec3::ZERO).all();
        let asked = intent.movement.is_finite() && intent.facing.is_none_or(Vec3::is_finite);
        let moving = state.velocity.is_finite() && state.up.is_normalized();
        if placed && scaled && asked && moving {
            if body.warned {
                body.bypass_change_detection().warned = false;
            }
            continue;
        }
        if !body.warned {
            body.bypass_change_detection().warned = true;
            if !placed {
                let value = format!("{:?}, {:?}", transform.translation, transform.rotation);
                let need = "finite numbers and a rotation of length 1";
                warn_bad(entity, "Transform", &value, need);
            } else if !scaled {
                let value = format!("{:?}", transform.scale);
                tracing::warn!(
                    "{entity}: Transform::scale is {value}, but needs finite numbers other than 0; \
                     0 is taken as {LEAST_SCALE}"
                );
            } else if !asked {
                let value = format!("{:?}", intent.movement);
                tracing::warn!(
                    "{entity}: CharacterIntent is {value}, but needs finite numbers; it is taken as nothing asked"
                );
            } else if !state.velocity.is_finite() {
                let value = format!("{:?}", state.velocity);
                warn_bad(entity, "CharacterState::velocity", &value, "finite numbers");
            } else {
                let value = format!("{:?}", state.up);
                warn_bad(entity, "CharacterState::up", &value, "a length of 1");
            }
        }
        if !placed {
            let last = state.last_pose;
            if !transform.translation.is_finite() {
                transform.translation = last.map_or(Vec3::ZERO, |pose| pose.position);
            }
            let length = transform.rotation.length();
            transform.rotation = if length > LEAST_SCALE && length.is_finite() {
                transform.rotation.normalize()
            } else {
                last.map_or(Quat::IDENTITY, |pose| pose.rotation)
            };
        }
        if !scaled {
            let scale = transform.scale;
            let scale = Vec3::select(scale.is_finite_mask(), scale, Vec3::ONE);
            let zero = scale.cmpeq(Vec3::ZERO);
            transform.scale = Vec3::select(zero, Vec3::splat(LEAST_SCALE), scale);
        }
        if !moving {
            if !state.velocity.is_finite() {
                state.velocity = Vec3::ZERO;
            }
            state.up = state.up.try_normalize().unwrap_or(Vec3::Y);
        }
    }
}
