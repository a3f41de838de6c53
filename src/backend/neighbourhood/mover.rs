//! The moving shape: a convex core with a rounding radius around it.
//!
//! A capsule's core is its axis, so the distance to it keeps its direction down to a depth of one
//! radius. Other shapes are shrunk by a thin skin and rounded by the same amount: while the skin
//! is not pierced, distances come from GJK, which is exact; deeper, from EPA, which is good enough
//! to get out again.

use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::SharedShape,
    math::Pose,
    parry::{
        query::{self},
        shape::{Ball, Capsule, Cuboid as ParryCuboid, Segment, Shape, Triangle},
    },
};

use super::Geometry;
use crate::math::{Closest, direction_or, segment};

/// Rounding of shapes that are not round, metres; thinner shapes get a tenth of their size.
const SKIN: f32 = 0.02;

/// Where a mover is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MoverPose {
    /// The foot.
    pub position: Vec3,
    pub rotation: Quat,
    /// Local `+Y` in the world.
    pub up: Vec3,
}

impl MoverPose {
    #[inline]
    pub fn at(self, position: Vec3) -> Self {
        Self { position, ..self }
    }
}

/// A convex shape whose lowest point is its origin.
#[derive(Clone)]
pub(crate) struct Mover {
    core: Core,
    /// Rounding around the core, metres.
    radius: f32,
    /// Radius of a ball around [`Self::middle`] that holds the shape, metres.
    pub reach: f32,
    /// Half the height, metres.
    pub middle: f32,
    /// Largest horizontal half extent, metres.
    pub width: f32,
}

#[derive(Clone)]
enum Core {
    /// Along the up axis from `low` to `high` above the foot.
    Axis { low: f32, high: f32 },
    /// A shape with its origin `offset` from the foot, in local axes.
    Convex { shape: SharedShape, offset: Vec3 },
}

impl Mover {
    /// An upright capsule.
    pub fn capsule(radius: f32, height: f32) -> Self {
        let high = (height - radius).max(radius);
        Self {
            core: Core::Axis { low: radius, high },
            radius,
            reach: height.max(2.0 * radius) * 0.5,
            middle: (high + radius) * 0.5,
            width: radius,
        }
    }

    /// An upright cylinder.
    pub fn cylinder(radius: f32, height: f32) -> Self {
        let skin = SKIN.min(0.1 * radius).min(0.1 * height);
        Self {
            core: Core::Convex {
                shape: SharedShape::cylinder(height * 0.5 - skin, radius - skin),
                offset: Vec3::Y * (height * 0.5),
            },
            radius: skin,
            reach: Vec2::new(radius, height * 0.5).length(),
            middle: height * 0.5,
            width: radius,
        }
    }

    /// An upright box.
    pub fn cuboid(size: Vec3) -> Self {
        let half = size * 0.5;
        let skin = SKIN.min(0.2 * half.min_element());
        let core = half - skin;
        Self {
            core: Core::Convex {
                shape: SharedShape::cuboid(core.x, core.y, core.z),
                offset: Vec3::Y * half.y,
            },
            radius: skin,
            reach: half.length(),
            middle: half.y,
            width: Vec2::new(half.x, half.z).length(),
        }
    }

