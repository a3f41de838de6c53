#![doc = include_str!("../README.md")]
#![cfg_attr(docsrs, feature(doc_cfg))]
// Bits must not depend on the platform's mathematics library.
#![warn(clippy::disallowed_methods)]

mod backend;
#[cfg(all(feature = "character", feature = "ragdoll"))]
pub mod bridge;
#[cfg(any(
    all(feature = "character", any(feature = "debug", feature = "egui")),
    all(feature = "vehicle", feature = "debug"),
    all(feature = "ragdoll", feature = "debug")
))]
pub mod debug;
#[cfg(any(feature = "character", feature = "vehicle"))]
mod diagnostics;
pub mod interpolation;
#[cfg(any(feature = "character", feature = "vehicle", feature = "ragdoll"))]
#[cfg_attr(
    not(feature = "character"),
    expect(dead_code, reason = "what only characters ask")
)]
mod math;
mod schedule;
mod teleport;
#[cfg(any(feature = "character", feature = "vehicle"))]
mod validate;

#[cfg(feature = "character")]
pub mod character;
#[cfg(feature = "ragdoll")]
pub mod ragdoll;
#[cfg(feature = "vehicle")]
pub mod vehicle;

use bevy::{app::PluginGroupBuilder, prelude::*};

pub use backend::checks::{EmbodyDiagnosis, EmbodyProblem};
#[cfg(all(feature = "character", feature = "debug"))]
pub use debug::EmbodyDebugPlugin;
#[cfg(all(feature = "character", feature = "egui"))]
pub use debug::EmbodyInspectorPlugin;
#[cfg(all(feature = "ragdoll", feature = "debug"))]
pub use debug::RagdollDebugPlugin;
#[cfg(all(feature = "vehicle", feature = "debug"))]
pub use debug::VehicleDebugPlugin;
#[cfg(feature = "character")]
pub use diagnostics::CharacterDiagnostics;
#[cfg(any(feature = "character", feature = "vehicle"))]
pub use diagnostics::EmbodyDiagnosticsPlugin;
#[cfg(feature = "vehicle")]
pub use diagnostics::VehicleDiagnostics;
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
        #[cfg(feature = "vehicle")]
        let group = group.add(vehicle::VehiclePlugin);
        #[cfg(feature = "ragdoll")]
        let group = group.add(ragdoll::RagdollPlugin);
        #[cfg(all(feature = "character", feature = "ragdoll"))]
        let group = group.add(bridge::CharacterRagdollPlugin);
        group
    }
}

/// What most games use.
pub mod prelude {
    #[cfg(feature = "character")]
    #[doc(hidden)]
    pub use crate::CharacterDiagnostics;
    #[cfg(all(feature = "character", feature = "debug"))]
    #[doc(hidden)]
    pub use crate::EmbodyDebugPlugin;
    #[cfg(any(feature = "character", feature = "vehicle"))]
    #[doc(hidden)]
    pub use crate::EmbodyDiagnosticsPlugin;
    #[cfg(all(feature = "character", feature = "egui"))]
    #[doc(hidden)]
    pub use crate::EmbodyInspectorPlugin;
    #[cfg(feature = "vehicle")]
    #[doc(hidden)]
    pub use crate::VehicleDiagnostics;
    #[cfg(all(feature = "character", feature = "ragdoll"))]
    #[doc(hidden)]
    pub use crate::bridge::{
        BecomeRagdoll, BodyPhase, CharacterRagdoll, CharacterRagdollPlugin, CharacterRagdollState,
        CharacterRagdollSystems, FallCommands, FellDown, Recover, StoodUp,
    };
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
    #[cfg(feature = "ragdoll")]
    #[doc(hidden)]
    pub use crate::ragdoll::{
        BakeRagdoll, BalanceState, BodyPart, BoneControl, BoneGroups, BoneJoint, BoneMass, BoneOf,
        BoneOutput, BonePose, BoneProfile, BoneShape, BoneSource, Bones, CameToRest, Dismember,
        FollowRoot, GetUp, GetUpClip, GetsUp, HitCommands, HitReaction, HumanoidDetail,
        HumanoidRig, JointBreak, JointBroke, JointKind, JointProfile, JointSoftness, Ragdoll,
        RagdollBalance, RagdollBlend, RagdollBone, RagdollDrive, RagdollFromSkin, RagdollHit,
        RagdollIntent, RagdollMode, RagdollPlugin, RagdollPose, RagdollProfile, RagdollReady,
        RagdollRest, RagdollState, RagdollUp, Reattach,
    };
    #[cfg(feature = "vehicle")]
    #[doc(hidden)]
    pub use crate::vehicle::{
        Aero, AntiLockBrakes, BottomedOut, Brakes, Clutch, Damper, Differential, DrivenAxle,
        Drivetrain, ElectricMotor, Engine, EngineStalled, Gear, GearShifted, Gearbox, GroundPlane,
        HillHold, LeanControl, PowerSource, ProbeInterval, RoadVelocity, Shifting, SlipEnded,
        SlipPoint, SlipStarted, SpringRate, StabilityControl, SteerPoint, Steering,
        SurfaceFriction, Suspension, Tire, TireModel, TorquePoint, TractionControl, Vehicle,
        VehicleIntent, VehicleMass, VehiclePlugin, VehiclePreset, VehicleState, VehicleSystems,
        VehicleTelemetry, Wheel, WheelContact, WheelDynamics, WheelLanded, WheelLeftGround,
        WheelOf, WheelProbe, WheelState, Wheels,
    };
    #[doc(hidden)]
    pub use crate::{
        EmbodyCorePlugin, EmbodyDiagnosis, EmbodyPlugins, EmbodyProblem, EmbodySystems, Teleported,
        interpolation::{EmbodyInterpolationPlugin, Interpolated, NotInterpolated},
    };
}
