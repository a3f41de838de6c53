//! What holds a dynamic body against a push from above, as the physics world saw it in the last step.
//!
//! A light body between a wheel and the floor carries the whole load of the wheel; the same body in the
//! air is thrown away by it. The mass is the same in both cases: what differs is what holds it.

use bevy::prelude::*;
use bevy_rapier3d::{
    prelude::RapierRigidBodyHandle,
    rapier::{
        dynamics::RigidBody,
        geometry::{Collider, ContactManifold},
    },
};

use super::world::PhysicsView;

/// A floor's normal is at least this much against the push, as a cosine.
const AGAINST: f32 = 0.7;
/// A push this far outside of the points of contact still goes through them, metres.
const MARGIN: f32 = 0.02;

/// What holds a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Hold {
    /// Nothing but its own inertia.
    Free,
    /// A floor on all sides of the push. It may slide there, and turn about the normal.
    Floor {
        normal: Vec3,
        /// Of the floor, metres per second.
        velocity: Vec3,
    },
    /// Joints to other bodies.
    Joints,
}

impl PhysicsView<'_> {
    /// What holds the body of an entity against a push at a point of the world, opposite to `up`.
    /// Contacts with the body `own`, which pushes, do not count.
    pub fn hold(&self, body: Entity, own: &RapierRigidBodyHandle, up: Vec3, point: Vec3) -> Hold {
        let Some(handle) = self.bodies.entity2body().get(&body).copied() else {
            return Hold::Free;
        };
        let Some(body) = self.bodies.bodies.get(handle) else {
            return Hold::Free;
        };
        let (side, front) = up.any_orthonormal_pair();
        let flat = |arm: Vec3| Vec2::new(arm.dot(side), arm.dot(front));
        let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (mut normal, mut velocity) = (Vec3::ZERO, Vec3::ZERO);
        self.for_contacts(body, own, |manifold, is_first, floor| {
            // It points from the first to the second.
            let inward = manifold.data.normal * if is_first { -1.0 } else { 1.0 };
            if inward.dot(up) < AGAINST || manifold.data.solver_contacts.is_empty() {
                return;
            }
            normal += inward;
            velocity = floor.map_or(Vec3::ZERO, |floor| floor.velocity_at_point(point));
            for point in &manifold.points {
                let data = &point.data;
                let arm = flat(if is_first {
                    data.solver_dp1
                } else {
                    data.solver_dp2
                });
                low = low.min(arm);
                high = high.max(arm);
            }
        });
        let at = flat(point - body.center_of_mass());
        let held = at.cmpge(low - MARGIN).all() && at.cmple(high + MARGIN).all();
        if held && let Some(normal) = normal.try_normalize() {
            return Hold::Floor { normal, velocity };
        }
        let impulse = &self.joints.impulse_joints;
        let multibody = &self.joints.multibody_joints;
        let joined = impulse.attached_enabled_joints(handle).next().is_some()
            || multibody.attached_joints(handle).next().is_some();
        if joined { Hold::Joints } else { Hold::Free }
    }

    /// Hands out the contacts of a body with others, whether it is the first of the two, and the other.
    fn for_contacts(
        &self,
        body: &RigidBody,
        own: &RapierRigidBodyHandle,
        mut take: impl FnMut(&ContactManifold, bool, Option<&RigidBody>),
    ) {
        for &collider in body.colliders() {
            for pair in self.simulation.narrow_phase.contact_pairs_with(collider) {
                let is_first = pair.collider1 == collider;
                let other = if is_first {
                    pair.collider2
                } else {
                    pair.collider1
                };
                let other = self.colliders.colliders.get(other);
                let other = other.and_then(Collider::parent);
                if other == Some(own.0) {
                    continue;
                }
                let other = other.and_then(|other| self.bodies.bodies.get(other));
                for manifold in pair.solver_manifolds() {
                    take(manifold, is_first, other);
                }
            }
        }
    }
}
