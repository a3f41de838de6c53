//! Collecting the pieces from the physics world.

use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::{Aabb, SharedShape, TypedShape},
    math::Pose,
    parry::partitioning::BvhNode,
};

use super::{Geometry, Mover, MoverPose, Neighbourhood, Piece};
use crate::math::{cuboid::Cuboid, triangle::Triangle};

/// What to collect.
pub(crate) struct Request<'a> {
    pub mover: &'a Mover,
    /// Where the mover starts, relative to the origin.
    pub pose: MoverPose,
    /// World position of the origin.
    pub origin: Vec3,
    /// Lower corner of the box to look in, relative to the origin.
    pub low: Vec3,
    /// Upper corner of the box to look in, relative to the origin.
    pub high: Vec3,
    /// Pieces farther than this from the mover's start are left out, metres.
    pub reach: f32,
    /// Points, relative to the origin, to find the sensors that hold them: the mover's middle and foot.
    pub middle: Vec3,
    pub foot: Vec3,
}

impl Neighbourhood {
    /// Adds the pieces of a collider's shape that the request asks for.
    pub fn add_shape(
        &mut self,
        request: &Request,
        obstacle: u32,
        shape: &SharedShape,
        position: &Pose,
        slack: f32,
    ) {
        let mut sink = Sink {
            neighbourhood: self,
            request,
            obstacle,
            part: 0,
            slack,
        };
        sink.add(shape, position);
    }
}

struct Sink<'a, 'b> {
    neighbourhood: &'a mut Neighbourhood,
    request: &'a Request<'b>,
    obstacle: u32,
    part: u32,
    /// How much farther to look, because the obstacle itself moves, metres.
    slack: f32,
}

impl Sink<'_, '_> {
    fn add(&mut self, shape: &SharedShape, position: &Pose) {
        // Relative to the origin: the subtraction comes first, where it is exact.
        let at = position.translation - self.request.origin;
        let turn = position.rotation;
        match shape.as_typed_shape() {
            TypedShape::Cuboid(cuboid) => self.push(Geometry::Cuboid(Cuboid {
                center: at,
                rotation: turn,
                half: cuboid.half_extents,
            })),
            TypedShape::Ball(ball) => self.push(Geometry::Ball {
                center: at,
                radius: ball.radius,
            }),
            TypedShape::Capsule(capsule) => self.push(Geometry::Capsule {
                a: at + turn * capsule.segment.a,
                b: at + turn * capsule.segment.b,
                radius: capsule.radius,
            }),
            TypedShape::Segment(segment) => self.push(Geometry::Capsule {
                a: at + turn * segment.a,
                b: at + turn * segment.b,
                radius: 0.0,
            }),
            TypedShape::HalfSpace(half_space) => self.push(Geometry::HalfSpace {
                point: at,
                normal: turn * half_space.normal,
            }),
            TypedShape::Triangle(t) => {
                self.push_triangle(at + turn * t.a, at + turn * t.b, at + turn * t.c);
            }
            TypedShape::TriMesh(mesh) => {
                let area = self.local_area(position);
                let origin = position.rotation.inverse() * -at;
                let area = BvhNode::leaf(area, 0);
                for index in mesh.bvh().leaves(|node| node.intersects(&area)) {
                    let t = mesh.triangle(index);
                    self.part = index;
                    self.push_triangle(
                        turn * (t.a - origin),
                        turn * (t.b - origin),
                        turn * (t.c - origin),
                    );
                }
            }
            TypedShape::HeightField(field) => {
                let area = self.local_area(position);
                let origin = position.rotation.inverse() * -at;
                field.map_elements_in_local_aabb(&area, &mut |index, t| {
                    self.part = index;
                    self.push_triangle(
                        turn * (t.a - origin),
                        turn * (t.b - origin),
                        turn * (t.c - origin),
                    );
                });
            }
            TypedShape::Voxels(voxels) => {
                let area = self.local_area(position);
                let half = voxels.voxel_size() * 0.5;
                for voxel in voxels.voxels_intersecting_local_aabb(&area) {
                    if voxel.state.is_empty() {
                        continue;
                    }
                    self.part = self.part.wrapping_add(1);
                    self.push(Geometry::Cuboid(Cuboid {
                        center: at + turn * voxel.center,
                        rotation: turn,
                        half,
                    }));
                }
            }
            TypedShape::Polyline(line) => {
                for index in 0..line.num_segments() {
                    let segment = line.segment(index as u32);
                    self.part = index as u32;
                    self.push(Geometry::Capsule {
                        a: at + turn * segment.a,
                        b: at + turn * segment.b,
                        radius: 0.0,
                    });
                }
            }
            TypedShape::Compound(compound) => {
                let area = self.local_area(position);
                let area = BvhNode::leaf(area, 0);
                for index in compound.bvh().leaves(|node| node.intersects(&area)) {
                    if let Some((offset, part)) = compound.shapes().get(index as usize) {
                        self.part = index << 16;
                        self.add(part, &(*position * *offset));
                    }
                }
            }
            _ if shape.as_support_map().is_some() => self.push(Geometry::Convex {
                shape: shape.clone(),
                position: at,
                rotation: turn,
            }),
            // Custom shapes without a support function cannot be collided with.
            _ => {}
        }
    }

    /// The box to look in, in a shape's own axes.
    fn local_area(&self, position: &Pose) -> Aabb {
        let grow = Vec3::splat(self.slack);
        let low = self.request.low - grow;
        let high = self.request.high + grow;
        let center = (low + high) * 0.5 + (self.request.origin - position.translation);
        let half = (high - low) * 0.5;
        let back = Mat3::from_quat(position.rotation.inverse());
        let local = back * center;
        let extent =
            back.x_axis.abs() * half.x + back.y_axis.abs() * half.y + back.z_axis.abs() * half.z;
        Aabb::new(local - extent, local + extent)
    }

    fn push_triangle(&mut self, a: Vec3, b: Vec3, c: Vec3) {
        // Boxes first: most triangles of a mesh leaf are out of reach.
        let low = a.min(b).min(c);
        let high = a.max(b).max(c);
        let grow = Vec3::splat(self.slack);
        if low.cmpgt(self.request.high + grow).any() || high.cmplt(self.request.low - grow).any() {
            return;
        }
        if let Some(triangle) = Triangle::new(a, b, c) {
            self.push(Geometry::Triangle(triangle));
        }
    }

    fn push(&mut self, geometry: Geometry) {
        self.neighbourhood.queries += 1;
        let found = self.request.mover.separation(&geometry, &self.request.pose);
        let obstacle = &self.neighbourhood.obstacles[self.obstacle as usize];
        let clearance = found.distance - obstacle.skin;
        // Also drops what is not finite.
        if clearance < self.request.reach + self.slack {
            self.neighbourhood.pieces.push(Piece {
                geometry,
                obstacle: self.obstacle,
                part: self.part,
                clearance,
                normal: found.normal,
                point: found.point,
            });
        }
    }
}
