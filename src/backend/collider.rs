//! Colliders whose origin is not their centre.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;

/// A collider with its centre this far above its origin, metres.
pub(crate) fn raised(collider: Collider, by: f32) -> Collider {
    Collider::compound(vec![(Vec3::Y * by, Quat::IDENTITY, collider)])
}
