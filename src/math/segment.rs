//! Closest points of segments. Source: C. Ericson, *Real-Time Collision Detection*, 5.1.

use bevy::math::{Vec3, Vec4};

use super::lanes::Lanes;

/// Parameters `(s, t)` in `0..=1` of the closest points of the segments `p0 + s·(p1 − p0)` and
/// `q0 + t·(q1 − q0)`. Segments without length are points.
#[inline]
pub(crate) fn closest_parameters(p0: Vec3, p1: Vec3, q0: Vec3, q1: Vec3) -> (f32, f32) {
    const TINY: f32 = 1.0e-12;
    let d1 = p1 - p0;
    let d2 = q1 - q0;
    let r = p0 - q0;
    let a = d1.dot(d1);
    let e = d2.dot(d2);
    let f = d2.dot(r);
    if a <= TINY && e <= TINY {
        return (0.0, 0.0);
    }
    if a <= TINY {
        return (0.0, (f / e).clamp(0.0, 1.0));
    }
    let c = d1.dot(r);
    if e <= TINY {
        return ((-c / a).clamp(0.0, 1.0), 0.0);
    }
    let b = d1.dot(d2);
    let denominator = a * e - b * b;
    let mut s = if denominator > 1.0e-9 * a * e {
        ((b * f - c * e) / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let mut t = (b * s + f) / e;
    if t < 0.0 {
        t = 0.0;
        s = (-c / a).clamp(0.0, 1.0);
    } else if t > 1.0 {
        t = 1.0;
        s = ((b - c) / a).clamp(0.0, 1.0);
    }
    (s, t)
}

/// As [`closest_parameters`], of one segment along `d1` and four along `d2` that have a length; `r`
/// leads from their starts to its start.
#[inline]
pub(crate) fn closest_parameters_of_four(d1: Vec3, d2: &Lanes, r: &Lanes) -> (Vec4, Vec4) {
    let a = d1.length_squared();
    let per_a = if a > 1.0e-12 { 1.0 / a } else { 0.0 };
    let d1 = Lanes::splat(d1);
    let b = d1.dot(d2);
    let c = d1.dot(r);
    let e = d2.dot(d2);
    let f = d2.dot(r);
    let unit = |v: Vec4| v.max(Vec4::ZERO).min(Vec4::ONE);
    let denominator = e * a - b * b;
    let skew = denominator.cmpgt(e * (1.0e-9 * a));
    let s = Vec4::select(skew, unit((b * f - c * e) / denominator), Vec4::ZERO);
    let t = (b * s + f) / e;
    let s = Vec4::select(t.cmplt(Vec4::ZERO), unit(-c * per_a), s);
    let s = Vec4::select(t.cmpgt(Vec4::ONE), unit((b - c) * per_a), s);
    (s, unit(t))
}

/// The point of the segment `q0 q1` closest to `p`.
#[inline]
pub(crate) fn closest_point(p: Vec3, q0: Vec3, q1: Vec3) -> Vec3 {
    let d = q1 - q0;
    let length2 = d.length_squared();
    if length2 <= 1.0e-12 {
        return q0;
    }
    q0 + d * ((p - q0).dot(d) / length2).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossing_segments_meet_where_they_cross() {
        let (s, t) = closest_parameters(
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(3.0, 0.0, 0.0),
            Vec3::new(0.0, -1.0, 1.0),
            Vec3::new(0.0, 1.0, 1.0),
        );
        assert!((s - 0.25).abs() < 1e-6 && (t - 0.5).abs() < 1e-6, "{s} {t}");
    }

    #[test]
    fn four_at_once_are_as_close_as_each_alone() {
        let mut seed = 9u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for round in 0..500 {
            let mut v = || Vec3::new(next(), next(), next());
            let (p0, mut p1, q) = (v(), v(), [v(), v(), v()]);
            if round % 10 == 0 {
                p1 = p0;
            }
            let from = Lanes::new(q[0], q[1], q[2]);
            let along = Lanes::new(q[1], q[2], q[0]).sub(&from);
            let (s, t) = closest_parameters_of_four(p1 - p0, &along, &Lanes::splat(p0).sub(&from));
            for i in 0..3 {
                let (q0, q1) = (q[i], q[(i + 1) % 3]);
                let gap = |s: f32, t: f32| p0.lerp(p1, s).distance(q0.lerp(q1, t));
                let (s1, t1) = closest_parameters(p0, p1, q0, q1);
                let (alone, together) = (gap(s1, t1), gap(s[i], t[i]));
                assert!((alone - together).abs() < 1e-5, "{alone} {together}");
            }
        }
    }

    #[test]
    fn no_sampled_pair_is_closer_than_the_closest_pair() {
        let mut seed = 1u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for _ in 0..500 {
            let mut v = || Vec3::new(next(), next(), next());
            let (p0, p1, q0, q1) = (v(), v(), v(), v());
            let (s, t) = closest_parameters(p0, p1, q0, q1);
            let best = (p0.lerp(p1, s) - q0.lerp(q1, t)).length();
            for i in 0..=20 {
                for j in 0..=20 {
                    let d = (p0.lerp(p1, i as f32 / 20.0) - q0.lerp(q1, j as f32 / 20.0)).length();
                    assert!(best <= d + 1e-5, "{best} > {d}");
                }
            }
        }
    }
}
