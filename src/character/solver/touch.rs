//! What is touched at a place, and what it does to a motion.
//!
//! **Inner edges.** Where two pieces meet flush (triangles of a floor, a row of boxes, voxels) the
//! edge between them is not felt: an edge contact whose point does not stand out of a touched face
//! by more than [`LIP`] is turned to that face or dropped. The rule looks at geometry only, so it
//! works between colliders as well as inside one.

use bevy::prelude::*;

use super::{LIP, Solver};
use crate::{
    backend::neighbourhood::{Geometry, MoverPose, ObstacleKind},
    math::Closest,
};

/// Cosines that differ by less are equal.
const ROUNDING: f32 = 1.0e-6;

/// How a contact bends a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bend {
    /// Ground: upwards only.
    Ground,
    /// Ground that is too steep: like a slope on the way down, like a wall on the way up.
    Steep,
    /// Walls, overhangs and ceilings.
    Wall,
}

/// A contact at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub obstacle: u32,
    pub distance: f32,
    pub normal: Vec3,
    pub point: Vec3,
    pub on_face: bool,
    pub surface: Vec3,
    pub bend: Bend,
    /// Whether the piece is a triangle, which has no other face than `surface`.
    pub triangle: bool,
}

/// A contact that stopped a motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blocker {
    pub obstacle: u32,
    pub normal: Vec3,
    pub point: Vec3,
    pub distance: f32,
    /// Closing speed along the normal, metres per second.
    pub speed: f32,
    pub bend: Bend,
}

/// What an edge contact beside touched faces amounts to.
pub(in crate::character) enum Edge {
    /// An edge like any other.
    Real,
    /// The face that it belongs to, with this normal.
    Face(Vec3),
    /// Nothing.
    Ghost,
}

impl Solver<'_> {
    /// Whether a piece at rest is farther than `range` from the mover at `pose` for certain.
    pub fn out_of_reach(&self, index: usize, pose: &MoverPose, range: f32) -> bool {
        let piece = &self.near.pieces[index];
        let obstacle = self.near.obstacle(piece);
        if !obstacle.motion.is_none() {
            return false;
        }
        let slack = piece.clearance - range;
        (slack > 0.0 && slack * slack > pose.position.distance_squared(self.pose.position))
            || self
                .mover
                .is_beyond(&piece.geometry, pose, range + obstacle.skin)
    }

    /// Collects everything within `range` of the mover at `p`, at the fraction `t` of the tick.
    pub fn touch(&mut self, p: Vec3, t: f32, range: f32) {
        self.touches.clear();
        self.touched_at = (p, t);
        let pose = self.pose.at(p);
        let count = self
            .near
            .within(range, p.distance(self.pose.position) + 1.0e-5);
        for index in 0..count {
            if self.out_of_reach(index, &pose, range) {
                continue;
            }
            let found = self.near.separation(index, &self.mover, &pose, t);
            if found.distance > range {
                continue;
            }
            let piece = &self.near.pieces[index];
            self.touches.push(Touch {
                obstacle: piece.obstacle,
                distance: found.distance,
                normal: found.normal,
                point: found.point,
                on_face: found.on_face,
                surface: found.surface,
                bend: Bend::Wall,
                triangle: matches!(piece.geometry, Geometry::Triangle(_)),
            });
        }
        // Faces first: edges are judged by them.
        self.touches.sort_unstable_by(|a, b| {
            b.on_face
                .cmp(&a.on_face)
                .then(a.distance.total_cmp(&b.distance))
                .then(a.point.x.total_cmp(&b.point.x))
                .then(a.point.y.total_cmp(&b.point.y))
                .then(a.point.z.total_cmp(&b.point.z))
                .then(a.surface.y.total_cmp(&b.surface.y))
        });
        let faces = self.touches.partition_point(|touch| touch.on_face);
        let mut kept = faces;
        for i in faces..self.touches.len() {
            let mut touch = self.touches[i];
            match edge_beside(&self.touches[..faces], &touch) {
                Edge::Real => {}
                Edge::Face(normal) => touch.normal = normal,
                Edge::Ghost => continue,
            }
            self.touches[kept] = touch;
            kept += 1;
        }
        self.touches.truncate(kept);
        for i in 0..self.touches.len() {
            let touch = self.touches[i];
            self.touches[i].bend = self.bend_of(&touch, p);
        }
    }

    /// What an edge contact found on the way amounts to, beside the faces touched at its start.
    pub fn edge_on_the_way(&self, found: &Closest, triangle: bool) -> Edge {
        let faces = self.touches.partition_point(|touch| touch.on_face);
        edge_beside(
            &self.touches[..faces],
            &Touch {
                obstacle: 0,
                distance: found.distance,
                normal: found.normal,
                point: found.point,
                on_face: false,
                surface: found.surface,
                bend: Bend::Wall,
                triangle,
            },
        )
    }

    fn bend_of(&self, touch: &Touch, p: Vec3) -> Bend {
        let rise = touch.normal.dot(self.up);
        if rise < 0.02 {
            return Bend::Wall;
        }
        if !self.walkable(touch.normal) {
            return Bend::Steep;
        }
        // Rounded feet would roll over edges that are higher than any step allowed.
        let height = (touch.point - p).dot(self.up);
        let highest = self.config.step.map_or(0.0, |step| step.height).max(LIP);
        if !touch.on_face && height > highest && !self.walkable(touch.surface) {
            return Bend::Steep;
        }
        Bend::Ground
    }

    /// Displacement over the rest of the tick of what is touched, as far as it pushes: what its arc
    /// comes to, and no less than where it heads now, for that is what a sweep meets first.
    pub fn push_of(&self, obstacle: u32, point: Vec3, normal: Vec3, t: f32) -> f32 {
        let obstacle = &self.near.obstacles[obstacle as usize];
        let motion = &obstacle.motion;
        let mut push = motion.rest(point, t).dot(normal);
        if motion.turn != Vec3::ZERO {
            push = push.max(motion.velocity(point, t).dot(normal) * (1.0 - t));
        }
        if obstacle.kind == ObstacleKind::Dynamic && !self.config.pushed_by_bodies {
            push.min(0.0)
        } else {
            push
        }
    }
}

fn edge_beside(faces: &[Touch], edge: &Touch) -> Edge {
    for face in faces {
        if (edge.point - face.point).dot(face.normal) > LIP {
            continue;
        }
        if !edge.triangle {
            return Edge::Ghost;
        }
        // Of the two directions that the edge's piece offers, the one nearer to the face.
        if edge.surface.dot(face.normal) >= edge.normal.dot(face.normal) - ROUNDING {
            return Edge::Face(edge.surface);
        }
    }
    Edge::Real
}
