//! The search tree, brought up to the tick that is about to run.
//!
//! Rapier updates its tree while it steps, so a query before the step sees where things were one step
//! ago. Here every box is widened by the whole way of the coming tick instead.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    prelude::RapierColliderHandle,
    rapier::{
        geometry::Aabb,
        parry::{bounding_volume::BoundingVolume, query::DefaultQueryDispatcher},
        pipeline::QueryFilter,
    },
};

use super::{
    activity::Activity, handles::entity_of, motion::end_of_tick, world_mut::PhysicsWorldsMut,
};

impl PhysicsWorldsMut<'_, '_> {
    /// Brings the search tree up to the tick that is about to run: what was spawned or placed since
    /// the last step, and the whole way of everything that moves. Marks where anything moves.
    ///
    /// `is_own` tells the bodies whose motion the caller decides, which are left alone;
    /// `touched` are the colliders that were added or placed.
    pub fn refresh<'a>(
        &mut self,
        dt: f32,
        touched: impl Iterator<Item = (&'a RapierColliderHandle, &'a RapierContextEntityLink)>,
        is_own: impl Fn(Entity) -> bool,
        activity: &mut Activity,
    ) {
        for (mut simulation, mut colliders, bodies) in &mut self.contexts {
            let simulation = &mut *simulation;
            bodies
                .bodies
                .propagate_modified_body_positions_to_colliders(
                    &mut colliders.bypass_change_detection().colliders,
                );
            for handle in simulation.islands.active_bodies() {
                let Some(body) = bodies.bodies.get(handle) else {
                    continue;
                };
                if !body.is_enabled() || is_own(entity_of(body.user_data)) {
                    continue;
                }
                let Some(end) = end_of_tick(body, dt) else {
                    continue;
                };
                for collider in body.colliders() {
                    let Some((co, local)) = colliders
                        .colliders
                        .get(*collider)
                        .and_then(|co| Some((co, co.position_wrt_parent()?)))
                    else {
                        continue;
                    };
                    if !co.is_enabled() {
                        continue;
                    }
                    let aabb = co.compute_swept_aabb(&(end * *local));
                    activity.mark(aabb.mins, aabb.maxs);
                    if aabb.mins.is_finite() && aabb.maxs.is_finite() {
                        simulation.broad_phase.set_aabb(
                            &simulation.integration_parameters,
                            *collider,
                            aabb,
                        );
                    }
                }
            }
        }
        for (handle, link) in touched {
            let Ok((mut simulation, colliders, bodies)) = self.contexts.get_mut(link.0) else {
                continue;
            };
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            // What starts to move in this tick is not among the active bodies yet.
            let end = collider
                .parent()
                .and_then(|body| bodies.bodies.get(body))
                .and_then(|body| end_of_tick(body, dt))
                .zip(collider.position_wrt_parent());
            let aabb = match end {
                Some((end, local)) => collider.compute_swept_aabb(&(end * *local)),
                None => collider.compute_aabb(),
            };
            if !collider.is_enabled() || !aabb.mins.is_finite() || !aabb.maxs.is_finite() {
                continue;
            }
            let simulation = &mut *simulation;
            // A body that moves this tick has its whole way in the tree already.
            let pipeline = simulation.broad_phase.as_query_pipeline(
                &DefaultQueryDispatcher,
                &bodies.bodies,
                &colliders.colliders,
                QueryFilter::default(),
            );
            let aabb = match pipeline.bvh.leaf_node(handle.0.into_raw_parts().0) {
                Some(node) => node.aabb().merged(&aabb),
                None => aabb,
            };
            // Also where it was: ground that shrinks leaves somebody without.
            activity.mark(aabb.mins, aabb.maxs);
            simulation
                .broad_phase
                .set_aabb(&simulation.integration_parameters, handle.0, aabb);
        }
    }

    /// Widens a collider's place in the search tree by the way that it goes this tick.
    pub fn look_ahead(
        &mut self,
        handle: &RapierColliderHandle,
        link: &RapierContextEntityLink,
        way: Vec3,
    ) {
        let Ok((mut simulation, colliders, _)) = self.contexts.get_mut(link.0) else {
            return;
        };
        let Some(collider) = colliders.colliders.get(handle.0) else {
            return;
        };
        let here = collider.compute_aabb();
        let there = Aabb::new(here.mins + way, here.maxs + way);
        let aabb = here.merged(&there);
        if aabb.mins.is_finite() && aabb.maxs.is_finite() {
            let simulation = &mut *simulation;
            simulation
                .broad_phase
                .set_aabb(&simulation.integration_parameters, handle.0, aabb);
        }
    }

    /// Brings what was spawned since the last step into the search tree, and gives new bodies their
    /// mass, which they would otherwise have only from the coming step on.
    #[cfg(any(feature = "vehicle", feature = "ragdoll"))]
    pub fn admit<'a>(
        &mut self,
        new: impl Iterator<Item = (&'a RapierColliderHandle, &'a RapierContextEntityLink)>,
    ) {
        for (handle, link) in new {
            let Ok((mut simulation, mut colliders, mut bodies)) = self.contexts.get_mut(link.0)
            else {
                continue;
            };
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            if let Some(parent) = collider.parent()
                && let Some(body) = bodies.bodies.get_mut(parent)
                && body.is_dynamic()
            {
                body.recompute_mass_properties_from_colliders(&colliders.colliders);
            }
            bodies
                .bodies
                .propagate_modified_body_positions_to_colliders(&mut colliders.colliders);
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            let aabb = collider.compute_aabb();
            if collider.is_enabled() && aabb.mins.is_finite() && aabb.maxs.is_finite() {
                let simulation = &mut *simulation;
                simulation
                    .broad_phase
                    .set_aabb(&simulation.integration_parameters, handle.0, aabb);
            }
        }
    }
}
