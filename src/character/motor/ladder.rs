//! On a ladder.

use bevy::prelude::*;

use super::Course;

/// Velocity on a ladder whose axes are `rungs` (its climb) and `out` (towards the climber).
///
/// Walking towards the ladder climbs; the part of the wish along up climbs as well; away from it
/// leads down. A gentle pull keeps the climber at it, and over its end.
pub(super) fn climb(movement: Vec3, rungs: Vec3, out: Vec3, up: Vec3, speed: f32) -> Course {
    let level = movement - up * movement.dot(up);
    let towards = -level.dot(out);
    let rise = (towards + movement.dot(up)).clamp(-1.0, 1.0);
    let side = level - out * level.dot(out);
    let pull = if towards > 0.0 {
        -out * towards * 0.5
    } else {
        Vec3::ZERO
    };
    Course::constant((rungs * rise + side * 0.5 + pull) * speed)
}

/// Whether a movement begins to climb: towards the ladder.
pub(super) fn begins(movement: Vec3, out: Vec3) -> bool {
    -movement.dot(out) > 0.3
}
