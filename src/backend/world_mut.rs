//! Writing the physics world between its synchronisation and its step: [`forces`](super::forces) act on
//! bodies, [`search_tree`](super::search_tree) tells queries where they are.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::plugin::context::{
    RapierContextColliders, RapierContextSimulation, RapierRigidBodySet,
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
