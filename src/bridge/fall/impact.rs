//! Being run into hard enough to fall.

use bevy::prelude::*;

use super::{BodyPhase, CharacterRagdoll, CharacterRagdollState, OwnBones};
use crate::{
    backend::{handles::RapierContextEntityLink, world::PhysicsWorlds},
    character::{Character, CharacterContacts, Hit},
    validate::warn_bad,
};

/// What throws down must be more than nothing.
fn can_fell(impulse: f32) -> bool {
    impulse > 0.0
}

/// What of a bad value is new.
fn untold(told: &mut Option<u32>, bad: Option<f32>) -> Option<f32> {
    let before = core::mem::replace(told, bad.map(f32::to_bits));
    bad.filter(|value| before != Some(value.to_bits()))
}

/// Tells of settings that cannot work, each once.
pub(super) fn check(
    mut changed: Query<(Entity, &CharacterRagdoll, &mut OwnBones), Changed<CharacterRagdoll>>,
) {
    for (entity, config, mut own) in &mut changed {
        let [told_impulse, told_time] = &mut own.bypass_change_detection().told;
        let bad = config.fall_impulse.filter(|most| !can_fell(*most));
        if let Some(value) = untold(told_impulse, bad) {
            let value = value.to_string();
            warn_bad(
                entity,
                "CharacterRagdoll::fall_impulse",
                &value,
                "a number above 0",
                "nothing throws it down",
            );
        }
        let bad = config.get_up_after.filter(|t| !(*t >= 0.0));
        if let Some(time) = untold(told_time, bad) {
            let value = time.to_string();
            warn_bad(
                entity,
                "CharacterRagdoll::get_up_after",
                &value,
                "a number of at least 0",
                "it gets up when it is told to",
            );
        }
    }
}

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
        let Some(most) = config.fall_impulse.filter(|most| can_fell(*most)) else {
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
    let Some(most) = config.fall_impulse.filter(|most| can_fell(*most)) else {
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
