//! Vehicles, measured against closed forms, conservation laws and invariants.

mod support;

mod statics;
mod hills;
mod springs;
