//! What a ragdoll carries from tick to tick: all that a rollback must restore, beside its bodies.

use bevy::prelude::*;

use super::{intent::RagdollMode, math::inertialize::PoseOffset, pose::BonePose};

/// The state of a ragdoll.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct RagdollState {
    /// The mode of the last tick.
    pub mode: RagdollMode,
    /// Time in it, seconds.
    pub age: f32,
    /// How long it takes to rise, seconds.
    pub rise_time: f32,
    /// The bones, parents before children, as in [`Bones`](super::Bones).
    pub bones: Vec<BoneState>,
}

impl Default for RagdollState {
    fn default() -> Self {
        Self {
            mode: RagdollMode::default(),
            age: 0.0,
            rise_time: 0.5,
            bones: Vec::new(),
        }
    }
}

/// What a bone is for the physics.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum BoneBody {
    /// Not there.
    #[default]
    Off,
    /// Follows the pose.
    Kinematic,
    /// Simulated.
    Dynamic,
    /// Stays where it is.
    Fixed,
}

/// The state of one bone. Poses are in the world.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BoneState {
    /// What it was in the last tick.
    pub body: BoneBody,
    /// The pose asked for at the end of the last tick; `None` before the first.
    pub target: Option<BonePose>,
    /// Where the last tick put it: of what is not simulated, where it was sent.
    pub place: BonePose,
    /// Velocity of its origin after the last tick, metres per second.
    pub velocity: Vec3,
    /// Radians per second.
    pub spin: Vec3,
    /// How hard it was driven in the last tick.
    pub strength: f32,
    /// How hard it was pinned in the last tick.
    pub pin: f32,
    /// Whether its offset is counted from the bone that bears it, not from its own pose.
    pub borne: bool,
    /// What is left of the pose from which it went over to following.
    pub offset: PoseOffset,
}
