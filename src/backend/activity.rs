//! Where anything moves this tick, on a coarse hashed grid: lets things at rest ask in a few
//! nanoseconds whether they may stay at rest. A hash collision costs a needless look, never a
//! missed one.

use bevy::prelude::*;

/// Edge of a cell, metres.
const CELL: f32 = 4.0;
const WORDS: usize = 1024;
/// An area of more cells than this along an axis, or with a corner farther out than this many
/// cells, is kept as it is.
const MOST_CELLS: f32 = 6.0;
const FARTHEST: f32 = 1.0e9;

/// The areas in which something moves.
#[derive(Resource)]
pub(crate) struct Activity {
    bits: Vec<u64>,
    large: Vec<(Vec3, Vec3)>,
    any: bool,
}

impl Default for Activity {
    fn default() -> Self {
        Self {
            bits: vec![0; WORDS],
            large: Vec::new(),
            any: false,
        }
    }
}

impl Activity {
    pub fn clear(&mut self) {
        if self.any {
            self.bits.fill(0);
            self.large.clear();
            self.any = false;
        }
    }

    /// Marks the box from `low` to `high` (world, metres) as active.
    pub fn mark(&mut self, low: Vec3, high: Vec3) {
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        self.any = true;
        if covers_many(low, high) {
            self.large.push((low, high));
            return;
        }
        let (a, b) = (cell(low), cell(high));
        for x in a[0]..=b[0] {
            for y in a[1]..=b[1] {
                for z in a[2]..=b[2] {
                    let h = hash(x, y, z);
                    self.bits[h / 64] |= 1 << (h % 64);
                }
            }
        }
    }

    /// Whether something may be moving in the box from `low` to `high`.
    pub fn near(&self, low: Vec3, high: Vec3) -> bool {
        if !self.any {
            return false;
        }
        if covers_many(low, high) {
            return true;
        }
        let (a, b) = (cell(low), cell(high));
        for x in a[0]..=b[0] {
            for y in a[1]..=b[1] {
                for z in a[2]..=b[2] {
                    let h = hash(x, y, z);
                    if self.bits[h / 64] & (1 << (h % 64)) != 0 {
                        return true;
                    }
                }
            }
        }
        self.large
            .iter()
            .any(|(l, h)| l.cmple(high).all() && low.cmple(*h).all())
    }
}

/// Whether a box is too large, or too far out, to be told apart by cells. Decided in floats: a
/// half-space is as large as they go.
fn covers_many(low: Vec3, high: Vec3) -> bool {
    // Written so that what is not a number is large.
    !((high - low).max_element() <= CELL * MOST_CELLS && low.abs().max_element() <= CELL * FARTHEST)
}

fn cell(p: Vec3) -> [i64; 3] {
    [
        (p.x / CELL).floor() as i64,
        (p.y / CELL).floor() as i64,
        (p.z / CELL).floor() as i64,
    ]
}

fn hash(x: i64, y: i64, z: i64) -> usize {
    let mixed =
        (x.wrapping_mul(73_856_093)) ^ (y.wrapping_mul(19_349_663)) ^ (z.wrapping_mul(83_492_791));
    (mixed as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) as usize >> 48
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_a_marked_box_is_near() {
        let mut activity = Activity::default();
        assert!(!activity.near(Vec3::ZERO, Vec3::ONE));
        activity.mark(Vec3::new(-3.0, 0.0, 5.0), Vec3::new(6.0, 1.0, 9.0));
        for (x, z) in [(-3.0, 5.0), (6.0, 9.0), (0.0, 7.0)] {
            let p = Vec3::new(x, 0.5, z);
            assert!(activity.near(p - 0.1, p + 0.1));
        }
        activity.mark(Vec3::splat(-1.0e6), Vec3::splat(1.0e6));
        assert!(activity.near(Vec3::splat(5.0e5), Vec3::splat(5.0e5)));
        activity.clear();
        assert!(!activity.near(Vec3::ZERO, Vec3::ONE));
    }

    #[test]
    fn the_box_of_a_half_space_is_near_everywhere() {
        let all = Vec3::splat(f32::MAX * 0.5);
        let mut activity = Activity::default();
        activity.mark(-all, all);
        for at in [0.0, 1.0e6, 1.0e30] {
            assert!(activity.near(Vec3::splat(at), Vec3::splat(at + 1.0)));
        }
        assert!(activity.near(-all, all));
        activity.clear();
        activity.mark(Vec3::splat(1.0e25), Vec3::splat(1.0e25));
        assert!(!activity.near(Vec3::ZERO, Vec3::ONE));
    }
}
