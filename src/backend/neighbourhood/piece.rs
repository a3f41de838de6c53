//! Convex pieces that obstacles are made of.

use bevy::prelude::*;
use bevy_rapier3d::rapier::geometry::SharedShape;

use crate::math::{cuboid::Cuboid, triangle::Triangle};

/// A convex piece of an obstacle, relative to the neighbourhood's origin, where it is at the start
/// of the tick.
#[derive(Clone)]
pub(crate) struct Piece {
    pub geometry: Geometry,
    /// Index of the obstacle.
    pub obstacle: u32,
    /// Which part of its collider it is, for a stable order.
    pub part: u32,
    /// Distance from the mover at the start of the tick, its obstacle's thickness taken off, metres.
    pub clearance: f32,
    /// From the piece to the mover at the start of the tick, unit length.
    pub normal: Vec3,
    /// The piece's point nearest to the mover at the start of the tick.
    pub point: Vec3,
}

/// The shapes with closed forms, and the rest.
#[derive(Clone)]
pub(crate) enum Geometry {
    Triangle(Triangle),
    Cuboid(Cuboid),
    Ball {
        center: Vec3,
        radius: f32,
    },
    Capsule {
        a: Vec3,
        b: Vec3,
        radius: f32,
    },
    HalfSpace {
        point: Vec3,
        normal: Vec3,
    },
    /// Any other convex shape, by its support function.
    Convex {
        shape: SharedShape,
        position: Vec3,
        rotation: Quat,
    },
}

impl Geometry {
    /// First point at which a ray meets the piece: distance along the unit `dir` and normal.
    pub fn cast_ray(&self, origin: Vec3, dir: Vec3, max: f32) -> Option<(f32, Vec3)> {
        use bevy_rapier3d::rapier::{
            math::Pose,
            parry::{
                query::{Ray, RayCast},
                shape::{Ball, Capsule},
            },
        };
        let ray = Ray::new(origin, dir);
        let hit = match self {
            Self::Triangle(triangle) => {
                let t = triangle.cast_ray(origin, dir, max)?;
                let normal = if triangle.normal.dot(dir) <= 0.0 {
                    triangle.normal
                } else {
                    -triangle.normal
                };
                return Some((t, normal));
            }
            Self::Cuboid(cuboid) => return cuboid.cast_ray(origin, dir, max),
            Self::HalfSpace { point, normal } => {
                let approach = normal.dot(dir);
                let height = (origin - *point).dot(*normal);
                return (approach < -1.0e-8 && height >= 0.0 && -height / approach <= max)
                    .then(|| (-height / approach, *normal));
            }
            Self::Ball { center, radius } => Ball::new(*radius).cast_ray_and_get_normal(
                &Pose::from_translation(*center),
                &ray,
                max,
                false,
            ),
            Self::Capsule { a, b, radius } => {
                Capsule::new(*a, *b, *radius).cast_local_ray_and_get_normal(&ray, max, false)
            }
            Self::Convex {
                shape,
                position,
                rotation,
            } => shape.cast_ray_and_get_normal(
                &Pose::from_parts(*position, *rotation),
                &ray,
                max,
                false,
            ),
        };
        hit.filter(|hit| hit.normal.dot(dir) < 0.0)
            .map(|hit| (hit.time_of_impact, hit.normal))
    }
}
