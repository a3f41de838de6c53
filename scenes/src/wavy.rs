//! A crowd on wavy terrain with stairs, pillars and crates: the scene in which the cost per
//! character is measured.
//!
//! The world is made of equal tiles of 50 m for 100 characters each, so a larger crowd is exactly
//! as dense as a small one. Everybody walks to a point of the own tile, and on to another one on
//! arrival or after two seconds; nobody ever stands still by choice. Points and speeds come from a
//! hash of the walker's number and the leg, the same on every platform.

use bevy::{
    math::{UVec2, ops},
    prelude::*,
};
use bevy_rapier3d::prelude::*;

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
/// Edge of a quad of the terrain, metres.
const QUAD: f32 = 0.5;
const QUADS: u32 = 100;
const AMPLITUDE: f32 = 2.0;
/// Waves along the edge of a tile: a whole number, so that tiles are alike. The terrain is 37
/// degrees steep at most.
const WAVES: f32 = 3.0;
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

/// A number for an entity that does not depend on how or when it was spawned.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StableId(pub u32);

/// The world of a crowd.
#[derive(Clone, Copy, Debug)]
pub struct Wavy {
    tiles: UVec2,
}

impl Wavy {
    /// A world with room for this many characters: the least number of tiles, as nearly square as
    /// they can be laid out.
    pub fn for_characters(characters: u32) -> Self {
        let count = characters.div_ceil(PER_TILE).max(1);
        let rows = (1..=count)
            .take_while(|rows| rows * rows <= count)
            .filter(|rows| count.is_multiple_of(*rows))
            .last()
            .unwrap_or(1);
        Self {
            tiles: UVec2::new(count / rows, rows),
        }
    }

    /// Number of tiles.
    pub fn tiles(&self) -> u32 {
        self.tiles.x * self.tiles.y
    }

    /// Height of the terrain, metres.
    pub fn height(x: f32, z: f32) -> f32 {
        let k = core::f32::consts::TAU * WAVES / TILE;
        AMPLITUDE * ops::sin(k * x) * ops::cos(k * z)
    }

    /// Angle of the terrain to level, radians.
    pub fn slope(x: f32, z: f32) -> f32 {
        let d = 0.5 * QUAD;
        let dx = Self::height(x + d, z) - Self::height(x - d, z);
        let dz = Self::height(x, z + d) - Self::height(x, z - d);
        ops::atan2(Vec2::new(dx, dz).length(), 2.0 * d)
    }

    /// Middle of a tile, metres.
    fn middle(&self, tile: u32) -> Vec2 {
        let at = UVec2::new(tile % self.tiles.x, tile / self.tiles.x);
        (at.as_vec2() - (self.tiles.as_vec2() - 1.0) * 0.5) * TILE
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
        if let Some(terrain) = self.terrain() {
            world.spawn((RigidBody::Fixed, terrain, Transform::default()));
        }
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

    /// The whole terrain as one mesh.
    fn terrain(&self) -> Option<Collider> {
        let quads = self.tiles * QUADS;
        let low = -0.5 * TILE * self.tiles.as_vec2();
        let vertices = (0..=quads.y)
            .flat_map(|j| (0..=quads.x).map(move |i| (i, j)))
            .map(|(i, j)| {
                let (x, z) = (low.x + QUAD * i as f32, low.y + QUAD * j as f32);
                Vec3::new(x, Self::height(x, z), z)
            })
            .collect();
        let row = quads.x + 1;
        let indices = (0..quads.y)
            .flat_map(|j| (0..quads.x).map(move |i| j * row + i))
            .flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]])
            .collect();
        Collider::trimesh(vertices, indices).ok()
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
                    && Self::slope(there.x, there.y) <= steepest
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

/// A number from 0 to 1 that looks random.
fn unit(i: u32, leg: u32, what: u32) -> f32 {
    // The finaliser of a common 64-bit mixing function.
    let mut h = u64::from(i) << 40 | u64::from(leg) << 8 | u64::from(what);
    h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    h ^= h >> 31;
    (h >> 40) as f32 / (1u32 << 24) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_laid_out_as_nearly_square_as_they_can_be() {
        for (characters, tiles) in [
            (1, (1, 1)),
            (100, (1, 1)),
            (1000, (5, 2)),
            (10_000, (10, 10)),
        ] {
            assert_eq!(Wavy::for_characters(characters).tiles, UVec2::from(tiles));
        }
    }

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
            assert!(on_stairs || Wavy::slope(p.x, p.z) <= 0.6, "{i}");
        }
    }

    #[test]
    fn the_terrain_of_a_tile_has_20_000_triangles() {
        let terrain = Wavy::for_characters(100).terrain();
        let count = terrain.and_then(|c| c.as_trimesh().map(|mesh| mesh.indices().len()));
        assert_eq!(count, Some(20_000));
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
