//! The joint that locks a pivot and holds limits.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    rapier::{
        dynamics::{GenericJoint, JointAxesMask, JointAxis, SpringCoefficients},
        math::Pose,
    },
};

use super::{JointHandle, JointWorlds, SLIDES, TURNS};

/// A limit of a cone must not bound the angle from below.
const BELOW: f32 = -1.0;

/// Where a joint is on each of its bodies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct JointFrames {
    pub anchor1: Vec3,
    pub rotation1: Quat,
    pub anchor2: Vec3,
    pub rotation2: Quat,
}

/// Which motions a joint takes away or bounds; of each kind about or along X, Y, Z.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct JointRows {
    pub locked_slides: [bool; 3],
    pub locked_turns: [bool; 3],
    /// Metres.
    pub slides: [Option<[f32; 2]>; 3],
    /// Radians.
    pub turns: [Option<[f32; 2]>; 3],
    /// Half angle of a circular cone between the X axes, radians.
    pub cone: Option<f32>,
}

/// How rows give.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RowSpring {
    /// Hertz.
    pub frequency: f32,
    pub damping_ratio: f32,
}

pub(super) fn joint(
    frames: &JointFrames,
    rows: &JointRows,
    spring: Option<RowSpring>,
) -> GenericJoint {
    let mut joint = GenericJoint::new(JointAxesMask::empty());
    joint.contacts_enabled = false;
    joint.local_frame1 = Pose::from_parts(frames.anchor1, frames.rotation1);
    joint.local_frame2 = Pose::from_parts(frames.anchor2, frames.rotation2);
    for (i, axis) in SLIDES.into_iter().enumerate() {
        if rows.locked_slides[i] {
            joint.lock_axes(axis.into());
        } else if let Some(limits) = rows.slides[i] {
            joint.set_limits(axis, limits);
        }
    }
    for (i, axis) in TURNS.into_iter().enumerate() {
        if rows.locked_turns[i] {
            joint.lock_axes(axis.into());
        } else if let Some(limits) = rows.turns[i] {
            joint.set_limits(axis, limits);
        }
    }
    if let Some(half_angle) = rows.cone {
        joint.coupled_axes = JointAxesMask::ANG_Y | JointAxesMask::ANG_Z;
        joint.set_limits(JointAxis::AngY, [BELOW, half_angle]);
    }
    if let Some(spring) = spring {
        joint.softness = SpringCoefficients {
            natural_frequency: spring.frequency,
            damping_ratio: spring.damping_ratio,
        };
    }
    joint
}

/// What changes from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AimedRows {
    /// Of the first frame.
    pub rotation1: Quat,
    /// Of the second.
    pub rotation2: Quat,
    /// Metres.
    pub slides: [Option<[f32; 2]>; 3],
    /// Radians.
    pub cone: Option<f32>,
    /// Radians.
    pub turns: [Option<[f32; 2]>; 3],
}

impl JointWorlds<'_, '_> {
    /// Sets the limits of a joint for a tick.
    pub fn aim(&mut self, link: &RapierContextEntityLink, joint: JointHandle, rows: &AimedRows) {
        self.edit(link, joint, |joint| {
            joint.local_frame1.rotation = rows.rotation1;
            joint.local_frame2.rotation = rows.rotation2;
            let axes = SLIDES.into_iter().chain(TURNS);
            for (axis, limits) in axes.zip(rows.slides.into_iter().chain(rows.turns)) {
                if let Some(limits) = limits {
                    joint.set_limits(axis, limits);
                }
            }
            if let Some(half_angle) = rows.cone {
                joint.set_limits(JointAxis::AngY, [BELOW, half_angle]);
            }
        });
    }
}
