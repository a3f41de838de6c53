//! The only place that names Rapier's internals.

pub(crate) mod checks;
pub(crate) mod setup;
pub(crate) mod teleport;
