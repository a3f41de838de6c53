//! What holds the character up.

use bevy::prelude::*;

use super::{SUPPORT, Solver, TOUCH, touch::Bend};
use crate::{
    character::state::GroundState,
    math::planes::{self, HalfSpace, nearest_yielding},
};

/// On an edge with level ground behind it the character stands as long as the contact points up by
/// at least this much (the sine of its angle to level); beyond it slips off.
const PERCH: f32 = 0.3;
/// While walking it is held by less, so that the last moment on a step is not a fall.
const PERCH_WALKING: f32 = 0.03;

/// How far aside an edge may turn the way down to the ground, metres.
const GRAZE: f32 = 0.02;

/// What was found below.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Support {
    pub state: GroundState,
    pub obstacle: Option<u32>,
    pub normal: Vec3,
    pub point: Vec3,
    pub distance: f32,
}

impl Solver<'_> {
    /// Finds out what holds the mover at `p` when the tick has passed.
    pub fn support(&mut self, p: Vec3, walking: bool) -> Support {
        let perch = if walking { PERCH_WALKING } else { PERCH };
        self.touch(p, 1.0, SUPPORT);
        let mut best: Option<(f32, Support)> = None;
        let mut mean = Vec3::ZERO;
        let mut on_flat = false;
        let mut steep: Option<(f32, Support)> = None;
        let mut steep_mean = Vec3::ZERO;
        for touch in self.touches.iter() {
            let rise = touch.normal.dot(self.up);
            if rise < 0.02 {
                continue;
            }
            let flat = self.walkable(touch.surface) && touch.surface.dot(self.up) > rise - 1.0e-4;
            let surface = if flat { touch.surface } else { touch.normal };
            let holds = touch.bend == Bend::Ground || (self.walkable(surface) && rise >= perch);
            let found = Support {
                state: GroundState::OnGround,
                obstacle: Some(touch.obstacle),
                normal: surface,
                point: touch.point,
                distance: touch.distance,
            };
            if holds {
                // A rim that is rolled over does not tilt the tread behind it.
                if flat && !on_flat {
                    on_flat = true;
                    mean = Vec3::ZERO;
                }
                if flat == on_flat {
                    mean += surface;
                }
                if best.is_none_or(|(most, _)| rise > most) {
                    best = Some((rise, found));
                }
            } else {
                steep_mean += touch.normal;
                if steep.is_none_or(|(most, _)| rise > most) {
                    steep = Some((rise, found));
                }
            }
        }
        if let Some((_, found)) = best {
            return Support {
                normal: mean.normalize_or(found.normal),
                ..found
            };
        }
        let Some((_, found)) = steep else {
            return Support {
                state: if self.touches.is_empty() {
                    GroundState::InAir
                } else {
                    GroundState::Unsupported
                },
                obstacle: None,
                normal: self.up,
                point: p,
                distance: f32::MAX,
            };
        };
        // Steep walls hold together what each alone does not: would a fall get anywhere?
        self.planes.clear();
        for touch in self.touches.iter() {
            planes::add(self.planes, HalfSpace::new(touch.normal, 0.0, 0));
        }
        let (fall, _) = nearest_yielding(-self.up.as_dvec3(), self.planes);
        if fall.length() as f32 <= self.sin_slope {
            return Support {
                normal: steep_mean.normalize_or(self.up),
                ..found
            };
        }
        Support {
            state: GroundState::Steep,
            ..found
        }
    }

    /// Looks for ground below `p` within the snap distance; where the foot then is, and on what.
    pub fn snap(&mut self, p: Vec3, walking: bool) -> Option<(Vec3, Support)> {
        // Whoever lands within reach of the ground is put onto it even if it does not snap.
        let reach = if self.grounded {
            self.config.ground_snap
        } else {
            0.0
        }
        .max(SUPPORT);
        self.touch(p, 1.0, TOUCH);
        let down = -self.up * reach;
        let s = self.sweep(p, down, 1.0, 1.0);
        if s >= 1.0 {
            return None;
        }
        let q = p + down * s;
        let support = self.support(q, walking);
        if support.state == GroundState::OnGround {
            return Some((q, support));
        }
        // The rim of the edge just left, which a round foot still grazes, is passed on the way.
        let (velocity, blockers, pinned) = (self.velocity, self.blockers.len(), self.pinned);
        let q = self.slide(q, down * (1.0 - s), 1.0, true);
        self.velocity = velocity;
        self.blockers.truncate(blockers);
        self.pinned = pinned;
        if self.level(q - p).length() > GRAZE {
            return None;
        }
        let support = self.support(q, walking);
        (support.state == GroundState::OnGround).then_some((q, support))
    }
}
