//! Scenes, harness and example shell shared by the tests, examples and lab of `bevy_embody`.

pub mod builders;
pub mod course;
pub mod drivelines;
pub mod driving;
#[cfg(feature = "window")]
pub mod falling;
#[cfg(feature = "window")]
pub mod figures;
pub mod harness;
pub mod reference;
#[cfg(feature = "window")]
pub mod shell;
pub mod stations;
pub mod terrain;
pub mod traffic;
pub mod wavy;

pub use builders::{FloorKind, Make, Mover, Patch, StairCeiling, Stairs};
pub use harness::Sim;
