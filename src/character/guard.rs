//! Numbers that are none, kept out of the physics world.

use bevy::prelude::*;

use super::{
    body::{CharacterBody, warn_bad},
    config::Character,
    intent::CharacterIntent,
    output::CharacterSnapshot,
    state::CharacterState,
};

/// Puts characters whose transform is not finite back to where they last were, and tells once of
/// each bad transform or intent.
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
        let placed = transform.translation.is_finite() && transform.rotation.is_finite();
        let asked = intent.movement.is_finite() && intent.facing.is_none_or(Vec3::is_finite);
        let moving = state.velocity.is_finite() && state.up.is_finite();
        if placed && asked && moving {
            if body.warned {
                body.bypass_change_detection().warned = false;
            }
            continue;
        }
        if !body.warned {
            body.bypass_change_detection().warned = true;
            if !placed {
                let value = format!("{:?}, {:?}", transform.translation, transform.rotation);
                warn_bad(entity, "Transform", &value, "finite numbers");
            } else if !asked {
                let value = format!("{:?}", intent.movement);
                tracing::warn!(
                    "{entity}: CharacterIntent is {value}, but needs finite numbers; it is taken as nothing asked"
                );
            } else {
                let value = format!("{:?}", state.velocity);
                warn_bad(entity, "CharacterState::velocity", &value, "finite numbers");
            }
        }
        if !placed {
            transform.translation = if state.last_position.is_finite() {
                state.last_position
            } else {
                Vec3::ZERO
            };
            transform.rotation = state.last_rotation;
        }
        if !moving {
            state.velocity = Vec3::ZERO;
            state.up = if state.up.is_finite() {
                state.up
            } else {
                Vec3::Y
            };
        }
    }
}
