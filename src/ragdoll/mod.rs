//! Ragdolls: skeletons as jointed bodies, limp, driven to a pose, or following it.
//!
//! A [`Ragdoll`] makes its [`Bones`] from a [`RagdollProfile`]: bodies at the top level of the world, each
//! tied to its parent by a joint with the limits of anatomy. [`RagdollIntent`] asks what they are
//! ([`RagdollMode`]); every change keeps the place and the velocity of every bone. Where they are driven,
//! each joint is a spring of a frequency in hertz with the inertia of all that hangs on it, aimed at the
//! pose by a frame of its own, so that it arrives from any rotation; weight is borne by a torque worked
//! out for the pose, so that it does not sag.

mod bone;
mod conditioning;
mod config;
mod drive;
mod humanoid;
mod intent;
mod limits;
mod math;
mod names;
mod plan;
mod pose;
mod prepare;
mod profile;
mod react;
mod state;
mod tick;
mod validate;

use bevy::prelude::*;
use bevy_rapier3d::prelude::PhysicsSet;

#[cfg(doc)]
use crate::schedule::EmbodyCorePlugin;
use crate::{
    backend::{forces::ForcedBodies, joints::PinAnchors},
    schedule::EmbodySystems,
};

pub use bone::{BoneOf, BoneOutput, Bones, RagdollBone};
pub use config::{Ragdoll, RagdollDrive};
pub use humanoid::{BodyPart, HumanoidDetail, HumanoidRig};
pub use intent::{BoneControl, RagdollIntent, RagdollMode};
pub use math::inertialize::PoseOffset;
pub use names::{NameMap, SkeletonBone, SkeletonMatch};
pub use pose::{BonePose, BoneSource, RagdollPose};
pub use profile::{
    BoneMass, BoneProfile, BoneShape, JointKind, JointProfile, JointSoftness, RagdollProfile,
};
pub use state::{BoneBody, BoneState, RagdollState};

/// Where ragdolls work in a tick; each right behind the set of the same name of [`EmbodySystems`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RagdollSystems {
    /// Bones are built and switched.
    Prepare,
    /// Bones are tied, sent and driven.
    Drive,
    /// What they did is measured.
    React,
}

/// Adds ragdolls. Needs [`EmbodyCorePlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct RagdollPlugin;

impl Plugin for RagdollPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Ragdoll>()
            .register_type::<RagdollIntent>()
            .register_type::<RagdollPose>()
            .register_type::<RagdollState>()
            .register_type::<RagdollBone>()
            .register_type::<BoneOf>()
            .register_type::<Bones>()
            .register_type::<BoneControl>()
            .register_type::<BoneOutput>()
            .init_resource::<ForcedBodies>()
            .init_resource::<PinAnchors>()
            .init_resource::<drive::BoneForces>()
            .configure_sets(
                FixedPostUpdate,
                (
                    RagdollSystems::Prepare
                        .after(EmbodySystems::Prepare)
                        .before(PhysicsSet::SyncBackend),
                    RagdollSystems::Drive
                        .after(EmbodySystems::Drive)
                        .before(PhysicsSet::StepSimulation),
                    RagdollSystems::React.after(EmbodySystems::React),
                ),
            );
        #[cfg(feature = "vehicle")]
        app.configure_sets(
            FixedPostUpdate,
            RagdollSystems::Drive.after(crate::vehicle::VehicleSystems::Drive),
        );
        app.add_systems(
            FixedPostUpdate,
            (
                (prepare::build, prepare::switch)
                    .chain()
                    .in_set(RagdollSystems::Prepare),
                (
                    drive::admit_new,
                    drive::tie,
                    drive::drive,
                    drive::apply_forces,
                )
                    .chain()
                    .in_set(RagdollSystems::Drive),
                react::observe.in_set(RagdollSystems::React),
            )
                .run_if(any_with_component::<Ragdoll>),
        )
        // Also when the last ragdoll is gone.
        .add_systems(
            FixedPostUpdate,
            drive::end_forces
                .after(PhysicsSet::SyncBackend)
                .before(EmbodySystems::Drive),
        );
    }
}
