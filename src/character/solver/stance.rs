//! Growing and shrinking in place: the foot stays, the head moves.

use bevy::prelude::*;

use super::{Solver, TOUCH};

/// What came of the wish to grow.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Growth {
    /// There is room.
    Free,
    /// An obstacle leaves room for this height only, metres.
    Blocked { obstacle: u32, room: f32 },
}

impl Solver<'_> {
    /// Whether the mover at `p` can grow by `by` when the tick has passed. A shape that grows
    /// upwards covers what it would sweep on its way up.
    pub fn room_to_grow(&mut self, p: Vec3, height: f32, by: f32) -> Growth {
        let lift = self.up * by;
        self.touch(p, 1.0, TOUCH);
        let mut s = self.sweep(p, lift, 1.0, 1.0);
        // Touching a wall from the side is no obstacle; being under something is.
        if s >= 1.0 {
            self.touch(p + lift, 1.0, -TOUCH);
            if self
                .touches
                .iter()
                .all(|touch| touch.normal.dot(self.up) > -0.05)
            {
                return Growth::Free;
            }
            s = 0.0;
        }
        self.touch(p + lift * s, 1.0, 10.0 * TOUCH);
        let lowest = self
            .touches
            .iter()
            .min_by(|a, b| a.normal.dot(self.up).total_cmp(&b.normal.dot(self.up)));
        match lowest {
            Some(touch) => Growth::Blocked {
                obstacle: touch.obstacle,
                room: height + by * s,
            },
            None => Growth::Free,
        }
    }
}
