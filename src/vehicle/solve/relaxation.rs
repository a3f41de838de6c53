//! The exact step of a linear filter, in a form that an implicit solve can use.
//!
//! A carcass of stiffness `k` in series with a patch of compliance `c` follows the slip `s` by
//! `u' = s − k c u`. With `h = dt k c` and `s` constant over the tick it ends at
//! `u₁ = e^{−h} u + s dt (1 − e^{−h}) / h`, or
//!
//! `a u₁ = b u + dt s`, `a = h / (1 − e^{−h})`, `b = a − h = h / (e^h − 1)`.
//!
//! Without flow through the patch (`h = 0`) both are 1: a spring. With much, `a → h` and `b → 0`: the patch
//! alone, at once. The steady `u = dt s / h` is exact for every `h`. As `b ≤ 1` and `a − b = h ≥ 0`, a mass
//! on it never gains energy.

use bevy::math::Vec2;

/// The weights of one tick, along and across.
#[derive(Clone, Copy, Debug)]
pub(super) struct Relaxation {
    pub a: Vec2,
    pub b: Vec2,
    /// By how much `b` falls for each unit of `h`: `b (a − 1) / h`.
    pub falls: Vec2,
}

impl Relaxation {
    /// `h` is the tick in parts of the time in which the force builds up, at least 0.
    pub fn new(h: Vec2) -> Self {
        // From nothing, where all is 0 / 0, to where `b` is nothing in single precision.
        let held = h.clamp(Vec2::splat(1.0e-6), Vec2::splat(24.0));
        let inverse = growth(held).recip();
        let b = (held * inverse).min(Vec2::ONE);
        let a = b + h;
        Self {
            a,
            b,
            falls: (a - 1.0).max(Vec2::ZERO) * inverse,
        }
    }
}

/// `e^h − 1` of both axes at once, for `h` up to 24: that of `h / 8` by the continued fraction of the
/// hyperbolic tangent, doubled three times. Within 1e-6 of itself up to 10, where `b` is 5e-4.
fn growth(h: Vec2) -> Vec2 {
    let x = h * (1.0 / 16.0);
    let y = x * x;
    let top = x * (y * (y + 105.0) + 945.0);
    let bottom = y * (y * 15.0 + 420.0) + 945.0;
    let mut grown = top * 2.0 / (bottom - top);
    for _ in 0..3 {
        grown *= grown + 2.0;
    }
    grown
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::ops;

    #[test]
    fn a_step_is_the_filters_own_however_long() {
        for h in [
            0.0f32, 1.0e-4, 9.9e-3, 0.0101, 0.1, 0.667, 2.0, 20.0, 1.0e3, 1.0e12,
        ] {
            let filter = Relaxation::new(Vec2::splat(h));
            let (a, b) = (f64::from(filter.a.x), f64::from(filter.b.x));
            // From a stretch of 0.3 with a slip of 0.7 for each tick.
            let now = (b * 0.3 + 0.7) / a;
            let wide = f64::from(h);
            let share = if wide > 0.0 {
                -(-wide).exp_m1() / wide
            } else {
                1.0
            };
            let exact = 0.3 * (1.0 + (-wide).exp_m1()) + 0.7 * share;
            assert!((now - exact).abs() < 1.0e-6, "{h}: {now} for {exact}");
        }
    }

    #[test]
    fn a_mass_on_it_never_gains_energy_even_if_the_patch_changes() {
        let mut seed = 3u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 16_777_216.0
        };
        for _ in 0..200 {
            // `g = k dt² / m`; stretch and speed in units of one tick.
            let g = ops::exp((next() - 0.5) * 20.0);
            let (mut u, mut v) = (next() - 0.5, next() - 0.5);
            let mut energy = g * u * u + v * v;
            for _ in 0..50 {
                let h = ops::exp((next() - 0.7) * 20.0);
                let filter = Relaxation::new(Vec2::splat(h));
                u = (filter.b.x * u + v) / (filter.a.x + g);
                v -= g * u;
                let now = g * u * u + v * v;
                assert!(now <= energy * (1.0 + 1.0e-5), "{g} {h}: {energy} to {now}");
                energy = now;
            }
        }
    }

    #[test]
    fn the_fall_of_the_weight_is_its_slope() {
        for h in [0.02f32, 0.3, 1.0, 4.0] {
            let filter = Relaxation::new(Vec2::splat(h));
            let weight = |h: f32| Relaxation::new(Vec2::splat(h)).b.x;
            let slope = (weight(h + 1.0e-2) - weight(h - 1.0e-2)) / 2.0e-2;
            assert!(
                (filter.falls.x + slope).abs() < 2.0e-3,
                "{h}: {filter:?} {slope}"
            );
        }
    }
}
