//! Capsules and boxes around the points of a skin.
//!
//! A capsule's axis is given, or taken from the spread of the points. Across it, a circle is fitted by
//! least squares to the points beside the straight part, which finds the middle also where only a part of
//! the way round is covered; the ends follow from the farthest points. A share of the points may lie
//! anywhere.

use bevy::{math::Vec2, prelude::*};

use crate::ragdoll::profile::BoneShape;

/// Part of the points that may lie beyond either end.
const STRAY: f32 = 0.005;
/// Fewer points than this tell no shape.
const FEWEST: usize = 12;

/// The capsule around points of its surface. `axis` is its direction, if known. `None` for too few points,
/// or such as span nothing.
///
/// Points spread evenly over a capsule give it back, to about 2 % with some hundreds of them.
pub fn fit_capsule(points: &[Vec3], axis: Option<Vec3>) -> Option<BoneShape> {
    if points.len() < FEWEST || !points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let mean = mean(points);
    let axis = axis.and_then(Vec3::try_normalize);
    let axis = axis.unwrap_or_else(|| spread(points, mean).x_axis);
    let (side, front) = axis.any_orthonormal_pair();
    let flat = |p: &Vec3| Vec2::new((p - mean).dot(side), (p - mean).dot(front));
    let mut along: Vec<f32> = points.iter().map(|p| (p - mean).dot(axis)).collect();
    along.sort_unstable_by(f32::total_cmp);
    let stray = (STRAY * points.len() as f32) as usize;
    let (low, high) = (along[stray], along[along.len() - 1 - stray]);
    // What is even by area on a tube or a ball is even along it: so far the ends are beyond.
    let missing = (stray as f32 + 0.5) / points.len() as f32;
    let beyond = (high - low) * missing / (1.0 - 2.0 * missing);
    let (low, high) = (low - beyond, high + beyond);
    let length = high - low;
    if !(length > 1.0e-5) {
        return None;
    }
    // What is beside the straight part depends on the radius of its ends: by turns.
    let (mut radius, mut center) = (0.25 * length, Vec2::ZERO);
    for _ in 0..8 {
        let inset = radius.min(0.4 * length);
        let beside: Vec<Vec2> = (points.iter())
            .filter(|p| {
                let t = (**p - mean).dot(axis);
                t >= low + inset && t <= high - inset
            })
            .map(flat)
            .collect();
        let Some((c, r)) = circle(&beside) else { break };
        (center, radius) = (c, r);
    }
    let radius = radius.min(0.5 * length);
    let middle = mean + side * center.x + front * center.y;
    (radius > 1.0e-5 && radius.is_finite()).then(|| BoneShape::Capsule {
        from: middle + axis * (low + radius),
        to: middle + axis * (high - radius),
        radius,
    })
}

/// The box with these axes around points of its surface. `None` for too few points, or such as span
/// nothing.
pub fn fit_box(points: &[Vec3], rotation: Quat) -> Option<BoneShape> {
    if points.len() < FEWEST || !points.iter().all(|p| p.is_finite()) {
        return None;
    }
    let stray = (4.0 * STRAY * points.len() as f32) as usize;
    let (mut low, mut high) = (Vec3::ZERO, Vec3::ZERO);
    for axis in 0..3 {
        let mut along: Vec<f32> = (points.iter())
            .map(|p| (rotation.inverse() * *p)[axis])
            .collect();
        along.sort_unstable_by(f32::total_cmp);
        (low[axis], high[axis]) = (along[stray], along[along.len() - 1 - stray]);
    }
    let half = (high - low) * 0.5;
    (half.min_element() > 1.0e-5).then(|| BoneShape::Box {
        center: rotation * ((low + high) * 0.5),
        rotation,
        half,
    })
}

fn mean(points: &[Vec3]) -> Vec3 {
    // Relative to the first: far from the origin no digit is lost.
    let first = points[0];
    let sum: Vec3 = points.iter().map(|p| *p - first).sum();
    first + sum / points.len() as f32
}

/// Axes of the spread of points, the widest first.
fn spread(points: &[Vec3], mean: Vec3) -> Mat3 {
    let mut m = Mat3::ZERO;
    for p in points {
        let d = *p - mean;
        m += Mat3::from_cols(d * d.x, d * d.y, d * d.z);
    }
    // Power iteration finds the widest axis, which is all that is needed.
    let mut axis = m * Vec3::new(0.577, 0.578, 0.576);
    for _ in 0..64 {
        axis = (m * axis).normalize_or(Vec3::Y);
    }
    let (side, front) = axis.any_orthonormal_pair();
    Mat3::from_cols(axis, side, front)
}

