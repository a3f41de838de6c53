//! Integration tests.

mod character;
mod debug;
mod foundation;
mod physics;
mod ragdoll;
mod support;
mod vehicle;
