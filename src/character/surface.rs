//! Components for the world a character moves in: what a surface does to those who stand on it,
//! volumes of water, ladders, and what a character may touch.

use core::fmt;
use std::sync::Arc;

use bevy::{
    ecs::{entity::MapEntities, reflect::ReflectMapEntities},
    prelude::*,
};

/// Carries characters that stand on this collider, as a conveyor or an escalator does, while the
/// collider itself stands still.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct SurfaceVelocity {
    /// Velocity of the surface in the collider's own axes, metres per second.
    pub linear: Vec3,
    /// Turning of the surface about the collider's origin, in its own axes, radians per second.
    pub angular: Vec3,
}

/// How well feet hold on this collider: scales a motor's acceleration and friction.
/// 1 is full grip, 0 is perfect ice on which a character keeps its velocity.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct SurfaceGrip(pub f32);

impl Default for SurfaceGrip {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Water: put it on an entity with a sensor [`Collider`](bevy_rapier3d::prelude::Collider).
/// A character whose waist is inside swims; other sensors about it change nothing.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct WaterVolume {
    /// Velocity of the water, world axes, metres per second; carries swimmers.
    pub flow: Vec3,
}

impl Default for WaterVolume {
    fn default() -> Self {
        Self { flow: Vec3::ZERO }
    }
}

/// A ladder: put it on an entity with a sensor [`Collider`](bevy_rapier3d::prelude::Collider)
/// that covers the space from which it can be climbed. The entity's local `+Z` points from the
/// ladder to the climber, its local `+Y` along the rungs' climb. A ladder on a body that moves takes
/// its climber along. In water it is climbed by who swims towards it.
///
/// It begins to be climbed by who moves towards it with the waist in the volume, and is left at the
/// top when waist and feet are out, or when the feet are above what is behind it: a volume that ends
/// level with a ledge, or above it, leads onto the ledge.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct Ladder;

/// On a body: characters never push it and do not weigh on it. It is a wall to them, which pushes
/// aside where it goes all that are pushed by bodies.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct NotPushable;

/// On a character: decides which colliders it touches, beyond Rapier's
/// [`CollisionGroups`](bevy_rapier3d::prelude::CollisionGroups). Sensors are never touched.
///
/// It is asked from several threads, in no order. A character at rest is asked again when this
/// component is written: write it when the answers change.
///
/// ```
/// # use bevy::{ecs::entity::EntityHashSet, prelude::*};
/// # use bevy_embody::prelude::*;
/// fn ghosts_pass_the_doors_of_their_team(
///     ghost: Single<Entity, With<Character>>,
///     doors: Query<Entity, With<Name>>,
///     mut commands: Commands,
/// ) {
///     let doors: EntityHashSet = doors.iter().collect();
///     let filter = CharacterFilter::new(move |_ghost, other| !doors.contains(&other));
///     commands.entity(*ghost).insert(filter);
/// }
/// ```
#[derive(Component, Clone)]
pub struct CharacterFilter(Arc<dyn Fn(Entity, Entity) -> bool + Send + Sync>);

impl CharacterFilter {
    /// A filter that asks `touches(character, other)`: whether this character touches the collider of
    /// that entity.
    pub fn new(touches: impl Fn(Entity, Entity) -> bool + Send + Sync + 'static) -> Self {
        Self(Arc::new(touches))
    }

    /// Whether this character touches the collider of that entity.
    pub fn touches(&self, character: Entity, other: Entity) -> bool {
        (self.0)(character, other)
    }
}

impl fmt::Debug for CharacterFilter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CharacterFilter").finish_non_exhaustive()
    }
}

/// On a character: leaves out these entities' colliders.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, MapEntities)]
#[reflect(Component, Default, Debug, PartialEq, Clone, MapEntities)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterIgnores(#[entities] pub Vec<Entity>);

/// Where up is for a character. Without it up is world `+Y`. Where the rule tells nothing, as on
/// ground before any is touched, a character begins upright in its own axes and then keeps its up.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Component, Default, Debug, PartialEq, Clone, MapEntities)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterUp {
    /// The direction.
    #[entities]
    pub direction: UpDirection,
    /// How fast the character turns to a new up, radians per second; at infinity at once, at 0 never.
    /// The up that it begins with is taken at once.
    pub turn_rate: f32,
}

impl Default for CharacterUp {
    fn default() -> Self {
        Self {
            direction: UpDirection::World(Vec3::Y),
            turn_rate: 6.0,
        }
    }
}

/// A rule for up.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum UpDirection {
    /// A direction in world axes.
    World(Vec3),
    /// Away from a point in the world, as on a planet.
    AwayFrom(Vec3),
    /// Against the gravity of the physics world.
    AgainstGravity,
    /// A direction in the axes of another entity, as on a turning ship.
    Of(#[entities] Entity, Vec3),
    /// Along the normal of the ground that is stood on; the last one when in the air.
    Ground,
}
