//! The joints of a human figure, by the ranges that tables of anatomy give.

use bevy::{
    math::{Vec2, ops},
    prelude::*,
};

use super::{
    part::{BodyPart, HumanoidDetail},
    rig::HumanoidRig,
};
use crate::ragdoll::{
    math::rotation::rotation_vector,
    profile::{JointKind, JointProfile, degrees},
};

const RIGHT: Vec3 = Vec3::X;
const FORWARD: Vec3 = Vec3::NEG_Z;

/// Axes with their X along `x` and their Y as near to `y` as can be.
fn axes(x: Vec3, y: Vec3) -> Quat {
    let x = x.normalize_or(Vec3::NEG_Y);
    let z = x.cross(y).normalize_or(x.any_orthonormal_vector());
    let y = z.cross(x);
    Quat::from_mat3(&Mat3::from_cols(x, y, z)).normalize()
}

/// A ball whose cone is about the direction `middle`, wherever the bone points in the bind pose. Half
/// angles are in the sagittal and in the frontal plane, degrees.
fn ball(bone: Vec3, middle: Vec3, across: Vec3, swing: [f32; 2], twist: f32) -> (Quat, JointKind) {
    let bone = bone.normalize_or(Vec3::NEG_Y);
    let middle = middle.normalize_or(bone);
    let centered = axes(middle, across);
    let arc = Quat::from_rotation_arc(bone, middle);
    let frame = (arc.inverse() * centered).normalize();
    let center = rotation_vector(frame.inverse() * centered);
    let kind = JointKind::Ball {
        swing: Vec2::new(swing[0].to_radians(), swing[1].to_radians()),
        center: Vec2::new(center.y, center.z),
        twist: Vec2::new(-twist.to_radians(), twist.to_radians()),
    };
    (frame, kind)
}

/// The same without twist.
fn without_twist((frame, kind): (Quat, JointKind)) -> (Quat, JointKind) {
    match kind {
        JointKind::Ball { swing, center, .. } => (frame, JointKind::Condyloid { swing, center }),
        other => (frame, other),
    }
}

/// A hinge that closes by turning `lower` towards `closes`, from straight to `most` degrees, where the
/// bind pose may be bent already.
fn hinge(upper: Vec3, lower: Vec3, closes: Vec3, most: f32) -> (Quat, JointKind) {
    let (upper, lower) = (upper.normalize_or(lower), lower.normalize_or(upper));
    let bend = upper.cross(lower);
    let expected = upper.cross(closes).normalize_or(RIGHT);
    // The bend of the bind pose tells the axis better than anatomy does.
    let axis = if bend.length() > 0.08 && bend.dot(expected) > 0.5 * bend.length() {
        bend.normalize()
    } else {
        expected
    };
    let bent = ops::atan2(bend.dot(axis), upper.dot(lower));
    let kind = JointKind::Hinge {
        min: -bent,
        max: most.to_radians() - bent,
    };
    (axes(axis, lower), kind)
}

/// Friction and greatest torque of a joint, newton-metres: those of a strong adult of 75 kg.
fn strength(part: BodyPart) -> (f32, f32) {
    use BodyPart::*;
    match part {
        LeftThigh | RightThigh | LowerSpine | MiddleSpine | UpperSpine | Chest => (5.0, 250.0),
        LeftShin | RightShin => (2.5, 200.0),
        LeftFoot | RightFoot => (2.5, 150.0),
        LeftClavicle | RightClavicle | LeftUpperArm | RightUpperArm => (2.5, 100.0),
        LeftForearm | RightForearm => (2.0, 80.0),
        Neck | Head => (2.0, 50.0),
        _ => (0.6, 20.0),
    }
}

/// The joint of a body with the body that bears it.
pub(super) fn joint(
    part: BodyPart,
    parent: BodyPart,
    rig: &HumanoidRig,
    detail: HumanoidDetail,
) -> JointProfile {
    use BodyPart::*;
    let bone = rig.end(part) - rig.start(part);
    let upper = rig.end(parent) - rig.start(parent);
    let side = part.side();
    // Joints of the spine at this level.
    let links = match detail {
        HumanoidDetail::Bodies10 | HumanoidDetail::Bodies15 => 1.0,
        HumanoidDetail::Bodies19 => 2.0,
        HumanoidDetail::Bodies23 => 4.0,
    };
    let (frame, kind) = match part {
        LowerSpine | MiddleSpine | UpperSpine | Chest => {
            let middle = degrees(RIGHT, -24.0 / links) * bone;
            let reach = [66.0 / links, 36.0 / links];
            ball(bone, middle, RIGHT, reach, 36.0 / links)
        }
        Neck | Head => {
            let single = part == Head && !Neck.is_body(detail);
            let n = if single { 2.0 } else { 1.0 };
            ball(bone, bone, RIGHT, [30.0 * n, 20.0 * n], 40.0 * n)
        }
        LeftClavicle | RightClavicle => {
            let middle = degrees(Vec3::Z, 10.0 * side) * bone;
            // Its sagittal plane is the horizontal one.
            without_twist(ball(bone, middle, Vec3::Z, [25.0, 15.0], 0.0))
        }
        LeftUpperArm | RightUpperArm => {
            let middle = Vec3::new(side, -1.0, -1.0);
            ball(bone, middle, RIGHT, [100.0, 100.0], 90.0)
        }
        LeftForearm | RightForearm => hinge(upper, bone, FORWARD, 145.0),
        LeftHand | RightHand => {
            // With the thumb forward the palm bends inward.
            ball(bone, upper, Vec3::Z, [75.0, 30.0], 80.0)
        }
        LeftThigh | RightThigh => {
            let middle = degrees(RIGHT, 45.0) * bone;
            ball(bone, middle, RIGHT, [75.0, 40.0], 45.0)
        }
        LeftShin | RightShin => hinge(upper, bone, -FORWARD, 140.0),
        LeftFoot | RightFoot => {
            let middle = degrees(RIGHT, -15.0) * bone;
            ball(bone, middle, RIGHT, [35.0, 25.0], 10.0)
        }
        LeftToes | RightToes => (
            Quat::IDENTITY,
            JointKind::Hinge {
                min: -(30f32.to_radians()),
                max: 60f32.to_radians(),
            },
        ),
        Pelvis => (Quat::IDENTITY, JointKind::Fixed),
    };
    let (friction, max_torque) = strength(part);
    JointProfile {
        kind,
        frame,
        friction,
        max_torque,
        softness: None,
        breaks: None,
    }
}
