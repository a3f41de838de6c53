//! Which way is up for a figure that lies, gets up, or is followed.

use bevy::prelude::*;

use super::plan::RagdollPlan;

/// On a ragdoll: where up is, world axes, of any length above 0. It says what is below a figure that gets
/// up or that its entity follows ([`FollowRoot`](super::FollowRoot)); gravity is the physics world's.
///
/// A character that can fall has that of its character. What is no direction is told once and counts as
/// `+Y`.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct RagdollUp(pub Vec3);

impl Default for RagdollUp {
    fn default() -> Self {
        Self(Vec3::Y)
    }
}

impl RagdollUp {
    /// Of unit length.
    pub(crate) fn direction(self) -> Vec3 {
        self.0.try_normalize().unwrap_or(Vec3::Y)
    }
}

/// Tells, once, of what is no direction.
pub(super) fn check(
    mut changed: Query<(Entity, &RagdollUp, &mut RagdollPlan), Changed<RagdollUp>>,
) {
    for (entity, up, mut plan) in &mut changed {
        let bad = up.0.try_normalize().is_none();
        let plan = plan.bypass_change_detection();
        if bad && !plan.told_up {
            tracing::warn!(
                "{entity}: ragdoll: RagdollUp is {}, but needs a direction; up is +Y",
                up.0
            );
        }
        plan.told_up = bad;
    }
}
