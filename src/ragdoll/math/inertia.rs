//! Mass, centre and inertia of a part and of everything that hangs on it.

use bevy::prelude::*;

/// Mass properties about the centre of mass, all in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MassPoint {
    /// Kilograms.
    pub mass: f32,
    /// Centre of mass, metres.
    pub center: Vec3,
    /// About the centre, kg·m².
    pub inertia: Mat3,
}

/// Inertia of a point mass about the origin of `r`.
fn of_point(mass: f32, r: Vec3) -> Mat3 {
    let outer = Mat3::from_cols(r * r.x, r * r.y, r * r.z);
    (Mat3::IDENTITY * r.length_squared() - outer) * mass
}

impl MassPoint {
    /// Both as one body.
    pub fn with(self, other: Self) -> Self {
        let mass = self.mass + other.mass;
        if !(mass > 0.0) {
            return self;
        }
        let way = other.center - self.center;
        // About the common centre, so that nothing large is subtracted.
        let reduced = self.mass * other.mass / mass;
        Self {
            mass,
            center: self.center + way * (other.mass / mass),
            inertia: self.inertia + other.inertia + of_point(reduced, way),
        }
    }

    /// Inertia about a point, kg·m².
    pub fn about(&self, point: Vec3) -> Mat3 {
        self.inertia + of_point(self.mass, self.center - point)
    }
}

/// What hangs on each bone, the bone itself included. Parents come before their children.
pub(crate) fn subtrees(own: &[MassPoint], parents: &[Option<usize>]) -> Vec<MassPoint> {
    let mut sums = own.to_vec();
    for child in (0..own.len()).rev() {
        if let Some(parent) = parents[child] {
            sums[parent] = sums[parent].with(sums[child]);
        }
    }
    sums
}

/// Moment of inertia about each axis of a frame, kg·m².
pub(crate) fn along_axes(inertia: Mat3, frame: Quat) -> Vec3 {
    let axes = Mat3::from_quat(frame);
    Vec3::new(
        axes.x_axis.dot(inertia * axes.x_axis),
        axes.y_axis.dot(inertia * axes.y_axis),
        axes.z_axis.dot(inertia * axes.z_axis),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rod(mass: f32, from: Vec3, to: Vec3) -> MassPoint {
        let way = to - from;
        MassPoint {
            mass,
            center: (from + to) * 0.5,
            inertia: of_point(mass / 12.0, way),
        }
    }

    #[test]
    fn a_rod_in_two_halves_is_the_rod() {
        let (a, b) = (Vec3::new(0.3, 1.0, -0.2), Vec3::new(1.1, 0.2, 0.4));
        let middle = (a + b) * 0.5;
        let whole = rod(2.0, a, b);
        let sums = subtrees(
            &[rod(1.0, a, middle), rod(1.0, middle, b)],
            &[None, Some(0)],
        );
        assert!(sums[0].center.distance(whole.center) < 1.0e-6);
        assert!(sums[0].inertia.abs_diff_eq(whole.inertia, 1.0e-6));
        assert_eq!(sums[1].mass, 1.0);
        // About its end: a third of mass times length squared, across.
        let across = along_axes(
            whole.about(a),
            Quat::from_rotation_arc(Vec3::X, (b - a).normalize()),
        );
        let expected = 2.0 * (b - a).length_squared() / 3.0;
        assert!(across.x.abs() < 1.0e-5);
        assert!((across.y - expected).abs() < 1.0e-5);
        assert!((across.z - expected).abs() < 1.0e-5);
    }

    #[test]
    fn branches_add_up_on_the_bone_that_bears_them() {
        let point = |m: f32, at: Vec3| MassPoint {
            mass: m,
            center: at,
            inertia: Mat3::ZERO,
        };
        let sums = subtrees(
            &[
                point(1.0, Vec3::ZERO),
                point(2.0, Vec3::X),
                point(3.0, Vec3::NEG_X),
                point(4.0, Vec3::Y),
            ],
            &[None, Some(0), Some(0), Some(2)],
        );
        assert_eq!(sums[0].mass, 10.0);
        assert_eq!(sums[2].mass, 7.0);
        assert!(sums[0].center.distance(Vec3::new(-0.1, 0.4, 0.0)) < 1.0e-6);
        // About Z at the origin: sum of mass times distance squared.
        assert!((sums[0].about(Vec3::ZERO).z_axis.z - 9.0).abs() < 1.0e-5);
    }
}
