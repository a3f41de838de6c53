//! How bones are tied together: kinds of joints, their limits, and both as functions of a rotation.

use bevy::{
    math::{Vec2, ops},
    prelude::*,
};

use crate::ragdoll::math::{
    cone::EllipticCone,
    rotation::{
        angle, from_rotation_vector, swing_of_point, swing_point, swing_twist, twist_angle,
        twist_of_angle,
    },
};

/// The joint of a bone with its parent.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct JointProfile {
    /// Which turns it allows.
    pub kind: JointKind,
    /// Axes of the joint in the figure's axes, bind pose: `X` is the axis of twist, or of a hinge.
    pub frame: Quat,
    /// Torque with which it resists turning when limp, newton-metres, at least 0: 2 to 5 for people. With
    /// none, limbs swing for a long time and come to rest late; more than slows what hangs on the joint by
    /// 600 rad/s² counts as that. A figure much lighter than a person needs as much less.
    pub friction: f32,
    /// Most torque that its muscles have, newton-metres, at least 0; infinite is allowed.
    pub max_torque: f32,
    /// A limit that gives; `None` is hard.
    pub softness: Option<JointSoftness>,
    /// The load under which it parts; `None` holds for ever.
    pub breaks: Option<JointBreak>,
}

/// The load under which a joint parts.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct JointBreak {
    /// Force on the joint, newtons, above 0. A joint bears the weight of what hangs on it already.
    pub force: f32,
    /// For so long without a break, seconds, at least 0. Loads are looked at at the end of each tick: a
    /// blow that is over within it never counts.
    pub time: f32,
}

impl Default for JointBreak {
    fn default() -> Self {
        Self {
            force: 4000.0,
            time: 0.05,
        }
    }
}

impl Default for JointProfile {
    fn default() -> Self {
        Self {
            kind: JointKind::default(),
            frame: Quat::IDENTITY,
            friction: 2.5,
            max_torque: 200.0,
            softness: None,
            breaks: None,
        }
    }
}

/// How a limit gives: as a spring with the inertia of what hangs on the joint.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct JointSoftness {
    /// Hertz, above 0; beyond a quarter of the substep rate it is as good as hard.
    pub frequency: f32,
    /// Part of critical damping, at least 0; 1 does not bounce.
    pub damping_ratio: f32,
}

impl Default for JointSoftness {
    fn default() -> Self {
        Self {
            frequency: 8.0,
            damping_ratio: 1.0,
        }
    }
}

/// The kinds of joints. Angles are in radians, against the bind pose, about the axes of
/// [`JointProfile::frame`].
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum JointKind {
    /// Ball and socket: the X axis swings within an elliptic cone, and the bone twists about it.
    Ball {
        /// Greatest swing about Y and about Z, each `0.009..=3.07`.
        swing: Vec2,
        /// Where the middle of the cone is: swing about Y and Z from the bind pose.
        center: Vec2,
        /// Least and greatest twist, within `±π`.
        twist: Vec2,
    },
    /// Turns about X alone, across the bone: elbow, knee.
    Hinge {
        /// Least angle.
        min: f32,
        /// Greatest angle; the range is below a full turn.
        max: f32,
    },
    /// Turns about X alone, along the bone: the radius about the ulna.
    Pivot {
        /// Least angle.
        min: f32,
        /// Greatest angle; the range is below a full turn.
        max: f32,
    },
    /// Turns about Y and about Z within a range for each, without twist: the root of the thumb.
    Saddle {
        /// Least and greatest angle about Y.
        y: Vec2,
        /// Least and greatest angle about Z.
        z: Vec2,
    },
    /// An elliptic cone without twist: the wrist.
    Condyloid {
        /// Greatest swing about Y and about Z, each `0.009..=3.07`.
        swing: Vec2,
        /// Where the middle of the cone is: swing about Y and Z from the bind pose.
        center: Vec2,
    },
    /// Slides across X without turning: the bones of the palm.
    Gliding {
        /// Greatest way along Y and along Z, metres, at least 0.
        reach: Vec2,
    },
    /// Not at all.
    Fixed,
}

impl Default for JointKind {
    fn default() -> Self {
        Self::Ball {
            swing: Vec2::splat(0.7),
            center: Vec2::ZERO,
            twist: Vec2::new(-0.5, 0.5),
        }
    }
}

impl JointKind {
    /// Turns the axes of the joint into those that limits are counted from.
    pub(crate) fn center(&self) -> Quat {
        match *self {
            Self::Ball { center, .. } | Self::Condyloid { center, .. } => {
                from_rotation_vector(Vec3::new(0.0, center.x, center.y))
            }
            _ => Quat::IDENTITY,
        }
    }

    /// The cone, of those that have one.
    pub(crate) fn cone(&self) -> Option<EllipticCone> {
        match *self {
            Self::Ball { swing, .. } | Self::Condyloid { swing, .. } => {
                Some(EllipticCone::new(swing))
            }
            _ => None,
        }
    }

