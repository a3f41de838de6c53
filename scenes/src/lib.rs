//! Scenes, harness and example shell shared by the tests, examples and lab of `bevy_embody`.

pub mod builders;
pub mod course;
pub mod harness;
pub mod stations;

pub use builders::{FloorKind, Make, Mover, Patch, StairCeiling, Stairs};
pub use harness::Sim;
