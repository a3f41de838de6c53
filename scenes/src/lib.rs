//! Scenes, harness and example shell shared by the tests, examples and lab of `bevy_embody`.

pub mod harness;

pub use harness::Sim;
