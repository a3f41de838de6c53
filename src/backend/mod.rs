//! The only place that names Rapier's internals: everything above works on plain geometry.

pub(crate) mod checks;
pub(crate) mod handles;
mod hierarchy;
pub(crate) mod setup;
pub(crate) mod teleport;

#[cfg(feature = "character")]
pub(crate) mod activity;
#[cfg(feature = "character")]
pub(crate) mod collider;
#[cfg(feature = "character")]
pub(crate) mod neighbourhood;
#[cfg(feature = "character")]
pub(crate) mod world;
