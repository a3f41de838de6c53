//! Splitting rotations: twist about the X axis, swing of the X axis, and the way from one to another.

use bevy::{
    math::{Vec2, ops},
    prelude::*,
};

/// A swing plane point farther out than this is at the antipode for every purpose.
const FARTHEST: f32 = 1.0e3;

/// Splits into `(swing, twist)` with `q = swing * twist`: the twist turns about X, the swing about an
/// axis across it. A half turn of the X axis has no twist of its own: it is given none.
pub(crate) fn swing_twist(q: Quat) -> (Quat, Quat) {
    let length = (q.x * q.x + q.w * q.w).sqrt();
    if length < 1.0e-7 {
        return (q, Quat::IDENTITY);
    }
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let twist = Quat::from_xyzw(q.x * sign / length, 0.0, 0.0, q.w * sign / length);
    ((q * twist.inverse()).normalize(), twist)
}

/// Angle of the twist about X, radians, within ±π.
pub(crate) fn twist_angle(q: Quat) -> f32 {
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    2.0 * ops::atan2(q.x * sign, q.w * sign)
}

/// A swing as a point of the plane: its axis across X, as long as the tangent of half its angle. This
/// is the stereographic map of the sphere, so circles on the sphere are circles here and angles are
/// kept.
pub(crate) fn swing_point(swing: Quat) -> Vec2 {
    let swing = if swing.w < 0.0 { -swing } else { swing };
    let axis = Vec2::new(swing.y, swing.z);
    let length = axis.length();
    if length > FARTHEST * swing.w {
        return axis * (FARTHEST / length);
    }
    axis / swing.w
}

/// The inverse of [`swing_point`].
pub(crate) fn swing_of_point(p: Vec2) -> Quat {
    Quat::from_xyzw(0.0, p.x, p.y, 1.0).normalize()
}

/// A turn about X.
pub(crate) fn twist_of_angle(angle: f32) -> Quat {
    let (sin, cos) = ops::sin_cos(angle * 0.5);
    Quat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// Angle between two directions given as swing plane points, radians.
pub(crate) fn angle_between_points(p: Vec2, q: Vec2) -> f32 {
    let across = (p - q).length();
    let along = Vec2::new(1.0 + p.dot(q), p.perp_dot(q)).length();
    2.0 * ops::atan2(across, along)
}

/// The shorter rotation vector of a rotation, radians; for the smallest turns without loss of digits.
pub(crate) fn rotation_vector(q: Quat) -> Vec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let axis = q.xyz();
    let sin = axis.length();
    if sin < 1.0e-6 {
        return axis * 2.0;
    }
    axis * (2.0 * ops::atan2(sin, q.w) / sin)
}

/// The inverse of [`rotation_vector`].
pub(crate) fn from_rotation_vector(v: Vec3) -> Quat {
    let angle = v.length();
    if angle < 1.0e-6 {
        return Quat::from_xyzw(v.x * 0.5, v.y * 0.5, v.z * 0.5, 1.0).normalize();
    }
    let (sin, cos) = ops::sin_cos(angle * 0.5);
    let axis = v * (sin / angle);
    Quat::from_xyzw(axis.x, axis.y, axis.z, cos)
}

/// Angle of a rotation, radians, `0..=π`.
pub(crate) fn angle(q: Quat) -> f32 {
    rotation_vector(q).length()
}

/// Velocity that turns `from` into `to` in this time, world axes, radians per second.
pub(crate) fn angular_velocity(from: Quat, to: Quat, dt: f32) -> Vec3 {
    rotation_vector(to * from.inverse()) / dt
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::PI;

    fn some_rotations() -> impl Iterator<Item = Quat> {
        (0..500u32).map(|i| {
            let f = |k: u32| (i * k % 211) as f32 / 105.0 - 1.0;
            let q = Quat::from_xyzw(f(37), f(91), f(53), f(17));
            if q.length() > 0.1 {
                q.normalize()
            } else {
                Quat::IDENTITY
            }
        })
    }

    #[test]
    fn swing_and_twist_make_the_rotation_again() {
        for q in some_rotations() {
            let (swing, twist) = swing_twist(q);
            assert!(angle((swing * twist).inverse() * q) < 1.0e-3, "{q}");
            assert!(swing.x.abs() < 1.0e-5, "{q}: {swing}");
            // Both are the same turn where the X axis is not turned round.
            if swing.w > 0.01 {
                assert!((twist_angle(q) - twist_angle(twist)).abs() < 1.0e-3);
            }
        }
    }

    #[test]
    fn a_twist_keeps_its_angle_through_any_swing() {
        for i in -17..=17 {
            let tau = i as f32 * 0.17;
            let q = swing_of_point(Vec2::new(0.7, -1.3)) * twist_of_angle(tau);
            assert!((twist_angle(q) - tau).abs() < 1.0e-5);
        }
    }

    #[test]
    fn points_of_the_plane_are_angles_on_the_sphere() {
        for q in some_rotations() {
            let (swing, _) = swing_twist(q);
            if swing.w.abs() < 0.02 {
                continue;
            }
            let p = swing_point(swing);
            assert!(angle(swing_of_point(p).inverse() * swing) < 1.0e-3);
            let other = Vec2::new(0.3, 0.9);
            let directions = (swing * Vec3::X).dot(swing_of_point(other) * Vec3::X);
            let expected = ops::acos(directions.clamp(-1.0, 1.0));
            assert!((angle_between_points(p, other) - expected).abs() < 2.0e-3);
        }
        assert!((angle_between_points(Vec2::ZERO, Vec2::new(1.0, 0.0)) - PI / 2.0).abs() < 1.0e-6);
    }

    #[test]
    fn rotation_vectors_are_exact_both_ways() {
        for v in [
            Vec3::ZERO,
            Vec3::new(1.0e-5, 0.0, -2.0e-5),
            Vec3::new(0.4, -1.1, 0.2),
            Vec3::new(0.0, 3.1, 0.0),
        ] {
            assert!((rotation_vector(from_rotation_vector(v)) - v).length() < 1.0e-5);
        }
        let turned = angular_velocity(Quat::IDENTITY, Quat::from_rotation_y(0.1), 0.02);
        assert!((turned - Vec3::Y * 5.0).length() < 1.0e-4);
    }
}
