//! The nearest point of a polyhedron given by half-spaces: where a motion goes that walls bend.
//!
//! Minimises `|x − x₀|²` under `nᵢ·x ≥ bᵢ`. In three dimensions at most three constraints are
//! active, so all sets of one, two and three are tried, and the one that meets the
//! Karush-Kuhn-Tucker conditions (all constraints kept, all multipliers positive) is the answer.
//! It is unique: the result does not depend on the order of the planes, a corner cannot swing or
//! jitter, and a motion is never reversed by resting walls. Solved in double precision; no
//! iteration, no stability limit. Cost grows with the cube of the number of planes, so planes that
//! are one but for rounding are merged ([`add`]), as under a flat foot on a fine mesh, and of more
//! than [`MAX_PLANES`] those that are kept least are taken first.

use bevy::math::{DMat3, DVec3, Vec3};

/// Most planes that one solve takes into account.
pub(crate) const MAX_PLANES: usize = 24;

/// A half-space `normal · x ≥ bound`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HalfSpace {
    pub normal: DVec3,
    pub bound: f64,
    /// Who gives way when not all can be kept: the higher number first.
    pub yields: u8,
}

impl HalfSpace {
    /// The half-space of points at least `bound` along `normal`, who yields `yields`.
    pub fn new(normal: Vec3, bound: f32, yields: u8) -> Self {
        Self {
            // Single precision leaves it longer or shorter than one by more than the tolerance.
            normal: normal.as_dvec3().normalize_or_zero(),
            bound: f64::from(bound),
            yields,
        }
    }
}

/// Normals whose cosine differs from one by less are one normal: an angle of 14 microradians.
const SAME: f64 = 1.0e-10;

/// Adds a plane; of planes with the same normal the one that asks most stays.
pub(crate) fn add(planes: &mut Vec<HalfSpace>, plane: HalfSpace) {
    let known = planes
        .iter_mut()
        .find(|p| p.yields == plane.yields && p.normal.dot(plane.normal) > 1.0 - SAME);
    match known {
        Some(known) if known.bound < plane.bound => *known = plane,
        Some(_) => {}
        None => planes.push(plane),
    }
}

/// Slack on every plane, metres.
const TOLERANCE: f64 = 1.0e-9;
/// Slack on every plane per metre of motion: normals come in single precision, and two walls that
/// face each other but for its rounding would else make a wedge that nothing leaves.
const ROUNDING: f64 = 2.0e-7;
/// An answer farther than this many times the largest push comes out of planes that are parallel
/// but for rounding, or out of a wedge so sharp that what it presses on gives way before.
const FAR: f64 = 3.0;

/// The nearest point to `x0` that keeps all `planes`, or `None` if there is none.
pub(crate) fn nearest(x0: DVec3, planes: &[HalfSpace]) -> Option<DVec3> {
    let slack = TOLERANCE + ROUNDING * x0.length();
    let push = planes.iter().map(|p| p.bound).fold(0.0, f64::max);
    // Where nothing pushes, standing still is allowed, so the nearest point is no farther than `x0`.
    let most = x0.length() + FAR * push + slack;
    let keeps = |x: DVec3| {
        planes.iter().all(|p| p.normal.dot(x) >= p.bound - slack)
            && x.length_squared() <= most * most
    };
    if keeps(x0) {
        return Some(x0);
    }
    let count = planes.len().min(MAX_PLANES);
    let planes_used = &planes[..count];
    for p in planes_used {
        let lift = p.bound - p.normal.dot(x0);
        if lift > 0.0 {
            let x = x0 + p.normal * lift;
            if keeps(x) {
                return Some(x);
            }
        }
    }
    for (i, p) in planes_used.iter().enumerate() {
        for q in &planes_used[i + 1..] {
            if let Some(x) = on_two(x0, p, q)
                && keeps(x)
            {
                return Some(x);
            }
        }
    }
    for (i, p) in planes_used.iter().enumerate() {
        for (j, q) in planes_used.iter().enumerate().skip(i + 1) {
            for r in &planes_used[j + 1..] {
                if let Some(x) = on_three(x0, p, q, r)
                    && keeps(x)
                {
                    return Some(x);
                }
            }
        }
    }
    // Rounding hides a corner in which nothing but standing still is left.
    (push <= 0.0).then_some(DVec3::ZERO)
}

