//! The shapes of bones, and what a solid of each weighs and resists.

use bevy::{math::ops, prelude::*};

/// What of a bone collides, in the bone's own axes, metres.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum BoneShape {
    /// A line with a radius.
    Capsule {
        /// One end of the line.
        from: Vec3,
        /// Its other end; the same makes a ball.
        to: Vec3,
        /// Above 0.
        radius: f32,
    },
    /// A box.
    Box {
        /// Its middle.
        center: Vec3,
        /// Its axes.
        rotation: Quat,
        /// Half of its size, each above 0.
        half: Vec3,
    },
}

impl Default for BoneShape {
    fn default() -> Self {
        Self::Capsule {
            from: Vec3::ZERO,
            to: Vec3::NEG_Y * 0.2,
            radius: 0.05,
        }
    }
}

impl BoneShape {
    /// The middle.
    pub fn center(&self) -> Vec3 {
        match *self {
            Self::Capsule { from, to, .. } => (from + to) * 0.5,
            Self::Box { center, .. } => center,
        }
    }

    /// Axes of its principal moments of inertia; of a capsule, `X` lies along the line.
    pub fn axes(&self) -> Quat {
        match *self {
            Self::Capsule { from, to, .. } => {
                Quat::from_rotation_arc(Vec3::X, (to - from).normalize_or(Vec3::X))
            }
            Self::Box { rotation, .. } => rotation,
        }
    }

    /// Radii of gyration of the solid about [`Self::axes`] through its middle, metres.
    pub fn gyration(&self) -> Vec3 {
        match *self {
            Self::Capsule { from, to, radius } => {
                let (l, r) = (from.distance(to), radius);
                // Parts of the volume over πr²: cylinder and both caps.
                let (tube, caps) = (l, 4.0 / 3.0 * r);
                let whole = tube + caps;
                let along = (tube * 0.5 + caps * 0.4) * r * r / whole;
                // A half ball's centre is 3/8 of its radius from its flat side.
                let shift = l * l * 0.25 + 0.375 * l * r;
                let across =
                    (tube * (r * r * 0.25 + l * l / 12.0) + caps * (0.4 * r * r + shift)) / whole;
                Vec3::new(along.sqrt(), across.sqrt(), across.sqrt())
            }
            Self::Box { half, .. } => {
                let s = half * half / 3.0;
                Vec3::new((s.y + s.z).sqrt(), (s.x + s.z).sqrt(), (s.x + s.y).sqrt())
            }
        }
    }

    /// Length along its longest axis, metres.
    pub fn length(&self) -> f32 {
        match *self {
            Self::Capsule { from, to, radius } => from.distance(to) + 2.0 * radius,
            Self::Box { half, .. } => 2.0 * half.max_element(),
        }
    }

    /// The same with every length times this.
    pub fn scaled(&self, by: f32) -> Self {
        match *self {
            Self::Capsule { from, to, radius } => Self::Capsule {
                from: from * by,
                to: to * by,
                radius: radius * by,
            },
            Self::Box {
                center,
                rotation,
                half,
            } => Self::Box {
                center: center * by,
                rotation,
                half: half * by,
            },
        }
    }

    /// Whether every number is finite and every size above 0.
    pub(crate) fn is_sound(&self) -> bool {
        match *self {
            Self::Capsule { from, to, radius } => {
                from.is_finite() && to.is_finite() && radius > 0.0 && radius.is_finite()
            }
            Self::Box {
                center,
                rotation,
                half,
            } => {
                center.is_finite()
                    && rotation.is_normalized()
                    && half.is_finite()
                    && half.min_element() > 0.0
            }
        }
    }

    /// How far it reaches from the origin of its bone along a direction of unit length, metres.
    pub(crate) fn reach(&self, along: Vec3) -> f32 {
        match *self {
            Self::Capsule { from, to, radius } => from.dot(along).max(to.dot(along)) + radius,
            Self::Box {
                center,
                rotation,
                half,
            } => center.dot(along) + (rotation.inverse() * along).abs().dot(half),
        }
    }

