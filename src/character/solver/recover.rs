//! Undoing overlaps: the least displacement that parts the character from everything it is inside
//! of, limited in speed, without touching its velocity.

use bevy::prelude::*;

use super::{Solver, TOUCH, push::give};
use crate::{
    backend::neighbourhood::ObstacleKind,
    math::planes::{self, HalfSpace, nearest_yielding},
};

impl Solver<'_> {
    /// Moves out of what the character is inside of at the start of the tick.
    pub fn recover(&mut self, p: Vec3) -> Vec3 {
        let inside = self
            .near
            .pieces
            .iter()
            .any(|piece| piece.clearance < -TOUCH);
        if !inside {
            return p;
        }
        self.touch(p, 0.0, TOUCH);
        let most = self.config.recovery_speed * self.dt;
        self.planes.clear();
        for touch in self.touches.iter() {
            let obstacle = &self.near.obstacles[touch.obstacle as usize];
            if touch.distance > -TOUCH
                || (obstacle.kind == ObstacleKind::Dynamic && !self.config.pushed_by_bodies)
            {
                continue;
            }
            let depth = -touch.distance - 0.5 * TOUCH;
            let way = match obstacle.kind {
                ObstacleKind::Static | ObstacleKind::Kinematic => depth,
                // The other one does its half.
                ObstacleKind::Character => 0.5 * depth,
                // A light body is no reason to give way, unless something else holds it there.
                ObstacleKind::Dynamic => {
                    let share = obstacle.dynamics.map_or(1.0, |body| {
                        let mass = body.effective_mass(touch.point, touch.normal);
                        mass / (mass + self.config.mass)
                    });
                    (depth * share).max(depth - give(self.dt))
                }
            };
            planes::add(
                self.planes,
                HalfSpace::new(touch.normal, way.min(most), obstacle.kind as u8),
            );
        }
        let (x, _) = nearest_yielding(bevy::math::DVec3::ZERO, self.planes);
        let x = x.as_vec3().clamp_length_max(most);
        // What is overlapped lets go; everything else stops the way out.
        self.frozen = true;
        let s = self.sweep(p, x, 0.0, 1.0);
        self.frozen = false;
        p + x * s
    }
}

impl Solver<'_> {
    /// What presses into the mover at `p` when the tick has passed, what it is pressed against, and
    /// how deep it is in: the deepest thing that moves as it wills and the one that opposes it most.
    pub fn crusher(&mut self, p: Vec3, deeper: f32) -> Option<(u32, Option<u32>, f32)> {
        self.touch(p, 1.0, TOUCH);
        let by = *self
            .touches
            .iter()
            .filter(|touch| {
                let kind = self.near.obstacles[touch.obstacle as usize].kind;
                kind == ObstacleKind::Kinematic && touch.distance < -deeper
            })
            .min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        let against = self
            .touches
            .iter()
            .filter(|touch| touch.obstacle != by.obstacle && touch.normal.dot(by.normal) < 0.0)
            .min_by(|a, b| a.normal.dot(by.normal).total_cmp(&b.normal.dot(by.normal)))
            .map(|touch| touch.obstacle);
        Some((by.obstacle, against, -by.distance))
    }

    /// Looks at what is touched at `p` when the tick has passed, unless that was the last look.
    pub fn touch_at_end(&mut self, p: Vec3) {
        if self.touched_at != (p, 1.0) {
            self.touch(p, 1.0, super::SUPPORT);
        }
    }

    /// What was touched at the last place looked at.
    pub fn touches(&self) -> &[super::Touch] {
        self.touches
    }
}
