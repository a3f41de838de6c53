//! Saving and restoring the physics world, as a game with rollback does.

use bevy_rapier3d::{
    prelude::*,
    rapier::prelude::{ColliderSet, DefaultBroadPhase, IslandManager, NarrowPhase, RigidBodySet},
};
use embody_scenes::Sim;

/// What of the physics world a rollback restores: what moves in it, and where queries find it.
#[derive(Clone)]
pub struct Physics {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    islands: IslandManager,
}

type Context = (
    &'static mut RapierRigidBodySet,
    &'static mut RapierContextColliders,
    &'static mut RapierContextSimulation,
);

impl Physics {
    pub fn save(sim: &mut Sim) -> Self {
        let world = sim.app.world_mut();
        let mut context = world.query::<Context>();
        let (bodies, colliders, simulation) = context.single_mut(world).expect("one physics world");
        Self {
            bodies: bodies.bodies.clone(),
            colliders: colliders.colliders.clone(),
            broad_phase: simulation.broad_phase.clone(),
            narrow_phase: simulation.narrow_phase.clone(),
            islands: simulation.islands.clone(),
        }
    }

    pub fn restore(&self, sim: &mut Sim) {
        let world = sim.app.world_mut();
        let mut context = world.query::<Context>();
        let (mut bodies, mut colliders, mut simulation) =
            context.single_mut(world).expect("one physics world");
        bodies.bodies = self.bodies.clone();
        colliders.colliders = self.colliders.clone();
        simulation.broad_phase = self.broad_phase.clone();
        simulation.narrow_phase = self.narrow_phase.clone();
        simulation.islands = self.islands.clone();
    }
}
