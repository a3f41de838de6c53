//! The only place that names Rapier's internals.

pub(crate) mod setup;
