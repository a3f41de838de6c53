//! Climbing steps: up, forward, down.
//!
//! A step is tried when something too steep stopped a character whose feet are on the ground.
//! Thin rays first look at the landing itself, so that what is climbed depends neither on the tick
//! rate nor on how round the feet are: it must be walkable, at most one step high and as deep as
//! the least width. Then the shape goes up (as far as the ceiling lets it), forward by the missing
//! part of the motion, and down onto whatever it meets. A round foot may come to rest on the edge;
//! the next ticks continue from there. No motion is added: forward is what was missing, no more.

use bevy::prelude::*;

use super::{Solver, TOUCH, touch::Bend};
use crate::{
    backend::neighbourhood::ObstacleKind,
    character::{
        config::StepConfig,
        output::{StepAttempt, StepResult},
    },
};

/// A step is tried against what opposes the motion by at least this cosine (75°).
const FACING: f32 = 0.26;
/// Most obstacles that are tried as a riser in one tick.
const TRIES: u32 = 3;
/// Least part of the missing motion that a step must achieve.
const PROGRESS: f32 = 0.05;
/// How far behind the riser the first look is, metres.
const BEHIND: f32 = 0.004;
/// Looks at the landing between the riser and one radius behind it.
const LOOKS: u32 = 6;

/// A landing that was looked at.
struct Landing {
    /// Height above the foot, metres.
    height: f32,
    obstacle: u32,
}

