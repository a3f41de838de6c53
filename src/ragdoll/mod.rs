//! Ragdolls: skeletons as jointed bodies, limp, driven to a pose, or following it.
//!
//! A [`Ragdoll`] makes its [`Bones`] from a [`RagdollProfile`]: bodies at the top level of the world, each
//! tied to its parent by a joint with the limits of anatomy. [`RagdollIntent`] asks what they are
//! ([`RagdollMode`]); every change keeps the place and the velocity of every bone. Where they are driven,
//! each joint is a spring of a frequency in hertz with the inertia of all that hangs on it, aimed at the
//! pose by a frame of its own, so that it arrives from any rotation; weight is borne by a torque worked
//! out for the pose, so that it does not sag.
//!
//! A skeleton is shown by its bones through [`BoneJoint`]s, which [`RagdollFromSkin`] makes of a loaded
//! figure. Figures are hit ([`HitCommands`]), noticed and frozen when they lie still ([`RagdollRest`]),
//! get up ([`GetUp`]), lose limbs ([`Dismember`]), and stand ([`RagdollBalance`]).
//!
//! Floors are best a half-space, a mesh or boxes of some tens of metres: between a capsule and a box of
//! hundreds of metres the physics engine loses all contacts for single ticks, and a figure on it may
//! tremble for long. In piles bodies stay awake longer than alone; [`RagdollRest::freeze_after`] ends it.

#[cfg(feature = "serialize")]
mod asset;
mod bake;
mod balance;
mod blend;
mod bone;
mod conditioning;
mod config;
mod drive;
mod follow;
mod hit;
mod humanoid;
mod intent;
mod keyframe;
mod limits;
mod math;
mod names;
#[cfg(any(feature = "debug", test))]
mod outline;
mod plan;
mod pose;
mod prepare;
mod profile;
mod react;
mod rest;
mod rise;
mod sever;
mod skin;
mod state;
mod teleport;
mod tick;
mod up;
mod validate;
mod weight;

use bevy::prelude::*;
use bevy_rapier3d::prelude::PhysicsSet;

#[cfg(doc)]
use crate::schedule::EmbodyCorePlugin;
use crate::{
    backend::{
        forces::ForcedBodies,
        joints::{JointIterations, PinAnchors},
    },
    schedule::EmbodySystems,
};

#[cfg(feature = "serialize")]
pub use asset::{RagdollFromProfile, RagdollProfileError, RagdollProfileLoader};
pub use bake::BakeRagdoll;
pub use balance::{BalanceState, Pendulum, RagdollBalance};
pub use blend::{BoneJoint, RagdollBlend};
pub use bone::{BoneOf, BoneOutput, Bones, RagdollBone};
pub use config::{BoneGroups, Ragdoll, RagdollDrive};
pub use follow::FollowRoot;
pub use hit::{HitCommands, HitReaction, RagdollHit};
pub use humanoid::{BodyPart, HumanoidDetail, HumanoidRig};
pub use intent::{BoneControl, RagdollIntent, RagdollMode};
pub use math::inertialize::PoseOffset;
pub use names::{NameMap, SkeletonBone, SkeletonMatch};
#[cfg(feature = "debug")]
pub(crate) use plan::PlannedBone;
#[cfg(any(feature = "character", feature = "debug"))]
pub(crate) use plan::RagdollPlan;
pub use pose::{BonePose, BoneSource, RagdollPose};
pub use profile::{
    BoneMass, BoneProfile, BoneShape, JointBreak, JointKind, JointProfile, JointSoftness,
    RagdollProfile,
};
pub use rest::{CameToRest, RagdollRest};
pub use rise::{GetUp, GetUpClip, GetsUp, Lying};
pub use sever::{Dismember, JointBroke, Reattach};
pub use skin::{RagdollFromSkin, RagdollReady, SkinReport, fit_box, fit_capsule};
pub use state::{BoneBody, BoneState, PendingHit, RagdollState};
pub use up::RagdollUp;
#[cfg(feature = "character")]
pub(crate) use {rise::find_place, sever::is_cut};

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
            .register_type::<BoneJoint>()
            .register_type::<FollowRoot>()
            .register_type::<RagdollUp>()
            .register_type::<HitReaction>()
            .register_type::<RagdollHit>()
            .register_type::<CameToRest>()
            .register_type::<GetUp>()
            .register_type::<GetsUp>()
            .register_type::<Dismember>()
            .register_type::<Reattach>()
            .register_type::<JointBroke>()
            .register_type::<BakeRagdoll>()
            .register_type::<RagdollBalance>()
            .register_type::<BalanceState>()
            .add_observer(bake::bake)
            .add_observer(bake::unmake)
            .add_observer(hit::take)
            .add_observer(sever::note_cut)
            .add_observer(sever::note_joined)
            .add_observer(balance::forget)
            .add_observer(teleport::carry)
            .add_observer(blend::note_joint)
            .init_resource::<ForcedBodies>()
            .init_resource::<PinAnchors>()
            .init_resource::<JointIterations>()
            .init_resource::<drive::BoneForces>()
            .init_resource::<blend::NewJoints>()
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
        #[cfg(feature = "serialize")]
        app.add_systems(
            FixedPostUpdate,
            asset::build
                .in_set(RagdollSystems::Prepare)
                .before(prepare::build)
                .run_if(any_with_component::<RagdollFromProfile>),
        );
        app.add_systems(
            FixedPostUpdate,
            (
                (
                    prepare::build,
                    blend::tell_shared,
                    prepare::pace,
                    hit::feel,
                    up::check,
                    rise::begin,
                    prepare::switch,
                )
                    .chain()
                    .in_set(RagdollSystems::Prepare),
                (
                    drive::admit_new,
                    drive::tie,
                    sever::part,
                    drive::drive,
                    (balance::check, balance::stand)
                        .chain()
                        .run_if(any_with_component::<RagdollBalance>),
                    drive::apply_forces,
                )
                    .chain()
                    .in_set(RagdollSystems::Drive),
                (
                    react::observe,
                    sever::strain,
                    rest::notice,
                    blend::fade,
                    follow::follow,
                )
                    .chain()
                    .in_set(RagdollSystems::React),
            )
                .run_if(any_with_component::<Ragdoll>),
        )
        .add_systems(
            FixedPostUpdate,
            skin::build
                .in_set(RagdollSystems::Prepare)
                .before(prepare::build)
                .run_if(any_with_component::<RagdollFromSkin>),
        )
        .add_systems(
            PostUpdate,
            blend::show
                .in_set(EmbodySystems::Present)
                .run_if(any_with_component::<Ragdoll>),
        )
        // Also when the last ragdoll is gone.
        .add_systems(
            FixedPostUpdate,
            (drive::end_forces, drive::set_iterations)
                .chain()
                .after(PhysicsSet::SyncBackend)
                .before(EmbodySystems::Drive),
        );
    }

    // Here it is known whether the app has assets.
    #[cfg(feature = "serialize")]
    fn finish(&self, app: &mut App) {
        if app.world().contains_resource::<AssetServer>() {
            app.init_asset::<RagdollProfile>()
                .register_asset_loader(RagdollProfileLoader);
        }
    }
}