/// The nearest point to `x0` on two planes, if both push.
fn on_two(x0: DVec3, p: &HalfSpace, q: &HalfSpace) -> Option<DVec3> {
    let c = p.normal.dot(q.normal);
    let determinant = 1.0 - c * c;
    if determinant < 1.0e-10 {
        return None;
    }
    let u = p.bound - p.normal.dot(x0);
    let v = q.bound - q.normal.dot(x0);
    let l = (u - c * v) / determinant;
    let m = (v - c * u) / determinant;
    (l >= 0.0 && m >= 0.0).then(|| x0 + p.normal * l + q.normal * m)
}

/// The common point of three planes, if all push.
fn on_three(x0: DVec3, p: &HalfSpace, q: &HalfSpace, r: &HalfSpace) -> Option<DVec3> {
    let normals = DMat3::from_cols(p.normal, q.normal, r.normal);
    let determinant = normals.determinant();
    if determinant.abs() < 1.0e-8 {
        return None;
    }
    let rows = normals.transpose();
    let need = DVec3::new(p.bound, q.bound, r.bound) - rows * x0;
    let step = rows.inverse() * need;
    let multipliers = normals.inverse() * step;
    (multipliers.min_element() >= -1.0e-9).then(|| x0 + step)
}

/// The nearest point to `x0` that keeps the planes, leaving out as few as needed when they
/// contradict each other: those that yield most, and of these the most violated. Returns the
/// point and whether any was left out.
pub(crate) fn nearest_yielding(x0: DVec3, planes: &mut Vec<HalfSpace>) -> (DVec3, bool) {
    if planes.len() > MAX_PLANES {
        let lift = |p: &HalfSpace| p.bound - p.normal.dot(x0);
        planes.sort_unstable_by(|a, b| {
            lift(b)
                .total_cmp(&lift(a))
                .then(a.normal.x.total_cmp(&b.normal.x))
                .then(a.normal.y.total_cmp(&b.normal.y))
                .then(a.normal.z.total_cmp(&b.normal.z))
        });
    }
    let mut left_out = false;
    loop {
        if let Some(x) = nearest(x0, planes) {
            return (x, left_out);
        }
        left_out = true;
        let worst = planes
            .iter()
            .enumerate()
            .max_by(|(_, a), (_, b)| {
                let lift = |p: &HalfSpace| p.bound - p.normal.dot(x0);
                a.yields.cmp(&b.yields).then(lift(a).total_cmp(&lift(b)))
            })
            .map(|(i, _)| i);
        match worst {
            Some(i) => {
                planes.swap_remove(i);
            }
            None => return (DVec3::ZERO, true),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(normal: DVec3, bound: f64) -> HalfSpace {
        HalfSpace {
            normal: normal.normalize(),
            bound,
            yields: 0,
        }
    }

    fn random_unit(seed: &mut u64) -> DVec3 {
        let mut next = || {
            *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        DVec3::new(next(), next(), next()).normalize()
    }

    #[test]
    fn one_wall_takes_out_the_normal_part() {
        let x = nearest(DVec3::new(1.0, -1.0, 0.5), &[plane(DVec3::Y, 0.0)]).unwrap();
        assert!(x.distance(DVec3::new(1.0, 0.0, 0.5)) < 1e-12);
    }

    #[test]
    fn a_wall_is_felt_behind_any_number_of_floor_tiles() {
        let mut seed = 11;
        for tiles in [30, 200] {
            let mut planes = Vec::new();
            for _ in 0..tiles {
                // Rounding tilts each a little.
                let tilt = random_unit(&mut seed) * 1.0e-7;
                add(&mut planes, plane(DVec3::Y + tilt, -1.0e-5));
            }
            add(&mut planes, plane(DVec3::NEG_X, 0.0));
            assert!(planes.len() <= 2, "{}", planes.len());
            let (x, left_out) = nearest_yielding(DVec3::new(1.0, -0.1, 0.5), &mut planes);
            assert!(!left_out);
            assert!(x.distance(DVec3::new(0.0, -1.0e-5, 0.5)) < 1.0e-6, "{x}");
        }
    }

    #[test]
    fn of_more_planes_than_can_be_tried_the_ones_that_push_decide() {
        let mut seed = 13;
        let mut planes: Vec<_> = (0..60)
            .map(|_| {
                let n = random_unit(&mut seed);
                plane(DVec3::new(n.x * 0.3, 1.0, n.z * 0.3), -1.0)
            })
            .collect();
        planes.push(plane(DVec3::NEG_X, 0.0));
        let (x, left_out) = nearest_yielding(DVec3::new(1.0, 0.0, 0.5), &mut planes);
        assert!(
            !left_out && x.distance(DVec3::new(0.0, 0.0, 0.5)) < 1.0e-9,
            "{x}"
        );
    }

    #[test]
    fn the_order_of_walls_does_not_matter() {
        let mut seed = 5;
        for _ in 0..500 {
            let x0 = random_unit(&mut seed);
            let mut walls: Vec<_> = (0..5).map(|_| plane(random_unit(&mut seed), 0.0)).collect();
            let a = nearest(x0, &walls);
            walls.reverse();
            let b = nearest(x0, &walls);
            match (a, b) {
                (Some(a), Some(b)) => assert!(a.distance(b) < 1e-6, "{a} {b}"),
                (a, b) => assert_eq!(a.is_some(), b.is_some()),
            }
        }
    }

    #[test]
    fn no_sampled_motion_that_keeps_a_cone_is_nearer_than_the_answer() {
        let cone = [
            (2.0, 0.0),
            (-2.0, 0.0),
            (0.0, 2.0),
            (0.0, -2.0),
            (1.5, 1.5),
            (-1.5, 1.5),
            (1.5, -1.5),
            (-1.5, -1.5),
            (1.0, 1.75),
            (-1.0, 1.75),
            (1.0, -1.75),
            (-1.0, -1.75),
            (1.75, 1.0),
            (-1.75, 1.0),
            (1.75, -1.0),
            (-1.75, -1.0),
        ];
        let mut seed = 11;
        for count in 1..=cone.len() {
            let walls: Vec<_> = cone[..count]
                .iter()
                .map(|(x, y)| plane(DVec3::new(*x, *y, 1.0), 0.0))
                .collect();
            for _ in 0..200 {
                let v = random_unit(&mut seed);
                let x = nearest(v, &walls).unwrap();
                for w in &walls {
                    assert!(w.normal.dot(x) > -1e-7);
                }
                assert!(
                    x.dot(v) >= -1e-9 && x.length() <= 1.0 + 1e-9,
                    "never reversed, never faster"
                );
                for _ in 0..50 {
                    let y = random_unit(&mut seed);
                    if walls.iter().all(|w| w.normal.dot(y) >= 0.0) {
                        // The best length along y.
                        let y = y * y.dot(v).max(0.0);
                        assert!(x.distance(v) <= y.distance(v) + 1e-6);
                    }
                }
            }
        }
    }

    #[test]
    fn walls_that_lean_by_rounding_only_throw_nobody_out_between_them() {
        let walls = [
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(0.023_583_256, 0.997_261_17, 0.070_099_96),
            Vec3::new(0.227_760_84, -8.940_697e-8, 0.973_716_86),
            Vec3::new(0.875_974_54, -1.341_104_5e-7, -0.482_357_8),
        ]
        .map(|normal| HalfSpace::new(normal, 0.0, 0));
        for x0 in [
            DVec3::new(0.06, 0.005, -0.08),
            DVec3::new(0.0, 0.35, -5.0),
            DVec3::new(3.0, -0.1, 0.2),
        ] {
            let x = nearest(x0, &walls).unwrap();
            assert!(x.length() <= x0.length() + 1e-6, "{x0} to {x}");
        }
    }

    #[test]
    fn closing_walls_that_contradict_leave_the_firm_one_standing() {
        let mut walls = vec![
            plane(DVec3::Y, 0.0),
            HalfSpace {
                normal: DVec3::NEG_Y,
                bound: 0.1,
                yields: 2,
            },
        ];
        let (x, crushed) = nearest_yielding(DVec3::new(0.3, -0.2, 0.0), &mut walls);
        assert!(
            crushed && x.distance(DVec3::new(0.3, 0.0, 0.0)) < 1e-12,
            "{x}"
        );
    }
}
