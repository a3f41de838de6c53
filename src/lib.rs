//! Characters that walk.

mod backend;
mod math;
mod schedule;

#[cfg(feature = "character")]
pub mod character;

use bevy::{app::PluginGroupBuilder, prelude::*};

pub use schedule::{EmbodyCorePlugin, EmbodySystems};

/// Everything that the enabled features offer, ready to use.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyPlugins;

impl PluginGroup for EmbodyPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>().add(EmbodyCorePlugin);
        #[cfg(feature = "character")]
        let group = group.add(character::CharacterPlugin);
        group
    }
}

/// What most games use.
pub mod prelude {
    #[cfg(feature = "character")]
    #[doc(hidden)]
    pub use crate::character::{
        Character, CharacterContacts, CharacterFilter, CharacterIgnores, CharacterIntent,
        CharacterMotor, CharacterPlugin, CharacterShape, CharacterState, CharacterUp, Crushed,
        CustomMotor, GroundState, Hit, Ladder, Landed, LeaveVelocity, LeftGround, MovementMode,
        NotPushable, SlopeSpeed, Stance, StanceChanged, StepConfig, Stepped, SurfaceGrip,
        SurfaceVelocity, UpDirection, WaterVolume,
    };
    #[doc(hidden)]
    pub use crate::{EmbodyCorePlugin, EmbodyPlugins, EmbodySystems};
}
