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
    /// How long nothing of it has moved, seconds; see [`RagdollRest`](super::RagdollRest).
    pub still: f32,
    /// How long it is not put back again after the solver tore it to pieces, seconds.
    pub spared: f32,
    /// The clip of its [`GetUp`](super::GetUp) that it waits for while it gets up.
    pub rise: Option<usize>,
    /// Where its entity was when the last tick drove it, or was taken to by
    /// [`FollowRoot`](super::FollowRoot): what a teleport counts from.
    pub figure: BonePose,
    /// Hits that the next tick delivers.
    pub hits: Vec<PendingHit>,
    /// The bones, parents before children, as in [`Bones`](super::Bones).
    pub bones: Vec<BoneState>,
}

/// A hit on its way.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct PendingHit {
    /// The bone, by its place in [`RagdollState::bones`].
    pub bone: usize,
    /// Where, world, metres.
    pub point: Vec3,
    /// Newton-seconds, world.
    pub impulse: Vec3,
}

impl Default for RagdollState {
    fn default() -> Self {
        Self {
            mode: RagdollMode::default(),
            age: 0.0,
            rise_time: 0.5,
            still: 0.0,
            spared: 0.0,
            rise: None,
            figure: BonePose::default(),
            hits: Vec::new(),
            bones: Vec::new(),
        }
    }
}

impl RagdollState {
    /// This state made ready to be written onto a ragdoll of the same profile, whose bodies may be
    /// elsewhere: its next tick puts every body where it was in this state, as fast as it was.
    ///
    /// A rollback that restores the physics world as well writes the state as it is instead.
    pub fn to_restore(&self) -> Self {
        let mut state = self.clone();
        for bone in &mut state.bones {
            bone.body = BoneBody::Off;
        }
        state
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
    /// Part of the physics in what is shown of it, `0..=1`.
    pub shown: f32,
    /// Part of its strength that a hit has taken, `0..=1`.
    pub hurt: f32,
    /// Time before it begins to come back, seconds.
    pub dazed: f32,
    /// Whether it is cut off from the bone that bears it.
    pub severed: bool,
    /// How long its joint has borne more than it can, seconds.
    pub strained: f32,
}
