//! A crowd on wavy terrain with stairs, pillars and crates: the scene in which the cost per
//! character is measured.
//!
//! The world is made of equal tiles of 50 m for 100 characters each, so a larger crowd is exactly
//! as dense as a small one. Everybody walks to a point of the own tile, and on to another one on
//! arrival or after two seconds; nobody ever stands still by choice. Points and speeds come from a
//! hash of the walker's number and the leg, the same on every platform.

use bevy::{math::UVec2, prelude::*};
use bevy_rapier3d::prelude::*;

use crate::terrain::{StableId, Waves, tiles_for, unit};

/// Characters on one tile.
pub const PER_TILE: u32 = 100;
/// Edge of a tile, metres.
pub const TILE: f32 = 50.0;
/// Fastest that a walker is asked to go, metres per second.
pub const FASTEST: f32 = 9.5;
/// Height of the lowest ground, metres.
pub const LOWEST: f32 = -AMPLITUDE;
/// Slowest that a walker is asked to go, metres per second.
const SLOWEST: f32 = 5.0;
/// Longest time on the way to one point, ticks of 1/60 s.
const LEG: u32 = 120;
const AMPLITUDE: f32 = 2.0;
/// The terrain, 37 degrees steep at most.
const TERRAIN: Waves = Waves {
    tile: TILE,
    quads: 100,
    amplitude: AMPLITUDE,
    waves: 3.0,
};
/// Rows and columns of characters, and of crates, on a tile.
const ROWS: u32 = 10;
/// Distance of rows and columns, metres.
const SPACING: f32 = 4.0;
const STEPS: u32 = 10;
const STEP: f32 = 0.3;
/// Height of the foot of the stairs, metres: they rise out of the terrain.
const STAIRS: f32 = -1.0;
const PILLARS: u32 = 10;
const CRATE: f32 = 0.5;

/// The world of a crowd.
#[derive(Clone, Copy, Debug)]
pub struct Wavy {
    tiles: UVec2,
}

impl Wavy {
    /// A world with room for this many characters: the least number of tiles, as nearly square as
    /// they can be laid out.
    pub fn for_characters(characters: u32) -> Self {
        Self {
            tiles: tiles_for(characters, PER_TILE),
        }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.tiles.x * self.tiles.y
    }

    /// Height of the terrain, metres.
    pub fn height(x: f32, z: f32) -> f32 {
        TERRAIN.height(x, z)
    }

    /// Middle of a tile, metres.
    fn middle(&self, tile: u32) -> Vec2 {
        TERRAIN.middle(self.tiles, tile)
    }

    /// Top of everything that does not move, metres, at a place relative to the middle of a tile.
    fn top(&self, middle: Vec2, at: Vec2) -> f32 {
        let ring = at.abs().max_element();
        let stairs = (0..STEPS)
            .filter(|i| ring <= half_width(*i))
            .map(|i| STAIRS + STEP * (i + 1) as f32)
            .fold(f32::MIN, f32::max);
        stairs.max(Self::height(middle.x + at.x, middle.y + at.y))
    }

    /// Spawns what does not move: terrain, stairs, pillars.
    pub fn spawn_ground(&self, world: &mut World) {
        TERRAIN.spawn(world, self.tiles);
        for tile in 0..self.tiles() {
            let middle = self.middle(tile);
            for i in 0..STEPS {
                let half = half_width(i);
                let top = STAIRS + STEP * (i + 1) as f32;
                // The lowest one reaches down into the hollows of the terrain.
                let low = if i == 0 { LOWEST } else { top - STEP };
                block(
                    world,
                    Vec3::new(middle.x - half, low, middle.y - half),
                    Vec3::new(middle.x + half, top, middle.y + half),
                );
            }
            for i in 0..PILLARS {
                // Side by side they are a wall with an inner edge every 0.2 m.
                let at = middle + Vec2::new(8.0, 6.9 + 0.2 * i as f32);
                let foot = Self::height(at.x, at.y) - 0.5;
                block(
                    world,
                    Vec3::new(at.x - 0.1, foot, at.y - 0.1),
                    Vec3::new(at.x + 0.1, foot + 5.0, at.y + 0.1),
                );
            }
        }
    }

    /// Spawns 100 crates of 1 kg on each tile; their numbers begin with `first`.
    pub fn spawn_crates(&self, world: &mut World, first: u32) {
        for i in 0..self.tiles() * PER_TILE {
            let (middle, at) = self.place(i, Vec2::splat(0.5 * SPACING));
            let y = self.top(middle, at) + CRATE;
            world.spawn((
                StableId(first + i),
                RigidBody::Dynamic,
                Collider::cuboid(0.5 * CRATE, 0.5 * CRATE, 0.5 * CRATE),
                ColliderMassProperties::Mass(1.0),
                Velocity::default(),
                Transform::from_xyz(middle.x + at.x, y, middle.y + at.y),
            ));
        }
    }

