//! A collider's shape as convex pieces.

use arrayvec::ArrayVec;
use bevy::{math::Vec3A, prelude::*};
use bevy_rapier3d::rapier::{
    geometry::{Aabb, ColliderHandle, SharedShape, TriMesh, TypedShape},
    math::Pose,
    parry::partitioning::BvhNode,
};

use super::Geometry;
use super::MeshMemory;
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

    /// The triangle if it may be in the area. Boxes first: most triangles of a mesh leaf are out of reach.
    #[inline]
    fn triangle(&self, a: Vec3, b: Vec3, c: Vec3) -> Option<Triangle> {
        let near = self.meets(a.min(b).min(c), a.max(b).max(c));
        near.then(|| Triangle::new(a, b, c)).flatten()
    }

    /// The triangles of a mesh, as [`break_down`] hands them out, but from memory where they are in it.
    pub fn recall<const MESHES: usize, const TRIANGLES: usize>(
        &self,
        memory: &mut MeshMemory<MESHES, TRIANGLES>,
        way: Vec3,
        collider: ColliderHandle,
        shape: &SharedShape,
        mesh: &TriMesh,
        position: &Pose,
        take: &mut impl FnMut(Triangle, u32),
    ) {
        let at = position.translation - self.origin;
        let turn = position.rotation;
        let origin = turn.inverse() * -at;
        memory.triangles(self, way, collider, shape, mesh, position, &mut |(
            corners,
            part,
        )| {
            let [a, b, c] = corners.map(|p| turn * (p - origin));
            if let Some(triangle) = self.triangle(a, b, c) {
                take(triangle, part);
            }
        });
    }

    /// The box around the whole area, in the world.
    #[cfg(feature = "vehicle")]
    pub fn in_world(&self) -> Block {
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        for (a, b) in self.boxes {
            low = low.min(*a);
            high = high.max(*b);
        }
        let grow = Vec3::splat(self.grow);
        Block::new(self.origin + (low - grow), self.origin + (high + grow))
    }

    /// The area in a shape's own axes.
    pub(super) fn nodes(&self, position: &Pose) -> Nodes {
        let mut nodes = Nodes::default();
        let back = Mat3::from_quat(position.rotation.inverse());
        let offset = self.origin - position.translation;
        for (low, high) in self.boxes.iter().take(MOST_BOXES) {
            let center = back * ((*low + *high) * 0.5 + offset);
            let half = (*high - *low) * 0.5 + Vec3::splat(self.grow);
            let extent = back.x_axis.abs() * half.x
                + back.y_axis.abs() * half.y
                + back.z_axis.abs() * half.z;
            nodes.add(Block::new(center - extent, center + extent));
        }
        nodes
    }
}

/// A box that is compared four numbers at a time.
#[derive(Clone, Copy)]
pub(crate) struct Block {
    low: Vec3A,
    high: Vec3A,
}

impl Block {
    #[inline]
    pub fn new(low: Vec3, high: Vec3) -> Self {
        Self {
            low: low.into(),
            high: high.into(),
        }
    }

    #[inline]
    fn meets(&self, other: &Self) -> bool {
        (self.low.cmple(other.high) & self.high.cmpge(other.low)).all()
    }

    /// Whether a node of a tree reaches into it.
    #[cfg(feature = "vehicle")]
    #[inline]
    pub fn meets_node(&self, node: &BvhNode) -> bool {
        self.meets(&Self::new(node.mins(), node.maxs()))
    }

    fn holds(&self, other: &Self) -> bool {
        (self.low.cmple(other.low) & self.high.cmpge(other.high)).all()
    }
}

/// An area in the axes of a search tree.
#[derive(Default)]
pub(crate) struct Nodes {
    /// All boxes together.
    whole: Option<Block>,
    parts: ArrayVec<Block, MOST_BOXES>,
}

impl Nodes {
    fn add(&mut self, part: Block) {
        let whole = self.whole.map_or(part, |whole| Block {
            low: whole.low.min(part.low),
            high: whole.high.max(part.high),
        });
        self.whole = Some(whole);
        self.parts.push(part);
    }

    /// Whether a node of the tree reaches into the area.
    #[inline]
    pub fn meet(&self, node: &BvhNode) -> bool {
        self.meet_block(&Block::new(node.mins(), node.maxs()))
    }

    /// Whether a box in the same axes reaches into the area.
    #[inline]
    pub fn meet_block(&self, block: &Block) -> bool {
        self.whole.as_ref().is_some_and(|whole| whole.meets(block))
            && (self.parts.len() == 1 || self.parts.iter().any(|part| part.meets(block)))
    }

    /// Whether each box of another area lies in the one of the same number here.
    pub fn hold(&self, other: &Self) -> bool {
        self.parts.len() == other.parts.len()
            && self.parts.iter().zip(&other.parts).all(|(a, b)| a.holds(b))
    }

    /// The area with all boxes larger by `around` on every side, and by a way.
    pub fn ahead(&self, way: Vec3, around: f32) -> Self {
        let way = Vec3A::from(way);
        let mut nodes = Self::default();
        for part in &self.parts {
            nodes.add(Block {
                low: part.low + way.min(Vec3A::ZERO) - around,
                high: part.high + way.max(Vec3A::ZERO) + around,
            });
        }
        nodes
    }

    fn aabb(&self) -> Option<Aabb> {
        self.whole
            .map(|whole| Aabb::new(whole.low.into(), whole.high.into()))
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
        if let Some(triangle) = area.triangle(a, b, c) {
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
