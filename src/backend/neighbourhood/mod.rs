//! The world near a moving shape, gathered once per tick and then queried many times.
//!
//! One traversal of the broad-phase tree collects every convex piece that the shape could reach in
//! the tick: whole convex colliders, triangles of meshes and height fields, cubes of voxel grids.
//! All coordinates are relative to an origin near the shape, so far from the world's origin no
//! digit is lost. Pieces that are too far to matter are left out by one distance evaluation each.
//! Queries then never touch the physics world again. Triangles of meshes are [remembered](MeshMemory)
//! for some ticks.
//!
//! Memory is kept between ticks; gathering allocates only while a buffer still grows.

mod break_down;
mod gather;
mod mesh_memory;
mod mover;
mod piece;

use bevy::{math::DQuat, prelude::*};

#[cfg(feature = "vehicle")]
pub(crate) use break_down::MOST_BOXES;
pub(crate) use break_down::{Area, break_down};
pub(crate) use gather::Request;
pub(crate) use mesh_memory::MeshMemory;
pub(crate) use mover::{Mover, MoverPose};
pub(crate) use piece::{Geometry, Piece};

use crate::math::Closest;

/// What a mover remembers of meshes: on the seam of two, and as much as is near one of a few metres.
pub(crate) type MoverMemory = MeshMemory<2, 64>;

/// A sensor that holds the mover's middle or foot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Volume {
    pub entity: Entity,
    /// Whether it holds the middle.
    pub middle: bool,
}

/// What kind of thing an obstacle is, in the order in which they give way: the later ones first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum ObstacleKind {
    /// Does not move this tick.
    Static,
    /// Moves as it wills.
    Kinematic,
    /// Another character.
    Character,
    /// Moves as forces will.
    Dynamic,
}

/// A collider near the shape.
#[derive(Clone, Debug)]
pub(crate) struct Obstacle {
    /// Entity of the collider.
    pub entity: Entity,
    /// Entity of its body, or of the collider when it has none.
    pub body: Entity,
    pub kind: ObstacleKind,
    /// Motion of its body over the whole tick.
    pub motion: Motion,
    /// Inverse mass and centre of mass (relative to the origin), for dynamic bodies.
    pub dynamics: Option<Dynamics>,
    pub friction: f32,
    pub restitution: f32,
    /// Thickness of the obstacle beyond its collider, metres.
    pub skin: f32,
}

/// What is needed to exchange momentum with a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dynamics {
    pub linear_velocity: Vec3,
    pub angular_velocity: Vec3,
    pub center: Vec3,
    /// Inverse mass along each world axis, 1/kg.
    pub inverse_mass: Vec3,
    /// Inverse inertia about the centre, world axes, 1/(kg·m²).
    pub inverse_inertia: Mat3,
}

impl Dynamics {
    /// Velocity of the body at a point, metres per second.
    pub fn velocity_at(&self, point: Vec3) -> Vec3 {
        self.linear_velocity + self.angular_velocity.cross(point - self.center)
    }

    /// Mass that the body opposes to an impulse along `n` at `point`, kilograms.
    pub fn effective_mass(&self, point: Vec3, n: Vec3) -> f32 {
        let arm = (point - self.center).cross(n);
        let inverse = (n * n).dot(self.inverse_mass) + arm.dot(self.inverse_inertia * arm);
        if inverse > 1.0e-12 {
            1.0 / inverse
        } else {
            f32::MAX
        }
    }

    /// Takes up an impulse at a point.
    pub fn apply(&mut self, impulse: Vec3, point: Vec3) {
        self.linear_velocity += impulse * self.inverse_mass;
        self.angular_velocity += self.inverse_inertia * (point - self.center).cross(impulse);
    }
}

/// A rigid motion over one tick: a turn about a moving pivot, spread evenly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    pub pivot: Vec3,
    /// Displacement of the pivot over the tick, metres.
    pub linear: Vec3,
    /// Rotation over the tick as axis times angle, radians.
    pub turn: Vec3,
}

impl Motion {
    pub const NONE: Self = Self {
        pivot: Vec3::ZERO,
        linear: Vec3::ZERO,
        turn: Vec3::ZERO,
    };

    #[inline]
    pub fn is_none(&self) -> bool {
        self.linear == Vec3::ZERO && self.turn == Vec3::ZERO
    }

    /// Displacement over the rest of the tick of the point that is at `point` at fraction `t`.
    pub fn rest(&self, point: Vec3, t: f32) -> Vec3 {
        if self.turn == Vec3::ZERO {
            return self.linear * (1.0 - t);
        }
        let arm = point - (self.pivot + self.linear * t);
        let rest = DQuat::from_scaled_axis((self.turn * (1.0 - t)).as_dvec3());
        self.linear * (1.0 - t) + (rest * arm.as_dvec3() - arm.as_dvec3()).as_vec3()
    }

    /// Velocity per tick of the point that is at `point` at fraction `t`.
    #[inline]
    pub fn velocity(&self, point: Vec3, t: f32) -> Vec3 {
        self.linear + self.turn.cross(point - (self.pivot + self.linear * t))
    }

    /// Greatest displacement of any point within `reach` of `around`.
    pub fn reach(&self, around: Vec3, reach: f32) -> f32 {
        self.linear.length() + self.turn.length() * ((around - self.pivot).length() + reach)
    }
}

