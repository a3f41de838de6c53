//! Ragdolls: skeletons as jointed bodies.

mod humanoid;
mod math;
mod profile;

pub use humanoid::{BodyPart, HumanoidDetail, HumanoidRig};
pub use profile::{
    BoneMass, BoneProfile, BoneShape, JointKind, JointProfile, JointSoftness, RagdollProfile,
};
