//! Feeling for the ground: rays and swept shapes, behind one question.
//!
//! What is near the wheels of a vehicle is gathered once per tick ([`Ground::gather`]): one traversal
//! of the search tree for all of them, and one of each mesh. Every probe of the tick then asks these
//! few pieces ([`Ground::probe`]) and never the physics world again.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextColliders,
    prelude::{CollisionGroups, RapierRigidBodyHandle},
    rapier::{
        geometry::{Aabb, InteractionGroups},
        math::Pose,
        parry::{
            query::{
                ShapeCastOptions, cast_shapes,
                gjk::{VoronoiSimplex, directional_distance},
            },
            shape::{Ball, Capsule, Cuboid as ParryCuboid, Cylinder, HalfSpace, Shape, Triangle},
        },
    },
};

use super::{
    neighbourhood::{Area, Geometry, MeshMemory, break_down},
    world::PhysicsView,
};
use crate::math::wheel::WheelCast;

/// What a vehicle remembers of meshes: as much as is usually near its wheels.
pub(crate) type WheelMemory = MeshMemory<4, 192>;

/// What is moved along the probe's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProbeShape {
    Ray,
    /// Radius, metres.
    Ball(f32),
    /// Radius and half width, metres; its axle is the rotated `X`.
    Wheel(f32, f32),
}

/// A probe from `origin` along `direction` (unit length) over `reach` metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub origin: Vec3,
    pub rotation: Quat,
    pub direction: Vec3,
    pub reach: f32,
    pub shape: ProbeShape,
}

impl Probe {
    /// The box that it sweeps: lower and upper corner, relative to `origin`.
    pub fn swept(&self, origin: Vec3) -> (Vec3, Vec3) {
        let start = self.origin - origin;
        let end = start + self.direction * self.reach;
        let around = match self.shape {
            ProbeShape::Ray => Vec3::ZERO,
            ProbeShape::Ball(radius) => Vec3::splat(radius),
            ProbeShape::Wheel(radius, half) => {
                let axle = self.rotation * Vec3::X;
                let in_plane = (Vec3::ONE - axle * axle).max(Vec3::ZERO);
                let disc = Vec3::new(in_plane.x.sqrt(), in_plane.y.sqrt(), in_plane.z.sqrt());
                disc * radius + axle.abs() * half
            }
        } + MARGIN;
        (start.min(end) - around, start.max(end) + around)
    }
}

/// Rays hit a little beside edges, so boxes are a little larger, metres.
const MARGIN: Vec3 = Vec3::splat(1.0e-3);

/// What a probe met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProbeHit {
    /// How far the shape went, metres.
    pub distance: f32,
    pub point: Vec3,
    /// Of the ground, against the probe's direction.
    pub normal: Vec3,
    /// Entity of the collider.
    pub entity: Entity,
}

/// What a probe saw first.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Seen {
    Ground(ProbeHit),
    /// The inside of a solid that it began in.
    Inside,
}

/// What lies near the wheels of one vehicle.
pub(crate) struct Ground {
    origin: Vec3,
    pieces: Vec<GroundPiece>,
}

struct GroundPiece {
    geometry: Geometry,
    entity: Entity,
    low: Vec3,
    high: Vec3,
}

impl Default for Ground {
    fn default() -> Self {
        Self {
            origin: Vec3::ZERO,
            // More than is usually near.
            pieces: Vec::with_capacity(256),
        }
    }
}

impl Ground {
    /// Collects every solid piece in these boxes, relative to `origin`, that is not of the body `own`.
    /// `memory` keeps what is near for some ticks, in which the boxes move by about `way`, metres.
    pub fn gather(
        &mut self,
        memory: &mut WheelMemory,
        view: &PhysicsView,
        origin: Vec3,
        boxes: &[(Vec3, Vec3)],
        way: Vec3,
        own: &RapierRigidBodyHandle,
        groups: Option<CollisionGroups>,
    ) {
        self.origin = origin;
        self.pieces.clear();
        if !boxes.iter().all(|(a, b)| a.is_finite() && b.is_finite()) || !origin.is_finite() {
            return;
        }
        let groups: InteractionGroups = groups.unwrap_or_default().into();
        let area = Area {
            origin,
            boxes,
            grow: 0.0,
        };
        let around = area.in_world();
        memory.begin();
        let pieces = &mut self.pieces;
        let near = |node: &_| around.meets_node(node);
        for (handle, collider, own_body) in view.colliders_in(near, own) {
            if own_body || collider.is_sensor() || !collider.collision_groups().test(groups) {
                continue;
            }
            let entity = RapierContextColliders::entity_from_collider(collider);
            let (shape, position) = (collider.shared_shape(), collider.position());
            let mut take = |geometry: Geometry| {
                let (low, high) = geometry.bounds();
                if area.meets(low, high) {
                    pieces.push(GroundPiece {
                        geometry,
                        entity,
                        low,
                        high,
                    });
                }
            };
            match shape.as_trimesh() {
                Some(mesh) => {
                    area.recall(memory, way, handle, shape, mesh, position, &mut |t, _| {
                        take(Geometry::Triangle(t));
                    });
                }
                None => break_down(&area, shape, position, &mut |geometry, _| take(geometry)),
            }
        }
    }

