//! How a spring and damper are integrated over one tick.
//!
//! The force is constant over the tick; the physics step then moves the body by
//! `dt ((1 − θ) v₀ + θ v₁)`, with `θ = (n + 1) / 2n` for its `n` substeps. The force is taken at
//!
//! `F = k (x₀ + dt (a v₀ + b v₁)) + c ((1 − q) v₀ + q v₁)`, with `v₁` the velocity it leads to.
//!
//! With `q = ½`, `a + b = 1 − θ` and `b = 1/12` the motion of a soft spring is that of the exact
//! solution to second order (its eigenvalues are, by expansion in `dt`), so ride frequency and
//! overshoot do not depend on the tick rate. With growing stiffness `b → 1`, `a → 1 − θ`, and with
//! growing damping `q → 1`: the stiff limit stops dead within two ticks, as an L-stable method does.
//! For every mode of the vehicle the map is a contraction; there is no limit on `k`, `c` or `dt`.
//!
//! A vehicle at rest feels `F = k x₀` exactly: sag does not depend on the tick rate.

/// Weights of one wheel's force over one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scheme {
    pub a: f32,
    pub b: f32,
    pub q: f32,
}

impl Scheme {
    /// `k` and `c` in SI units, `mobility` the greatest velocity per impulse that the wheel's modes
    /// show (1/kg), `theta` as above.
    pub fn new(k: f32, c: f32, mobility: f32, dt: f32, theta: f32) -> Self {
        let stiff = k * dt * dt * mobility;
        let damped = c * dt * mobility;
        let hard = stiff * stiff / (stiff * stiff + 4.0);
        let b = hard + (1.0 - hard) / 12.0;
        Self {
            a: (1.0 - theta) + hard - b,
            b,
            q: damping_weight(damped),
        }
    }
}

/// The weight that makes a pure damper exact, `1 / (1 − e^{−g}) − 1 / g`, to 0.02: ½ at 0, 1 at ∞.
fn damping_weight(g: f32) -> f32 {
    // Beyond this the weight is 1 in single precision.
    let g = g.clamp(0.0, 1.0e8);
    0.5 + 0.5 * g * (g + 4.0) / (g * g + 6.0 * g + 24.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::ops;

    /// One mass on a spring through `n` ticks, from `x` and `v`: all compressions.
    fn run(k: f32, c: f32, m: f32, dt: f32, n: usize, x: f32) -> Vec<f32> {
        let theta = 0.625;
        let s = Scheme::new(k, c, 1.0 / m, dt, theta);
        let (mut x, mut v) = (x, 0.0);
        (0..n)
            .map(|_| {
                let free = k * (x + dt * s.a * v) + c * (1.0 - s.q) * v;
                let gain = dt * s.b * k + s.q * c;
                let v1 = (v - dt / m * free) / (1.0 + dt / m * gain);
                x += dt * ((1.0 - theta) * v + theta * v1);
                v = v1;
                x
            })
            .collect()
    }

    #[test]
    fn a_quarter_car_overshoots_as_much_at_every_tick_rate() {
        for ratio in [0.2f32, 0.5] {
            let m = 375.0;
            let w = core::f32::consts::TAU * 1.5;
            let exact = ops::exp(-core::f32::consts::PI * ratio / (1.0 - ratio * ratio).sqrt());
            for hz in [30.0, 60.0, 120.0, 240.0] {
                let path = run(
                    m * w * w,
                    2.0 * ratio * w * m,
                    m,
                    1.0 / hz,
                    hz as usize,
                    1.0,
                );
                let low = path.iter().copied().fold(0.0, f32::min);
                assert!(
                    (-low - exact).abs() < 0.02,
                    "{hz} {ratio}: {low} for {exact}"
                );
            }
        }
    }

    #[test]
    fn no_stiffness_or_damping_makes_it_grow() {
        for k in [0.0, 1.0e3, 1.0e4, 1.0e5, 1.0e6, 1.0e7, 1.0e8, 1.0e10] {
            for c in [0.0, 1.0e2, 1.0e4, 1.0e6, 1.0e8] {
                for hz in [20.0, 30.0, 60.0, 240.0] {
                    let path = run(k, c, 375.0, 1.0 / hz, 400, 0.1);
                    let first = path[..40].iter().fold(0.1f32, |a, b| a.max(b.abs()));
                    let last = path[300..].iter().fold(0.0f32, |a, b| a.max(b.abs()));
                    assert!(last <= first * 1.001, "{k} {c} {hz}: {first} to {last}");
                }
            }
        }
    }

    #[test]
    fn the_damping_weight_is_that_of_the_exact_solution() {
        for g in [0.05f32, 0.3, 1.0, 3.0, 10.0, 50.0] {
            let exact = 1.0 / (1.0 - ops::exp(-g)) - 1.0 / g;
            let off = damping_weight(g) - exact;
            assert!(off.abs() < 0.02, "{g}: {} for {exact}", damping_weight(g));
        }
    }
}
