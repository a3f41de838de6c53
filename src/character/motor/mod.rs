//! The movement layer: intent to velocity.

mod config;

pub use config::{CharacterMotor, CustomMotor};
