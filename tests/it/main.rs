//! Integration tests.

mod foundation;
