//! A collider's shape as convex pieces.

use arrayvec::ArrayVec;
use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::{Aabb, SharedShape, TypedShape},
    math::Pose,
    parry::{bounding_volume::BoundingVolume, partitioning::BvhNode},
};

use super::Geometry;
use crate::math::{cuboid::Cuboid, triangle::Triangle};

/// The most boxes of an area.
pub(crate) const MOST_BOXES: usize = 16;

/// Where pieces are looked for: boxes by their lower and upper corners, relative to an origin.
#[derive(Clone, Copy)]
pub(crate) struct Area<'a> {
    /// World, metres.
    pub origin: Vec3,
    pub boxes: &'a [(Vec3, Vec3)],
    /// By how much each box is larger on every side, metres.
    pub grow: f32,
}

impl Area<'_> {
    /// Whether a box, relative to the origin, reaches into the area.
    #[inline]
    pub fn meets(&self, low: Vec3, high: Vec3) -> bool {
        let grow = Vec3::splat(self.grow);
        self.boxes
            .iter()
            .any(|(a, b)| low.cmple(*b + grow).all() && high.cmpge(*a - grow).all())
    }

    /// The area in the world.
    #[cfg(feature = "vehicle")]
    pub fn in_world(&self) -> Nodes {
        self.nodes(&Pose::IDENTITY)
    }

    /// The area in a shape's own axes.
    fn nodes(&self, position: &Pose) -> Nodes {
        let mut nodes = Nodes::default();
        let back = Mat3::from_quat(position.rotation.inverse());
        let offset = self.origin - position.translation;
        for (low, high) in self.boxes.iter().take(MOST_BOXES) {
            let center = back * ((*low + *high) * 0.5 + offset);
            let half = (*high - *low) * 0.5 + Vec3::splat(self.grow);
            let extent = back.x_axis.abs() * half.x
                + back.y_axis.abs() * half.y
                + back.z_axis.abs() * half.z;
            nodes.add(Aabb::new(center - extent, center + extent));
        }
        nodes
    }
}

/// An area in the axes of a search tree.
#[derive(Default)]
pub(crate) struct Nodes {
    /// All boxes together.
    whole: Option<Aabb>,
    parts: ArrayVec<Aabb, MOST_BOXES>,
}

impl Nodes {
    fn add(&mut self, part: Aabb) {
        let whole = self.whole.map_or(part, |whole| whole.merged(&part));
        self.whole = Some(whole);
        self.parts.push(part);
    }

    /// Whether a node of the tree reaches into the area.
    #[inline]
    pub fn meet(&self, node: &BvhNode) -> bool {
        let (low, high) = (node.mins(), node.maxs());
        let meets = |b: &Aabb| low.cmple(b.maxs).all() && high.cmpge(b.mins).all();
        self.whole.as_ref().is_some_and(meets)
            && (self.parts.len() == 1 || self.parts.iter().any(meets))
    }

    fn aabb(&self) -> Option<Aabb> {
        self.whole
    }
}

/// Hands every convex piece of a shape that may be in the area to `take`, relative to the area's
/// origin, with the number of the part of the shape it is.
pub(crate) fn break_down(
    area: &Area,
    shape: &SharedShape,
    position: &Pose,
    take: &mut impl FnMut(Geometry, u32),
) {
    add(area, shape, position, 0, take);
}

fn add(
    area: &Area,
    shape: &SharedShape,
    position: &Pose,
    part: u32,
    take: &mut impl FnMut(Geometry, u32),
) {
    // Relative to the origin: the subtraction comes first, where it is exact.
    let at = position.translation - area.origin;
    let turn = position.rotation;
    let mut triangle = |a: Vec3, b: Vec3, c: Vec3, part: u32| {
        // Boxes first: most triangles of a mesh leaf are out of reach.
        if area.meets(a.min(b).min(c), a.max(b).max(c))
            && let Some(triangle) = Triangle::new(a, b, c)
        {
            take(Geometry::Triangle(triangle), part);
        }
    };
    match shape.as_typed_shape() {
        TypedShape::Cuboid(cuboid) => {
            let geometry = Geometry::Cuboid(Cuboid {
                center: at,
                rotation: turn,
                half: cuboid.half_extents,
            });
            take(geometry, part);
        }
        TypedShape::Ball(ball) => {
            let geometry = Geometry::Ball {
                center: at,
                radius: ball.radius,
            };
            take(geometry, part);
        }
        TypedShape::Capsule(capsule) => {
            let geometry = Geometry::Capsule {
                a: at + turn * capsule.segment.a,
                b: at + turn * capsule.segment.b,
                radius: capsule.radius,
            };
            take(geometry, part);
        }
        TypedShape::Segment(segment) => {
            let geometry = Geometry::Capsule {
                a: at + turn * segment.a,
                b: at + turn * segment.b,
                radius: 0.0,
            };
            take(geometry, part);
        }
        TypedShape::HalfSpace(half_space) => {
            let geometry = Geometry::HalfSpace {
                point: at,
                normal: turn * half_space.normal,
            };
            take(geometry, part);
        }
        TypedShape::Triangle(t) => {
            triangle(at + turn * t.a, at + turn * t.b, at + turn * t.c, part);
        }
        TypedShape::TriMesh(mesh) => {
            let nodes = area.nodes(position);
            let origin = position.rotation.inverse() * -at;
            for index in mesh.bvh().leaves(|node| nodes.meet(node)) {
                let t = mesh.triangle(index);
                triangle(
                    turn * (t.a - origin),
                    turn * (t.b - origin),
                    turn * (t.c - origin),
                    index,
                );
            }
        }
        TypedShape::HeightField(field) => {
            let Some(local) = area.nodes(position).aabb() else {
                return;
            };
            let origin = position.rotation.inverse() * -at;
            field.map_elements_in_local_aabb(&local, &mut |index, t| {
                triangle(
                    turn * (t.a - origin),
                    turn * (t.b - origin),
                    turn * (t.c - origin),
                    index,
                );
            });
        }
        TypedShape::Voxels(voxels) => {
            let Some(local) = area.nodes(position).aabb() else {
                return;
            };
            let half = voxels.voxel_size() * 0.5;
            let mut part = part;
            for voxel in voxels.voxels_intersecting_local_aabb(&local) {
                if voxel.state.is_empty() {
                    continue;
                }
                part = part.wrapping_add(1);
                let geometry = Geometry::Cuboid(Cuboid {
                    center: at + turn * voxel.center,
                    rotation: turn,
                    half,
                });
                take(geometry, part);
            }
        }
        TypedShape::Polyline(line) => {
            for index in 0..line.num_segments() {
                let segment = line.segment(index as u32);
                let geometry = Geometry::Capsule {
                    a: at + turn * segment.a,
                    b: at + turn * segment.b,
                    radius: 0.0,
                };
                take(geometry, index as u32);
            }
        }
        TypedShape::Compound(compound) => {
            let nodes = area.nodes(position);
            for index in compound.bvh().leaves(|node| nodes.meet(node)) {
                if let Some((offset, inner)) = compound.shapes().get(index as usize) {
                    add(area, inner, &(*position * *offset), index << 16, take);
                }
            }
        }
        _ if shape.as_support_map().is_some() => {
            let geometry = Geometry::Convex {
                shape: shape.clone(),
                position: at,
                rotation: turn,
            };
            take(geometry, part);
        }
        // Custom shapes without a support function cannot be collided with.
        _ => {}
    }
}