    /// The convex hull of points, or `None` when they span no volume. The lowest point is moved to
    /// the foot's height.
    pub fn convex_hull(points: &[Vec3]) -> Option<Self> {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for p in points {
            if !p.is_finite() {
                return None;
            }
            low = low.min(*p);
            high = high.max(*p);
        }
        let extent = high - low;
        if points.len() < 4 || !(extent.min_element() > 1.0e-3) {
            return None;
        }
        let skin = SKIN.min(0.1 * extent.min_element());
        let center = (low + high) * 0.5;
        // Shrunk towards the middle so that the skin fits inside the outline on every side.
        let scale = (extent - 2.0 * skin) / extent;
        let shrunk: Vec<Vec3> = points
            .iter()
            .map(|p| (*p - center) * scale + center - Vec3::Y * low.y)
            .collect();
        let shape = SharedShape::convex_hull(&shrunk)?;
        let width = points
            .iter()
            .map(|p| Vec2::new(p.x, p.z).length())
            .fold(0.0, f32::max);
        let middle = extent.y * 0.5;
        let reach = points
            .iter()
            .map(|p| (*p - Vec3::Y * (low.y + middle)).length())
            .fold(0.0, f32::max);
        Some(Self {
            core: Core::Convex {
                shape,
                offset: Vec3::ZERO,
            },
            radius: skin,
            reach,
            middle,
            width,
        })
    }

    /// Whether a piece is farther than `distance` from the surface for certain. Cheap, and may miss.
    #[inline]
    pub fn is_beyond(&self, geometry: &Geometry, pose: &MoverPose, distance: f32) -> bool {
        match (&self.core, geometry) {
            (Core::Axis { low, high }, Geometry::Triangle(triangle)) => triangle.is_beyond(
                pose.position + pose.up * *low,
                pose.position + pose.up * *high,
                distance + self.radius,
            ),
            _ => false,
        }
    }

    /// Distance from a piece, measured between the surfaces.
    #[inline]
    pub fn separation(&self, geometry: &Geometry, pose: &MoverPose) -> Closest {
        let mut found = match &self.core {
            Core::Axis { low, high } => axis_to(
                geometry,
                pose.position + pose.up * *low,
                pose.position + pose.up * *high,
                pose.up,
            ),
            Core::Convex { shape, offset } => {
                let position =
                    Pose::from_parts(pose.position + pose.rotation * *offset, pose.rotation);
                convex_to(&*shape.0, &position, geometry, pose.up)
            }
        };
        found.distance -= self.radius;
        found
    }
}

/// Closest pair of the segment `p0 p1` and a piece.
fn axis_to(geometry: &Geometry, p0: Vec3, p1: Vec3, up: Vec3) -> Closest {
    match geometry {
        Geometry::Triangle(triangle) => triangle.closest_to_segment(p0, p1),
        Geometry::Cuboid(cuboid) => cuboid.closest_to_segment(p0, p1, up),
        Geometry::Ball { center, radius } => {
            let on_axis = segment::closest_point(*center, p0, p1);
            round(on_axis, *center, *radius, up)
        }
        Geometry::Capsule { a, b, radius } => {
            let (s, t) = segment::closest_parameters(p0, p1, *a, *b);
            round(p0 + (p1 - p0) * s, *a + (*b - *a) * t, *radius, up)
        }
        Geometry::HalfSpace { point, normal } => {
            let (h0, h1) = ((p0 - *point).dot(*normal), (p1 - *point).dot(*normal));
            let (p, h) = if h0 <= h1 { (p0, h0) } else { (p1, h1) };
            Closest {
                distance: h,
                normal: *normal,
                point: p - *normal * h,
                on_face: true,
                surface: *normal,
            }
        }
        Geometry::Convex {
            shape,
            position,
            rotation,
        } => {
            let axis = Segment::new(p0, p1);
            shapes(
                &axis,
                &Pose::identity(),
                &*shape.0,
                &Pose::from_parts(*position, *rotation),
                up,
            )
        }
    }
}

/// Closest pair of a point of the mover and a ball around `center`.
fn round(on_mover: Vec3, center: Vec3, radius: f32, up: Vec3) -> Closest {
    let offset = on_mover - center;
    let normal = direction_or(offset, up);
    Closest {
        distance: offset.length() - radius,
        normal,
        point: center + normal * radius,
        on_face: true,
        surface: normal,
    }
}

