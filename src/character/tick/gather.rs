//! What to look at in a tick, and the share of the gaps between characters.

use bevy::{math::ops, prelude::*};

use super::Tick;
use crate::{
    backend::neighbourhood::{Mover, MoverPose, Neighbourhood, ObstacleKind, Request},
    character::solver::Solver,
};

/// How much farther than the way goes is looked, metres.
const MARGIN: f32 = 0.05;
/// For how many ticks ahead triangles of meshes are searched, and how far at most, metres.
const TICKS_AHEAD: f32 = 8.0;
const FARTHEST_AHEAD: f32 = 1.0;
/// What of it is not needed to find what is touched, metres.
const SPARE: f32 = 0.04;
/// Part of a motion past another character that may be turned towards it.
const ASIDE: f32 = 0.5;

impl Tick<'_, '_, '_, '_> {
    pub(super) fn gather(
        &mut self,
        near: &mut Neighbourhood,
        mover: &Mover,
        pose: MoverPose,
        displacement: Vec3,
        growth: f32,
        wide: bool,
    ) {
        let up = pose.up;
        let step = self.config.step.map_or(0.0, |step| step.height);
        let min_width = self.config.step.map_or(0.0, |step| step.min_width);
        let below = if self.state.on_ground() {
            self.config.ground_snap
        } else {
            0.0
        };
        let above = growth + if wide { step + 0.05 } else { 0.0 };
        let aside = if wide { mover.width + min_width } else { 0.0 };
        let margin = MARGIN + self.push;
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        let foot = pose.position - up * below;
        let head = pose.position + up * (2.0 * mover.middle + above);
        for p in [foot, head, foot + displacement, head + displacement] {
            low = low.min(p);
            high = high.max(p);
        }
        // A flat foot reaches farthest along the axes that are level.
        let level = Vec3::from(
            (Vec3::ONE - up * up)
                .max(Vec3::ZERO)
                .to_array()
                .map(ops::sqrt),
        );
        let grow = level * (mover.width + aside) + margin;
        let request = Request {
            mover,
            pose,
            origin: self.start.position,
            low: low - grow,
            high: high + grow,
            reach: displacement.length() + below.max(above) + margin + aside,
            middle: pose.position + up * mover.middle,
            foot: pose.position,
            way: (displacement * TICKS_AHEAD).clamp_length_max(FARTHEST_AHEAD),
        };
        let around = self.around;
        around.view.gather(
            &request,
            around.groups,
            around.dt,
            |collider, body| around.judge(collider, body, self.config.pushed_by_bodies),
            self.memory,
            near,
        );
        self.share_gaps(near, displacement);
        near.sort();
    }

    /// How far anything that moves, other than what carries, could push the character this tick.
    pub(super) fn push_ahead(&self, near: &Neighbourhood, displacement: Vec3) -> f32 {
        if !near.moving {
            return 0.0;
        }
        let carrier = self.state.anchor.map(|anchor| anchor.entity);
        let mut push = 0.0f32;
        for piece in &near.pieces {
            let obstacle = near.obstacle(piece);
            if obstacle.motion.is_none() || Some(obstacle.entity) == carrier {
                continue;
            }
            // What goes away or past does not push; what turns comes round by more than it heads for.
            let motion = &obstacle.motion;
            let turn = motion.turn.length();
            let arm = (piece.point - motion.pivot).length() + displacement.length();
            let ahead = motion.velocity(piece.point, 0.0).dot(piece.normal) + turn * turn * arm;
            if piece.clearance < ahead + displacement.length() {
                push = push.max(ahead);
            }
        }
        // A little is within the margin of every look.
        if push > SPARE { push } else { 0.0 }
    }

    /// Looks again as far as a step reaches, for a motion that was stopped in the near neighbourhood.
    pub(super) fn look_wider(&mut self, solver: &mut Solver, displacement: Vec3, growth: f32) {
        let queries = solver.near.queries;
        let (mover, pose) = (&solver.mover, solver.pose);
        solver.near.set_aside();
        self.gather(solver.near, mover, pose, displacement, growth, true);
        solver.near.carry_over();
        solver.near.queries += queries;
        for blocker in solver.blockers.iter_mut() {
            blocker.obstacle = solver.near.index_now(blocker.obstacle);
        }
        for impulse in solver.impulses.iter_mut() {
            impulse.obstacle = solver.near.index_now(impulse.obstacle);
        }
        if !solver.impulses.is_empty() {
            solver.near.note_pushed();
        }
    }

    /// Two characters that close on each other each get their share of the gap between them.
    fn share_gaps(&self, near: &mut Neighbourhood, displacement: Vec3) {
        for piece in &mut near.pieces {
            let obstacle = &mut near.obstacles[piece.obstacle as usize];
            if obstacle.kind != ObstacleKind::Character {
                continue;
            }
            let Ok(other) = self.around.others.get(obstacle.body) else {
                continue;
            };
            let mine = approach(displacement, -piece.normal);
            let theirs = approach(other.velocity * self.around.dt, piece.normal);
            let gap = piece.clearance;
            if mine + theirs > gap && theirs > 0.0 && gap > 0.0 {
                let share = gap * theirs / (mine + theirs);
                obstacle.skin += share;
                piece.clearance -= share;
            }
        }
    }
}

/// How far a displacement may lead along `n`: what it wants, and half of what goes aside, which a
/// third character may turn that way. Who goes away does not come near.
fn approach(displacement: Vec3, n: Vec3) -> f32 {
    let along = displacement.dot(n);
    let aside = (displacement - n * along).length();
    (along + ASIDE * aside).max(0.0)
}
