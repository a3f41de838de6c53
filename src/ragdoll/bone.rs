//! Bones: entities of their own, tied to their ragdoll.

use bevy::prelude::*;

use super::intent::BoneControl;
use crate::backend::joints::JointHandle;

/// One bone of a ragdoll: a body. Made by the plugin.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(BoneControl, BoneOutput, BoneTies, Transform)]
pub struct RagdollBone {
    /// Its number in [`RagdollProfile::bones`](super::RagdollProfile::bones).
    pub index: usize,
    /// Its number with parents before children, as in
    /// [`RagdollState::bones`](super::RagdollState::bones).
    pub order: usize,
}

/// On a bone: the ragdoll it belongs to.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Component, Debug, PartialEq, Clone)]
#[relationship(relationship_target = Bones)]
pub struct BoneOf(pub Entity);

/// On a ragdoll: its bones, parents before children. Kept by [`BoneOf`].
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[relationship_target(relationship = BoneOf, linked_spawn)]
pub struct Bones(Vec<Entity>);

/// What a bone did in the last tick.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BoneOutput {
    /// Velocity of its origin, metres per second.
    pub velocity: Vec3,
    /// Radians per second.
    pub spin: Vec3,
    /// Distance of its joint's two sides, metres.
    pub gap: f32,
    /// How far its joint is beyond its limits, radians.
    pub violation: f32,
    /// Angle between its joint and the pose asked for, radians.
    pub error: f32,
    /// Whether it is simulated.
    pub simulated: bool,
    /// Whether it sleeps.
    pub asleep: bool,
}

/// The joints of a bone in the physics world.
#[derive(Component, Debug, Default)]
pub(crate) struct BoneTies {
    /// Locks the pivot, and holds the limits when they are hard.
    pub limit: Option<JointHandle>,
    /// Holds soft limits, and the cone of a joint whose twist is locked.
    pub soft: Option<JointHandle>,
    pub drive: Option<JointHandle>,
    pub pin: Option<JointHandle>,
    /// Keeps it from colliding with the bone that it was cut off from.
    pub apart: Option<JointHandle>,
    /// Whether it was told that the pose asked for is none.
    pub told: bool,
}
