//! What a character can see of the world.

use bevy::prelude::*;
use bevy_rapier3d::prelude::CollisionGroups;

use crate::{
    backend::{
        activity::Activity,
        world::{PhysicsView, Verdict},
    },
    character::{
        output::CharacterSnapshot,
        surface::{CharacterFilter, CharacterIgnores, NotPushable, SurfaceGrip, SurfaceVelocity},
    },
};

/// What a character can see of the world.
pub(in crate::character) struct Surroundings<'a, 'w, 's> {
    pub entity: Entity,
    pub view: PhysicsView<'a>,
    pub dt: f32,
    /// Whether what may be touched is not what it was in the last tick.
    pub filters_changed: bool,
    pub groups: CollisionGroups,
    pub filter: Option<&'a CharacterFilter>,
    pub ignores: Option<&'a CharacterIgnores>,
    pub activity: &'a Activity,
    pub surfaces: &'a Query<
        'w,
        's,
        (
            Option<&'static SurfaceVelocity>,
            Option<&'static SurfaceGrip>,
        ),
    >,
    pub others: &'a Query<'w, 's, &'static CharacterSnapshot>,
    pub walls: &'a Query<'w, 's, (), With<NotPushable>>,
}

impl Surroundings<'_, '_, '_> {
    /// What a collider is to the character; `pushes` tells whether bodies push it.
    pub fn judge(&self, collider: Entity, body: Entity, pushes: bool) -> Verdict {
        if body == self.entity
            || self
                .ignores
                .is_some_and(|i| i.0.contains(&collider) || i.0.contains(&body))
            || self
                .filter
                .is_some_and(|filter| !(filter.0)(self.entity, collider))
        {
            Verdict::Skip
        } else if let Ok(other) = self.others.get(body) {
            Verdict::Character {
                skin: other.margin,
                way: other.velocity.length() * self.dt,
            }
        } else if self.walls.contains(body) || self.walls.contains(collider) {
            Verdict::Wall { pushes }
        } else {
            Verdict::AsIs
        }
    }

    pub fn surface_velocity(&self, entity: Entity) -> SurfaceVelocity {
        self.surfaces
            .get(entity)
            .ok()
            .and_then(|(velocity, _)| velocity.copied())
            .filter(|v| v.linear.is_finite() && v.angular.is_finite())
            .unwrap_or_default()
    }
}