impl Solver<'_> {
    /// Tries to climb from `p`, with `missing` the level motion that was stopped and `velocity` the
    /// one before it was. Returns where the foot then is and how high the landing is.
    pub fn try_step(&mut self, p: Vec3, missing: Vec3, velocity: Vec3) -> Option<(Vec3, f32)> {
        let step = self.config.step?;
        let distance = missing.length();
        if distance < 1.0e-5 {
            return None;
        }
        let forward = missing / distance;
        // Beside a wall the riser is not always what opposes the motion most: each is tried in turn.
        let mut tried = f32::INFINITY;
        for _ in 0..TRIES {
            let (facing, direction, point) = self
                .blockers
                .iter()
                .filter(|b| b.bend != Bend::Ground && b.normal.dot(self.up) > -0.1)
                .filter_map(|b| {
                    let level = self.level(-b.normal).try_normalize()?;
                    Some((level.dot(forward), level, b.point))
                })
                .filter(|(facing, ..)| *facing >= FACING && *facing < tried - 1.0e-4)
                .max_by(|a, b| a.0.total_cmp(&b.0))?;
            tried = facing;
            let result = self.climb(p, missing, velocity, direction, point, step);
            let (landed, answer) = match result {
                Ok((q, height, rise)) => (Some((q, height)), StepResult::Climbed(rise)),
                Err(refusal) => (None, refusal),
            };
            if landed.is_some() || self.step.is_none() {
                self.step = Some(StepAttempt {
                    point,
                    direction,
                    result: answer,
                });
            }
            if landed.is_some() {
                return landed;
            }
        }
        None
    }

    fn climb(
        &mut self,
        p: Vec3,
        missing: Vec3,
        velocity: Vec3,
        direction: Vec3,
        point: Vec3,
        step: StepConfig,
    ) -> Result<(Vec3, f32, f32), StepResult> {
        let landing = self.look(p, direction, point, step)?;
        let kind = self.near.obstacles[landing.obstacle as usize].kind;
        if kind == ObstacleKind::Dynamic && !step.onto_dynamic {
            return Err(StepResult::Dynamic);
        }
        let up = self.up * (landing.height + 0.01);
        // What is touched tells which edges on the way are part of a face.
        self.touch(p, 1.0, TOUCH);
        let lifted = up * self.sweep(p, up, 1.0, 1.0);
        if lifted.dot(self.up) < 1.0e-3 {
            return Err(StepResult::NoRoom);
        }
        let before = (self.velocity, self.blockers.len(), self.pinned);
        self.velocity = velocity;
        let raised = p + lifted;
        let q = self.slide(raised, missing, 1.0, false);
        let after = core::mem::replace(&mut self.velocity, before.0);
        self.blockers.truncate(before.1);
        self.pinned = before.2;
        let progress = (q - raised).dot(missing) / missing.length_squared();
        if progress < PROGRESS {
            return Err(StepResult::NoRoom);
        }
        self.touch(q, 1.0, TOUCH);
        let down = -(lifted + self.up * 2.0e-3);
        let s = self.sweep(q, down, 1.0, 1.0);
        if s >= 1.0 {
            return Err(StepResult::NoProgress);
        }
        let landed = q + down * s;
        let rise = (landed - p).dot(self.up);
        if rise < 1.0e-4 || rise > step.height + 1.0e-3 {
            return Err(StepResult::NoProgress);
        }
        self.velocity = after;
        Ok((landed, landing.height, rise))
    }

    /// Looks for a landing behind the riser at `point`.
    fn look(
        &mut self,
        p: Vec3,
        direction: Vec3,
        point: Vec3,
        step: StepConfig,
    ) -> Result<Landing, StepResult> {
        let riser = point - self.up * (point - p).dot(self.up);
        let depth = self.mover.width.max(0.1);
        let mut refusal = StepResult::NoLanding;
        for i in 0..LOOKS {
            let behind = BEHIND + depth * i as f32 / LOOKS as f32;
            let at = riser + direction * behind;
            let Some((height, normal, obstacle)) = self.ground_under(at, step.height) else {
                if i == 0 && self.solid_at(at, step.height, direction) {
                    return Err(StepResult::TooHigh);
                }
                continue;
            };
            if height < 1.0e-3 {
                continue;
            }
            if !self.walkable(normal) {
                refusal = StepResult::TooSteep;
                continue;
            }
            if step.min_width > 0.0 {
                let far = at + direction * step.min_width;
                let rise = step.min_width * self.sin_slope / self.cos_slope.max(0.05) + 0.01;
                match self.ground_under(far, step.height) {
                    Some((h, n, _)) if self.walkable(n) && (h - height).abs() <= rise => {}
                    Some((_, n, _)) if !self.walkable(n) => return Err(StepResult::TooSteep),
                    _ => return Err(StepResult::TooNarrow),
                }
            }
            return Ok(Landing { height, obstacle });
        }
        Err(refusal)
    }

    /// The highest ground under a point one step above the foot's level: height above that level,
    /// normal, obstacle.
    fn ground_under(&mut self, at: Vec3, reach: f32) -> Option<(f32, Vec3, u32)> {
        let top = reach + 2.0e-3;
        let from = at + self.up * top;
        self.cast(from, -self.up, top)
            .map(|(distance, normal, obstacle)| (top - distance, normal, obstacle))
    }

    /// Whether something stands in the way just above the highest step.
    fn solid_at(&mut self, at: Vec3, reach: f32, direction: Vec3) -> bool {
        let from = at + self.up * (reach + 5.0e-3) - direction * (self.mover.width + BEHIND);
        self.cast(from, direction, self.mover.width + 2.0 * BEHIND + 0.02)
            .is_some()
    }

    /// First hit of a ray among the gathered pieces where the tick leaves them.
    fn cast(&mut self, from: Vec3, dir: Vec3, max: f32) -> Option<(f32, Vec3, u32)> {
        let mut best: Option<(f32, Vec3, u32)> = None;
        for piece in &self.near.pieces {
            self.near.queries += 1;
            let motion = &self.near.obstacles[piece.obstacle as usize].motion;
            let limit = best.map_or(max, |b| b.0);
            let hit = if motion.is_none() {
                piece.geometry.cast_ray(from, dir, limit)
            } else {
                let turn = Quat::from_scaled_axis(motion.turn);
                let back = turn.inverse();
                let local = motion.pivot + back * (from - motion.pivot - motion.linear);
                piece
                    .geometry
                    .cast_ray(local, back * dir, limit)
                    .map(|(t, n)| (t, turn * n))
            };
            if let Some((t, n)) = hit
                && best.is_none_or(|b| t < b.0)
            {
                best = Some((t, n, piece.obstacle));
            }
        }
        best
    }
}
