//! Integration tests.

mod character;
mod debug;
mod foundation;
mod vehicle;
