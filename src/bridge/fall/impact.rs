//! Being run into hard enough to fall.

use bevy::prelude::*;

use super::{BodyPhase, CharacterRagdoll, CharacterRagdollState};
use crate::{
    backend::{handles::RapierContextEntityLink, world::PhysicsWorlds},
    character::{Character, CharacterContacts, Hit},
};

/// Lets characters fall that loose bodies ran into harder than they can stand.
///
/// The solver of characters gives a body that runs into one the impulse of a collision without rebound;
/// what the character pushes itself comes on top, up to its strength, and does not count.
pub(super) fn feel(
    time: Res<Time>,
    mut characters: Query<
        (
            &CharacterRagdoll,
            &mut CharacterRagdollState,
            &Character,
            &CharacterContacts,
        ),
        Changed<CharacterContacts>,
    >,
) {
    let dt = time.delta_secs();
    for (config, mut state, character, contacts) in &mut characters {
        let Some(most) = config.fall_impulse else {
            continue;
        };
        if !matches!(state.phase, BodyPhase::Upright | BodyPhase::Rising) {
            continue;
        }
        let push = |own: f32| (character.push_strength * dt).min(character.mass * own);
        let felt = contacts.contacts.iter().map(|contact| {
            // Opposite to what the body received.
            let impulse = (-contact.impulse.dot(contact.normal)).max(0.0);
            impulse - push((-state.velocity.dot(contact.normal)).max(0.0))
        });
        if felt.fold(0.0, f32::max) >= most {
            state.falls = true;
        }
    }
}

/// Lets a character fall that something ran into which nothing stops.
pub(super) fn note(
    hit: On<Hit>,
    time: Res<Time>,
    worlds: PhysicsWorlds,
    mut characters: Query<(
        &CharacterRagdoll,
        &mut CharacterRagdollState,
        &Character,
        &RapierContextEntityLink,
    )>,
) {
    let Ok((config, mut state, character, link)) = characters.get_mut(hit.entity) else {
        return;
    };
    let Some(most) = config.fall_impulse else {
        return;
    };
    let carrier = (worlds.of(link)).and_then(|view| view.carrier(hit.other, time.delta_secs()));
    if carrier.is_none_or(|c| c.mass.is_finite()) {
        return;
    }
    // What it ran itself is not the other's doing.
    let own = (-state.velocity.dot(hit.normal)).max(0.0);
    if character.mass * (hit.speed - own) >= most {
        state.falls = true;
    }
}
