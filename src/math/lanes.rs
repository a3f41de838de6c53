//! Four vectors at once, one to a lane of the processor's short vectors.

use bevy::math::{Vec3, Vec4};

/// Four vectors by their coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes {
    x: Vec4,
    y: Vec4,
    z: Vec4,
}

impl Lanes {
    /// Three vectors, the last one twice.
    #[inline]
    pub fn new(a: Vec3, b: Vec3, c: Vec3) -> Self {
        Self {
            x: Vec4::new(a.x, b.x, c.x, c.x),
            y: Vec4::new(a.y, b.y, c.y, c.y),
            z: Vec4::new(a.z, b.z, c.z, c.z),
        }
    }

    /// One vector in every lane.
    #[inline]
    pub fn splat(v: Vec3) -> Self {
        Self {
            x: Vec4::splat(v.x),
            y: Vec4::splat(v.y),
            z: Vec4::splat(v.z),
        }
    }

    #[inline]
    pub fn add(&self, other: &Self) -> Self {
        Self {
            x: self.x + other.x,
            y: self.y + other.y,
            z: self.z + other.z,
        }
    }

    #[inline]
    pub fn sub(&self, other: &Self) -> Self {
        Self {
            x: self.x - other.x,
            y: self.y - other.y,
            z: self.z - other.z,
        }
    }

    /// Each vector by its own factor.
    #[inline]
    pub fn scaled(&self, by: Vec4) -> Self {
        Self {
            x: self.x * by,
            y: self.y * by,
            z: self.z * by,
        }
    }

    #[inline]
    pub fn dot(&self, other: &Self) -> Vec4 {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    #[inline]
    pub fn cross(&self, other: &Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
}
