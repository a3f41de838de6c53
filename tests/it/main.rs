//! Integration tests.

mod character;
mod foundation;
mod vehicle;
