//! What the game asks of a ragdoll; read once per tick.

use bevy::prelude::*;

/// What a ragdoll is asked to do. The game writes it in `FixedUpdate` or before; the tick that follows
/// uses it. It is never written by the plugin.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct RagdollIntent {
    /// What the bones are.
    pub mode: RagdollMode,
    /// How hard bones that are driven hold their pose, `0..=1`.
    pub strength: f32,
}

impl Default for RagdollIntent {
    fn default() -> Self {
        Self {
            mode: RagdollMode::default(),
            strength: 1.0,
        }
    }
}

/// What the bones of a ragdoll are. Any may follow any other, in any tick: each bone keeps its position
/// and velocity.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum RagdollMode {
    /// Not there for the physics.
    Animated,
    /// Kinematic bodies that follow the pose: rays and things hit them.
    HitBoxes,
    /// Bones with [`BoneControl::simulated`](super::BoneControl::simulated) are driven as in
    /// [`Self::Powered`], the others follow the pose as in [`Self::HitBoxes`].
    Partial,
    /// Simulated, and driven to the pose.
    Powered,
    /// Simulated, and given each tick the velocity that takes every bone to its place in the world: it is
    /// where the pose is as long as nothing is in the way, and shoves what is loose aside. Muscles have
    /// no part in it.
    Keyframed,
    /// Simulated, without muscles.
    #[default]
    Limp,
    /// Held where it is, at no cost.
    Frozen,
    /// Follows the pose, from wherever it lies, over
    /// [`RagdollState::rise_time`](super::RagdollState::rise_time).
    GettingUp,
}

/// On a bone: what it adds to the intent of its ragdoll. Read once per tick.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct BoneControl {
    /// Its part of the ragdoll's strength, `0..=1`.
    pub strength: f32,
    /// How hard it is held at its pose in the world when it is driven, `0..=1`.
    pub pin: f32,
    /// Whether it is simulated in [`RagdollMode::Partial`].
    pub simulated: bool,
    /// Part of the physics in what is shown of it while it is simulated, `0..=1`; the rest is the
    /// animation. Matters to bones with a [`BoneJoint`](super::BoneJoint).
    pub blend: f32,
}

impl Default for BoneControl {
    fn default() -> Self {
        Self {
            strength: 1.0,
            pin: 0.0,
            simulated: false,
            blend: 1.0,
        }
    }
}

/// A number within `0..=1`; what is none counts as 0.
pub(crate) fn part(v: f32) -> f32 {
    if v > 0.0 { v.min(1.0) } else { 0.0 }
}
