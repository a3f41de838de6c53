//! The elliptic cone: how far outside a direction is, where the boundary is nearest, and the circular
//! cone that touches it there.
//!
//! The physics engine knows circular cones only. Here an ellipse of the swing plane (see
//! [`swing_point`](super::rotation::swing_point)) is replaced, each tick, by the circle that touches
//! it at the nearest boundary point. The plane is the stereographic image of the sphere, so that
//! circle is a true cone, with the true normal of the boundary: what leans on the limit feels no
//! push along it.

use bevy::{
    math::{Vec2, ops},
    prelude::*,
};

use super::rotation::{angle_between_points, swing_of_point};

/// A half angle below this is taken for this one, radians: half a degree.
const NARROWEST: f32 = 0.0087;
/// A half angle above this is taken for this one, radians: 176 degrees.
const WIDEST: f32 = 3.07;
/// A circular cone at least as wide as this, radians, is replaced by a narrower one, too.
const WIDE: f32 = 1.2;

/// An elliptic cone about X, by the tangents of half its half angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EllipticCone {
    semi: Vec2,
}

/// A circular cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cap {
    /// Turns X into the axis of the cone.
    pub center: Quat,
    /// Radians.
    pub half_angle: f32,
}

impl EllipticCone {
    /// By the greatest swing about Y and about Z, radians.
    pub fn new(half_angles: Vec2) -> Self {
        let tan = |a: f32| ops::tan(a.clamp(NARROWEST, WIDEST) * 0.5);
        Self {
            semi: Vec2::new(tan(half_angles.x), tan(half_angles.y)),
        }
    }

    /// Whether it is a circle, to a twentieth.
    pub fn is_circular(&self) -> bool {
        (self.semi.x - self.semi.y).abs() <= 0.05 * self.semi.min_element()
    }

    /// The point of the boundary at this angle of the ellipse, by its cosine and sine.
    #[cfg(any(feature = "debug", test))]
    pub fn on_boundary(&self, cos: f32, sin: f32) -> Vec2 {
        Vec2::new(cos, sin) * self.semi
    }

    /// Whether a point of the swing plane lies within.
    pub fn contains(&self, p: Vec2) -> bool {
        (p / self.semi).length_squared() <= 1.0
    }

    /// The nearest point of the boundary.
    pub fn nearest(&self, p: Vec2) -> Vec2 {
        let (a, b) = (self.semi.x, self.semi.y);
        let q = p.abs();
        // Walks along the boundary by the circle of curvature at each guess.
        let mut t = Vec2::splat(core::f32::consts::FRAC_1_SQRT_2);
        for _ in 0..6 {
            let at = t * self.semi;
            let evolute = Vec2::new(
                (a * a - b * b) * t.x * t.x * t.x / a,
                (b * b - a * a) * t.y * t.y * t.y / b,
            );
            let radius = (at - evolute).length();
            let way = q - evolute;
            let length = way.length();
            if length < 1.0e-9 {
                break;
            }
            let next = (way * (radius / length) + evolute) / self.semi;
            t = next.clamp(Vec2::ZERO, Vec2::ONE).normalize_or(t);
        }
        Vec2::new((t.x * a).copysign(p.x), (t.y * b).copysign(p.y))
    }

    /// Angle to the boundary, radians: positive outside.
    pub fn excess(&self, p: Vec2) -> f32 {
        let angle = angle_between_points(p, self.nearest(p));
        if self.contains(p) { -angle } else { angle }
    }

    /// The nearest point within.
    pub fn clamp(&self, p: Vec2) -> Vec2 {
        if self.contains(p) { p } else { self.nearest(p) }
    }

