//! What the tests of the vehicle share: the reference car of the scenes, and random numbers.

use bevy::math::ops;

pub use embody_scenes::reference::*;

pub use crate::support::{Findings, G, RATES, edit, insert};

/// Random numbers, the same in every run.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 to 1.
    pub fn roll(&mut self) -> f32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((self.0 >> 40) as f32) / ((1u64 << 24) as f32)
    }

    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.roll()
    }

    /// Evenly over the orders of magnitude.
    pub fn scale(&mut self, low: f32, high: f32) -> f32 {
        ops::exp(self.between(ops::ln(low), ops::ln(high)))
    }
}
