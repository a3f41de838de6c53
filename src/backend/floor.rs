//! Where a figure can stand: the floor below a point, and room for a capsule.

use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::{Collider, ColliderHandle},
    parry::query::{DefaultQueryDispatcher, Ray},
    pipeline::{QueryFilter, QueryPipeline},
};

#[cfg(feature = "character")]
use bevy_rapier3d::rapier::{math::Pose, parry::shape::Capsule};

use super::{handles::entity_of, world::PhysicsView};

impl PhysicsView<'_> {
    fn solids<'q>(
        &'q self,
        wanted: &'q dyn Fn(ColliderHandle, &Collider) -> bool,
    ) -> QueryPipeline<'q> {
        self.simulation.broad_phase.as_query_pipeline(
            &DefaultQueryDispatcher,
            &self.bodies.bodies,
            &self.colliders.colliders,
            QueryFilter {
                predicate: Some(wanted),
                ..QueryFilter::default().exclude_sensors()
            },
        )
    }

    /// The floor below a point, along `down` (unit length) over `reach` metres: where it is, and its
    /// normal. Colliders of entities that `skip` names are left out; from inside of something nothing
    /// is below.
    pub fn floor_below(
        &self,
        point: Vec3,
        down: Vec3,
        reach: f32,
        skip: impl Fn(Entity) -> bool,
    ) -> Option<(Vec3, Vec3)> {
        if !(point.is_finite() && down.is_finite()) {
            return None;
        }
        let wanted = |_: ColliderHandle, c: &Collider| !skip(entity_of(c.user_data));
        let ray = Ray::new(point, down);
        let (_, hit) = self
            .solids(&wanted)
            .cast_ray_and_get_normal(&ray, reach, true)?;
        let ahead = hit.time_of_impact > 0.0 && hit.normal.dot(down) < 0.0;
        ahead.then(|| (point + down * hit.time_of_impact, hit.normal))
    }

    /// Whether nothing solid is in a capsule, but what `skip` names.
    #[cfg(feature = "character")]
    pub fn has_room(&self, a: Vec3, b: Vec3, radius: f32, skip: impl Fn(Entity) -> bool) -> bool {
        if !(a.is_finite() && b.is_finite()) {
            return false;
        }
        let wanted = |_: ColliderHandle, c: &Collider| !skip(entity_of(c.user_data));
        let capsule = Capsule::new(Vec3::ZERO, b - a, radius);
        let pose = Pose::from_parts(a, Quat::IDENTITY);
        let met = self
            .solids(&wanted)
            .intersect_shape(pose, &capsule)
            .next()
            .is_some();
        !met
    }
}
