//! What the physics engine is told of a joint's limits for the coming tick.
//!
//! The engine looks at a limit only once it is passed, and stops the bone a substep too late: an arm that
//! swings at 10 rad/s is 2.4 degrees beyond by then. So each limit is drawn in by the way that the joint
//! goes in a substep at its present rate; at rest nothing is drawn in. An elliptic cone is replaced by
//! the circular one that touches it where the bone is nearest to it.

use bevy::prelude::*;

use super::{
    math::rotation::{from_rotation_vector, swing_point, swing_twist, twist_angle, twist_of_angle},
    plan::{PlannedBone, bounds},
    profile::JointKind,
};
use crate::backend::joints::AimedRows;

/// The narrowest cone that is asked for, radians.
const NARROWEST: f32 = 0.004;

/// How far ahead a turn is looked at for the cone, radians.
const FARTHEST: f32 = 0.2;

/// A range drawn in on the side that is approached.
fn ahead(range: [f32; 2], rate: f32, substep: f32) -> [f32; 2] {
    let way = rate * substep;
    let [min, max] = [range[0] - way.min(0.0), range[1] - way.max(0.0)];
    // Approached from far away, a narrow range must not turn inside out.
    if min <= max {
        [min, max]
    } else {
        [(range[0] + range[1]) * 0.5; 2]
    }
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

    /// The limits for a tick, by the rotations of parent and child, the child's spin and the velocity of its
    /// joint against the parent (world, radians and metres per second), and the lengths of the tick and of
    /// a substep, seconds.
    pub fn aimed(
        &self,
        (parent, child): (Quat, Quat),
        spin: Vec3,
        slip: Vec3,
        (dt, substep): (f32, f32),
    ) -> Option<AimedRows> {
        let first = parent * self.frames.rotation1;
        let mut aimed = AimedRows {
            rotation1: self.frames.rotation1,
            rotation2: self.frames.rotation2,
            slides: [None; 3],
            cone: None,
            turns: [None; 3],
        };
        match self.joint.kind {
            JointKind::Ball { .. } | JointKind::Condyloid { .. } => {
                // Where the bone is in the middle of the tick: an ellipse bends away under one that slides
                // along it, and a cone that is ahead of it would drive it on. No farther than so that
                // the cone there does not leave out a bone that is well within; what would be outside
                // is stopped.
                let turned = |way: Vec3| (from_rotation_vector(way) * child).normalize();
                let stopped = |child: Quat| {
                    let q = self.joint_rotation(parent, child);
                    self.joint.kind.clamp(q)
                };
                let end = stopped(turned(spin * dt));
                let child = turned((spin * (0.5 * dt)).clamp_length_max(FARTHEST));
                let (center, half_angle) = self.cap(stopped(child));
                let axis = first * center * Vec3::X;
                let own = child * self.frames.rotation2 * Vec3::X;
                let outward = axis.cross(own).normalize_or_zero();
                let opens = spin.dot(outward).max(0.0) * substep;
                aimed.rotation1 = (self.frames.rotation1 * center).normalize();
                aimed.cone = Some((half_angle - opens).max(NARROWEST));
                if let JointKind::Ball { twist, .. } = self.joint.kind {
                    // From the turned axis the same twist measures differently, and otherwise at the end
                    // of the tick than before.
                    let shift = twist_angle(center.inverse() * end) - twist_angle(end);
                    aimed.rotation2 = self.frames.rotation2 * twist_of_angle(-shift);
                    // A blow against the cone turns swing into twist within the tick, either way.
                    let rate = spin.length();
                    aimed.turns[0] = bounds(twist)
                        .map(|range| ahead(ahead(range, rate, substep), -rate, substep));
                }
            }
            JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => {
                let rate = spin.dot(first * Vec3::X);
                aimed.turns[0] = Some(ahead([min, max], rate, substep));
            }
            JointKind::Saddle { y, z } => {
                let rates = first.inverse() * spin;
                aimed.turns[1] = Some(ahead([y.x, y.y], rates.y, substep));
                aimed.turns[2] = Some(ahead([z.x, z.y], rates.z, substep));
            }
            JointKind::Gliding { reach } => {
                let rates = first.inverse() * slip;
                for (axis, reach, rate) in [(1, reach.x, rates.y), (2, reach.y, rates.z)] {
                    // What cannot slide is locked.
                    if reach > 0.0 {
                        aimed.slides[axis] = Some(ahead([-reach, reach], rate, substep));
                    }
                }
            }
            JointKind::Fixed => return None,
        }
        Some(aimed)
    }
}