    /// What the probe meets first among the gathered pieces.
    pub fn probe(&self, probe: &Probe) -> Option<Seen> {
        if !probe.origin.is_finite() || !(probe.reach > 0.0) {
            return None;
        }
        let (low, high) = probe.swept(self.origin);
        let start = probe.origin - self.origin;
        let wheel = match probe.shape {
            ProbeShape::Wheel(radius, half) => {
                let axle = probe.rotation * Vec3::X;
                WheelCast::new(start, axle, radius, half, probe.direction)
            }
            _ => None,
        };
        let mut first: Option<ProbeHit> = None;
        for piece in &self.pieces {
            if piece.low.cmpgt(high).any() || piece.high.cmplt(low).any() {
                continue;
            }
            let reach = first.map_or(probe.reach, |hit| hit.distance);
            let hit = match (&piece.geometry, probe.shape, &wheel) {
                (geometry, ProbeShape::Ray, _) => {
                    if geometry.holds(start) {
                        return Some(Seen::Inside);
                    }
                    geometry
                        .cast_ray(start, probe.direction, reach)
                        .map(|(t, normal)| (t, start + probe.direction * t, normal))
                }
                (Geometry::Triangle(triangle), _, Some(wheel)) => wheel
                    .cast(triangle, reach)
                    .map(|touch| (touch.distance, touch.point, touch.normal)),
                (Geometry::Cuboid(cuboid), _, Some(wheel)) => wheel
                    .cast_box(cuboid, reach)
                    .map(|touch| (touch.distance, touch.point, touch.normal)),
                (geometry, ..) => cast(geometry, probe, start, reach),
            };
            let Some((distance, point, normal)) = hit else {
                continue;
            };
            if !normal.is_finite() || !point.is_finite() || !(distance <= reach) {
                continue;
            }
            // The backs of triangles hold as their fronts do.
            let normal = if normal.dot(probe.direction) > 0.0 {
                -normal
            } else {
                normal
            };
            // Of two at one distance the order in the search tree, which depends on the rest of the
            // world, must not decide.
            let nearer = first.is_none_or(|old| {
                distance < old.distance
                    || (distance == old.distance
                        && (normal - old.normal)
                            .to_array()
                            .into_iter()
                            .find(|d| *d != 0.0)
                            .is_some_and(|d| d > 0.0))
            });
            if nearer {
                first = Some(ProbeHit {
                    distance,
                    point: self.origin + point,
                    normal,
                    entity: piece.entity,
                });
            }
        }
        first.map(Seen::Ground)
    }
}

/// A swept shape against any piece: distance, point, normal.
fn cast(geometry: &Geometry, probe: &Probe, start: Vec3, reach: f32) -> Option<(f32, Vec3, Vec3)> {
    let swept = |piece: &dyn Shape, position: Vec3, rotation: Quat| {
        let at = Pose::from_parts(position, rotation);
        let from = |turn: Quat| at.inverse() * Pose::from_parts(start, turn);
        let way = rotation.inverse() * probe.direction;
        let (distance, point, normal) = match probe.shape {
            ProbeShape::Ray => return None,
            ProbeShape::Ball(radius) => {
                let ball = Ball::new(radius);
                sweep(piece, &ball, radius, &from(probe.rotation), way, reach)
            }
            ProbeShape::Wheel(radius, half) => {
                // Parry's cylinders stand along Y.
                let upright = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
                let cylinder = Cylinder::new(half, radius);
                let from = from(probe.rotation * upright);
                let around = Vec2::new(radius, half).length();
                sweep(piece, &cylinder, around, &from, way, reach)
            }
        }?;
        Some((distance, at * point, rotation * normal))
    };
    match geometry {
        Geometry::Triangle(t) => swept(&Triangle::new(t.a, t.b, t.c), Vec3::ZERO, Quat::IDENTITY),
        Geometry::Cuboid(c) => swept(&ParryCuboid::new(c.half), c.center, c.rotation),
        Geometry::Ball { center, radius } => swept(&Ball::new(*radius), *center, Quat::IDENTITY),
        Geometry::Capsule { a, b, radius } => {
            swept(&Capsule::new(*a, *b, *radius), Vec3::ZERO, Quat::IDENTITY)
        }
        Geometry::HalfSpace { point, normal } => {
            swept(&HalfSpace::new(*normal), *point, Quat::IDENTITY)
        }
        Geometry::Convex {
            shape,
            position,
            rotation,
        } => swept(&**shape, *position, *rotation),
    }
}

