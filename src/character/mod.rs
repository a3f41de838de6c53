//! A kinematic character controller.

mod config;
mod events;
mod intent;
mod motor;
mod output;
mod state;
mod surface;

use bevy::prelude::*;

pub use config::{Character, CharacterShape, LeaveVelocity, SlopeSpeed, StepConfig};
pub use events::{Crushed, Hit, Landed, LeftGround, StanceChanged, Stepped};
pub use intent::{CharacterIntent, Stance};
pub use motor::{CharacterMotor, CustomMotor};
pub use output::{
    CharacterContact, CharacterContacts, CharacterSnapshot, StanceRefusal, StepAttempt, StepResult,
};
pub use state::{Anchor, CharacterState, Ground, GroundMaterial, GroundState, MovementMode};
pub use surface::{
    CharacterFilter, CharacterIgnores, CharacterUp, Ladder, NotPushable, SurfaceGrip,
    SurfaceVelocity, UpDirection, WaterVolume,
};

/// Adds the character controller. Needs [`EmbodyCorePlugin`](crate::EmbodyCorePlugin).
#[derive(Clone, Copy, Debug, Default)]
pub struct CharacterPlugin;

impl Plugin for CharacterPlugin {
    fn build(&self, _app: &mut App) {}
}