    /// The thickest line within: its ends and its radius.
    pub(crate) fn core(&self) -> (Vec3, Vec3, f32) {
        match *self {
            Self::Capsule { from, to, radius } => (from, to, radius),
            Self::Box {
                center,
                rotation,
                half,
            } => {
                let radius = half.min_element();
                let long = if half.x >= half.y && half.x >= half.z {
                    Vec3::X
                } else if half.y >= half.z {
                    Vec3::Y
                } else {
                    Vec3::Z
                };
                let reach = rotation * long * (half.max_element() - radius);
                (center - reach, center + reach, radius)
            }
        }
    }
}

/// A capsule from a joint to the end of its bone that reaches neither beyond: its caps are within the
/// length.
pub(crate) fn capsule_within(end: Vec3, radius: f32) -> BoneShape {
    let length = end.length();
    let radius = radius.min(length * 0.5).max(1.0e-3);
    let along = end.normalize_or_zero();
    BoneShape::Capsule {
        from: along * radius,
        to: along * (length - radius).max(radius),
        radius,
    }
}

/// Radius of a capsule of this whole length that has this volume, by Newton's method; metres.
pub(crate) fn radius_of_volume(length: f32, volume: f32) -> f32 {
    use core::f32::consts::PI;
    // V = πr²(l − 2r) + 4/3·πr³.
    let mut r = (volume / (PI * length)).sqrt();
    for _ in 0..12 {
        let value = PI * r * r * (length - 2.0 * r) + 4.0 / 3.0 * PI * r * r * r - volume;
        let slope = 2.0 * PI * r * length - 2.0 * PI * r * r;
        if slope > 1.0e-9 {
            r -= value / slope;
        }
        r = r.clamp(length * 0.02, length * 0.5);
    }
    r
}

/// Turns by degrees about an axis; for tables.
pub(crate) fn degrees(axis: Vec3, angle: f32) -> Quat {
    let (sin, cos) = ops::sin_cos(angle.to_radians() * 0.5);
    Quat::from_xyzw(axis.x * sin, axis.y * sin, axis.z * sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_capsule_without_length_is_a_ball_and_a_long_one_a_rod() {
        let ball = BoneShape::Capsule {
            from: Vec3::ONE,
            to: Vec3::ONE,
            radius: 0.3,
        };
        let g = ball.gyration();
        assert!((g * g - Vec3::splat(0.4 * 0.09)).length() < 1.0e-6);
        let rod = BoneShape::Capsule {
            from: Vec3::ZERO,
            to: Vec3::Y * 10.0,
            radius: 0.001,
        };
        let g = rod.gyration();
        assert!((g.y * g.y - 100.0 / 12.0).abs() < 0.01);
        assert!((rod.axes() * Vec3::X - Vec3::Y).length() < 1.0e-6);
    }

    #[test]
    fn a_turned_box_reaches_as_far_as_its_farthest_corner() {
        let shape = BoneShape::Box {
            center: Vec3::new(0.0, 0.1, 0.0),
            rotation: degrees(Vec3::Z, 45.0),
            half: Vec3::new(0.3, 0.3, 0.05),
        };
        let diagonal = 0.3 * 2.0f32.sqrt();
        assert!((shape.reach(Vec3::NEG_Y) - (diagonal - 0.1)).abs() < 1.0e-6);
        assert!((shape.reach(Vec3::Y) - (diagonal + 0.1)).abs() < 1.0e-6);
        assert!((shape.reach(Vec3::Z) - 0.05).abs() < 1.0e-6);
    }

    #[test]
    fn the_radius_of_a_volume_has_that_volume() {
        use core::f32::consts::PI;
        for (length, radius) in [(0.4f32, 0.05f32), (0.3, 0.12), (1.0, 0.2)] {
            let volume = PI * radius * radius * (length - 2.0 * radius)
                + 4.0 / 3.0 * PI * radius * radius * radius;
            assert!((radius_of_volume(length, volume) - radius).abs() < 1.0e-4);
        }
    }
}
