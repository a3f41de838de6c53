//! From a skinned mesh to a ragdoll: shapes fitted to the skin, and the whole way in one component.

mod fit;
mod scene;

pub use fit::{fit_box, fit_capsule};
pub(crate) use scene::SkeletonJoints;
pub(super) use scene::build;
pub use scene::{RagdollFromSkin, RagdollReady, SkinReport};
