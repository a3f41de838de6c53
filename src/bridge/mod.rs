//! What systems do to each other: each bridge is a module of its own, there when both of its sides are.

#[cfg(all(feature = "character", feature = "ragdoll"))]
mod fall;

#[cfg(all(feature = "character", feature = "ragdoll"))]
pub use fall::{
    BecomeRagdoll, BodyPhase, CharacterRagdoll, CharacterRagdollPlugin, CharacterRagdollState,
    CharacterRagdollSystems, FallCommands, FellDown, Recover, StoodUp,
};
