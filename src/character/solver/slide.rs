//! Sweep, bend, sweep on.

use bevy::prelude::*;

use super::{
    HIT, Solver, TOUCH,
    touch::{Bend, Blocker, Edge, Touch},
};
use crate::{
    backend::neighbourhood::{Geometry, ObstacleKind},
    character::config::SlopeSpeed,
    math::planes::{self, HalfSpace, nearest_yielding},
};

/// Most sweeps in one tick. What is left after them is not moved.
const SWEEPS: usize = 10;
/// Closing by less than this per tick is going along, metres.
const ASIDE: f32 = 1.0e-6;
/// Most advances of one piece in one sweep.
const ADVANCES: usize = 24;

/// A direction in which the velocity was stopped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stop {
    normal: Vec3,
    /// Least velocity along the normal, metres per second.
    bound: f32,
    yields: u8,
    /// Whether it raises the velocity instead of turning it.
    lifts: bool,
}

impl Solver<'_> {
    /// Moves from `start` by `displacement`, beginning at the fraction `t` of the tick, along
    /// whatever is in the way; takes out of the velocity what is stopped. With `t = 1` the world
    /// stands still where the tick leaves it. `ground` tells whether ground bends upwards.
    pub fn slide(&mut self, start: Vec3, displacement: Vec3, mut t: f32, ground: bool) -> Vec3 {
        let mut p = start;
        // What is wished stays as it was; each bend starts from it, never from an earlier bend, so
        // the result in a corner does not depend on which wall was met first.
        let mut wish = displacement;
        let before = self.velocity;
        self.stops.clear();
        self.overrun.clear();
        for _ in 0..SWEEPS {
            self.touch(p, t, TOUCH);
            let rest = self.bend(wish, before, t, ground);
            let s = self.sweep(p, rest, t, 1.0);
            p += rest * s;
            if s >= 1.0 {
                break;
            }
            t += (1.0 - t) * s;
            wish *= 1.0 - s;
            if rest == Vec3::ZERO && !self.near.moving {
                break;
            }
        }
        self.overrun.clear();
        p
    }

    /// Bends a motion along everything in `touches`, and the velocity `before` with it.
    fn bend(&mut self, rest: Vec3, before: Vec3, t: f32, ground: bool) -> Vec3 {
        if self.touches.is_empty() {
            return rest;
        }
        self.note_blockers(rest, t);
        for i in 0..self.touches.len() {
            self.exchange_momentum(i, rest, t);
        }
        let bent = if ground { self.lift(rest, t) } else { rest };
        self.planes.clear();
        for touch in self.touches.iter() {
            let push = self.push_of(touch.obstacle, touch.point, touch.normal, t);
            let gap = (touch.distance - HIT).max(0.0);
            let yields = self.near.obstacles[touch.obstacle as usize].kind as u8;
            planes::add(
                self.planes,
                HalfSpace::new(touch.normal, push - gap, yields),
            );
            let motion = &self.near.obstacles[touch.obstacle as usize].motion;
            if motion.turn != Vec3::ZERO && touch.on_face && touch.bend == Bend::Wall {
                // A face that turns is met again and again unless the way ends before it as well.
                let turned = Quat::from_scaled_axis(motion.turn * (1.0 - t)) * touch.normal;
                let push = motion.rest(touch.point, t).dot(turned);
                let pushes = yields != ObstacleKind::Dynamic as u8 || self.config.pushed_by_bodies;
                let push = if pushes { push } else { push.min(0.0) };
                // Beside the touched point a round body comes nearer to a face that leans towards it.
                let lean = (1.0 - turned.dot(touch.normal)) * self.mover.width;
                let push = push + lean;
                planes::add(self.planes, HalfSpace::new(turned, push - gap, yields));
            }
            if touch.bend == Bend::Steep
                && let Some(level) = self.level(touch.normal).try_normalize()
            {
                let steepness = level.dot(touch.normal).max(0.01);
                let push = self.push_of(touch.obstacle, touch.point, level, t);
                planes::add(
                    self.planes,
                    HalfSpace::new(level, push - gap / steepness, yields),
                );
            }
        }
        let stopped = self
            .planes
            .iter()
            .any(|plane| plane.normal.dot(bent.as_dvec3()) < plane.bound);
        if !stopped && bent == rest {
            return rest;
        }
        let (x, left_out) = nearest_yielding(bent.as_dvec3(), self.planes);
        self.pinned |= left_out;
        if left_out {
            self.note_overrun(x.as_vec3(), t);
        }
        self.bend_velocity(before, t, ground);
        x.as_vec3()
    }

    /// Remembers which of the touched gave way: the motion `x` goes into them, and a sweep that
    /// stopped there would leave the character to what it cannot withstand.
    fn note_overrun(&mut self, x: Vec3, t: f32) {
        for touch in self.touches.iter() {
            let obstacle = touch.obstacle;
            if self.near.obstacles[obstacle as usize].kind == ObstacleKind::Static
                || self.overrun.contains(&obstacle)
            {
                continue;
            }
            let push = self.push_of(obstacle, touch.point, touch.normal, t);
            let gap = (touch.distance - HIT).max(0.0);
            if touch.normal.dot(x) < push - gap - ASIDE {
                self.overrun.push(obstacle);
            }
        }
    }

    /// Raises a motion so that it keeps above the ground that it touches, without turning it.
    fn lift(&self, rest: Vec3, t: f32) -> Vec3 {
        let mut lift = 0.0f32;
        let mut face = false;
        for touch in self
            .touches
            .iter()
            .filter(|touch| touch.bend == Bend::Ground)
        {
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

    /// Takes out of the velocity `before` what stops it: the touches of now, and all that stopped it
    /// earlier in the tick.
    fn bend_velocity(&mut self, before: Vec3, t: f32, ground: bool) {
        for i in 0..self.touches.len() {
            let touch = self.touches[i];
            // Rounded feet roll over low edges without losing speed.
            if ground && touch.bend == Bend::Ground && !touch.on_face {
                continue;
            }
            let yields = self.near.obstacles[touch.obstacle as usize].kind as u8;
            self.stop(
                touch.normal,
                self.pace_of(&touch, touch.normal, t),
                yields,
                &touch,
                ground,
            );
            if touch.bend == Bend::Steep
                && let Some(level) = self.level(touch.normal).try_normalize()
            {
                self.stop(level, self.pace_of(&touch, level, t), yields, &touch, false);
            }
        }
        let mut lift = 0.0f32;
        for stop in self.stops.iter().filter(|stop| stop.lifts) {
            let need = stop.bound - stop.normal.dot(before);
            lift = lift.max(need / stop.normal.dot(self.up));
        }
        let mut velocity = before + self.up * lift;
        if lift > 0.0
            && self.grounded
            && self.config.slope_speed == SlopeSpeed::AlongGround
            && velocity.length() > before.length()
        {
            velocity *= before.length() / velocity.length();
        }
        self.planes.clear();
        for stop in self.stops.iter() {
            planes::add(
                self.planes,
                HalfSpace::new(stop.normal, stop.bound, stop.yields),
            );
        }
        let (x, _) = nearest_yielding(velocity.as_dvec3(), self.planes);
        self.velocity = x.as_vec3();
    }

    /// Speed with which a touch pushes along `normal`, relative to what carries, metres per second.
    fn pace_of(&self, touch: &Touch, normal: Vec3, t: f32) -> f32 {
        // What stands still after the tick's end does not push.
        if t >= 1.0 {
            return 0.0;
        }
        let obstacle = &self.near.obstacles[touch.obstacle as usize];
        let mut pace = obstacle.motion.velocity(touch.point, t).dot(normal);
        if obstacle.kind == ObstacleKind::Dynamic {
            pace += self.withheld(obstacle.body).dot(normal);
            if !self.config.pushed_by_bodies {
                pace = pace.min(0.0);
            }
        }
        (pace - self.carry.dot(normal)) / self.dt
    }

    /// Remembers a direction in which the velocity is stopped; the last bound of a direction holds.
    fn stop(&mut self, normal: Vec3, bound: f32, yields: u8, touch: &Touch, ground: bool) {
        let stop = Stop {
            normal,
            bound,
            yields,
            lifts: ground && touch.bend == Bend::Ground,
        };
        match self
            .stops
            .iter_mut()
            .find(|s| s.normal.dot(normal) > 0.9999)
        {
            Some(known) => *known = stop,
            None => self.stops.push(stop),
        }
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
            let known = self
                .blockers
                .iter_mut()
                .find(|b| b.obstacle == touch.obstacle && b.normal.dot(touch.normal) > 0.999);
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
        let aside = 1.0e-5 * length + ASIDE;
        let mut best = most;
        let pose = self.pose.at(p);
        let away = p.distance(self.pose.position) + 1.0e-5;
        let count = self.near.within(length * best + HIT, away);
        for index in 0..count {
            if self.out_of_reach(index, &pose, length * best + HIT)
                || self.overrun.contains(&self.near.pieces[index].obstacle)
            {
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
            let time = if self.frozen { t } else { t + (1.0 - t) * s };
            let pose = self.pose.at(p + rest * s);
            let found = self.near.separation(index, &self.mover, &pose, time);
            let motion = &self.near.obstacles[obstacle as usize].motion;
            let moved = if motion.is_none() || self.frozen {
                Vec3::ZERO
            } else {
                motion.velocity(found.point, time) * (1.0 - t)
            };
            let relative = rest - moved;
            let closing = -found.normal.dot(relative);
            if closing <= aside {
                return None;
            }
            if found.distance <= HIT {
                if !found.on_face {
                    match self.edge_on_the_way(&found, triangle) {
                        Edge::Real => {}
                        Edge::Face(normal) if -normal.dot(relative) > aside => {}
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
