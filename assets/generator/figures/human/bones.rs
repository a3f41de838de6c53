//! The skeleton of a human of 1.80 m with arms half raised, and the gates of its skin.

use bevy::math::{DQuat, DVec3};

use crate::figures::{
    skeleton::{Skeleton, mirror},
    skin::Gate,
};

/// Both sides: prefix of the names, and the sign of `x`.
pub const SIDES: [(&str, f64); 2] = [("left", 1.0), ("right", -1.0)];

/// How far the arms are raised sideways in the bind pose, degrees.
pub const ARM_RAISED: f64 = 45.0;
/// How far the elbow is bent in the bind pose, degrees.
const ELBOW_BENT: f64 = 10.0;

const UPPER_ARM: f64 = 0.285;
const FOREARM: f64 = 0.255;

/// Joints of the left half.
pub mod at {
    use bevy::math::DVec3;

    pub const HIPS: DVec3 = DVec3::new(0.0, 0.955, 0.0);
    pub const SPINE: DVec3 = DVec3::new(0.0, 1.06, -0.005);
    pub const CHEST: DVec3 = DVec3::new(0.0, 1.18, -0.008);
    pub const UPPER_CHEST: DVec3 = DVec3::new(0.0, 1.315, -0.018);
    pub const NECK: DVec3 = DVec3::new(0.0, 1.485, -0.03);
    pub const HEAD: DVec3 = DVec3::new(0.0, 1.58, -0.008);
    pub const TOP: DVec3 = DVec3::new(0.0, 1.8, 0.0);
    pub const COLLAR: DVec3 = DVec3::new(0.03, 1.445, -0.01);
    pub const SHOULDER: DVec3 = DVec3::new(0.172, 1.435, -0.022);
    pub const HIP: DVec3 = DVec3::new(0.09, 0.945, 0.0);
    pub const KNEE: DVec3 = DVec3::new(0.094, 0.51, 0.012);
    pub const ANKLE: DVec3 = DVec3::new(0.098, 0.078, -0.022);
    pub const BALL: DVec3 = DVec3::new(0.104, 0.022, 0.105);
    pub const TOE: DVec3 = DVec3::new(0.106, 0.022, 0.185);
    pub const HEEL: DVec3 = DVec3::new(0.098, 0.0, -0.075);
}

/// The turn that takes the left arm from hanging down to the bind pose.
pub fn raised() -> DQuat {
    DQuat::from_rotation_z(ARM_RAISED.to_radians())
}

/// The left arm in the bind pose: shoulder, elbow, wrist, and the direction of the hand.
pub fn arm() -> (DVec3, DVec3, DVec3, DVec3) {
    let down = raised() * -DVec3::Y;
    let bend = DQuat::from_axis_angle(down.cross(DVec3::Z), ELBOW_BENT.to_radians());
    let elbow = at::SHOULDER + down * UPPER_ARM;
    let ahead = bend * down;
    (at::SHOULDER, elbow, elbow + ahead * FOREARM, ahead)
}

/// Axis through the thickness of the left hand, from its back to its palm.
pub fn palm() -> DVec3 {
    let (.., ahead) = arm();
    let thumb = (DVec3::Z - ahead * ahead.z).normalize();
    ahead.cross(thumb)
}

/// From the left wrist: so far along the hand, towards the thumb, out of the palm.
pub fn hand(along: f64, thumb: f64, out: f64) -> DVec3 {
    let (_, _, wrist, ahead) = arm();
    wrist + ahead * along + palm().cross(ahead) * thumb + palm() * out
}

