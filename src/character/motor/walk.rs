//! On the ground.

use bevy::prelude::*;

use super::{Course, approach};
use crate::character::config::SlopeSpeed;

/// The velocity along ground with this normal that goes in the direction of the level velocity
/// `level` on the map. Its length is that of `level`, along the ground or on the map.
pub(crate) fn along_ground(level: Vec3, normal: Vec3, up: Vec3, speed: SlopeSpeed) -> Vec3 {
    let rise = normal.dot(up);
    // Steeper than 85° there is no sensible way along.
    if rise < 0.087 || level == Vec3::ZERO {
        return level;
    }
    let along = level - up * (level.dot(normal) / rise);
    match speed {
        SlopeSpeed::Horizontal => along,
        SlopeSpeed::AlongGround => along * (level.length() / along.length()),
    }
}

/// The inverse: the level velocity of a velocity along the ground.
fn level_of(velocity: Vec3, up: Vec3, speed: SlopeSpeed) -> Vec3 {
    let level = velocity - up * velocity.dot(up);
    match speed {
        SlopeSpeed::Horizontal => level,
        SlopeSpeed::AlongGround => level.normalize_or_zero() * velocity.length(),
    }
}

/// Walks with `wish` the level velocity asked for.
pub(super) fn walk(
    velocity: Vec3,
    wish: Vec3,
    normal: Vec3,
    up: Vec3,
    speed: SlopeSpeed,
    rate: f32,
    dt: f32,
) -> Course {
    let course = approach(level_of(velocity, up, speed), wish, rate, dt);
    Course {
        mean: along_ground(course.mean, normal, up, speed),
        end: along_ground(course.end, normal, up, speed),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_along_a_slope_keeps_its_heading_and_length() {
        let normal = Vec3::new(-0.6, 0.8, 0.0);
        let along = along_ground(Vec3::X * 2.0, normal, Vec3::Y, SlopeSpeed::AlongGround);
        assert!(along.distance(Vec3::new(1.6, 1.2, 0.0)) < 1e-5);
        let map = along_ground(Vec3::X * 2.0, normal, Vec3::Y, SlopeSpeed::Horizontal);
        assert!(map.distance(Vec3::new(2.0, 1.5, 0.0)) < 1e-5);
        assert!(level_of(along, Vec3::Y, SlopeSpeed::AlongGround).distance(Vec3::X * 2.0) < 1e-5);
    }
}
