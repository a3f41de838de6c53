//! How the joints of all figures are, ours and Rapier's.

use bevy::prelude::*;
use bevy_rapier3d::plugin::context::{RapierContextJoints, RapierRigidBodySet};
use serde::{Deserialize, Serialize};

/// How the joints of all figures are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Joints {
    /// Distance of their two sides, millimetres: the mean of all over all ticks, the largest of any tick,
    /// and the largest in the end.
    pub mean_gap: f64,
    pub largest_gap: f64,
    pub end_gap: f64,
    /// Bodies that are awake in the end, and all that could be.
    pub awake: usize,
    pub bodies: usize,
}

impl Joints {
    /// Adds a later tick, which is the `n`th.
    pub fn then(&mut self, now: &Self, n: usize) {
        let part = 1.0 / n as f64;
        *self = Self {
            mean_gap: self.mean_gap + (now.mean_gap - self.mean_gap) * part,
            largest_gap: self.largest_gap.max(now.largest_gap),
            ..*now
        };
    }
}

/// Looks at all joints of the physics world that lock a place, and at all bodies of figures.
pub fn joints(world: &mut World) -> Joints {
    let mut seen = Joints::default();
    let mut worlds = world.query::<(&RapierContextJoints, &RapierRigidBodySet)>();
    for (joints, bodies) in worlds.iter(world) {
        let bodies = &bodies.bodies;
        let mut n = 0.0;
        for (_, joint) in joints.impulse_joints.iter() {
            let locked = joint.data.locked_axes.bits() & 0b111 == 0b111;
            let (Some(a), Some(b)) = (bodies.get(joint.body1()), bodies.get(joint.body2())) else {
                continue;
            };
            if !locked {
                continue;
            }
            let a = *a.position() * joint.data.local_frame1;
            let b = *b.position() * joint.data.local_frame2;
            let gap = 1e3 * f64::from((a.translation - b.translation).length());
            seen.mean_gap += gap;
            seen.end_gap = seen.end_gap.max(gap);
            n += 1.0;
        }
        seen.mean_gap /= f64::max(n, 1.0);
        for (_, body) in bodies.iter().filter(|(_, body)| body.is_dynamic()) {
            seen.bodies += 1;
            seen.awake += usize::from(!body.is_sleeping());
        }
    }
    seen.largest_gap = seen.end_gap;
    seen
}
