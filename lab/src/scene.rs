//! A world to measure.

use crate::subject::Build;

/// A world to measure.
pub struct Scene {
    pub name: &'static str,
    pub about: &'static str,
    /// Ticks until it is as it stays.
    pub warm_up: usize,
    /// Fills an empty world with this many.
    pub build: Build,
}
