//! Integration tests.

mod character;
mod debug;
mod foundation;
mod physics;
mod support;
mod vehicle;
