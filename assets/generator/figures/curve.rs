//! Closed-form curves over time.

#![expect(
    clippy::disallowed_methods,
    reason = "in double precision and rounded to single right away"
)]

use std::f64::consts::TAU;

/// Sine of turns: one is a whole cycle.
pub fn wave(turns: f64) -> f64 {
    (turns * TAU).sin()
}

/// Smooth from zero to one with rest at both ends, also in acceleration.
pub fn ease(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

/// A hill of height one over 0..1, flat at both ends.
pub fn hill(t: f64) -> f64 {
    if (0.0..=1.0).contains(&t) {
        0.5 - 0.5 * (t * TAU).cos()
    } else {
        0.0
    }
}

/// Steep at both ends of 0..1 and next to nothing between: keeps a sole that has left the ground, or
/// is about to come down, from grazing it.
pub fn clear(t: f64) -> f64 {
    let (a, b) = (t * t, (1.0 - t) * (1.0 - t));
    t * (1.0 - t) * (b * b + 0.8 * a * a)
}

/// Cubic from a value and slope at 0 to a value and slope at 1.
pub fn hermite([p, q]: [f64; 2], [u, v]: [f64; 2], t: f64) -> f64 {
    let (t2, t3) = (t * t, t * t * t);
    p * (2.0 * t3 - 3.0 * t2 + 1.0)
        + u * (t3 - 2.0 * t2 + t)
        + q * (3.0 * t2 - 2.0 * t3)
        + v * (t3 - t2)
}

/// A smooth curve through keys of (time, value) that never overshoots them; rests at the ends.
pub fn keys(keys: &[(f64, f64)], t: f64) -> f64 {
    let last = keys.len() - 1;
    if t <= keys[0].0 {
        return keys[0].1;
    }
    if t >= keys[last].0 {
        return keys[last].1;
    }
    let rise = |i: usize| (keys[i + 1].1 - keys[i].1) / (keys[i + 1].0 - keys[i].0);
    // Harmonic mean of the neighbours' slopes, none at a turning point.
    let slope = |i: usize| {
        if i == 0 || i == last || rise(i - 1) * rise(i) <= 0.0 {
            0.0
        } else {
            2.0 * rise(i - 1) * rise(i) / (rise(i - 1) + rise(i))
        }
    };
    let i = (0..last).find(|&i| t < keys[i + 1].0).unwrap_or(last - 1);
    let length = keys[i + 1].0 - keys[i].0;
    hermite(
        [keys[i].1, keys[i + 1].1],
        [slope(i) * length, slope(i + 1) * length],
        (t - keys[i].0) / length,
    )
}
