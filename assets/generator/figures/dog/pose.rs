//! A pose of the dog as an animator says it: hips, back, neck and where the paws are. Degrees and
//! metres.

use bevy::math::{DQuat, DVec3};

use super::bones::{SIDES, at};
use crate::figures::{
    curve,
    ik::Limb,
    skeleton::{Pose, Skeleton, mirror},
};

/// A leg, as on the left: `x` is positive outwards.
#[derive(Clone, Debug)]
pub struct Leg {
    /// The joint of the toes.
    pub paw: DVec3,
    /// How far what is above the toes leans forwards.
    pub lean: f64,
    /// Toes down.
    pub toes: f64,
    /// Shoulder blade swung forwards, for the legs in front.
    pub blade: f64,
}

#[derive(Clone, Debug)]
pub struct Stance {
    pub hips: DVec3,
    /// Nose down, to the left, turned to the left.
    pub pelvis: [f64; 3],
    pub back: [f64; 3],
    pub neck: [f64; 3],
    pub head: [f64; 3],
    /// Tail up, to the left.
    pub tail: [f64; 2],
    /// Left and right in front, left and right at the back.
    pub legs: [Leg; 4],
}

fn turn([pitch, roll, yaw]: [f64; 3]) -> DQuat {
    DQuat::from_rotation_y(yaw.to_radians())
        * DQuat::from_rotation_x(pitch.to_radians())
        * DQuat::from_rotation_z(-roll.to_radians())
}

pub fn stand() -> Stance {
    let leg = |paw: DVec3| Leg {
        paw,
        lean: 0.0,
        toes: 0.0,
        blade: 0.0,
    };
    let (front, back) = (leg(at::FRONT[4]), leg(at::BACK[3]));
    Stance {
        hips: at::HIPS - DVec3::Y * 0.008,
        pelvis: [0.0; 3],
        back: [0.0; 3],
        neck: [0.0; 3],
        head: [6.0, 0.0, 0.0],
        tail: [0.0, 0.0],
        legs: [front.clone(), front, back.clone(), back],
    }
}

impl Stance {
    /// The turns of all bones.
    pub fn pose(&self, skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::bind(skeleton);
        pose.shift = self.hips - at::HIPS;
        let mut set = |name: &str, angles: [f64; 3]| {
            pose.turns[skeleton.find(name)] = turn(angles);
        };
        set("hips", self.pelvis);
        set("spine", self.back.map(|a| a / 2.0));
        set("chest", self.back.map(|a| a / 2.0));
        set("neck", self.neck);
        set("head", self.head);
        for name in ["tail1", "tail2", "tail3"] {
            set(name, [self.tail[0], 0.0, -self.tail[1]]);
        }
        for (i, leg) in self.legs.iter().enumerate() {
            leg.set(skeleton, &mut pose, SIDES[i % 2], i < 2);
        }
        pose
    }

    fn values(&self) -> Vec<f64> {
        let mut all = self.hips.to_array().to_vec();
        for angles in [&self.pelvis, &self.back, &self.neck, &self.head] {
            all.extend(angles);
        }
        all.extend(self.tail);
        for leg in &self.legs {
            all.extend(leg.paw.to_array());
            all.extend([leg.lean, leg.toes, leg.blade]);
        }
        all
    }

    fn from_values(values: &[f64]) -> Self {
        let mut values = values.iter().copied();
        let mut next = || values.next().unwrap_or_default();
        let mut three = || [next(), next(), next()];
        let (hips, pelvis, back, neck, head) = (three(), three(), three(), three(), three());
        let tail = [next(), next()];
        Self {
            hips: hips.into(),
            pelvis,
            back,
            neck,
            head,
            tail,
            legs: [(); 4].map(|()| Leg {
                paw: DVec3::new(next(), next(), next()),
                lean: next(),
                toes: next(),
                blade: next(),
            }),
        }
    }

    /// A smooth way through stances at times.
    pub fn between(keys: &[(f64, Self)], t: f64) -> Self {
        let values: Vec<Vec<f64>> = keys.iter().map(|(_, stance)| stance.values()).collect();
        let track = |i: usize| -> Vec<(f64, f64)> {
            let times = keys.iter().map(|(time, _)| *time);
            times.zip(values.iter().map(|values| values[i])).collect()
        };
        let mixed: Vec<f64> = (0..values[0].len())
            .map(|i| curve::keys(&track(i), t))
            .collect();
        Self::from_values(&mixed)
    }
}

impl Leg {
    fn set(&self, skeleton: &Skeleton, pose: &mut Pose, (side, sign): (&str, f64), front: bool) {
        let bone = |name: &str| skeleton.find(&format!("{side}{name}"));
        let flip = |v: DVec3| DVec3::new(sign * v.x, v.y, v.z);
        let on_side = |turn: DQuat| if sign > 0.0 { turn } else { mirror(turn) };
        let about_x = |degrees: f64| DQuat::from_rotation_x(degrees.to_radians());
        // Upper joint, middle joint, end of what bends; then the joint of the toes.
        let (names, joints, pole) = if front {
            let [_, a, b, c, d, _] = at::FRONT;
            let names = ["FrontUpperLeg", "FrontLowerLeg", "FrontFoot", "FrontToes"];
            pose.turns[bone("Shoulder")] = about_x(-self.blade);
            (names, [a, b, c, d], DVec3::new(0.0, -0.1, -1.0))
        } else {
            let [a, b, c, d, _] = at::BACK;
            (super::bones::BACK, [a, b, c, d], DVec3::new(0.0, 0.1, 1.0))
        };
        let [a, b, c, d] = joints;
        let limb = Limb {
            upper: b - a,
            lower: c - b,
            most: 2.9,
        };
        let foot = about_x(self.lean);
        let end = self.paw + foot * (c - d);
        let from = flip(pose.place(skeleton, bone(names[0])).at);
        let [upper, lower] = limb.reach(from, end, pole);
        pose.aim(skeleton, bone(names[0]), on_side(upper));
        pose.turns[bone(names[1])] = on_side(lower);
        pose.aim(skeleton, bone(names[2]), on_side(foot));
        pose.aim(skeleton, bone(names[3]), on_side(about_x(self.toes)));
    }
}
