//! Each tick the elliptic cone of a joint is replaced by the circular one that touches it where the
//! bone is nearest to it.

use bevy::prelude::*;

use super::{
    math::rotation::{swing_point, swing_twist, twist_angle},
    plan::PlannedBone,
    profile::JointKind,
};

/// What the physics engine is given of a cone for a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AimedCone {
    /// Of the joint's first frame.
    pub rotation1: Quat,
    /// Radians.
    pub half_angle: f32,
    pub twist: [f32; 2],
}

impl PlannedBone {
    /// Turn of the cone's axis, and half angle, for a rotation of the joint.
    pub fn cap(&self, q: Quat) -> (Quat, f32) {
        match &self.cone {
            Some(cone) => {
                let cap = cone.touching(swing_point(swing_twist(q).0));
                (cap.center, cap.half_angle)
            }
            None => (Quat::IDENTITY, core::f32::consts::PI),
        }
    }

    /// The cone for a tick; `None` where it is the same in every tick.
    pub fn aimed(&self, parent: Quat, child: Quat) -> Option<AimedCone> {
        let cone = self.cone.as_ref()?;
        if cone.is_circular() {
            return None;
        }
        let twist = match self.joint.kind {
            JointKind::Ball { twist, .. } => twist,
            _ => Vec2::ZERO,
        };
        let q = self.joint_rotation(parent, child);
        let (center, half_angle) = self.cap(q);
        // From the turned axis the same twist measures differently.
        let shift = twist_angle(center.inverse() * q) - twist_angle(q);
        Some(AimedCone {
            rotation1: (self.frames.rotation1 * center).normalize(),
            half_angle,
            twist: [twist.x + shift, twist.y + shift],
        })
    }
}
