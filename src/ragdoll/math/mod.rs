//! Rotations and inertia of joints, as pure functions.

pub(crate) mod cone;
pub(crate) mod inertia;
pub(crate) mod inertialize;
pub(crate) mod rotation;
