//! The only place that names Rapier's internals: everything above works on plain geometry.

pub(crate) mod checks;
pub(crate) mod handles;
mod hierarchy;
pub(crate) mod setup;
pub(crate) mod teleport;

#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
pub(crate) mod activity;
#[cfg(feature = "character")]
pub(crate) mod collider;
#[cfg(feature = "ragdoll")]
mod floor;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
pub(crate) mod forces;
#[cfg(feature = "vehicle")]
pub(crate) mod hold;
#[cfg(feature = "ragdoll")]
pub(crate) mod joints;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
pub(crate) mod motion;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
pub(crate) mod neighbourhood;
#[cfg(feature = "vehicle")]
pub(crate) mod probe;
#[cfg(feature = "vehicle")]
pub(crate) mod rigid;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
mod search_tree;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
pub(crate) mod world;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
pub(crate) mod world_mut;
