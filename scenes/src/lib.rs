//! Scenes, harness and example shell shared by the tests, examples and lab of `bevy_embody`.

pub mod course;
pub mod harness;
pub mod stations;
pub mod wavy;

pub use harness::Sim;
