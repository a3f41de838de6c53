//! How deep two bones lie in each other.

use bevy::prelude::*;

use super::BoneShape;
use crate::math::{cuboid::Cuboid, segment::closest_parameters};

/// A shape in the figure's axes.
enum Placed {
    Line { ends: (Vec3, Vec3), radius: f32 },
    Box(Cuboid),
}

impl Placed {
    fn of(shape: &BoneShape, at: &Transform) -> Self {
        let place = |p: Vec3| at.rotation * p + at.translation;
        match *shape {
            BoneShape::Capsule { from, to, radius } => Self::Line {
                ends: (place(from), place(to)),
                radius,
            },
            BoneShape::Box {
                center,
                rotation,
                half,
            } => Self::Box(Cuboid {
                center: place(center),
                rotation: (at.rotation * rotation).normalize(),
                half,
            }),
        }
    }
}

/// How deep two bones lie in each other in the bind pose, metres; negative apart. Of boxes that are apart,
/// never more than they are.
pub(crate) fn overlap(a: &BoneShape, at: &Transform, b: &BoneShape, bt: &Transform) -> f32 {
    use Placed::{Box, Line};
    match (Placed::of(a, at), Placed::of(b, bt)) {
        (
            Line {
                ends: (a0, a1),
                radius: ra,
            },
            Line {
                ends: (b0, b1),
                radius: rb,
            },
        ) => {
            let (s, t) = closest_parameters(a0, a1, b0, b1);
            ra + rb - a0.lerp(a1, s).distance(b0.lerp(b1, t))
        }
        (Line { ends, radius }, Box(solid)) | (Box(solid), Line { ends, radius }) => {
            radius - solid.closest_to_segment(ends.0, ends.1, Vec3::Y).distance
        }
        (Box(a), Box(b)) => depth_of_boxes(&a, &b),
    }
}

/// The least way along a direction that parts two boxes, over their faces and the crosses of their edges.
fn depth_of_boxes(a: &Cuboid, b: &Cuboid) -> f32 {
    let (of_a, of_b) = (
        Mat3::from_quat(a.rotation).to_cols_array_2d(),
        Mat3::from_quat(b.rotation).to_cols_array_2d(),
    );
    let (of_a, of_b) = (of_a.map(Vec3::from_array), of_b.map(Vec3::from_array));
    let reach = |axes: &[Vec3; 3], half: Vec3, way: Vec3| {
        Vec3::new(axes[0].dot(way), axes[1].dot(way), axes[2].dot(way))
            .abs()
            .dot(half)
    };
    let between = b.center - a.center;
    let along =
        |way: Vec3| reach(&of_a, a.half, way) + reach(&of_b, b.half, way) - between.dot(way).abs();
    let faces = of_a.iter().chain(&of_b).copied();
    let crosses = of_a.iter().flat_map(|x| of_b.iter().map(|y| x.cross(*y)));
    // Edges that are parallel part nothing that faces do not.
    let crosses = crosses.filter_map(Vec3::try_normalize);
    faces.chain(crosses).map(along).fold(f32::MAX, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Transform = Transform::IDENTITY;

    fn capsule() -> BoneShape {
        BoneShape::Capsule {
            from: Vec3::NEG_Y,
            to: Vec3::Y,
            radius: 0.2,
        }
    }

    /// Two metres wide, flat.
    fn slab() -> BoneShape {
        BoneShape::Box {
            center: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            half: Vec3::new(1.0, 0.1, 0.5),
        }
    }

    #[test]
    fn overlap_is_the_depth_of_two_capsules() {
        let beside = Transform::from_xyz(0.3, 0.5, 0.0);
        assert!((overlap(&capsule(), &HERE, &capsule(), &beside) - 0.1).abs() < 1.0e-6);
        let above = Transform::from_xyz(0.0, 3.0, 0.0);
        assert!((overlap(&capsule(), &HERE, &capsule(), &above) + 0.6).abs() < 1.0e-6);
    }

    #[test]
    fn overlap_of_a_capsule_and_a_box_counts_the_box_to_its_corners() {
        // Beside the corner of the slab: its thickest line would be 0.9 m away.
        let corner = Transform::from_xyz(0.95, 1.25, 0.48);
        assert!((overlap(&capsule(), &corner, &slab(), &HERE) - 0.05).abs() < 1.0e-5);
        let off = Transform::from_xyz(1.3, 1.4, 0.0);
        let expected = 0.2 - Vec2::new(0.3, 0.3).length();
        assert!((overlap(&slab(), &HERE, &capsule(), &off) - expected).abs() < 1.0e-5);
        // Right through it: out through the side that is nearest.
        let through = Transform::from_xyz(0.9, 0.0, 0.0);
        assert!((overlap(&slab(), &HERE, &capsule(), &through) - 0.3).abs() < 1.0e-5);
    }

    #[test]
    fn overlap_of_two_boxes_is_the_way_that_parts_them() {
        let above = Transform::from_xyz(0.3, 0.15, 0.2);
        assert!((overlap(&slab(), &HERE, &slab(), &above) - 0.05).abs() < 1.0e-6);
        let apart = Transform::from_xyz(0.0, 0.25, 0.0);
        assert!((overlap(&slab(), &HERE, &slab(), &apart) + 0.05).abs() < 1.0e-6);
        // Turned by 45 degrees, an edge comes first.
        let edge = Transform::from_xyz(0.0, 0.1 + 0.2 * 2.0f32.sqrt() - 0.02, 0.0)
            .with_rotation(Quat::from_rotation_z(core::f32::consts::FRAC_PI_4));
        let bar = BoneShape::Box {
            center: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            half: Vec3::splat(0.2),
        };
        assert!((overlap(&slab(), &HERE, &bar, &edge) - 0.02).abs() < 1.0e-5);
        // Two bars across each other, edge on edge.
        let turned = |axis: Vec3| Quat::from_axis_angle(axis, core::f32::consts::FRAC_PI_4);
        let rod = |along: Vec3| BoneShape::Box {
            center: Vec3::ZERO,
            rotation: turned(along),
            half: Vec3::splat(0.1) + along * 0.9,
        };
        let reach = 0.1 * 2.0f32.sqrt();
        let crossed = Transform::from_xyz(0.0, 2.0 * reach + 0.03, 0.0);
        let depth = overlap(&rod(Vec3::X), &HERE, &rod(Vec3::Z), &crossed);
        assert!((depth + 0.03).abs() < 1.0e-5, "{depth}");
    }
}
