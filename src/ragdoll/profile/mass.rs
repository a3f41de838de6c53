//! How a bone's mass is spread.

use bevy::prelude::*;

use super::shape::BoneShape;

/// The mass of a bone as a share of the figure's, in the bone's own axes.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BoneMass {
    /// Weight of this bone against the others, above 0. Shares need not sum to 1: each bone gets its
    /// part of the sum.
    pub share: f32,
    /// Centre of mass, metres.
    pub center: Vec3,
    /// Axes of the principal moments of inertia.
    pub axes: Quat,
    /// Radii of gyration about these axes through the centre, metres, each above 0: moment of inertia
    /// is mass times its square.
    pub gyration: Vec3,
}

impl Default for BoneMass {
    fn default() -> Self {
        Self::solid(1.0, &BoneShape::default())
    }
}

impl BoneMass {
    /// Of a solid of this shape.
    pub fn solid(share: f32, shape: &BoneShape) -> Self {
        Self {
            share,
            center: shape.center(),
            axes: shape.axes(),
            gyration: shape.gyration(),
        }
    }

    /// Of a limb from the origin to `end`, as the tables of anatomy give it: the centre of mass at a
    /// part of the length, and the radius of gyration across as a part of the length. About the limb
    /// itself it is that of the shape.
    pub fn limb(share: f32, shape: &BoneShape, end: Vec3, center: f32, gyration: f32) -> Self {
        let across = gyration * end.length();
        Self {
            share,
            center: end * center,
            axes: Quat::from_rotation_arc(Vec3::X, end.normalize_or(Vec3::X)),
            gyration: Vec3::new(shape.gyration().min_element(), across, across),
        }
    }
}
