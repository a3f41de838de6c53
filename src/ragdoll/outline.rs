//! Where the limits of a joint are, as directions to draw.

use bevy::{math::ops, prelude::*};

use super::{
    math::rotation::{swing_of_point, twist_of_angle},
    plan::PlannedBone,
    profile::JointKind,
};

impl PlannedBone {
    /// Rotations of the child's axes of the joint, in those that limits are counted from, around the
    /// boundary of its swing; `part` goes round once from 0 to 1. `None` where it does not swing.
    pub(crate) fn rim(&self, part: f32) -> Option<Quat> {
        let (sin, cos) = ops::sin_cos(part * core::f32::consts::TAU);
        match self.joint.kind {
            JointKind::Ball { .. } | JointKind::Condyloid { .. } => {
                let cone = self.cone.as_ref()?;
                Some(swing_of_point(cone.on_boundary(cos, sin)))
            }
            JointKind::Saddle { y, z } => {
                // Along the four sides of its rectangle.
                let side = (part * 4.0).clamp(0.0, 4.0);
                let t = side - side.floor();
                let (a, b) = match side as u32 % 4 {
                    0 => (y.x + (y.y - y.x) * t, z.x),
                    1 => (y.y, z.x + (z.y - z.x) * t),
                    2 => (y.y + (y.x - y.y) * t, z.y),
                    _ => (y.x, z.y + (z.x - z.y) * t),
                };
                let half = Vec2::new(ops::tan(a * 0.5), ops::tan(b * 0.5));
                Some(swing_of_point(half))
            }
            _ => None,
        }
    }

    /// Least and greatest turn about X, radians.
    pub(crate) fn twist(&self) -> Option<(f32, f32)> {
        match self.joint.kind {
            JointKind::Ball { twist, .. } => Some((twist.x, twist.y)),
            JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => Some((min, max)),
            _ => None,
        }
    }

    /// A rotation of the joint as one of the child in the world.
    pub(crate) fn child_of(&self, parent: Quat, q: Quat) -> Quat {
        (parent * self.frames.rotation1 * q * self.frames.rotation2.inverse()).normalize()
    }

    /// Where the bone points from its joint, in its own axes, unit length.
    #[cfg(feature = "debug")]
    pub(crate) fn along(&self) -> Vec3 {
        self.center.normalize_or(self.frames.rotation2 * Vec3::X)
    }

    /// A direction across X at a turn about it, in the axes that limits are counted from.
    pub(crate) fn across(turn: f32) -> Vec3 {
        twist_of_angle(turn) * Vec3::Y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::{
        config::Ragdoll,
        humanoid::HumanoidDetail,
        math::rotation::{angle, from_rotation_vector, rotation_vector},
        plan::RagdollPlan,
        profile::RagdollProfile,
    };

    #[test]
    fn the_rim_that_is_drawn_is_where_violation_begins() {
        let mut profile = RagdollProfile::humanoid(HumanoidDetail::Bodies23, 1.75);
        profile.bone_mut("hand_l").unwrap().joint.kind = JointKind::Saddle {
            y: Vec2::new(-0.3, 0.8),
            z: Vec2::new(-0.2, 0.5),
        };
        let plan = RagdollPlan::of(&Ragdoll::new(profile, 75.0));
        let mut rims = 0;
        for bone in &plan.bones {
            for i in 0..40 {
                let Some(q) = bone.rim(i as f32 / 40.0) else {
                    continue;
                };
                rims += 1;
                let kind = &bone.joint.kind;
                assert!(kind.violation(q) < 3.0e-3, "{}", kind.violation(q));
                let beyond = from_rotation_vector(rotation_vector(q) * 1.2);
                assert!(kind.violation(beyond) > 1.0e-3, "{i}: {kind:?}");
            }
            let (parent, q) = (Quat::from_rotation_y(0.7), Quat::from_rotation_x(0.2));
            let back = bone.joint_rotation(parent, bone.child_of(parent, q));
            assert!(angle(back.inverse() * q) < 1.0e-3);
        }
        assert!(rims > 400);
    }
}
