//! How the weight of a standing vehicle rests on its wheels.

use arrayvec::ArrayVec;
use bevy::math::{DMat3, DVec3, Vec3};

use super::WheelList;
use crate::vehicle::solve::MOST_WHEELS;

/// Mass on each wheel, kilograms: the distribution that is linear in place, has the right sum and
/// lets the vehicle balance about its centre of mass. No wheel counts less than a twentieth of the
/// mean, so that wheels which carry nothing still have a spring.
pub(super) fn shares(mass: f32, center: Vec3, wheels: &WheelList) -> ArrayVec<f32, MOST_WHEELS> {
    let n = wheels.len() as f64;
    let mut matrix = DMat3::ZERO;
    for wheel in wheels {
        let at = place(wheel.attachment, center);
        matrix += DMat3::from_cols(at * at.x, at * at.y, at * at.z);
    }
    // Wheels in one line balance along it only.
    let softening = 1.0e-6 * n;
    matrix += DMat3::from_diagonal(DVec3::new(0.0, softening, softening));
    let weights = if matrix.determinant().abs() > 1.0e-12 {
        matrix.inverse() * DVec3::new(1.0, 0.0, 0.0)
    } else {
        DVec3::new(1.0 / n, 0.0, 0.0)
    };
    let least = 0.05 / n;
    wheels
        .iter()
        .map(|wheel| {
            let part = place(wheel.attachment, center).dot(weights).max(least);
            mass * part as f32
        })
        .collect()
}

fn place(attachment: Vec3, center: Vec3) -> DVec3 {
    let at = (attachment - center).as_dvec3();
    DVec3::new(1.0, at.x, at.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::Wheel;

    #[test]
    fn the_weight_rests_on_the_axles_by_their_distances() {
        let wheel = |x, z| Wheel {
            attachment: Vec3::new(x, 0.0, z),
            ..Wheel::default()
        };
        let all = [
            wheel(-0.8, -1.2),
            wheel(0.8, -1.2),
            wheel(-0.8, 1.6),
            wheel(0.8, 1.6),
        ];
        let list: WheelList = all.iter().collect();
        let found = shares(1500.0, Vec3::ZERO, &list);
        let front = 1500.0 * 1.6 / 2.8 / 2.0;
        assert!(
            (found[0] - front).abs() < 0.1 && (found[1] - front).abs() < 0.1,
            "{found:?}"
        );
        assert!((found.iter().sum::<f32>() - 1500.0).abs() < 0.1);
        // Two wheels in line.
        let two: WheelList = [&all[0], &all[2]].into_iter().collect();
        let found = shares(200.0, Vec3::new(-0.8, 0.0, 0.2), &two);
        assert!((found[0] - 100.0).abs() < 0.1, "{found:?}");
    }
}