    /// How far a rotation is beyond the limits, radians; 0 within. `q` is that of the child's axes of the
    /// joint in the axes that limits are counted from.
    pub(crate) fn violation(&self, q: Quat) -> f32 {
        let outside = |a: f32, range: Vec2| (range.x - a).max(a - range.y).max(0.0);
        let (swing, _) = swing_twist(q);
        let p = swing_point(swing);
        match *self {
            Self::Ball { swing, twist, .. } => {
                let cone = EllipticCone::new(swing).excess(p).max(0.0);
                cone.max(outside(twist_angle(q), twist))
            }
            Self::Condyloid { swing, .. } => {
                let cone = EllipticCone::new(swing).excess(p).max(0.0);
                cone.max(twist_angle(q).abs())
            }
            Self::Hinge { min, max } | Self::Pivot { min, max } => {
                let off = 2.0 * ops::atan(p.length());
                off.max(turn_outside(twist_angle(q), min, max))
            }
            Self::Saddle { y, z } => {
                let angles = Vec2::new(2.0 * ops::atan(p.x), 2.0 * ops::atan(p.y));
                let off = twist_angle(q).abs();
                off.max(outside(angles.x, y)).max(outside(angles.y, z))
            }
            Self::Gliding { .. } | Self::Fixed => angle(q),
        }
    }

    /// The nearest rotation within the limits.
    pub(crate) fn clamp(&self, q: Quat) -> Quat {
        let (swing, _) = swing_twist(q);
        let p = swing_point(swing);
        match *self {
            Self::Ball { swing, twist, .. } => {
                let turn = twist_angle(q).clamp(twist.x, twist.y);
                swing_of_point(EllipticCone::new(swing).clamp(p)) * twist_of_angle(turn)
            }
            Self::Condyloid { swing, .. } => swing_of_point(EllipticCone::new(swing).clamp(p)),
            Self::Hinge { min, max } | Self::Pivot { min, max } => {
                let turn = twist_angle(q);
                let beyond = turn_outside(turn, min, max);
                if beyond == 0.0 {
                    return twist_of_angle(turn);
                }
                let to_min = angle(twist_of_angle(turn - min));
                let to_max = angle(twist_of_angle(turn - max));
                twist_of_angle(if to_min < to_max { min } else { max })
            }
            Self::Saddle { y, z } => {
                let tan = |a: f32| ops::tan(a * 0.5);
                let half = |a: f32, range: Vec2| tan((2.0 * ops::atan(a)).clamp(range.x, range.y));
                swing_of_point(Vec2::new(half(p.x, y), half(p.y, z)))
            }
            Self::Gliding { .. } | Self::Fixed => Quat::IDENTITY,
        }
    }
}

/// How far an angle is outside of a range on the circle, by the shorter way, radians.
fn turn_outside(turn: f32, min: f32, max: f32) -> f32 {
    use core::f32::consts::{PI, TAU};
    let middle = (min + max) * 0.5;
    let off = (turn - middle + PI).rem_euclid(TAU) - PI;
    (off.abs() - (max - min) * 0.5).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds() -> [JointKind; 7] {
        [
            JointKind::Ball {
                swing: Vec2::new(0.9, 0.4),
                center: Vec2::new(0.3, -0.2),
                twist: Vec2::new(-0.3, 0.8),
            },
            JointKind::Hinge { min: 0.0, max: 2.5 },
            JointKind::Pivot {
                min: -1.0,
                max: 4.2,
            },
            JointKind::Saddle {
                y: Vec2::new(-0.2, 0.9),
                z: Vec2::new(-0.5, 0.1),
            },
            JointKind::Condyloid {
                swing: Vec2::new(1.2, 0.5),
                center: Vec2::ZERO,
            },
            JointKind::Gliding {
                reach: Vec2::splat(0.01),
            },
            JointKind::Fixed,
        ]
    }

    #[test]
    fn a_clamped_rotation_is_within_and_one_within_is_kept() {
        for kind in kinds() {
            for i in 0..300u32 {
                let f = |k: u32| (i * k % 199) as f32 / 99.0 - 1.0;
                let q = from_rotation_vector(Vec3::new(f(31), f(57), f(83)) * 1.8);
                let clamped = kind.clamp(q);
                assert!(
                    kind.violation(clamped) < 2.0e-3,
                    "{kind:?} {q}: {}",
                    kind.violation(clamped)
                );
                let again = kind.clamp(clamped);
                assert!(angle(again.inverse() * clamped) < 4.0e-3, "{kind:?} {q}");
            }
        }
    }

    #[test]
    fn hinges_reach_round_beyond_half_a_turn() {
        let hinge = JointKind::Hinge { min: 0.0, max: 4.7 };
        assert!(hinge.violation(twist_of_angle(4.5)) < 1.0e-5);
        assert!((hinge.violation(twist_of_angle(-0.5)) - 0.5).abs() < 1.0e-4);
        assert!(angle(hinge.clamp(twist_of_angle(-0.5))) < 1.0e-4);
    }
}