/// Less than this is no way at all, metres: there the normals of [`directional_distance`] are noise.
const TOUCHING: f32 = 1.0e-4;

/// A convex shape `moved` from a pose along a way of unit length until it meets `piece`, all in the axes
/// of the piece. One that touches at the start is held by the point nearest to its middle, if that is
/// ahead and not farther away than its `radius`: a search for the way out would need memory of its own.
fn sweep(
    piece: &dyn Shape,
    moved: &impl Shape,
    radius: f32,
    from: &Pose,
    way: Vec3,
    reach: f32,
) -> Option<(f32, Vec3, Vec3)> {
    if piece.as_shape::<HalfSpace>().is_some() {
        let options = ShapeCastOptions {
            max_time_of_impact: reach,
            stop_at_penetration: false,
            ..ShapeCastOptions::default()
        };
        let identity = Pose::IDENTITY;
        let hit = cast_shapes(&identity, Vec3::ZERO, piece, from, way, moved, options).ok()??;
        return Some((hit.time_of_impact, hit.witness1, hit.normal1));
    }
    let (a, b) = (piece.as_support_map()?, moved.as_support_map()?);
    let simplex = &mut VoronoiSimplex::new();
    let (distance, normal, point, _) = directional_distance(from, a, b, way, simplex)?;
    if distance >= TOUCHING {
        return (distance <= reach).then_some((distance, point, normal));
    }
    let middle = from.translation;
    let nearest = piece.project_local_point(middle, true);
    let arm = middle - nearest.point;
    let normal = arm.try_normalize()?;
    let held = !nearest.is_inside && arm.length() <= radius + TOUCHING && normal.dot(way) < 0.0;
    held.then_some((0.0, nearest.point, normal))
}

impl Geometry {
    /// Lower and upper corner of the box around it.
    fn bounds(&self) -> (Vec3, Vec3) {
        match self {
            Self::Triangle(t) => (t.a.min(t.b).min(t.c), t.a.max(t.b).max(t.c)),
            Self::Cuboid(c) => {
                let turn = Mat3::from_quat(c.rotation);
                let half = turn.x_axis.abs() * c.half.x
                    + turn.y_axis.abs() * c.half.y
                    + turn.z_axis.abs() * c.half.z;
                (c.center - half, c.center + half)
            }
            Self::Ball { center, radius } => (center - *radius, center + *radius),
            Self::Capsule { a, b, radius } => (a.min(*b) - *radius, a.max(*b) + *radius),
            Self::HalfSpace { .. } => (Vec3::NEG_INFINITY, Vec3::INFINITY),
            Self::Convex {
                shape,
                position,
                rotation,
            } => {
                let aabb: Aabb = shape.compute_aabb(&Pose::from_parts(*position, *rotation));
                (aabb.mins, aabb.maxs)
            }
        }
    }

    /// Whether a point is inside a solid; faces have no inside.
    fn holds(&self, point: Vec3) -> bool {
        match self {
            Self::Triangle(_) => false,
            Self::Cuboid(c) => {
                let p = c.rotation.inverse() * (point - c.center);
                p.abs().cmple(c.half).all()
            }
            Self::Ball { center, radius } => point.distance_squared(*center) <= radius * radius,
            Self::Capsule { a, b, radius } => {
                let (along, arm) = (b - a, point - a);
                let t = (arm.dot(along) / along.length_squared().max(1.0e-12)).clamp(0.0, 1.0);
                *radius > 0.0 && arm.distance_squared(along * t) <= radius * radius
            }
            Self::HalfSpace { point: at, normal } => (point - *at).dot(*normal) <= 0.0,
            Self::Convex {
                shape,
                position,
                rotation,
            } => shape.contains_point(&Pose::from_parts(*position, *rotation), point),
        }
    }
}
