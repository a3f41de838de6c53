//! Sweep, bend, sweep on.

use bevy::prelude::*;

use super::{
    HIT, Solver, TOUCH,
    touch::{Bend, Blocker, Edge},
};
use crate::{
    backend::neighbourhood::{Geometry, ObstacleKind},
    character::config::SlopeSpeed,
    math::planes::{HalfSpace, nearest_yielding},
};

/// Most sweeps in one tick. What is left after them is not moved.
const SWEEPS: usize = 10;
/// Most advances of one piece in one sweep.
const ADVANCES: usize = 24;

impl Solver<'_> {
    /// Moves from `start` by `displacement`, beginning at the fraction `t` of the tick, along
    /// whatever is in the way; takes out of the velocity what is stopped. With `t = 1` the world
    /// stands still where the tick leaves it. `ground` tells whether ground bends upwards.
    pub fn slide(&mut self, start: Vec3, displacement: Vec3, mut t: f32, ground: bool) -> Vec3 {
        let mut p = start;
        let mut rest = displacement;
        for _ in 0..SWEEPS {
            self.touch(p, t, TOUCH);
            rest = self.bend(p, rest, t, ground);
            let s = self.sweep(p, rest, t, 1.0);
            p += rest * s;
            if s >= 1.0 {
                break;
            }
            t += (1.0 - t) * s;
            rest *= 1.0 - s;
            if rest == Vec3::ZERO && !self.near.moving {
                break;
            }
        }
        p
    }

    /// Bends a motion, and the velocity with it, along everything in `touches`.
    fn bend(&mut self, p: Vec3, rest: Vec3, t: f32, ground: bool) -> Vec3 {
        if self.touches.is_empty() {
            return rest;
        }
        for i in 0..self.touches.len() {
            self.exchange_momentum(i, rest, t);
        }
        let mut bent = rest;
        if ground {
            bent = self.lift(bent, t);
        }
        self.planes.clear();
        let mut blocked = bent != rest;
        for touch in self.touches.iter() {
            let obstacle = &self.near.obstacles[touch.obstacle as usize];
            let push = self.push_of(touch.obstacle, touch.point, touch.normal, t);
            let gap = (touch.distance - HIT).max(0.0);
            let yields = obstacle.kind as u8;
            let bound = push - gap;
            blocked |= touch.normal.dot(bent) < bound;
            self.planes.push(HalfSpace::new(touch.normal, bound, yields));
            if touch.bend == Bend::Steep
                && let Some(level) = self.level(touch.normal).try_normalize()
            {
                let steepness = level.dot(touch.normal);
                let push = self.push_of(touch.obstacle, touch.point, level, t);
                self.planes.push(HalfSpace::new(level, push - gap / steepness.max(0.01), yields));
            }
        }
        if !blocked {
            // Nothing in the way, but the velocity may still point into something at rest.
            let bends = self.planes.iter().any(|plane| {
                plane.normal.dot(bent.as_dvec3()) < plane.bound
            });
            if !bends {
                return bent;
            }
        }
        self.note_blockers(rest, t);
        let (x, left_out) = nearest_yielding(bent.as_dvec3(), self.planes);
        self.pinned |= left_out;
        self.bend_velocity(t, ground);
        let _ = p;
        x.as_vec3()
    }

    /// Raises a motion so that it keeps above the ground that it touches, without turning it.
    fn lift(&self, rest: Vec3, t: f32) -> Vec3 {
        let mut lift = 0.0f32;
        let mut face = false;
        for touch in self.touches.iter().filter(|touch| touch.bend == Bend::Ground) {
            let push = self.push_of(touch.obstacle, touch.point, touch.normal, t);
            let need = push - (touch.distance - HIT).max(0.0) - touch.normal.dot(rest);
            let needed = need / touch.normal.dot(self.up);
            if needed > lift {
                lift = needed;
                face = touch.on_face;
            }
        }
        if lift <= 0.0 {
            return rest;
        }
        let lifted = rest + self.up * lift;
        if !(self.grounded && face && self.config.slope_speed == SlopeSpeed::AlongGround) {
            return lifted;
        }
        // Uphill the length of the own motion is kept, not its shadow.
        let carry = self.carry * (1.0 - t);
        let (before, after) = ((rest - carry).length(), (lifted - carry).length());
        if after > before {
            carry + (lifted - carry) * (before / after)
        } else {
            lifted
        }
    }

    /// Takes out of the velocity what the touches stop.
    fn bend_velocity(&mut self, t: f32, ground: bool) {
        let per_second = 1.0 / self.dt;
        let carry = self.carry * per_second;
        let bound = |solver: &Self, obstacle: u32, point: Vec3, normal: Vec3| {
            let motion = &solver.near.obstacles[obstacle as usize];
            let mut push = motion.motion.velocity(point, t).dot(normal) * per_second;
            if motion.kind == ObstacleKind::Dynamic && !solver.config.pushed_by_bodies {
                push = push.min(0.0);
            }
            // What stands still after the tick's end does not push.
            if t >= 1.0 { 0.0 } else { push - carry.dot(normal) }
        };
        let mut velocity = self.velocity;
        let before = velocity;
        if ground {
            let mut lift = 0.0f32;
            for touch in self.touches.iter() {
                if touch.bend == Bend::Ground && touch.on_face {
                    let need = bound(self, touch.obstacle, touch.point, touch.normal)
                        - touch.normal.dot(velocity);
                    lift = lift.max(need / touch.normal.dot(self.up));
                }
            }
            if lift > 0.0 {
                let lifted = velocity + self.up * lift;
                velocity = if self.grounded
                    && self.config.slope_speed == SlopeSpeed::AlongGround
                    && lifted.length() > before.length()
                {
                    lifted * (before.length() / lifted.length())
                } else {
                    lifted
                };
            }
        }
        self.planes.clear();
        for touch in self.touches.iter() {
            // Rounded feet roll over low edges without losing speed.
            if ground && touch.bend == Bend::Ground && !touch.on_face {
                continue;
            }
            let yields = self.near.obstacles[touch.obstacle as usize].kind as u8;
            self.planes.push(HalfSpace::new(touch.normal, bound(self, touch.obstacle, touch.point, touch.normal), yields));
            if touch.bend == Bend::Steep
                && let Some(level) = self.level(touch.normal).try_normalize()
            {
                self.planes.push(HalfSpace::new(level, bound(self, touch.obstacle, touch.point, level), yields));
            }
        }
        let (x, _) = nearest_yielding(velocity.as_dvec3(), self.planes);
        self.velocity = x.as_vec3();
    }

    /// Remembers which touches stop the motion `rest`.
    fn note_blockers(&mut self, rest: Vec3, t: f32) {
        let per_second = 1.0 / (self.dt * (1.0 - t).max(1.0e-3));
        for touch in self.touches.iter() {
            let push = self.push_of(touch.obstacle, touch.point, touch.normal, t);
            let closing = push - touch.normal.dot(rest);
            if closing <= 1.0e-6 {
                continue;
            }
            let known = self.blockers.iter_mut().find(|b| {
                b.obstacle == touch.obstacle && b.normal.dot(touch.normal) > 0.999
            });
            let speed = if t >= 1.0 { 0.0 } else { closing * per_second };
            if let Some(known) = known {
                known.speed = known.speed.max(speed);
            } else {
                self.blockers.push(Blocker {
                    obstacle: touch.obstacle,
                    normal: touch.normal,
                    point: touch.point,
                    distance: touch.distance,
                    speed,
                    bend: touch.bend,
                });
            }
        }
    }

    /// How much of `rest` can be moved from `p` until something is met, at most `most`.
    pub fn sweep(&mut self, p: Vec3, rest: Vec3, t: f32, most: f32) -> f32 {
        let length = rest.length();
        if length == 0.0 && !self.near.moving {
            return most;
        }
        let aside = 1.0e-5 * length + 1.0e-9;
        let mut best = most;
        for index in 0..self.near.pieces.len() {
            if self.out_of_reach(index, p, length * best + HIT) {
                continue;
            }
            if let Some(s) = self.advance(index, p, rest, t, best, aside) {
                best = s;
            }
        }
        best
    }

    /// Conservative advancement against one piece: the fraction of `rest` at which it is met.
    fn advance(
        &mut self,
        index: usize,
        p: Vec3,
        rest: Vec3,
        t: f32,
        best: f32,
        aside: f32,
    ) -> Option<f32> {
        let (triangle, obstacle) = {
            let piece = &self.near.pieces[index];
            (
                matches!(piece.geometry, Geometry::Triangle(_)),
                piece.obstacle,
            )
        };
        let mut s = 0.0;
        for _ in 0..ADVANCES {
            let time = t + (1.0 - t) * s;
            let pose = self.pose.at(p + rest * s);
            let found = self.near.separation(index, &self.mover, &pose, time);
            let motion = &self.near.obstacles[obstacle as usize].motion;
            let moved = if motion.is_none() {
                Vec3::ZERO
            } else {
                motion.velocity(found.point, time) * (1.0 - t)
            };
            let relative = rest - moved;
            let closing = -found.normal.dot(relative);
            // A motion may close the gap that is there: it was bent to do no more.
            let room = aside + found.distance.max(0.0);
            let left = best - s;
            if closing * left <= room {
                return None;
            }
            if found.distance <= HIT {
                if !found.on_face {
                    match self.edge_on_the_way(&found, triangle) {
                        Edge::Real => {}
                        Edge::Face(normal) if -normal.dot(relative) * left > room => {}
                        Edge::Face(_) | Edge::Ghost => return None,
                    }
                }
                return Some(s);
            }
            s += (found.distance - 0.5 * HIT) / closing;
            if s >= best {
                return None;
            }
        }
        Some(s)
    }
}