pub fn skeleton() -> Skeleton {
    let mut made = Skeleton::default();
    made.add("hips", "", at::HIPS, at::SPINE);
    made.add("spine", "hips", at::SPINE, at::CHEST);
    made.add("chest", "spine", at::CHEST, at::UPPER_CHEST);
    made.add("upperChest", "chest", at::UPPER_CHEST, at::NECK);
    made.add("neck", "upperChest", at::NECK, at::HEAD);
    made.add("head", "neck", at::HEAD, at::TOP);
    let (shoulder, elbow, wrist, _) = arm();
    for (side, sign) in SIDES {
        let flip = |v: DVec3| DVec3::new(sign * v.x, v.y, v.z);
        let mut add = |name: &str, parent: &str, head: DVec3, tail: DVec3| {
            let parent = match parent {
                "hips" | "upperChest" => parent.to_string(),
                _ => format!("{side}{parent}"),
            };
            made.add(&format!("{side}{name}"), &parent, flip(head), flip(tail));
        };
        add("Shoulder", "upperChest", at::COLLAR, shoulder);
        add("UpperArm", "Shoulder", shoulder, elbow);
        add("LowerArm", "UpperArm", elbow, wrist);
        add("Hand", "LowerArm", wrist, hand(0.09, 0.0, 0.0));
        add(
            "Fingers",
            "Hand",
            hand(0.09, 0.0, 0.0),
            hand(0.18, 0.0, 0.0),
        );
        add(
            "Thumb",
            "Hand",
            hand(0.03, 0.028, 0.004),
            hand(0.085, 0.06, 0.008),
        );
        add("UpperLeg", "hips", at::HIP, at::KNEE);
        add("LowerLeg", "UpperLeg", at::KNEE, at::ANKLE);
        add("Foot", "LowerLeg", at::ANKLE, at::BALL);
        add("Toes", "Foot", at::BALL, at::TOE);
    }
    made
}

/// The gates of the skin, one at every joint.
pub fn gates(skeleton: &Skeleton) -> Vec<Gate> {
    let mut gates = Vec::new();
    let mut gate = |name: &str, point: DVec3, normal: DVec3, half: f64| {
        let leg = name.ends_with("UpperLeg");
        let wing = match name {
            "spine" | "chest" | "upperChest" => [0.19, 4.0],
            "neck" => [0.065, -3.0],
            _ if leg => [0.19, -4.0],
            _ => [0.0; 2],
        };
        gates.push(Gate {
            bone: skeleton.find(name),
            point,
            normal,
            half,
            side: leg.then_some(0.04),
            wing,
        });
    };
    let up = DVec3::Y;
    gate("spine", at::SPINE, up, 0.06);
    gate("chest", at::CHEST, up, 0.06);
    gate("upperChest", at::UPPER_CHEST, up, 0.06);
    gate(
        "neck",
        at::NECK + up * 0.01,
        DVec3::new(0.0, 1.0, 0.3),
        0.035,
    );
    gate(
        "head",
        at::HEAD + up * 0.005,
        DVec3::new(0.0, 1.0, -0.4),
        0.03,
    );
    let (shoulder, elbow, wrist, ahead) = arm();
    let along = (elbow - shoulder).normalize();
    let thumb = hand(0.07, 0.11, 0.0) - hand(0.03, 0.022, 0.0);
    for (side, sign) in SIDES {
        let flip = |v: DVec3| DVec3::new(sign * v.x, v.y, v.z);
        let mut gate = |name: &str, point: DVec3, normal: DVec3, half: f64| {
            gate(&format!("{side}{name}"), flip(point), flip(normal), half);
        };
        gate(
            "Shoulder",
            DVec3::new(0.095, 1.40, 0.0),
            DVec3::new(0.8, 0.6, 0.0),
            0.06,
        );
        gate(
            "UpperArm",
            shoulder - DVec3::X * 0.005,
            DVec3::new(0.95, -0.3, 0.0),
            0.055,
        );
        gate("LowerArm", elbow, (along + ahead).normalize(), 0.045);
        gate("Hand", wrist, ahead, 0.028);
        gate("Fingers", hand(0.09, 0.0, 0.0), ahead, 0.02);
        gate("Thumb", hand(0.04, 0.032, 0.0), thumb, 0.014);
        gate(
            "UpperLeg",
            at::HIP - up * 0.03,
            DVec3::new(0.25, -1.0, 0.0),
            0.075,
        );
        gate("LowerLeg", at::KNEE, -up, 0.06);
        gate(
            "Foot",
            at::ANKLE + up * 0.01,
            DVec3::new(0.0, -1.0, 0.35),
            0.03,
        );
        gate("Toes", at::BALL, DVec3::Z, 0.022);
    }
    gates
}

/// The same turn on a side of the body.
pub fn on_side(turn: DQuat, sign: f64) -> DQuat {
    if sign > 0.0 { turn } else { mirror(turn) }
}