    /// Place `i` of the grid of all tiles: middle of its tile, and the place relative to that.
    fn place(&self, i: u32, offset: Vec2) -> (Vec2, Vec2) {
        let k = i % PER_TILE;
        let cell = UVec2::new(k % ROWS, k / ROWS).as_vec2();
        let at = (cell - 0.5 * (ROWS - 1) as f32) * SPACING + offset;
        (self.middle(i / PER_TILE), at)
    }

    /// Where walker `i` starts with its foot: a little above the ground.
    pub fn start(&self, i: u32) -> Vec3 {
        let (middle, at) = self.place(i, Vec2::ZERO);
        let y = self.top(middle, at) + 0.5;
        Vec3::new(middle.x + at.x, y, middle.y + at.y)
    }

    /// Where somebody may stand for ever: on terrain no steeper than `steepest` radians and clear of
    /// the stairs, or on top of a step.
    pub fn resting_place(&self, i: u32, steepest: f32) -> Vec3 {
        let (middle, cell) = self.place(i, Vec2::ZERO);
        // Somewhere in the cell; a wave has level places in every cell.
        let found = (0..64)
            .map(|leg| {
                let jitter = Vec2::new(unit(i, leg, 3), unit(i, leg, 4)) - 0.5;
                cell + jitter * (SPACING - 1.0)
            })
            .find(|at| {
                let there = middle + at;
                at.abs().max_element() > half_width(0) + 0.5
                    && TERRAIN.slope(there.x, there.y) <= steepest
            })
            .unwrap_or(cell);
        let y = self.top(middle, found) + 0.05;
        Vec3::new(middle.x + found.x, y, middle.y + found.y)
    }

    /// The point that walker `i` goes to on a leg of its way; the height is of no meaning.
    pub fn target(&self, i: u32, leg: u32) -> Vec3 {
        let middle = self.middle(i / PER_TILE);
        let at = (Vec2::new(unit(i, leg, 0), unit(i, leg, 1)) - 0.5) * (TILE - 2.0);
        Vec3::new(middle.x + at.x, 0.0, middle.y + at.y)
    }

    /// How fast walker `i` goes on a leg of its way, metres per second.
    pub fn speed(i: u32, leg: u32) -> f32 {
        SLOWEST + (FASTEST - SLOWEST) * unit(i, leg, 2)
    }
}

/// Somebody who never stops walking. Steer it once per tick.
#[derive(Component, Clone, Copy, Debug)]
pub struct Walker {
    index: u32,
    leg: u32,
    ticks: u32,
    /// Level velocity that it wants, metres per second.
    pub wish: Vec3,
}

impl Walker {
    /// Walker number `index`, about to set out.
    pub fn new(index: u32) -> Self {
        Self {
            index,
            leg: 0,
            ticks: 0,
            wish: Vec3::ZERO,
        }
    }

    /// Decides where to go in the tick that follows, from where it is.
    pub fn steer(&mut self, wavy: &Wavy, at: Vec3) {
        let way = |leg| (wavy.target(self.index, leg) - at).with_y(0.0);
        let speed = Wavy::speed(self.index, self.leg);
        self.ticks += 1;
        if self.ticks > LEG || way(self.leg).length() < 2.0 * speed / 60.0 {
            self.leg += 1;
            self.ticks = 0;
        }
        let speed = Wavy::speed(self.index, self.leg);
        self.wish = way(self.leg).normalize_or(Vec3::X) * speed;
    }
}

/// Half the width of a step of the pyramid, metres.
fn half_width(step: u32) -> f32 {
    4.0 - 0.4 * step as f32
}

fn block(world: &mut World, low: Vec3, high: Vec3) {
    let half = (high - low) * 0.5;
    world.spawn((
        RigidBody::Fixed,
        Collider::cuboid(half.x, half.y, half.z),
        Transform::from_translation(low + half),
    ));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_walker_starts_and_walks_inside_its_own_tile() {
        let wavy = Wavy::for_characters(1000);
        for i in 0..1000 {
            let middle = wavy.middle(i / PER_TILE);
            for p in (0..20)
                .map(|leg| wavy.target(i, leg))
                .chain([wavy.start(i)])
            {
                let at = Vec2::new(p.x, p.z) - middle;
                assert!(at.abs().max_element() < 0.5 * TILE, "{i}: {at}");
            }
        }
    }

    #[test]
    fn resting_places_are_level_enough() {
        let wavy = Wavy::for_characters(1000);
        for i in 0..1000 {
            let p = wavy.resting_place(i, 0.6);
            let at = Vec2::new(p.x, p.z) - wavy.middle(i / PER_TILE);
            let on_stairs = at.abs().max_element() <= half_width(0);
            assert!(on_stairs || TERRAIN.slope(p.x, p.z) <= 0.6, "{i}");
        }
    }

    #[test]
    fn targets_spread_over_the_tile() {
        let wavy = Wavy::for_characters(100);
        let sum: Vec3 = (0..100)
            .flat_map(|i| (0..20).map(move |leg| wavy.target(i, leg)))
            .sum();
        assert!((sum / 2000.0).length() < 1.0, "{}", sum / 2000.0);
    }
}
