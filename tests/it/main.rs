//! Integration tests.

mod character;
mod debug;
mod foundation;
mod support;
mod vehicle;
