//! A pose of the human as an animator says it: where the hips and feet are, how far the back is
//! bent, where the arms point or what they lean on. Degrees and metres.

use bevy::math::{DQuat, DVec3};

use super::bones::{ARM_RAISED, SIDES, arm, at, on_side, palm};
use crate::figures::{
    curve,
    ik::Limb,
    skeleton::{Pose, Skeleton},
};

/// Most that a knee and an elbow bend, degrees.
pub const KNEE_MOST: f64 = 138.0;
pub const ELBOW_MOST: f64 = 143.0;
/// Most that the toes go up and down at the ankle, degrees.
const ANKLE_UP: f64 = 18.5;
const ANKLE_DOWN: f64 = 48.0;

/// An arm, as on the left: `x` is positive outwards.
#[derive(Clone, Debug)]
pub struct Arm {
    /// Collar bone: up, forwards.
    pub shoulder: [f64; 2],
    /// From hanging down: forwards, outwards, turned inwards, elbow.
    pub angles: [f64; 4],
    /// Where the wrist is while it holds on.
    pub hand: DVec3,
    /// Where the elbow points while it holds on.
    pub pole: DVec3,
    /// 0 by angles, 1 holds on.
    pub hold: f64,
    /// Forearm turned so that the palm looks back.
    pub forearm: f64,
    /// Hand bent back.
    pub wrist: f64,
    /// Fingers bent.
    pub grip: f64,
}

/// A leg, as on the left: `x` is positive outwards.
#[derive(Clone, Debug)]
pub struct Leg {
    pub ankle: DVec3,
    /// Where the knee points.
    pub pole: DVec3,
    /// Foot: toes up, toes outwards.
    pub foot: [f64; 2],
    /// Toes up against the foot.
    pub toes: f64,
}

#[derive(Clone, Debug)]
pub struct Stance {
    pub hips: DVec3,
    /// Forwards, to the left, turned to the left.
    pub pelvis: [f64; 3],
    /// The back all in all, as the pelvis.
    pub back: [f64; 3],
    /// Neck and head together, as the pelvis.
    pub nod: [f64; 3],
    pub arms: [Arm; 2],
    pub legs: [Leg; 2],
}

/// Turn by angles forwards, to the left, turned to the left.
fn turn([pitch, roll, yaw]: [f64; 3]) -> DQuat {
    DQuat::from_rotation_y(yaw.to_radians())
        * DQuat::from_rotation_x(pitch.to_radians())
        * DQuat::from_rotation_z(-roll.to_radians())
}

/// Upright with both feet under the hips and hanging arms.
pub fn stand() -> Stance {
    let arm = Arm {
        shoulder: [-4.0, 0.0],
        angles: [4.0, 11.0, 8.0, 16.0],
        hand: DVec3::new(0.3, 0.8, 0.1),
        pole: -DVec3::Z,
        hold: 0.0,
        forearm: 14.0,
        wrist: -4.0,
        grip: 24.0,
    };
    let leg = Leg {
        ankle: DVec3::new(0.105, at::ANKLE.y, -0.035),
        pole: DVec3::new(0.12, 0.0, 1.0),
        foot: [0.0, 7.0],
        toes: 0.0,
    };
    Stance {
        hips: DVec3::new(0.0, 0.95, -0.012),
        pelvis: [0.0; 3],
        back: [3.0, 0.0, 0.0],
        nod: [-2.0, 0.0, 0.0],
        arms: [arm.clone(), arm],
        legs: [leg.clone(), leg],
    }
}

pub fn leg_limb() -> Limb {
    Limb {
        upper: at::KNEE - at::HIP,
        lower: at::ANKLE - at::KNEE,
        most: KNEE_MOST.to_radians(),
    }
}

pub fn arm_limb() -> Limb {
    let (shoulder, elbow, wrist, _) = arm();
    Limb {
        upper: elbow - shoulder,
        lower: wrist - elbow,
        most: ELBOW_MOST.to_radians(),
    }
}

