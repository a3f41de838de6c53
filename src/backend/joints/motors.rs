//! The joint that drives.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextEntityLink,
    rapier::{
        dynamics::{GenericJoint, JointAxesMask, JointAxis, MotorModel},
        math::Pose,
    },
};

use super::{JointFrames, JointHandle, JointWorlds, SLIDES, TURNS};

/// Three motors about, or along, the axes of a joint's first frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct MotorRows {
    /// Newton-metres per radian, or newtons per metre.
    pub stiffness: Vec3,
    /// By the second.
    pub damping: Vec3,
    /// Radians, or metres, per second.
    pub velocity: Vec3,
    /// Newton-metres or newtons, finite.
    pub most: f32,
}

pub(super) fn enable(joint: &mut GenericJoint, axis: JointAxis) {
    // By the engine's own model, gains are scaled by the two bodies' inertia about their centres, which
    // has little to do with what hangs on the joint.
    joint.set_motor(axis, 0.0, 0.0, 0.0, 0.0);
    joint.set_motor_model(axis, MotorModel::ForceBased);
    joint.set_motor_max_force(axis, 0.0);
}

pub(super) fn joint(frames: &JointFrames, axes: &[JointAxis]) -> GenericJoint {
    let mut joint = GenericJoint::new(JointAxesMask::empty());
    joint.contacts_enabled = false;
    joint.local_frame1 = Pose::from_parts(frames.anchor1, frames.rotation1);
    joint.local_frame2 = Pose::from_parts(frames.anchor2, frames.rotation2);
    for axis in axes {
        enable(&mut joint, *axis);
    }
    joint
}

fn write(joint: &mut GenericJoint, axes: [JointAxis; 3], rows: &MotorRows) {
    for (i, axis) in axes.into_iter().enumerate() {
        let motor = &mut joint.motors[axis as usize];
        motor.target_vel = rows.velocity[i];
        motor.stiffness = rows.stiffness[i];
        motor.damping = rows.damping[i];
        motor.max_force = rows.most;
    }
}

impl JointWorlds<'_, '_> {
    /// Turns the first frame to the target and sets the motors that lead there.
    pub fn drive(
        &mut self,
        link: &RapierContextEntityLink,
        joint: JointHandle,
        rotation1: Quat,
        rows: &MotorRows,
    ) {
        self.edit(link, joint, |joint| {
            joint.local_frame1.rotation = rotation1;
            write(joint, TURNS, rows);
        });
    }

    /// Moves a pin to this pose of the world and sets its motors.
    pub fn drive_pin(
        &mut self,
        link: &RapierContextEntityLink,
        joint: JointHandle,
        position: Vec3,
        rotation: Quat,
        slides: &MotorRows,
        turns: &MotorRows,
    ) {
        self.edit(link, joint, |joint| {
            joint.local_frame1 = Pose::from_parts(position, rotation);
            write(joint, SLIDES, slides);
            write(joint, TURNS, turns);
        });
    }
}
