//! What a ragdoll is made of, as data: bones with shape, mass and joint.

mod joint;
mod mass;
mod overlap;
mod shape;

use bevy::prelude::*;

pub use joint::{JointBreak, JointKind, JointProfile, JointSoftness};
pub use mass::BoneMass;
pub(crate) use overlap::overlap;
pub use shape::BoneShape;
pub(crate) use shape::{capsule_within, degrees, radius_of_volume};

/// A body plan: bones in the bind pose, each with its shape, its share of the mass and its joint.
///
/// Everything is in the axes of the figure: origin on the ground between the feet, `Y` up, facing
/// `-Z`, metres. [`RagdollProfile::humanoid`] makes one for people; animals and props are written by
/// hand or loaded (with the feature `serialize`).
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct RagdollProfile {
    /// The bones, in any order; one of them has no parent.
    pub bones: Vec<BoneProfile>,
    /// Pairs of bones by name that do not collide with each other, beside those tied by a joint and
    /// those that overlap in the bind pose.
    pub no_contact: Vec<(String, String)>,
}

/// One bone.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BoneProfile {
    /// Its name, once per profile.
    pub name: String,
    /// The bone that bears it; `None` for the root.
    pub parent: Option<String>,
    /// Where its joint with the parent is in the bind pose, metres; of the root, where its origin is.
    pub position: Vec3,
    /// Its rotation in the bind pose. What its [`BoneShape`] and [`BoneMass`] are given in.
    pub rotation: Quat,
    /// What collides.
    pub shape: BoneShape,
    /// How its mass is spread.
    pub mass: BoneMass,
    /// How it is tied to its parent; unused on the root.
    pub joint: JointProfile,
}

impl RagdollProfile {
    /// The index of a bone.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.bones.iter().position(|b| b.name == name)
    }

    /// A bone by name.
    pub fn bone(&self, name: &str) -> Option<&BoneProfile> {
        self.bones.iter().find(|b| b.name == name)
    }

    /// A bone by name, to be changed.
    pub fn bone_mut(&mut self, name: &str) -> Option<&mut BoneProfile> {
        self.bones.iter_mut().find(|b| b.name == name)
    }
}
