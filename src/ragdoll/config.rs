//! What a ragdoll is, as a whole.

use bevy::prelude::*;

use super::{
    blend::RagdollBlend, humanoid::HumanoidDetail, intent::RagdollIntent, plan::RagdollPlan,
    pose::RagdollPose, profile::RagdollProfile, rest::RagdollRest, state::RagdollState,
    up::RagdollUp,
};

/// A ragdoll: add it to an entity, and it gets [`Bones`](super::Bones), bodies of their own at the top
/// level of the world, tied to it by [`BoneOf`](super::BoneOf).
///
/// The entity's [`Transform`] says where the figure is: origin on the ground between the feet, `Y` up,
/// facing `-Z`. What the figure should do is asked through [`RagdollIntent`], what pose it should take
/// through [`RagdollPose`] or [`BoneSource`](super::BoneSource), what each bone adds to that through
/// [`BoneControl`](super::BoneControl); what it does is in [`RagdollState`] and each bone's
/// [`BoneOutput`](super::BoneOutput).
///
/// A value out of its range is refused with one warning; the ragdoll then has no bones until it is
/// mended. Another profile, mass, conditioning, damping or number of iterations builds the bones anew;
/// everything else is used from the next tick on.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(
    RagdollIntent,
    RagdollState,
    RagdollPose,
    RagdollUp,
    RagdollPlan,
    Transform
)]
pub struct Ragdoll {
    /// The body plan.
    pub profile: RagdollProfile,
    /// Kilograms, above 0.
    pub mass: f32,
    /// How far masses and inertias are evened out for the solver, `0..=1`: 0 are those of anatomy; 1 is
    /// the stablest, with hands several times as heavy as real ones. The whole keeps its mass.
    pub conditioning: f32,
    /// How it is driven to a pose.
    pub drive: RagdollDrive,
    /// Damping of linear and angular velocity by the air, per second, at least 0.
    pub damping: f32,
    /// No bone is faster than this, metres per second, above 0.
    pub max_speed: f32,
    /// No bone turns faster than this, radians per second, above 0. Limits hold up to about this
    /// rate; beyond, they are overrun.
    pub max_spin: f32,
    /// How long a switch to a kinematic mode takes to leave the pose it came from, seconds, at least 0.
    pub fade: f32,
    /// How animation and physics are mixed in what is shown.
    pub blend: RagdollBlend,
    /// When it counts as lying still, and what then.
    pub rest: RagdollRest,
    /// Greatest speed of a bone in [`RagdollMode::Keyframed`](super::RagdollMode::Keyframed), metres per
    /// second, above 0. Pressed against a wall with much more than 10 it trembles.
    pub keyframe_speed: f32,
    /// How often the solver goes over the joints in each substep, at least 1. It is a setting of the
    /// whole physics world, where the largest that is asked for counts. With 4 a neck that
    /// bears a whole figure gives by 8 degrees, with 6 by none; powered figures that lie on each other have
    /// gaps of 0.3 mm in their joints with 8, and come to rest.
    pub iterations: u8,
    /// With whom its bones collide.
    pub groups: BoneGroups,
}

/// With whom the bones of a ragdoll collide: Rapier's collision groups, a bit for each of 32. Two things
/// meet when each is in a group that the other meets.
///
/// By default bones are in all groups and meet all. A bone with groups of its own gets them as
/// [`CollisionGroups`](bevy_rapier3d::prelude::CollisionGroups) on its entity; they stay until these are
/// changed.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BoneGroups {
    /// The groups that they are in.
    pub memberships: u32,
    /// The groups that they meet.
    pub filters: u32,
}

impl Default for BoneGroups {
    fn default() -> Self {
        Self {
            memberships: u32::MAX,
            filters: u32::MAX,
        }
    }
}

/// How a powered ragdoll is driven to its pose.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct RagdollDrive {
    /// Hertz, above 0: how fast each joint returns to its pose, with everything that hangs on it. 2 is
    /// soft, 10 firm; 20 needs 120 ticks per second or `iterations` of 4.
    pub frequency: f32,
    /// Part of critical damping, at least 0; below 1 it swings.
    pub damping_ratio: f32,
    /// Part of the pose's own velocity that is aimed at, `0..=1`; below 1 it lags behind.
    pub velocity: f32,
    /// Part of gravity that joints bear without sagging, `0..=1`, where they hang from a bone that is
    /// kinematic or pinned.
    pub gravity: f32,
    /// Part of each joint's greatest torque that it has; infinite is allowed.
    pub torque: f32,
    /// Hertz, above 0: how fast a pinned bone returns to its place.
    pub pin_frequency: f32,
}

impl Default for RagdollDrive {
    fn default() -> Self {
        Self {
            frequency: 10.0,
            damping_ratio: 1.0,
            velocity: 1.0,
            gravity: 1.0,
            torque: 1.0,
            pin_frequency: 10.0,
        }
    }
}

impl Default for Ragdoll {
    fn default() -> Self {
        Self {
            profile: RagdollProfile::humanoid(HumanoidDetail::default(), 1.75),
            mass: 75.0,
            conditioning: 1.0,
            drive: RagdollDrive::default(),
            damping: 0.05,
            max_speed: 100.0,
            max_spin: 47.0,
            fade: 0.25,
            blend: RagdollBlend::default(),
            rest: RagdollRest::default(),
            keyframe_speed: 10.0,
            iterations: 6,
            groups: BoneGroups::default(),
        }
    }
}

impl Ragdoll {
    /// Whether bones made of the other are those of this.
    pub(super) fn has_bones_of(&self, other: &Self) -> bool {
        self.mass == other.mass
            && self.conditioning == other.conditioning
            && self.damping == other.damping
            && self.iterations == other.iterations
            && self.profile == other.profile
    }

    /// Takes over all that builds no bones; nothing is allocated.
    pub(super) fn take_settings(&mut self, other: &Self) {
        // Every field is named, so that a new one is not forgotten.
        let Self {
            profile: _,
            mass: _,
            conditioning: _,
            damping: _,
            iterations: _,
            drive,
            max_speed,
            max_spin,
            fade,
            blend,
            rest,
            keyframe_speed,
            groups,
        } = other;
        self.drive = *drive;
        self.max_speed = *max_speed;
        self.max_spin = *max_spin;
        self.fade = *fade;
        self.blend = *blend;
        self.rest = *rest;
        self.keyframe_speed = *keyframe_speed;
        self.groups = *groups;
    }

    /// A figure of this plan and mass.
    pub fn new(profile: RagdollProfile, mass: f32) -> Self {
        Self {
            profile,
            mass,
            ..default()
        }
    }
}
