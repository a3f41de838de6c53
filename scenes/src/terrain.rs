//! Wavy ground that goes on for ever, and how large scenes are laid out on it.
//!
//! A large scene is made of equal square tiles with equally many inhabitants, so it is exactly as
//! dense as a small one. Choices come from a hash of an inhabitant's number, the same on every
//! platform.

use bevy::{
    math::{UVec2, ops},
    prelude::*,
};
use bevy_rapier3d::prelude::*;

/// A number for an entity that does not depend on how or when it was spawned.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StableId(pub u32);

/// Ground of crossing waves on square tiles, as one mesh.
#[derive(Clone, Copy, Debug)]
pub struct Waves {
    /// Edge of a tile, metres.
    pub tile: f32,
    /// Quads along the edge of a tile.
    pub quads: u32,
    /// Metres.
    pub amplitude: f32,
    /// Waves along the edge of a tile: a whole number, so that tiles are alike.
    pub waves: f32,
}

impl Waves {
    /// Height of the ground, metres.
    pub fn height(&self, x: f32, z: f32) -> f32 {
        let k = core::f32::consts::TAU * self.waves / self.tile;
        self.amplitude * ops::sin(k * x) * ops::cos(k * z)
    }

    /// Angle of the ground to level, radians.
    pub fn slope(&self, x: f32, z: f32) -> f32 {
        let d = 0.5 * self.quad();
        let dx = self.height(x + d, z) - self.height(x - d, z);
        let dz = self.height(x, z + d) - self.height(x, z - d);
        ops::atan2(Vec2::new(dx, dz).length(), 2.0 * d)
    }

    /// Edge of a quad, metres.
    fn quad(&self) -> f32 {
        self.tile / self.quads as f32
    }

    /// Middle of a tile, metres.
    pub fn middle(&self, tiles: UVec2, tile: u32) -> Vec2 {
        let at = UVec2::new(tile % tiles.x, tile / tiles.x);
        (at.as_vec2() - (tiles.as_vec2() - 1.0) * 0.5) * self.tile
    }

    /// The ground of all tiles as one mesh.
    pub fn mesh(&self, tiles: UVec2) -> Option<Collider> {
        let quads = tiles * self.quads;
        let low = -0.5 * self.tile * tiles.as_vec2();
        let vertices = (0..=quads.y)
            .flat_map(|j| (0..=quads.x).map(move |i| (i, j)))
            .map(|(i, j)| {
                let x = low.x + self.quad() * i as f32;
                let z = low.y + self.quad() * j as f32;
                Vec3::new(x, self.height(x, z), z)
            })
            .collect();
        let row = quads.x + 1;
        let indices = (0..quads.y)
            .flat_map(|j| (0..quads.x).map(move |i| j * row + i))
            .flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]])
            .collect();
        Collider::trimesh(vertices, indices).ok()
    }

    /// Spawns the ground of all tiles.
    pub fn spawn(&self, world: &mut World, tiles: UVec2) {
        if let Some(mesh) = self.mesh(tiles) {
            world.spawn((RigidBody::Fixed, mesh, Transform::default()));
        }
    }
}

/// Rows of tiles with room for this many: the least number of tiles, as nearly square as they can
/// be laid out.
pub fn tiles_for(count: u32, per_tile: u32) -> UVec2 {
    let count = count.div_ceil(per_tile).max(1);
    let rows = (1..=count)
        .take_while(|rows| rows * rows <= count)
        .filter(|rows| count.is_multiple_of(*rows))
        .last()
        .unwrap_or(1);
    UVec2::new(count / rows, rows)
}

/// A number from 0 to 1 that looks random.
pub fn unit(i: u32, leg: u32, what: u32) -> f32 {
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
        for (count, tiles) in [
            (1, (1, 1)),
            (100, (1, 1)),
            (1000, (5, 2)),
            (10_000, (10, 10)),
        ] {
            assert_eq!(tiles_for(count, 100), UVec2::from(tiles));
        }
    }

    #[test]
    fn a_tile_has_two_triangles_to_a_quad() {
        let waves = Waves {
            tile: 50.0,
            quads: 100,
            amplitude: 2.0,
            waves: 3.0,
        };
        let count = waves
            .mesh(UVec2::ONE)
            .and_then(|c| c.as_trimesh().map(|mesh| mesh.indices().len()));
        assert_eq!(count, Some(20_000));
    }
}
