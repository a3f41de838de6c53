//! What a character can see of the world.

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_rapier3d::prelude::CollisionGroups;

use crate::{
    backend::{
        activity::Activity,
        world::{PhysicsView, Verdict},
    },
    character::{
        output::CharacterSnapshot,
        surface::{
            CharacterFilter, CharacterIgnores, Ladder, NotPushable, SurfaceGrip, SurfaceVelocity,
            WaterVolume,
        },
    },
};

/// What a character can see of the world.
pub(in crate::character) struct Surroundings<'a, 'w, 's> {
    pub entity: Entity,
    pub view: PhysicsView<'a>,
    pub dt: f32,
    /// Whether its config, or what may be touched, is not what it was in the last tick.
    pub settings_changed: bool,
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
    pub volumes: &'a Query<'w, 's, Volume>,
}

/// What a sensor can be to a character.
pub(in crate::character) type Volume = (
    Option<&'static WaterVolume>,
    Option<&'static Ladder>,
    &'static GlobalTransform,
);

impl Surroundings<'_, '_, '_> {
    /// What a collider is to the character; `pushes` tells whether bodies push it.
    pub fn judge(&self, collider: Entity, body: Entity, pushes: bool) -> Verdict {
        if body == self.entity
            || self
                .ignores
                .is_some_and(|i| i.0.contains(&collider) || i.0.contains(&body))
            || self
                .filter
                .is_some_and(|filter| !filter.touches(self.entity, collider))
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

    /// Of the sensors around, the one that `is` what is looked for: `last` as long as it is among
    /// them.
    pub fn volume(
        &self,
        sensors: impl Iterator<Item = Entity> + Clone,
        last: Option<Entity>,
        is: impl Fn(&<Volume as QueryData>::Item<'_, '_>) -> bool,
    ) -> Option<Entity> {
        let mut found =
            sensors.filter(|entity| self.volumes.get(*entity).is_ok_and(|volume| is(&volume)));
        let first = found.clone().min();
        last.filter(|last| found.any(|entity| entity == *last))
            .or(first)
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
