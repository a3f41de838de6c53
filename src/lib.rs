#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
// Bits must not depend on the platform's mathematics library.
#![warn(clippy::disallowed_methods)]

mod backend;
#[cfg(all(feature = "character", any(feature = "debug", feature = "egui")))]
pub mod debug;
pub mod interpolation;
#[cfg(feature = "character")]
mod math;
mod schedule;
mod teleport;

#[cfg(feature = "character")]
pub mod character;

use bevy::{app::PluginGroupBuilder, prelude::*};

pub use backend::checks::{EmbodyDiagnosis, EmbodyProblem};
#[cfg(feature = "character")]
pub use character::{CharacterDiagnostics, EmbodyDiagnosticsPlugin};
#[cfg(all(feature = "character", feature = "debug"))]
pub use debug::EmbodyDebugPlugin;
#[cfg(all(feature = "character", feature = "egui"))]
pub use debug::EmbodyInspectorPlugin;
pub use schedule::{EmbodyCorePlugin, EmbodySystems};
pub use teleport::Teleported;

/// Everything that the enabled features offer, ready to use.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyPlugins;

impl PluginGroup for EmbodyPlugins {
    fn build(self) -> PluginGroupBuilder {
        let group = PluginGroupBuilder::start::<Self>()
            .add(EmbodyCorePlugin)
            .add(interpolation::EmbodyInterpolationPlugin);
        #[cfg(feature = "character")]
        let group = group.add(character::CharacterPlugin);
        group
    }
}

/// What most games use.
pub mod prelude {
    #[cfg(all(feature = "character", feature = "debug"))]
    #[doc(hidden)]
    pub use crate::EmbodyDebugPlugin;
    #[cfg(all(feature = "character", feature = "egui"))]
    #[doc(hidden)]
    pub use crate::EmbodyInspectorPlugin;
    #[cfg(feature = "character")]
    #[doc(hidden)]
    pub use crate::character::{
        Anchor, Character, CharacterContact, CharacterContacts, CharacterFilter, CharacterIgnores,
        CharacterIntent, CharacterMotor, CharacterPlugin, CharacterShape, CharacterState,
        CharacterUp, Crushed, CustomMotor, Ground, GroundMaterial, GroundState, Hit, Ladder,
        Landed, LastPose, LeaveVelocity, LeftGround, MovementMode, NotPushable, SlopeSpeed, Stance,
        StanceChanged, StanceRefusal, StepAttempt, StepConfig, StepResult, Stepped, SurfaceGrip,
        SurfaceVelocity, UpDirection, WaterVolume,
    };
    #[cfg(feature = "character")]
    #[doc(hidden)]
    pub use crate::{CharacterDiagnostics, EmbodyDiagnosticsPlugin};
    #[doc(hidden)]
    pub use crate::{
        EmbodyCorePlugin, EmbodyDiagnosis, EmbodyPlugins, EmbodyProblem, EmbodySystems, Teleported,
        interpolation::{EmbodyInterpolationPlugin, Interpolated, NotInterpolated},
    };
}
