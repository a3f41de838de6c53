//! Integration tests.

mod character;
mod foundation;