impl Stance {
    /// The turns of all bones.
    pub fn pose(&self, skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::bind(skeleton);
        pose.shift = self.hips - at::HIPS;
        pose.turns[0] = turn(self.pelvis);
        for name in ["spine", "chest", "upperChest"] {
            pose.turns[skeleton.find(name)] = turn(self.back.map(|a| a / 3.0));
        }
        for name in ["neck", "head"] {
            pose.turns[skeleton.find(name)] = turn(self.nod.map(|a| a / 2.0));
        }
        for (i, side) in SIDES.into_iter().enumerate() {
            self.arms[i].set(skeleton, &mut pose, side);
            self.legs[i].set(skeleton, &mut pose, side);
        }
        pose
    }

    fn values(&self) -> Vec<f64> {
        let mut all = self.hips.to_array().to_vec();
        all.extend(self.pelvis.iter().chain(&self.back).chain(&self.nod));
        for arm in &self.arms {
            all.extend(arm.shoulder.iter().chain(&arm.angles));
            all.extend(arm.hand.to_array().iter().chain(&arm.pole.to_array()));
            all.extend([arm.hold, arm.forearm, arm.wrist, arm.grip]);
        }
        for leg in &self.legs {
            all.extend(leg.ankle.to_array().iter().chain(&leg.pole.to_array()));
            all.extend(leg.foot.iter().chain([&leg.toes]));
        }
        all
    }

    fn from_values(values: &[f64]) -> Self {
        let mut values = values.iter().copied();
        let mut next = || values.next().unwrap_or_default();
        let mut three = || [next(), next(), next()];
        let (hips, pelvis, back, nod) = (three(), three(), three(), three());
        let arms = [(); 2].map(|()| Arm {
            shoulder: [next(), next()],
            angles: [next(), next(), next(), next()],
            hand: DVec3::new(next(), next(), next()),
            pole: DVec3::new(next(), next(), next()),
            hold: next(),
            forearm: next(),
            wrist: next(),
            grip: next(),
        });
        let legs = [(); 2].map(|()| Leg {
            ankle: DVec3::new(next(), next(), next()),
            pole: DVec3::new(next(), next(), next()),
            foot: [next(), next()],
            toes: next(),
        });
        Self {
            hips: hips.into(),
            pelvis,
            back,
            nod,
            arms,
            legs,
        }
    }

    /// A smooth way through stances at times.
    pub fn between(keys: &[(f64, Self)], t: f64) -> Self {
        let values: Vec<Vec<f64>> = keys.iter().map(|(_, stance)| stance.values()).collect();
        let mixed: Vec<f64> = (0..values[0].len())
            .map(|i| {
                let track: Vec<(f64, f64)> = keys
                    .iter()
                    .zip(&values)
                    .map(|((time, _), values)| (*time, values[i]))
                    .collect();
                curve::keys(&track, t)
            })
            .collect();
        Self::from_values(&mixed)
    }
}

fn flip(v: DVec3, sign: f64) -> DVec3 {
    DVec3::new(sign * v.x, v.y, v.z)
}

/// An ankle bends only so far, wherever the foot was to point.
fn ankle(turn: DQuat) -> DQuat {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let twist = DQuat::from_xyzw(0.0, turn.y, 0.0, turn.w).normalize();
    let swing = (turn * twist.inverse()).to_scaled_axis();
    let within = |v: f64, [low, high]: [f64; 2]| v.clamp(low.to_radians(), high.to_radians());
    let x = within(swing.x, [-ANKLE_UP, ANKLE_DOWN]);
    let z = within(swing.z, [-6.0, 6.0]);
    let y = within(twist.to_scaled_axis().y, [-9.0, 9.0]);
    DQuat::from_scaled_axis(DVec3::new(x, 0.0, z)) * DQuat::from_rotation_y(y)
}

impl Arm {
    /// Turn of the upper arm against the collar bone and bend of the elbow, by angles.
    fn by_angles(&self) -> (DQuat, f64) {
        let [ahead, out, inward, elbow] = self.angles.map(f64::to_radians);
        let from_down = DQuat::from_rotation_x(-ahead)
            * DQuat::from_rotation_z(out)
            * DQuat::from_rotation_y(-inward);
        let bind = DQuat::from_rotation_z(ARM_RAISED.to_radians());
        (from_down * bind.inverse(), elbow)
    }

