//! Integration tests.

mod character;
