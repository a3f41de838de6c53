//! Exchange of momentum with dynamic bodies.
//!
//! A contact with a body is a plastic impact between the character's mass and the mass that the
//! body opposes at the contact: both go on with the common velocity. What the character gives is
//! limited by its strength times the tick, so a heavy box does not move, and a light one leaves the
//! contact at the character's speed along the normal and no faster; what other contacts and the
//! physics step then make of it is theirs. On top of its feet its weight is not limited. What it
//! receives is not limited: a truck wins.
//!
//! The impulse enters the body before the physics step, and the body's predicted motion with it, so
//! the solver below sees the same velocity as the character did and finds nothing to correct. Whether
//! anything holds the body up is not known before that step: what the push itself would move it is
//! followed for [`give`] at most, overlaps from earlier ticks counted, so one that is wedged in stops
//! the character as a wall does, however light it is.

use bevy::prelude::*;

use super::{Solver, TOUCH};
use crate::backend::neighbourhood::ObstacleKind;

/// Part of an overlap that a push undoes per tick.
const PRESS: f32 = 0.8;

/// How far a body is followed where only its push moves it, metres, with nothing lost to friction.
const GIVE: f32 = 5.0e-3;
/// Deceleration by friction that a body is followed in spite of, metres per second squared.
const DRAG: f32 = 9.81;

/// How deep a body that was pushed and did not move out of the way may be entered, metres.
pub(super) fn give(dt: f32) -> f32 {
    GIVE + DRAG * dt * dt
}

/// An impulse for a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Impulse {
    /// Index of the obstacle.
    pub obstacle: u32,
    /// Entity of the body.
    pub body: Entity,
    /// What it receives at once, newton-seconds, world axes.
    pub impulse: Vec3,
    /// What it receives evenly over the tick, newton-seconds, world axes.
    pub work: Vec3,
    /// Where, relative to the neighbourhood's origin.
    pub point: Vec3,
    /// Displacement of the body by the push that counts for the character's velocity beyond what it is
    /// followed, metres per tick.
    withheld: Vec3,
}

impl Solver<'_> {
    /// Lets touch `i` and the motion `rest` exchange momentum, once per body and tick.
    pub fn exchange_momentum(&mut self, i: usize, rest: Vec3, t: f32) {
        let touch = self.touches[i];
        let obstacle = &self.near.obstacles[touch.obstacle as usize];
        if obstacle.kind != ObstacleKind::Dynamic || t >= 1.0 {
            return;
        }
        let Some(mut body) = obstacle.dynamics else {
            return;
        };
        let n = touch.normal;
        let under_foot = n.dot(self.up) > 0.7;
        // Whoever pushes a box does so at the height of its middle, as far as he reaches: there it
        // slides instead of tipping, and what holds it from turning need not be known.
        let point = if under_foot {
            touch.point
        } else {
            let foot = self.pose.position.dot(self.up);
            let tall = 2.0 * self.mover.middle;
            let height = body
                .center
                .dot(self.up)
                .clamp(foot + 0.1 * tall, foot + 0.9 * tall);
            touch.point + self.up * (height - touch.point.dot(self.up))
        };
        let own = rest.dot(n) / (self.dt * (1.0 - t).max(1.0e-3));
        let other = body.velocity_at(point).dot(n);
        // What is pressed in by friction that slowed the body is pushed out again, not followed.
        let pressed = (-touch.distance - TOUCH).max(0.0) * PRESS / self.dt;
        let closing = other - own + pressed.min(1.0);
        if closing <= 1.0e-4
            || self
                .impulses
                .iter()
                .any(|known| known.body == obstacle.body)
        {
            return;
        }
        let mass = if under_foot {
            body.effective_mass(point, n)
        } else {
            body.effective_mass(body.center, n)
        };
        let reduced = if mass >= f32::MAX {
            self.config.mass
        } else {
            mass * self.config.mass / (mass + self.config.mass)
        };
        let full = reduced * closing;
        let free = body;
        // What stands on a body weighs on it by a force of its own; only a landing is an impact.
        if under_foot && self.grounded {
            return;
        }
        // What the body brings in itself is stopped whole; beyond that it is the character who works.
        let received = if self.config.pushed_by_bodies {
            (reduced * other).clamp(0.0, full)
        } else {
            0.0
        };
        let given = if under_foot {
            full - received
        } else {
            (full - received).min(self.config.push_strength * self.dt)
        };
        let axis = if under_foot { self.up } else { n };
        let (impulse, work) = if under_foot {
            (-axis * (received + given), Vec3::ZERO)
        } else {
            (-axis * received, -axis * given)
        };
        if impulse == Vec3::ZERO && work == Vec3::ZERO {
            return;
        }
        let at = if under_foot { point } else { body.center };
        body.apply(impulse, at);
        let before = body;
        body.apply(work, at);
        // Work is done evenly over the tick, so half of it counts for the way.
        let linear = (before.linear_velocity + body.linear_velocity) * (0.5 * self.dt);
        let turn = body.angular_velocity * self.dt;
        let give = give(self.dt);
        let trust = (1.0 + touch.distance.min(0.0) / give).clamp(0.0, 1.0);
        // What comes is stopped, what goes is followed, and what the push adds as far as it is trusted.
        let own = (free.linear_velocity.dot(n) * self.dt).min(0.0);
        let added = (own - linear.dot(n)).max(0.0);
        let followed = added.min(trust * give / (1.0 - t));
        let withheld = n * (followed - added * trust);
        let linear = linear + n * (added - followed);
        let entity = obstacle.body;
        let center = body.center;
        // All colliders of the body go with it.
        for obstacle in &mut self.near.obstacles {
            if obstacle.body == entity && obstacle.dynamics.is_some() {
                obstacle.dynamics = Some(body);
                obstacle.motion.pivot = center;
                obstacle.motion.linear = linear;
                obstacle.motion.turn = turn;
            }
        }
        self.near.note_pushed();
        self.impulses.push(Impulse {
            obstacle: touch.obstacle,
            body: entity,
            impulse,
            work,
            point,
            withheld,
        });
    }

    /// What the velocity may count on of a body's motion beyond what it is followed, metres per tick.
    pub fn withheld(&self, body: Entity) -> Vec3 {
        let known = self.impulses.iter().find(|known| known.body == body);
        known.map_or(Vec3::ZERO, |known| known.withheld)
    }
}