    fn set(&self, skeleton: &Skeleton, pose: &mut Pose, (side, sign): (&str, f64)) {
        let bone = |name: &str| skeleton.find(&format!("{side}{name}"));
        let [up, ahead] = self.shoulder.map(f64::to_radians);
        let collar = DQuat::from_rotation_y(-ahead) * DQuat::from_rotation_z(up);
        pose.turns[bone("Shoulder")] = on_side(collar, sign);
        let limb = arm_limb();
        let (mut upper, mut elbow) = self.by_angles();
        if self.hold > 0.0 {
            let shoulder = pose.place(skeleton, bone("UpperArm"));
            let above = on_side(pose.place(skeleton, bone("Shoulder")).turn, sign);
            let [reach, lower] = limb.reach(flip(shoulder.at, sign), self.hand, self.pole);
            let held = above.inverse() * reach;
            upper = upper.slerp(held, self.hold);
            let bend = lower.to_scaled_axis().dot(limb.hinge()) + limb.rest();
            elbow += (bend - elbow) * self.hold;
        }
        let (.., along) = arm();
        let hinge = DQuat::from_axis_angle(limb.hinge(), elbow - limb.rest());
        let roll = DQuat::from_axis_angle(along, -self.forearm.to_radians());
        let back = palm().cross(along).normalize();
        let bend = |degrees: f64| DQuat::from_axis_angle(back, degrees.to_radians());
        for (name, turn) in [
            ("UpperArm", upper),
            ("LowerArm", hinge * roll),
            ("Hand", bend(self.wrist)),
            ("Fingers", bend(-self.grip)),
            ("Thumb", bend(-0.4 * self.grip)),
        ] {
            pose.turns[bone(name)] = on_side(turn, sign);
        }
    }
}

impl Leg {
    fn set(&self, skeleton: &Skeleton, pose: &mut Pose, (side, sign): (&str, f64)) {
        let bone = |name: &str| skeleton.find(&format!("{side}{name}"));
        let hip = pose.place(skeleton, bone("UpperLeg")).at;
        let [upper, lower] = leg_limb().reach(flip(hip, sign), self.ankle, self.pole);
        pose.aim(skeleton, bone("UpperLeg"), on_side(upper, sign));
        pose.turns[bone("LowerLeg")] = on_side(lower, sign);
        let foot = bone("Foot");
        pose.aim(skeleton, foot, on_side(self.foot_turn(), sign));
        let free = on_side(pose.turns[foot], sign);
        pose.turns[foot] = on_side(ankle(free), sign);
        let toes = DQuat::from_rotation_x(-self.toes.to_radians());
        pose.turns[bone("Toes")] = on_side(toes, sign);
    }

    /// How the foot is turned in the model, as on the left.
    pub fn foot_turn(&self) -> DQuat {
        let [up, out] = self.foot.map(f64::to_radians);
        DQuat::from_rotation_y(out) * DQuat::from_rotation_x(-up)
    }

    /// Puts the foot down with its ball, flat at `z` from the ankle, and the heel raised by degrees.
    pub fn on_ball(&mut self, ankle: DVec3, heel: f64) {
        self.foot[0] = -heel;
        self.toes = heel;
        let pivot = at::BALL - at::ANKLE;
        let flat = DQuat::from_rotation_y(self.foot[1].to_radians());
        self.ankle = ankle + flat * pivot - self.foot_turn() * pivot;
    }

    /// Puts the foot down with its heel, the toes up by degrees.
    pub fn on_heel(&mut self, ankle: DVec3, toes: f64) {
        self.foot[0] = toes;
        self.toes = 0.0;
        let pivot = at::HEEL - at::ANKLE;
        let flat = DQuat::from_rotation_y(self.foot[1].to_radians());
        self.ankle = ankle + flat * pivot - self.foot_turn() * pivot;
    }
}
