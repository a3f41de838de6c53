//! The difference between a motion and a jump.

use bevy::prelude::*;

/// Trigger it on a body after writing its [`Transform`] to say: it did not move there, it is there.
///
/// - It is shown in its new place at once, not drawn on the way.
/// - A position-driven kinematic body gets no velocity from it and throws nothing about.
///
/// Velocities of dynamic bodies stay; reset them if they should. Without this event a jump is
/// recognised for what it is in these cases: a position written outside the fixed schedules that is
/// not the one shown there, and the position of a dynamic body or a character written in
/// `FixedUpdate`.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_embody::prelude::*;
/// fn back_to_start(lift: Single<(Entity, &mut Transform), With<Name>>, mut commands: Commands) {
///     let (entity, mut transform) = lift.into_inner();
///     transform.translation = Vec3::ZERO;
///     commands.trigger(Teleported { entity });
/// }
/// ```
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Teleported {
    /// The body.
    pub entity: Entity,
}
