//! The skeleton of a dog of 0.58 m at the shoulders, and the gates of its skin.

use bevy::math::DVec3;

use crate::figures::{skeleton::Skeleton, skin::Gate};

pub const SIDES: [(&str, f64); 2] = [("left", 1.0), ("right", -1.0)];

/// Joints, those of pairs on the left.
pub mod at {
    use bevy::math::DVec3;

    pub const HIPS: DVec3 = DVec3::new(0.0, 0.52, -0.3);
    pub const LOIN: DVec3 = DVec3::new(0.0, 0.545, -0.14);
    pub const CHEST: DVec3 = DVec3::new(0.0, 0.535, 0.06);
    pub const NECK: DVec3 = DVec3::new(0.0, 0.575, 0.24);
    pub const HEAD: DVec3 = DVec3::new(0.0, 0.705, 0.355);
    pub const NOSE: DVec3 = DVec3::new(0.0, 0.665, 0.55);
    pub const TAIL: [DVec3; 4] = [
        DVec3::new(0.0, 0.55, -0.385),
        DVec3::new(0.0, 0.545, -0.48),
        DVec3::new(0.0, 0.565, -0.58),
        DVec3::new(0.0, 0.615, -0.665),
    ];
    pub const EAR: [DVec3; 2] = [
        DVec3::new(0.045, 0.765, 0.345),
        DVec3::new(0.07, 0.70, 0.345),
    ];
    /// Shoulder blade, shoulder, elbow, wrist, paw, tip of the paw.
    pub const FRONT: [DVec3; 6] = [
        DVec3::new(0.05, 0.575, 0.145),
        DVec3::new(0.082, 0.445, 0.235),
        DVec3::new(0.085, 0.305, 0.145),
        DVec3::new(0.083, 0.105, 0.17),
        DVec3::new(0.083, 0.03, 0.185),
        DVec3::new(0.083, 0.018, 0.235),
    ];
    /// Hip, knee, heel, paw, tip of the paw.
    pub const BACK: [DVec3; 5] = [
        DVec3::new(0.072, 0.495, -0.325),
        DVec3::new(0.086, 0.325, -0.235),
        DVec3::new(0.08, 0.165, -0.4),
        DVec3::new(0.08, 0.03, -0.37),
        DVec3::new(0.08, 0.018, -0.32),
    ];
}

pub const FRONT: [&str; 5] = [
    "Shoulder",
    "FrontUpperLeg",
    "FrontLowerLeg",
    "FrontFoot",
    "FrontToes",
];
pub const BACK: [&str; 4] = ["BackUpperLeg", "BackLowerLeg", "BackFoot", "BackToes"];

pub fn skeleton() -> Skeleton {
    let mut made = Skeleton::default();
    made.add("hips", "", at::HIPS, at::LOIN);
    made.add("spine", "hips", at::LOIN, at::CHEST);
    made.add("chest", "spine", at::CHEST, at::NECK);
    made.add("neck", "chest", at::NECK, at::HEAD);
    made.add("head", "neck", at::HEAD, at::NOSE);
    for (i, pair) in at::TAIL.windows(2).enumerate() {
        let parent = match i {
            0 => "hips".into(),
            _ => format!("tail{i}"),
        };
        made.add(&format!("tail{}", i + 1), &parent, pair[0], pair[1]);
    }
    for (side, sign) in SIDES {
        let flip = |v: DVec3| DVec3::new(sign * v.x, v.y, v.z);
        made.add(
            &format!("{side}Ear"),
            "head",
            flip(at::EAR[0]),
            flip(at::EAR[1]),
        );
        let mut chain = |names: &[&str], joints: &[DVec3], root: &str| {
            let mut parent = root.to_string();
            for (name, pair) in names.iter().zip(joints.windows(2)) {
                let name = format!("{side}{name}");
                made.add(&name, &parent, flip(pair[0]), flip(pair[1]));
                parent = name;
            }
        };
        chain(&FRONT, &at::FRONT, "chest");
        chain(&BACK, &at::BACK, "hips");
    }
    made
}

/// The gates of the skin, one at every joint.
pub fn gates(skeleton: &Skeleton) -> Vec<Gate> {
    let mut gates = Vec::new();
    let mut gate = |name: &str, point: DVec3, normal: DVec3, half: f64, side: Option<f64>| {
        gates.push(Gate {
            bone: skeleton.find(name),
            point,
            normal,
            half,
            side,
            wing: if name.starts_with("tail") {
                [0.04, -8.0]
            } else {
                [0.0; 2]
            },
        });
    };
    gate("spine", at::LOIN, DVec3::Z, 0.09, None);
    gate("chest", at::CHEST, DVec3::Z, 0.08, None);
    gate("neck", at::NECK, at::HEAD - at::NECK, 0.06, None);
    gate("head", at::HEAD, DVec3::new(0.0, 0.35, 1.0), 0.035, None);
    for (i, pair) in at::TAIL.windows(2).enumerate() {
        gate(
            &format!("tail{}", i + 1),
            pair[0],
            pair[1] - pair[0],
            0.03,
            None,
        );
    }
    for (side, sign) in SIDES {
        let flip = |v: DVec3| DVec3::new(sign * v.x, v.y, v.z);
        let mut gate = |name: &str, point: DVec3, normal: DVec3, half: f64, pair: Option<f64>| {
            gate(
                &format!("{side}{name}"),
                flip(point),
                flip(normal),
                half,
                pair,
            );
        };
        let [_, shoulder, elbow, wrist, paw, _] = at::FRONT;
        let [hip, knee, heel, hind, _] = at::BACK;
        gate(
            "Ear",
            at::EAR[0] + DVec3::X * 0.006,
            DVec3::new(1.0, -0.6, 0.0),
            0.014,
            None,
        );
        gate(
            "Shoulder",
            DVec3::new(0.075, 0.47, 0.2),
            DVec3::new(0.75, -0.55, 0.1),
            0.05,
            Some(0.03),
        );
        gate(
            "FrontUpperLeg",
            shoulder - DVec3::Y * 0.03,
            DVec3::new(0.1, -1.0, -0.3),
            0.05,
            None,
        );
        gate(
            "FrontLowerLeg",
            elbow,
            DVec3::new(0.0, -1.0, 0.35),
            0.04,
            None,
        );
        gate("FrontFoot", wrist, -DVec3::Y, 0.025, None);
        gate("FrontToes", paw, DVec3::new(0.0, -0.5, 1.0), 0.018, None);
        gate(
            "BackUpperLeg",
            hip + DVec3::new(-0.01, -0.05, 0.0),
            DVec3::new(0.7, -1.0, 0.0),
            0.07,
            Some(0.03),
        );
        gate(
            "BackLowerLeg",
            knee,
            DVec3::new(0.0, -0.95, -0.3),
            0.045,
            None,
        );
        gate("BackFoot", heel, DVec3::new(0.0, -1.0, -0.1), 0.03, None);
        gate("BackToes", hind, DVec3::new(0.0, -0.5, 1.0), 0.018, None);
    }
    gates
}
