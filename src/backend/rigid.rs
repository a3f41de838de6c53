//! A dynamic body as a solver of forces sees it, and the ground that bodies can be.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::{RapierContextColliders, RapierContextEntityLink},
    prelude::{RapierColliderHandle, RapierRigidBodyHandle},
    rapier::dynamics::RigidBody,
};

use super::{
    motion::{end_of_tick, symmetric},
    world::PhysicsView,
    world_mut::PhysicsWorldsMut,
};

/// A dynamic body before the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rigid {
    pub position: Vec3,
    pub rotation: Quat,
    /// Centre of mass, world, metres.
    pub center: Vec3,
    /// Velocity of the centre of mass, metres per second.
    pub velocity: Vec3,
    /// Radians per second.
    pub spin: Vec3,
    /// Kilograms.
    pub mass: f32,
    /// World axes, 1/(kg·m²).
    pub inverse_inertia: Mat3,
    /// What others push it with for the whole tick, newtons and newton-metres, about the centre.
    pub force: Vec3,
    pub torque: Vec3,
    pub gravity_scale: f32,
    pub sleeping: bool,
}

/// How a collider that something stands on moves.
#[derive(Clone, Copy, Debug)]
pub(crate) enum GroundMotion {
    /// Not at all.
    Still,
    /// As it wills: velocity of the point `center`, and turning about it.
    Driven {
        velocity: Vec3,
        spin: Vec3,
        center: Vec3,
    },
    /// As forces will.
    Free { body: Entity, rigid: Rigid },
}

impl GroundMotion {
    /// Velocity of a point of it, world, metres per second.
    pub fn velocity_at(&self, point: Vec3) -> Vec3 {
        match self {
            Self::Still => Vec3::ZERO,
            Self::Driven {
                velocity,
                spin,
                center,
            } => *velocity + spin.cross(point - *center),
            Self::Free { rigid, .. } => rigid.velocity + rigid.spin.cross(point - rigid.center),
        }
    }
}

fn rigid(body: &RigidBody) -> Option<Rigid> {
    let properties = body.mass_properties();
    let mass = properties.mass();
    if !body.is_dynamic() || !(mass > 0.0) {
        return None;
    }
    let pose = body.position();
    Some(Rigid {
        position: pose.translation,
        rotation: pose.rotation,
        center: body.center_of_mass(),
        velocity: body.linvel(),
        spin: body.angvel(),
        mass,
        inverse_inertia: symmetric(&properties.effective_world_inv_inertia),
        force: body.user_force(),
        torque: body.user_torque(),
        gravity_scale: body.gravity_scale(),
        sleeping: body.is_sleeping(),
    })
}

impl PhysicsView<'_> {
    /// A dynamic body; `None` when it is of another kind, disabled, or has no mass yet.
    pub fn rigid(&self, handle: &RapierRigidBodyHandle) -> Option<Rigid> {
        let body = self.bodies.bodies.get(handle.0)?;
        if !body.is_enabled() {
            return None;
        }
        rigid(body)
    }

    /// Whether a dynamic body sleeps.
    pub fn sleeps(&self, handle: &RapierRigidBodyHandle) -> bool {
        let body = self.bodies.bodies.get(handle.0);
        body.is_some_and(|b| b.is_dynamic() && b.is_sleeping())
    }

    /// Share of the velocity at the end of a tick in how far the step moves a free body.
    pub fn end_share(&self) -> f32 {
        let substeps = self
            .simulation
            .integration_parameters
            .num_solver_iterations
            .max(1) as f32;
        (substeps + 1.0) / (2.0 * substeps)
    }

    /// How the body of a collider moves during this tick; `None` when the collider is gone.
    pub fn ground_motion(&self, collider: Entity, dt: f32) -> Option<GroundMotion> {
        let handle = self.colliders.entity2collider().get(&collider)?;
        let collider = self.colliders.colliders.get(*handle)?;
        let Some(body) = collider.parent().and_then(|h| self.bodies.bodies.get(h)) else {
            return Some(GroundMotion::Still);
        };
        if body.is_dynamic() {
            let body_entity = Entity::from_bits(body.user_data as u64);
            return Some(match rigid(body) {
                Some(rigid) => GroundMotion::Free {
                    body: body_entity,
                    rigid,
                },
                None => GroundMotion::Still,
            });
        }
        let Some(end) = end_of_tick(body, dt) else {
            return Some(GroundMotion::Still);
        };
        let start = body.position();
        let turn = end.rotation * start.rotation.inverse();
        let turn = if turn.w < 0.0 { -turn } else { turn };
        let spin = if end.rotation == start.rotation {
            Vec3::ZERO
        } else {
            turn.to_scaled_axis() / dt
        };
        // A point on a turning body moves on an arc: its mean velocity is the one half way.
        Some(GroundMotion::Driven {
            velocity: (end.translation - start.translation) / dt,
            spin,
            center: start.translation,
        })
    }

    /// Whether something that stands on this collider has to look at it again: it is gone, or its body
    /// moves in this tick.
    pub fn ground_stirs(&self, collider: Entity, dt: f32) -> bool {
        let Some(collider) = self
            .colliders
            .entity2collider()
            .get(&collider)
            .and_then(|h| self.colliders.colliders.get(*h))
        else {
            return true;
        };
        if !collider.is_enabled() {
            return true;
        }
        match collider.parent().and_then(|h| self.bodies.bodies.get(h)) {
            Some(body) => end_of_tick(body, dt).is_some(),
            None => false,
        }
    }

    /// Pose of a collider.
    pub fn collider_pose(&self, collider: Entity) -> Option<(Vec3, Quat)> {
        let handle = self.colliders.entity2collider().get(&collider)?;
        let pose = self.colliders.colliders.get(*handle)?.position();
        Some((pose.translation, pose.rotation))
    }
}

impl PhysicsWorldsMut<'_, '_> {
    /// Gives a dynamic body a force and a torque about its centre of mass for the whole tick.
    pub fn force_body(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        force: Vec3,
        torque: Vec3,
        wake: bool,
    ) {
        let Some(body) = self.body_mut(link.0, handle.0).filter(|b| b.is_dynamic()) else {
            return;
        };
        if wake && body.is_sleeping() {
            body.wake_up(true);
        }
        if !body.is_sleeping() && force.is_finite() && torque.is_finite() {
            let before = (body.user_force(), body.user_torque());
            body.add_force(force, false);
            body.add_torque(torque, false);
            self.note_forced(link.0, handle.0, before);
        }
    }

    /// Brings what was spawned since the last step into the search tree, and gives new bodies their
    /// mass, which they would otherwise have only from the coming step on.
    pub fn admit<'a>(
        &mut self,
        new: impl Iterator<Item = (&'a RapierColliderHandle, &'a RapierContextEntityLink)>,
    ) {
        for (handle, link) in new {
            let Some((simulation, colliders, bodies)) = self.parts_mut(link.0) else {
                continue;
            };
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            if let Some(parent) = collider.parent() {
                let colliders: &RapierContextColliders = colliders;
                if let Some(body) = bodies.bodies.get_mut(parent)
                    && body.is_dynamic()
                {
                    body.recompute_mass_properties_from_colliders(&colliders.colliders);
                }
            }
            bodies
                .bodies
                .propagate_modified_body_positions_to_colliders(&mut colliders.colliders);
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            let aabb = collider.compute_aabb();
            if collider.is_enabled() && aabb.mins.is_finite() && aabb.maxs.is_finite() {
                simulation
                    .broad_phase
                    .set_aabb(&simulation.integration_parameters, handle.0, aabb);
            }
        }
    }
}
