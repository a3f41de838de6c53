//! Moving a character through the gathered world for one tick.
//!
//! The tick is a time from 0 to 1 in which the character and the obstacles move together: a lift, a
//! closing door and a falling crate are met where they will be, not where they were.
//!
//! 1. [`recover`]: an overlap left by someone else is undone, at a limited speed.
//! 2. [`slide`]: the way is swept to the first contact, bent by everything touched there, and swept
//!    on. Bending is an exact projection on all touched planes at once ([`crate::math::planes`]), so
//!    corners neither swing nor jitter. Ground that can be walked on bends upwards only, which keeps
//!    the heading; ground that is too steep also acts as a wall, so it is not climbed.
//! 3. [`step`]: if something too steep was in the way and the feet were on the ground, a step is
//!    tried.
//! 4. [`ground`]: what holds the character now; if it was held before, it is pulled down to the
//!    ground within reach.
//!
//! Contacts are exact for capsules against triangles, boxes, balls, capsules and planes (closed
//! forms), and those of GJK for all others. A sweep advances by distance over closing speed, which
//! for convex pieces in straight relative motion never passes a contact; turning obstacles are
//! followed to second order in the angle per tick. There is no stability limit on the tick rate.

mod ground;
mod push;
mod recover;
mod slide;
mod stance;
mod step;
mod touch;

use bevy::{math::ops, prelude::*};

use super::{config::Character, output::StepAttempt};
use crate::backend::neighbourhood::{Mover, MoverPose, Neighbourhood};
use crate::math::planes::HalfSpace;

pub(super) use ground::Support;
pub(super) use push::Impulse;
pub(super) use stance::Growth;
pub(super) use touch::{Bend, Blocker, Touch};

/// Closer than this counts as touching, metres.
const TOUCH: f32 = 1.0e-4;
/// A sweep ends when it is this close, metres.
const HIT: f32 = 2.0e-5;
/// Edges that stand out of a touched face by less than this are part of it, metres.
const LIP: f32 = 8.0e-4;
/// Ground within this distance carries, metres.
const SUPPORT: f32 = 2.0e-3;
/// Slack on the slope limit, so that a ramp at the limit is not a matter of rounding, radians.
const SLOPE_SLACK: f32 = 5.0e-4;

/// Buffers that a solve needs; kept between ticks, one per thread.
pub(super) struct Scratch {
    pub near: Neighbourhood,
    touches: Vec<Touch>,
    planes: Vec<HalfSpace>,
    stops: Vec<slide::Stop>,
    overrun: Vec<u32>,
    pub blockers: Vec<Blocker>,
    pub impulses: Vec<Impulse>,
}

impl Default for Scratch {
    /// With room for more than a usual tick needs.
    fn default() -> Self {
        Self {
            near: Neighbourhood::with_room(),
            touches: Vec::with_capacity(128),
            planes: Vec::with_capacity(128),
            stops: Vec::with_capacity(64),
            overrun: Vec::with_capacity(16),
            blockers: Vec::with_capacity(64),
            impulses: Vec::with_capacity(16),
        }
    }
}

/// One character in one tick.
pub(super) struct Solver<'a> {
    pub config: &'a Character,
    pub mover: Mover,
    /// Pose at the start of the tick, relative to the neighbourhood's origin.
    pub pose: MoverPose,
    pub up: Vec3,
    pub dt: f32,
    pub near: &'a mut Neighbourhood,
    touches: &'a mut Vec<Touch>,
    /// The place and time that `touches` are of.
    touched_at: (Vec3, f32),
    planes: &'a mut Vec<HalfSpace>,
    stops: &'a mut Vec<slide::Stop>,
    /// Obstacles that gave way to others in the running slide: it goes into them.
    overrun: &'a mut Vec<u32>,
    pub blockers: &'a mut Vec<Blocker>,
    pub impulses: &'a mut Vec<Impulse>,
    /// Own velocity, relative to what carries, metres per second.
    pub velocity: Vec3,
    /// Displacement by what carries over the tick, metres.
    pub carry: Vec3,
    /// Whether it stood on the ground when the tick began, and did not leave it since.
    pub grounded: bool,
    /// Whether two things that close on each other hold it.
    pub pinned: bool,
    /// Whether sweeps find everything where it is, as if nothing moved.
    frozen: bool,
    /// The attempt to climb a step in this tick.
    pub step: Option<StepAttempt>,
    cos_slope: f32,
    sin_slope: f32,
}

impl<'a> Solver<'a> {
    pub fn new(
        config: &'a Character,
        mover: Mover,
        pose: MoverPose,
        dt: f32,
        scratch: &'a mut Scratch,
    ) -> Self {
        let limit = (config.max_slope + SLOPE_SLACK).min(core::f32::consts::FRAC_PI_2);
        let (sin_slope, cos_slope) = ops::sin_cos(limit);
        scratch.blockers.clear();
        scratch.overrun.clear();
        scratch.impulses.clear();
        Self {
            config,
            mover,
            up: pose.up,
            pose,
            dt,
            near: &mut scratch.near,
            touches: &mut scratch.touches,
            touched_at: (Vec3::NAN, 0.0),
            planes: &mut scratch.planes,
            stops: &mut scratch.stops,
            overrun: &mut scratch.overrun,
            blockers: &mut scratch.blockers,
            impulses: &mut scratch.impulses,
            velocity: Vec3::ZERO,
            carry: Vec3::ZERO,
            grounded: false,
            pinned: false,
            frozen: false,
            step: None,
            cos_slope,
            sin_slope,
        }
    }

    /// The part of a vector that is perpendicular to up.
    pub fn level(&self, v: Vec3) -> Vec3 {
        v - self.up * v.dot(self.up)
    }

    /// Whether ground with this normal can be stood on.
    fn walkable(&self, normal: Vec3) -> bool {
        normal.dot(self.up) >= self.cos_slope
    }
}