    /// The circular cone that touches the boundary nearest to this point from within.
    pub fn touching(&self, p: Vec2) -> Cap {
        let (a, b) = (self.semi.x, self.semi.y);
        if self.is_circular() {
            let half_angle = 2.0 * ops::atan(self.semi.min_element());
            if half_angle < WIDE {
                return Cap {
                    center: Quat::IDENTITY,
                    half_angle,
                };
            }
            // Half way to the bone: from an axis at a right angle to it, its twist cannot be told.
            let half = (ops::atan(p.length())).min(0.5 * half_angle);
            return Cap {
                center: swing_of_point(p.normalize_or_zero() * ops::tan(0.5 * half)),
                half_angle: half_angle - half,
            };
        }
        let e = self.nearest(p);
        let (cos, sin) = (e.x / a, e.y / b);
        let normal = Vec2::new(e.x / (a * a), e.y / (b * b)).normalize_or(Vec2::X);
        let curvature = a * a * sin * sin + b * b * cos * cos;
        let osculating = curvature * curvature.sqrt() / (a * b);
        // Not flatter than the ellipse, and otherwise with its centre as near to X as it can be.
        let radius = osculating.min(e.dot(normal));
        let center = e - normal * radius;
        let off = center.length();
        let near = 2.0 * ops::atan(off - radius);
        let far = 2.0 * ops::atan(off + radius);
        let middle = ops::tan((near + far) * 0.25);
        Cap {
            center: swing_of_point(center.normalize_or_zero() * middle),
            half_angle: (far - near) * 0.5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::math::rotation::swing_point;

    fn cone(y: f32, z: f32) -> EllipticCone {
        EllipticCone::new(Vec2::new(y.to_radians(), z.to_radians()))
    }

    /// The nearest boundary point by trying ten thousand.
    fn tried(cone: &EllipticCone, p: Vec2) -> f32 {
        (0..10_000)
            .map(|i| {
                let (sin, cos) = ops::sin_cos(i as f32 * core::f32::consts::TAU / 10_000.0);
                (Vec2::new(cos, sin) * cone.semi).distance(p)
            })
            .fold(f32::MAX, f32::min)
    }

    #[test]
    fn the_nearest_boundary_point_is_the_nearest_of_ten_thousand() {
        for (y, z) in [
            (45.0, 45.0),
            (75.0, 30.0),
            (12.0, 22.0),
            (100.0, 100.0),
            (2.0, 40.0),
        ] {
            let cone = cone(y, z);
            for i in 0..60 {
                let f = |k: i32| ((i * k) % 29) as f32 / 14.0 - 1.0;
                let p = Vec2::new(f(7), f(11)) * 1.6;
                let found = cone.nearest(p).distance(p);
                assert!(found <= tried(&cone, p) + 2.0e-3, "{y} {z} {p}: {found}");
                assert!(((cone.nearest(p) / cone.semi).length() - 1.0).abs() < 1.0e-4);
            }
        }
    }

    #[test]
    fn a_circular_cone_is_measured_by_its_angle() {
        let cone = cone(40.0, 40.0);
        for (swing, excess) in [(0.0, -40.0), (30.0, -10.0), (55.0, 15.0), (160.0, 120.0f32)] {
            let p = swing_point(Quat::from_rotation_z(f32::to_radians(swing)));
            assert!((cone.excess(p).to_degrees() - excess).abs() < 1.0e-2);
        }
    }

    #[test]
    fn an_elliptic_cone_has_its_half_angles_on_its_axes() {
        let cone = cone(75.0, 30.0);
        let about_y = swing_point(Quat::from_rotation_y(75f32.to_radians()));
        let about_z = swing_point(Quat::from_rotation_z(-(30f32.to_radians())));
        assert!(cone.excess(about_y).abs() < 1.0e-4);
        assert!(cone.excess(about_z).abs() < 1.0e-4);
        assert!(cone.excess(Vec2::ZERO) < -(29.9f32.to_radians()));
    }

    #[test]
    fn the_touching_cone_touches_and_stays_within() {
        for (y, z) in [
            (75.0, 30.0),
            (22.0, 12.0),
            (60.0, 50.0),
            (30.0, 100.0),
            (50.0, 50.0),
            (100.0, 100.0),
            (75.0, 75.0),
        ] {
            let cone = cone(y, z);
            for i in 0..40 {
                let (sin, cos) = ops::sin_cos(i as f32 * 0.157);
                let p = Vec2::new(cos, sin) * cone.semi * 1.1;
                let cap = cone.touching(p);
                let axis = cap.center * Vec3::X;
                let e = swing_of_point(cone.nearest(p)) * Vec3::X;
                let reach = ops::acos(axis.dot(e).clamp(-1.0, 1.0));
                assert!(
                    (reach - cap.half_angle).abs() < 2.0e-3,
                    "{y} {z} at {i}: {reach} for {}",
                    cap.half_angle
                );
                // A circle of curvature leaves its curve with the third power of the way.
                for turn in [-0.2f32, -0.1, -0.05, 0.05, 0.1, 0.2] {
                    let leaves = turn.abs() * turn.abs() * turn.abs() + 5.0e-4;
                    let rim = Quat::from_axis_angle(axis, turn) * e;
                    let rim = swing_point(Quat::from_rotation_arc(Vec3::X, rim));
                    let excess = cone.excess(rim);
                    assert!(excess < leaves, "{y} {z} at {i}, {turn}: {excess}");
                }
            }
        }
    }

    #[test]
    fn of_a_wide_cone_the_bone_is_never_at_a_right_angle_to_the_axis() {
        let cone = cone(100.0, 100.0);
        for degrees in [0.0f32, 20.0, 60.0, 95.0, 100.0, 130.0] {
            let swing = Quat::from_rotation_z(degrees.to_radians());
            let cap = cone.touching(swing_point(swing));
            let off = ops::acos((cap.center * Vec3::X).dot(swing * Vec3::X).clamp(-1.0, 1.0));
            let within = off - cap.half_angle;
            let excess = (degrees - 100.0).to_radians();
            assert!(off.to_degrees() < 85.0, "{degrees}: {}", off.to_degrees());
            assert!((within - excess).abs() < 2.0e-3, "{degrees}: {within}");
        }
    }

    #[test]
    fn what_is_outside_is_brought_to_the_boundary() {
        let cone = cone(20.0, 60.0);
        assert_eq!(cone.clamp(Vec2::new(0.01, 0.02)), Vec2::new(0.01, 0.02));
        let clamped = cone.clamp(Vec2::new(5.0, -9.0));
        assert!(cone.excess(clamped).abs() < 1.0e-3);
    }
}
