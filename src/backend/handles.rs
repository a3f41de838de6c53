//! How Rapier's plugin ties entities to its worlds, for queries above this folder.

/// The first of Rapier's systems in a tick.
pub(crate) use bevy_rapier3d::plugin::systems::update_character_controls;
#[cfg(any(feature = "character", feature = "vehicle"))]
pub(crate) use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    prelude::{RapierColliderHandle, RapierRigidBodyHandle},
};