/// Closest pair of a convex core and a piece, by its support function.
fn convex_to(core: &dyn Shape, position: &Pose, geometry: &Geometry, up: Vec3) -> Closest {
    let identity = Pose::identity();
    match geometry {
        Geometry::Triangle(t) => {
            let triangle = Triangle::new(t.a, t.b, t.c);
            let found = shapes(core, position, &triangle, &identity, up);
            snap_to_face(found, &[t.normal, -t.normal])
        }
        Geometry::Cuboid(c) => {
            let cuboid = ParryCuboid::new(c.half);
            let pose = Pose::from_parts(c.center, c.rotation);
            let found = shapes(core, position, &cuboid, &pose, up);
            let faces = [
                Vec3::X,
                Vec3::Y,
                Vec3::Z,
                Vec3::NEG_X,
                Vec3::NEG_Y,
                Vec3::NEG_Z,
            ]
            .map(|n| c.rotation * n);
            let mut found = snap_to_face(found, &faces);
            if !found.on_face {
                // The most upward of the faces that meet at the closest point.
                let local = c.rotation.inverse() * (found.point - c.center);
                let mut most = f32::MIN;
                for (i, face) in faces.iter().enumerate() {
                    let axis = i % 3;
                    let sign = if i < 3 { 1.0 } else { -1.0 };
                    let on_it = local[axis] * sign > c.half[axis] - 1.0e-3;
                    if on_it && found.normal.dot(*face) > 1.0e-3 && face.dot(up) > most {
                        most = face.dot(up);
                        found.surface = *face;
                    }
                }
            }
            found
        }
        Geometry::Ball { center, radius } => {
            let mut found = shapes(
                core,
                position,
                &Ball::new(*radius),
                &Pose::from_translation(*center),
                up,
            );
            found.on_face = true;
            found
        }
        Geometry::Capsule { a, b, radius } => {
            let mut found = shapes(
                core,
                position,
                &Capsule::new(*a, *b, *radius),
                &identity,
                up,
            );
            found.on_face = true;
            found
        }
        Geometry::HalfSpace { point, normal } => {
            // The lowest point over the plane, in closed form.
            let local = position.rotation.inverse() * -*normal;
            let lowest = core.as_support_map().map_or(position.translation, |core| {
                position.rotation * core.local_support_point(local) + position.translation
            });
            let height = (lowest - *point).dot(*normal);
            Closest {
                distance: height,
                normal: *normal,
                point: lowest - *normal * height,
                on_face: true,
                surface: *normal,
            }
        }
        Geometry::Convex {
            shape,
            position: at,
            rotation,
        } => shapes(
            core,
            position,
            &*shape.0,
            &Pose::from_parts(*at, *rotation),
            up,
        ),
    }
}

/// Closest pair of two convex shapes.
fn shapes(a: &dyn Shape, at_a: &Pose, b: &dyn Shape, at_b: &Pose, up: Vec3) -> Closest {
    match query::contact(at_a, a, at_b, b, 1.0e6) {
        Ok(Some(contact)) if contact.dist.is_finite() => {
            let normal = direction_or(contact.normal2, up);
            Closest {
                distance: contact.dist,
                normal,
                point: contact.point2,
                on_face: false,
                surface: normal,
            }
        }
        // No answer: as if it were out of reach.
        _ => Closest {
            distance: f32::MAX,
            normal: up,
            point: at_a.translation,
            on_face: false,
            surface: up,
        },
    }
}

/// Takes the face's normal when the found one differs from it by rounding only.
fn snap_to_face(mut found: Closest, faces: &[Vec3]) -> Closest {
    for face in faces {
        if found.normal.dot(*face) > 0.999_9 {
            found.normal = *face;
            found.surface = *face;
            found.on_face = true;
            return found;
        }
    }
    // Otherwise it is an edge, whose surface is the face most turned to the mover.
    if let Some(face) = faces
        .iter()
        .max_by(|a, b| a.dot(found.normal).total_cmp(&b.dot(found.normal)))
    {
        found.surface = *face;
    }
    found
}
