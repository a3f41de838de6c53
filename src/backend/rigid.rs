//! A dynamic body as a solver of forces sees it, and the ground that bodies can be.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::RapierRigidBodyHandle, rapier::dynamics::RigidBody};

use super::{
    handles::entity_of,
    motion::{end_of_tick, symmetric},
    world::PhysicsView,
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
    /// Along the world's axes, 1/kg; 0 along those that are locked.
    pub inverse_mass: Vec3,
    /// World axes, 1/(kg·m²).
    pub inverse_inertia: Mat3,
    /// What others push it with for the whole tick, newtons and newton-metres, about the centre.
    pub force: Vec3,
    pub torque: Vec3,
    pub gravity_scale: f32,
    pub sleeping: bool,
}

impl Rigid {
    /// 1 along the axes of the world that it can move along, 0 along those that are locked.
    pub fn free_axes(&self) -> Vec3 {
        Vec3::select(self.inverse_mass.cmpgt(Vec3::ZERO), Vec3::ONE, Vec3::ZERO)
    }
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

    /// How it turns, world, radians per second.
    pub fn spin(&self) -> Vec3 {
        match self {
            Self::Still => Vec3::ZERO,
            Self::Driven { spin, .. } => *spin,
            Self::Free { rigid, .. } => rigid.spin,
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
        inverse_mass: properties.effective_inv_mass,
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

    /// Why a body cannot be pushed: which of its components, and what that would have to be. `None` of
    /// one that is only switched off.
    pub fn unfit(&self, handle: &RapierRigidBodyHandle) -> Option<(&'static str, &'static str)> {
        let body = self.bodies.bodies.get(handle.0)?;
        if !body.is_enabled() {
            None
        } else if !body.is_dynamic() {
            Some(("RigidBody", "RigidBody::Dynamic"))
        } else {
            Some(("mass", "a collider or a VehicleMass"))
        }
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
            let body_entity = entity_of(body.user_data);
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
        // A point on a turning body moves on an arc: its mean velocity is the one half way, half a turn of
        // the tick after that of the start.
        let mean = (end.translation - start.translation) / dt;
        Some(GroundMotion::Driven {
            velocity: Quat::from_scaled_axis(spin * (-0.5 * dt)) * mean,
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
