//! What a tick does to bodies: kinematic ones are placed, dynamic ones are pushed for one tick.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    prelude::RapierRigidBodyHandle,
    rapier::{
        dynamics::{RigidBody, RigidBodyHandle},
        math::Pose,
    },
};

use super::{motion::WorldPose, world_mut::PhysicsWorldsMut};

impl PhysicsWorldsMut<'_, '_> {
    /// Puts a kinematic body where it is at the end of the tick, without a velocity: what it pushes
    /// aside on the way was decided by its own solver, and must not be pushed again, with unlimited
    /// force, by the physics step.
    pub fn place_body(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        pose: WorldPose,
    ) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            let pose = Pose::from_parts(pose.position, pose.rotation);
            if *body.position() != pose || *body.next_position() != pose {
                body.set_position(pose, true);
                body.set_next_kinematic_position(pose);
            }
        }
    }

    /// Gives a dynamic body an impulse at once and a force for the whole tick, at a point of the
    /// world. A sleeping body is left asleep unless `wake`.
    ///
    /// The force goes through Rapier's own substeps, so damping and friction act against it as they
    /// would against any force; [`Self::end_forces`] takes it away again.
    pub fn push_body(
        &mut self,
        link: &RapierContextEntityLink,
        body: Entity,
        impulse: Vec3,
        force: Vec3,
        point: Vec3,
        wake: bool,
    ) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0) {
            let Some(handle) = bodies.entity2body().get(&body).copied() else {
                return;
            };
            let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle) else {
                return;
            };
            if !body.is_dynamic() || (body.is_sleeping() && !wake) {
                return;
            }
            if impulse != Vec3::ZERO {
                body.apply_impulse_at_point(impulse, point, wake);
            }
            if force != Vec3::ZERO {
                let before = (body.user_force(), body.user_torque());
                body.add_force_at_point(force, point, wake);
                self.forced.remember(link, handle, before, body);
            }
        }
    }

    /// Gives a dynamic body a force and a torque about its centre of mass for the whole tick. A sleeping
    /// body is left asleep unless `wake`.
    #[cfg(any(feature = "vehicle", feature = "ragdoll"))]
    pub fn force_body(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        force: Vec3,
        torque: Vec3,
        wake: bool,
    ) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
            && body.is_dynamic()
            && (wake || !body.is_sleeping())
            && force.is_finite()
            && torque.is_finite()
        {
            if body.is_sleeping() {
                body.wake_up(true);
            }
            let before = (body.user_force(), body.user_torque());
            // Not woken by every force: what is awake must be able to fall asleep.
            body.add_force(force, false);
            body.add_torque(torque, false);
            self.forced.remember(link, handle.0, before, body);
        }
    }

    /// Wakes a body that sleeps.
    #[cfg(feature = "vehicle")]
    pub fn wake_body(&mut self, link: &RapierContextEntityLink, handle: &RapierRigidBodyHandle) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
            && body.is_sleeping()
        {
            body.wake_up(true);
        }
    }

    /// Gives the bodies back the forces that they had before the last tick's pushes, unless the game
    /// gave them others meanwhile.
    pub fn end_forces(&mut self) {
        // The last push of a body is undone first.
        for forced in self.forced.0.iter_mut().rev() {
            forced.waits = false;
            if let Ok((_, _, mut bodies)) = self.contexts.get_mut(forced.link)
                && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(forced.body)
            {
                // One that is not dynamic any more hides its forces until it is so again.
                forced.waits = !body.is_dynamic();
                if (body.user_force(), body.user_torque()) == forced.after && !forced.waits {
                    body.reset_forces(false);
                    body.reset_torques(false);
                    body.add_force(forced.before.0, false);
                    body.add_torque(forced.before.1, false);
                }
            }
        }
        self.forced.0.retain(|forced| forced.waits);
    }
}

/// The force and torque of a body before and after a tick's pushes.
#[derive(Clone, Copy)]
struct Forced {
    link: Entity,
    body: RigidBodyHandle,
    before: (Vec3, Vec3),
    after: (Vec3, Vec3),
    /// Whether it could not be undone yet.
    waits: bool,
}

/// The pushes of this tick, in their order; between ticks those that wait to be undone.
#[derive(Resource)]
pub(crate) struct ForcedBodies(Vec<Forced>);

impl ForcedBodies {
    fn remember(
        &mut self,
        link: &RapierContextEntityLink,
        handle: RigidBodyHandle,
        before: (Vec3, Vec3),
        body: &RigidBody,
    ) {
        self.0.push(Forced {
            link: link.0,
            body: handle,
            before,
            after: (body.user_force(), body.user_torque()),
            waits: false,
        });
    }
}

impl Default for ForcedBodies {
    fn default() -> Self {
        Self(Vec::with_capacity(256))
    }
}
