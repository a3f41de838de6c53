//! How far the joints of a human go, and by how much a pose is beyond that.

use bevy::math::{DQuat, DVec3};

use super::{
    bones::{SIDES, arm, on_side, raised},
    pose::{arm_limb, leg_limb},
};
use crate::figures::{
    ik::Limb,
    skeleton::{Pose, Skeleton},
};

/// An elliptic cone about a bone with its twist; degrees.
struct Cone {
    bone: &'static str,
    /// Along the bone when it is not turned.
    axis: DVec3,
    /// Middle of the cone.
    center: DQuat,
    /// Across the cone: an axis and how far the bone turns about it, and the other way.
    across: [(DVec3, f64); 2],
    twist: f64,
}

fn about(axis: DVec3, degrees: f64) -> DQuat {
    DQuat::from_axis_angle(axis, degrees.to_radians())
}

/// Every joint that is no hinge, as on the left.
fn cones() -> Vec<Cone> {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let (.., hand) = arm();
    let back = super::bones::palm().cross(hand);
    let cone = |bone, axis, center, across, twist| Cone {
        bone,
        axis,
        center,
        across,
        twist,
    };
    let still = DQuat::IDENTITY;
    let spine = |bone| cone(bone, y, about(x, 8.0), [(x, 22.0), (z, 12.0)], 12.0);
    let neck = |bone| cone(bone, y, still, [(x, 30.0), (z, 20.0)], 40.0);
    let ahead = DQuat::from_rotation_arc(-y, DVec3::new(0.5, -0.5_f64.sqrt(), 0.5));
    vec![
        spine("spine"),
        spine("chest"),
        spine("upperChest"),
        neck("neck"),
        neck("head"),
        cone("Shoulder", x, about(z, 10.0), [(z, 25.0), (y, 15.0)], 1.0),
        cone("UpperArm", -y, ahead, [(x, 100.0), (z, 100.0)], 90.0),
        cone(
            "Hand",
            hand,
            still,
            [(back, 75.0), (super::bones::palm(), 30.0)],
            1.0,
        ),
        cone(
            "UpperLeg",
            -y,
            about(x, -45.0),
            [(x, 75.0), (z, 40.0)],
            45.0,
        ),
        cone("Foot", -y, about(x, 15.0), [(x, 35.0), (z, 25.0)], 10.0),
    ]
}

impl Cone {
    /// Degrees beyond the cone and beyond the twist.
    fn beyond(&self, turn: DQuat) -> f64 {
        let from = self.center.inverse() * turn;
        let along = self.axis * DVec3::new(from.x, from.y, from.z).dot(self.axis);
        let twist = DQuat::from_xyzw(along.x, along.y, along.z, from.w).normalize();
        let swing = short(from * twist.inverse());
        let [a, b] = self
            .across
            .map(|(axis, half)| swing.dot(axis).to_degrees() / half);
        let most = self.across[0].1.min(self.across[1].1);
        let outside = ((a * a + b * b).sqrt() - 1.0) * most;
        outside.max(short(twist).length().to_degrees() - self.twist)
    }
}

/// Axis times angle, the shorter way.
fn short(turn: DQuat) -> DVec3 {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    turn.to_scaled_axis()
}

/// Degrees beyond a hinge, and beyond what it may twist along the lower bone.
fn hinge(limb: &Limb, turn: DQuat, [low, high]: [f64; 2], twist: f64) -> f64 {
    let lower = limb.lower.normalize();
    let along = lower * DVec3::new(turn.x, turn.y, turn.z).dot(lower);
    let roll = DQuat::from_xyzw(along.x, along.y, along.z, turn.w).normalize();
    let bend = short(turn * roll.inverse());
    let angle = (bend.dot(limb.hinge()) + limb.rest()).to_degrees();
    let aside = bend.reject_from(limb.hinge()).length().to_degrees() - 0.1;
    (low - angle)
        .max(angle - high)
        .max(aside)
        .max(short(roll).length().to_degrees() - twist)
}

/// The joint that is most beyond its limits, and by how many degrees.
pub fn worst(skeleton: &Skeleton, pose: &Pose) -> (String, f64) {
    let mut all = Vec::new();
    let cones = cones();
    for (side, sign) in SIDES {
        let turn = |name: &str| on_side(pose.turns[skeleton.find(name)], sign);
        for cone in &cones {
            if cone.bone.starts_with(char::is_lowercase) {
                all.push((cone.bone.to_string(), cone.beyond(turn(cone.bone))));
                continue;
            }
            let name = format!("{side}{}", cone.bone);
            let from_rest = match cone.bone {
                "UpperArm" => turn(&name) * raised(),
                _ => turn(&name),
            };
            all.push((name, cone.beyond(from_rest)));
        }
        let name = format!("{side}LowerArm");
        let beyond = hinge(&arm_limb(), turn(&name), [0.0, 145.0], 80.0);
        all.push((name, beyond));
        let name = format!("{side}LowerLeg");
        let beyond = hinge(&leg_limb(), turn(&name), [0.0, 140.0], 0.5);
        all.push((name, beyond));
        let name = format!("{side}Toes");
        let up = -short(turn(&name)).x.to_degrees();
        all.push((name, (-30.0 - up).max(up - 60.0)));
    }
    all.into_iter()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or_default()
}