/// Centre and radius of the circle nearest to points, by the least squares of their power.
fn circle(points: &[Vec2]) -> Option<(Vec2, f32)> {
    if points.len() < 6 {
        return None;
    }
    let n = points.len() as f32;
    let middle = points.iter().sum::<Vec2>() / n;
    let (mut xx, mut xy, mut yy, mut xz, mut yz, mut zz) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for p in points {
        let d = *p - middle;
        let z = d.length_squared();
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
        xz += d.x * z;
        yz += d.y * z;
        zz += z;
    }
    let det = xx * yy - xy * xy;
    // On a line there is no circle.
    if !(det > 1.0e-4 * xx.max(yy) * xx.max(yy)) {
        return None;
    }
    let c = Vec2::new(yy * xz - xy * yz, xx * yz - xy * xz) / (2.0 * det);
    let radius = (c.length_squared() + zz / n).sqrt();
    radius.is_finite().then_some((middle + c, radius))
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::ops;
    use core::f32::consts::TAU;

    /// Points spread evenly over the surface of a capsule along a part of the way round.
    fn sampled(from: Vec3, to: Vec3, radius: f32, count: u32, around: f32) -> Vec<Vec3> {
        let axis = (to - from).normalize_or(Vec3::Y);
        let (side, front) = axis.any_orthonormal_pair();
        let (tube, ends) = (from.distance(to), 2.0 * radius);
        (0..count)
            .map(|i| {
                // By height and angle is even by area, on the tube and on a ball.
                let t = (i as f32 + 0.5) / count as f32 * (tube + ends) - radius;
                let (sin, cos) = ops::sin_cos(i as f32 * 2.399_963 % TAU * around);
                let over = (t.clamp(0.0, tube) - t).abs();
                let r = (radius * radius - over * over).max(0.0).sqrt();
                from + axis * t + (side * cos + front * sin) * r
            })
            .collect()
    }

    fn off(found: BoneShape, from: Vec3, to: Vec3, radius: f32) -> f32 {
        let BoneShape::Capsule {
            from: a,
            to: b,
            radius: r,
        } = found
        else {
            return f32::MAX;
        };
        let straight = a.distance(from).max(b.distance(to));
        let crossed = a.distance(to).max(b.distance(from));
        straight.min(crossed).max((r - radius).abs()) / radius
    }

    #[test]
    fn points_of_a_capsule_give_it_back_within_two_percent_of_its_radius() {
        for (from, to, radius) in [
            (Vec3::ZERO, Vec3::NEG_Y * 0.3, 0.05),
            (Vec3::new(5.0, 1.0, -3.0), Vec3::new(5.2, 0.7, -2.9), 0.07),
            (Vec3::ZERO, Vec3::new(0.4, 0.3, 0.1), 0.12),
        ] {
            for count in [200, 1000] {
                let points = sampled(from, to, radius, count, 1.0);
                for axis in [Some(to - from), None] {
                    let found = fit_capsule(&points, axis).map(|c| off(c, from, to, radius));
                    let bound = 0.02;
                    assert!(
                        found.is_some_and(|off| off < bound),
                        "{from} {to} {radius}, {count}, {axis:?}: {found:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn half_of_the_way_round_is_enough() {
        let (from, to, radius) = (Vec3::X, Vec3::new(1.0, 0.4, 0.0), 0.06);
        let points = sampled(from, to, radius, 800, 0.5);
        let found = fit_capsule(&points, Some(to - from)).map(|c| off(c, from, to, radius));
        assert!(found.is_some_and(|off| off < 0.05), "{found:?}");
    }

    #[test]
    fn points_of_a_box_give_it_back() {
        let half = Vec3::new(0.15, 0.1, 0.08);
        let rotation = Quat::from_euler(EulerRot::XYZ, 0.4, -0.3, 1.0);
        let center = Vec3::new(0.1, -2.0, 0.3);
        let mut points = Vec::new();
        for i in 0..600 {
            let f = |k: i32| ((i * k) % 101) as f32 / 50.0 - 1.0;
            let mut p = Vec3::new(f(7), f(31), f(57));
            p[(i % 3) as usize] = if i % 2 == 0 { 1.0 } else { -1.0 };
            points.push(center + rotation * (p * half));
        }
        let Some(BoneShape::Box {
            center: c, half: h, ..
        }) = fit_box(&points, rotation)
        else {
            panic!("no box");
        };
        assert!(
            c.distance(center) < 2.0e-3 && h.distance(half) < 2.0e-3,
            "{c} {h}"
        );
    }

    #[test]
    fn what_spans_nothing_has_no_shape() {
        assert_eq!(fit_capsule(&[Vec3::ONE; 40], None), None);
        assert_eq!(fit_capsule(&[], None), None);
        assert_eq!(fit_box(&[Vec3::X; 40], Quat::IDENTITY), None);
        let mut points = sampled(Vec3::ZERO, Vec3::Y, 0.1, 100, 1.0);
        points[7].x = f32::NAN;
        assert_eq!(fit_capsule(&points, None), None);
    }
}
