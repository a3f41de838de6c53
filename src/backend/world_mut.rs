//! Writing the physics world between its synchronisation and its step.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{
    plugin::context::{RapierContextColliders, RapierContextSimulation, RapierRigidBodySet},
    rapier::dynamics::{RigidBody, RigidBodyHandle},
};

use super::forces::ForcedBodies;

/// All physics worlds, to be written.
#[derive(SystemParam)]
pub(crate) struct PhysicsWorldsMut<'w, 's> {
    pub(super) contexts: Query<
        'w,
        's,
        (
            &'static mut RapierContextSimulation,
            &'static mut RapierContextColliders,
            &'static mut RapierRigidBodySet,
        ),
    >,
    pub(super) forced: ResMut<'w, ForcedBodies>,
}

impl PhysicsWorldsMut<'_, '_> {
    /// A body, to be written.
    #[cfg(feature = "vehicle")]
    pub(super) fn body_mut(
        &mut self,
        link: Entity,
        handle: RigidBodyHandle,
    ) -> Option<&mut RigidBody> {
        let (_, _, bodies) = self.contexts.get_mut(link).ok()?;
        bodies.into_inner().bodies.get_mut(handle)
    }

    /// Everything of one world.
    #[cfg(feature = "vehicle")]
    pub(super) fn parts_mut(
        &mut self,
        link: Entity,
    ) -> Option<(
        &mut RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )> {
        let (simulation, colliders, bodies) = self.contexts.get_mut(link).ok()?;
        Some((
            simulation.into_inner(),
            colliders.into_inner(),
            bodies.into_inner(),
        ))
    }
}