/// The gathered surroundings of one shape.
#[derive(Default)]
pub(crate) struct Neighbourhood {
    pub obstacles: Vec<Obstacle>,
    pub pieces: Vec<Piece>,
    /// Distance evaluations since the last gathering.
    pub queries: u32,
    /// Whether any obstacle moves.
    pub moving: bool,
    /// The sensors that hold the mover's middle or foot.
    pub volumes: Vec<Volume>,
    /// How much nearer than at the start of the tick any piece can come by its own motion, metres.
    pub slack: f32,
    order: Vec<(f32, u32)>,
    earlier: Vec<Obstacle>,
}

impl Neighbourhood {
    /// Empty, with room for more than is usually near.
    pub fn with_room() -> Self {
        Self {
            obstacles: Vec::with_capacity(64),
            pieces: Vec::with_capacity(512),
            volumes: Vec::with_capacity(8),
            order: Vec::with_capacity(512),
            earlier: Vec::with_capacity(64),
            ..default()
        }
    }

    /// Forgets everything but keeps the memory.
    pub fn clear(&mut self) {
        self.obstacles.clear();
        self.pieces.clear();
        self.queries = 0;
        self.moving = false;
        self.volumes.clear();
        self.slack = 0.0;
    }

    /// An obstacle was set in motion: where it can get to was not known when pieces were collected.
    pub fn note_pushed(&mut self) {
        self.moving = true;
        self.slack = f32::INFINITY;
    }

    /// Sets the obstacles aside before the place is looked at again, in a wider circle.
    pub fn set_aside(&mut self) {
        core::mem::swap(&mut self.obstacles, &mut self.earlier);
    }

    /// Carries over what was found out about the obstacles that were set aside: how they were pushed.
    pub fn carry_over(&mut self) {
        for old in &self.earlier {
            if let Some(new) = self.obstacles.iter_mut().find(|o| o.entity == old.entity) {
                new.motion = old.motion;
                new.dynamics = old.dynamics;
            }
        }
    }

    /// The present index of an obstacle that was set aside.
    pub fn index_now(&mut self, index: u32) -> u32 {
        let old = &self.earlier[index as usize];
        let known = self.obstacles.iter().position(|o| o.entity == old.entity);
        let now = known.unwrap_or_else(|| {
            self.obstacles.push(old.clone());
            self.obstacles.len() - 1
        });
        now as u32
    }

    /// Puts the pieces in the order of their clearance. The order of the search tree depends on what
    /// else there is in the world; geometry does not.
    pub fn sort(&mut self) {
        let pieces = &mut self.pieces;
        self.order.clear();
        self.order.extend(
            pieces
                .iter()
                .zip(0..)
                .map(|(piece, i)| (piece.clearance, i)),
        );
        self.order.sort_unstable_by(|(a, i), (b, j)| {
            a.total_cmp(b).then_with(|| {
                let (a, b) = (&pieces[*i as usize], &pieces[*j as usize]);
                a.normal
                    .x
                    .total_cmp(&b.normal.x)
                    .then(a.normal.y.total_cmp(&b.normal.y))
                    .then(a.normal.z.total_cmp(&b.normal.z))
                    .then(a.point.x.total_cmp(&b.point.x))
                    .then(a.point.y.total_cmp(&b.point.y))
                    .then(a.point.z.total_cmp(&b.point.z))
                    .then(a.part.cmp(&b.part))
            })
        });
        // Pieces are large: each is moved once, along the cycles of the permutation.
        for start in 0..self.order.len() {
            let mut at = start;
            loop {
                let from = self.order[at].1 as usize;
                self.order[at].1 = at as u32;
                if from == start || from == at {
                    break;
                }
                pieces.swap(at, from);
                at = from;
            }
        }
    }

    /// How many of the pieces, from the first on, can be within `range` of a mover that is
    /// `distance` from where it started.
    #[inline]
    pub fn within(&self, range: f32, distance: f32) -> usize {
        let most = range + distance + self.slack;
        self.pieces.partition_point(|piece| piece.clearance <= most)
    }

    #[inline]
    pub fn obstacle(&self, piece: &Piece) -> &Obstacle {
        &self.obstacles[piece.obstacle as usize]
    }

    /// Distance of the mover from a piece at the fraction `t` of the tick: closest pair with the
    /// distance measured between the surfaces.
    #[inline]
    pub fn separation(&mut self, index: usize, mover: &Mover, pose: &MoverPose, t: f32) -> Closest {
        self.queries += 1;
        let piece = &self.pieces[index];
        let obstacle = &self.obstacles[piece.obstacle as usize];
        let motion = &obstacle.motion;
        if t == 0.0 || motion.is_none() {
            let mut found = mover.separation(&piece.geometry, pose);
            found.distance -= obstacle.skin;
            return found;
        }
        // The piece stays where it was at the start; the mover goes back in its frame instead.
        let turn = Quat::from_scaled_axis(motion.turn * t);
        let back = turn.inverse();
        let pivot = motion.pivot + motion.linear * t;
        let local = MoverPose {
            position: motion.pivot + back * (pose.position - pivot),
            rotation: back * pose.rotation,
            up: back * pose.up,
        };
        let found = mover.separation(&piece.geometry, &local);
        Closest {
            distance: found.distance - obstacle.skin,
            normal: turn * found.normal,
            point: pivot + turn * (found.point - motion.pivot),
            on_face: found.on_face,
            surface: turn * found.surface,
        }
    }
}
