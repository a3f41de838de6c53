//! How Rapier's plugin ties entities to its worlds, for queries above this folder.

#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
use bevy::prelude::*;

/// The first of Rapier's systems in a tick.
pub(crate) use bevy_rapier3d::plugin::systems::update_character_controls;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
pub(crate) use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    prelude::{RapierColliderHandle, RapierRigidBodyHandle},
};

/// The entity of a body or collider; of one that the game put into Rapier itself, none that exists.
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
pub(super) fn entity_of(user_data: u128) -> Entity {
    Entity::try_from_bits(user_data as u64).unwrap_or(Entity::PLACEHOLDER)
}
