//! What a figure cannot stand by.

use bevy::prelude::*;

use super::{BalanceState, RagdollBalance};
use crate::ragdoll::config::Ragdoll;

/// Tells of settings that cannot work.
pub(in crate::ragdoll) fn check(
    changed: Query<(Entity, &Ragdoll, &RagdollBalance), Changed<RagdollBalance>>,
) {
    for (entity, config, balance) in &changed {
        if !(balance.gain > 0.0 && balance.gain.is_finite()) {
            tracing::warn!(
                "{entity}: RagdollBalance::gain is {}, but needs a finite number above 0; it does not stand \
                 by itself",
                balance.gain
            );
        }
        for name in &balance.feet {
            if !config.profile.bones.iter().any(|bone| bone.name == *name) {
                tracing::warn!(
                    "{entity}: RagdollBalance::feet has \"{name}\", but needs the name of a bone; it does \
                     not stand on that foot"
                );
            }
        }
    }
}

/// Who is not to stand any more has no state of it.
pub(in crate::ragdoll) fn forget(removed: On<Remove, RagdollBalance>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<BalanceState>();
    }
}
