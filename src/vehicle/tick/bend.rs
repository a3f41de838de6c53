//! How the ground bends along a vehicle's way, told by the ground under its wheels.
//!
//! A tick pushes along the normals of its start. On a curve these lean forward against those of the way
//! to come, and would drive the vehicle; here is by how much they turn. The line of least squares through
//! the normals gives the rate. It counts as far as the ground is a curve: on one, the contacts lie square
//! to the mean of their normals, at the foot of a ramp or at a kerb they do not, and normals that differ
//! by much are those of an edge.
//!
//! Limits: a kink that is just half way between the axles looks like a curve; wheels in one line across
//! the way tell nothing.

use bevy::{math::ops, prelude::*};

/// Difference of a normal from the mean up to which it is a curve's, and from which it is an edge's.
const CURVE: [f32; 2] = [0.12, 0.2];

/// How the ground bends.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bend {
    way: Vec3,
    /// Change of the normal along the way, 1/m.
    rate: Vec3,
    /// The most that a normal is turned.
    most: f32,
}

impl Bend {
    /// From points and normals of the ground under the wheels, and the velocity against it.
    pub fn of(ground: &[(Vec3, Vec3)], velocity: Vec3) -> Self {
        let share = 1.0 / ground.len().max(1) as f32;
        let middle: Vec3 = ground.iter().map(|(point, _)| point * share).sum();
        let mean: Vec3 = ground.iter().map(|(_, normal)| normal * share).sum();
        let up = mean.normalize_or_zero();
        let way = velocity.reject_from_normalized(up).normalize_or_zero();
        let (mut all, mut spread, mut rate, mut slope) = (0.0, 0.0, Vec3::ZERO, 0.0);
        for (point, normal) in ground {
            let off = *point - middle;
            let ahead = off.dot(way);
            all += off.length_squared();
            spread += ahead * ahead;
            rate += (*normal - mean) * ahead;
            slope += off.dot(up) * ahead;
        }
        // Wheels of one axle tell nothing.
        if !(spread > 0.25 * all) {
            return Self::default();
        }
        let (rate, slope) = (rate / spread, slope / spread);
        let differs = rate.length() * ops::sqrt(spread * share);
        if !(differs > 1.0e-6) {
            return Self::default();
        }
        let askew = slope / differs;
        let smooth = (1.0 - 4.0 * askew * askew).max(0.0);
        let gentle = ((CURVE[1] - differs) / (CURVE[1] - CURVE[0])).clamp(0.0, 1.0);
        Self {
            way,
            rate: rate * smooth * gentle,
            most: differs,
        }
    }

    /// By how much a normal turns while its wheel goes this far.
    pub fn turn(&self, path: Vec3) -> Vec3 {
        (self.rate * path.dot(self.way)).clamp_length_max(self.most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAY: Vec3 = Vec3::NEG_Z;

    /// Four wheels 2.8 m by 1.6 m on ground of this height and slope by the way ahead.
    fn wheels(height: impl Fn(f32) -> (f32, f32)) -> [(Vec3, Vec3); 4] {
        [(-0.8, 1.4), (0.8, 1.4), (-0.8, -1.4), (0.8, -1.4)].map(|(x, ahead)| {
            let (y, slope) = height(ahead);
            (
                Vec3::new(x, y, -ahead),
                Vec3::new(0.0, 1.0, slope).normalize(),
            )
        })
    }

    #[test]
    fn on_a_circle_the_normal_turns_by_the_way_over_the_radius() {
        let circle = wheels(|s| {
            let drop = ops::sqrt(400.0 - s * s);
            (20.0 - drop, s / drop)
        });
        let turned = Bend::of(&circle, WAY * 12.0).turn(WAY * 0.2);
        assert!((turned - Vec3::Z * 0.01).length() < 1.0e-4, "{turned}");
        // Falling onto it is no way along it.
        let falling = Bend::of(&circle, Vec3::NEG_Y * 14.0).turn(Vec3::NEG_Y * 0.2);
        assert!(falling.length() < 1.0e-6, "{falling}");
    }

    #[test]
    fn a_ramp_under_one_axle_leaves_the_other_its_flat_ground() {
        for degrees in [5.0f32, 20.0, 40.0] {
            let tan = ops::tan(degrees.to_radians());
            for foot in [1.3, 1.0, -1.0] {
                let ramp =
                    wheels(|s| ((s - foot).max(0.0) * tan, if s > foot { tan } else { 0.0 }));
                let turned = Bend::of(&ramp, WAY * 25.0).turn(WAY * 0.2);
                assert!(turned.length() < 1.0e-6, "{degrees} from {foot}: {turned}");
            }
        }
    }

    #[test]
    fn wheels_of_one_axle_tell_nothing_on_any_way() {
        let axle = [
            (Vec3::X * 0.8, Vec3::new(0.1, 1.0, 0.0).normalize()),
            (Vec3::X * -0.8, Vec3::new(-0.1, 1.0, 0.0).normalize()),
        ];
        for degrees in [0.0f32, 5.0, 20.0] {
            let way = Quat::from_rotation_y(degrees.to_radians()) * WAY;
            let turned = Bend::of(&axle, way * 20.0).turn(way * 0.3);
            assert!(turned.length() < 1.0e-6, "{degrees}: {turned}");
        }
        assert!(Bend::of(&[], WAY).turn(WAY) == Vec3::ZERO);
    }
}
