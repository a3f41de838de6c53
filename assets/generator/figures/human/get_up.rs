//! Getting up from lying on the front and on the back, to standing at the origin.

use bevy::math::DVec3;

use super::{
    bones::at,
    idle,
    pose::{Stance, stand},
};
use crate::figures::{clip::Clip, skeleton::Skeleton};

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A key in the making.
struct Key(Stance);

impl Key {
    fn new(hips: DVec3, pelvis: f64, back: f64, nod: f64) -> Self {
        let mut made = stand();
        made.hips = hips;
        made.pelvis[0] = pelvis;
        made.back[0] = back;
        made.nod[0] = nod;
        Self(made)
    }

    /// Both wrists hold on there, the elbows point there; hands bent back.
    fn hands(mut self, at: DVec3, pole: DVec3, wrist: f64) -> Self {
        for arm in &mut self.0.arms {
            arm.hand = at;
            arm.pole = pole;
            arm.hold = 1.0;
            arm.wrist = wrist;
            arm.grip = 8.0;
            arm.forearm = 0.0;
        }
        self
    }

    /// One wrist elsewhere.
    fn hand(mut self, side: usize, at: DVec3) -> Self {
        self.0.arms[side].hand = at;
        self
    }

    /// Arms by angles.
    fn arms(mut self, angles: [f64; 4]) -> Self {
        for arm in &mut self.0.arms {
            arm.angles = angles;
            arm.hold = 0.0;
        }
        self
    }

    /// A leg: ankle, knee, foot toes up.
    fn leg(mut self, side: usize, ankle: DVec3, pole: DVec3, foot: f64, toes: f64) -> Self {
        let leg = &mut self.0.legs[side];
        leg.ankle = ankle;
        leg.pole = pole;
        leg.foot = [foot, 3.0];
        leg.toes = toes;
        self
    }

    fn legs(self, ankle: DVec3, pole: DVec3, foot: f64, toes: f64) -> Self {
        self.leg(0, ankle, pole, foot, toes)
            .leg(1, ankle, pole, foot, toes)
    }

    /// A foot with its ball on the ground, where it would be flat at `z`, its heel raised.
    fn foot(mut self, side: usize, z: f64, heel: f64) -> Self {
        let leg = &mut self.0.legs[side];
        leg.pole = v(0.14, 0.0, 1.0);
        leg.foot[1] = 7.0;
        leg.on_ball(v(0.105, at::ANKLE.y, z), heel);
        self
    }
}

/// Starts with the hips over the origin and the head ahead.
pub fn front(skeleton: &Skeleton) -> Clip {
    let below = v(0.1, -1.0, 0.1);
    let out = v(0.7, 0.2, -0.7);
    let lie = Key::new(v(0.0, 0.125, 0.0), 88.0, -4.0, -10.0)
        .hands(v(0.33, 0.094, 0.34), v(0.9, 0.35, -0.6), 66.0)
        .legs(v(0.11, 0.165, -0.874), below, -140.0, -12.0);
    let press = Key::new(v(0.0, 0.16, -0.02), 80.0, -28.0, -34.0)
        .hands(v(0.3, 0.062, 0.38), v(0.9, 0.3, -0.6), 62.0)
        .legs(v(0.11, 0.165, -0.884), below, -140.0, -12.0);
    let lift = Key::new(v(0.0, 0.35, -0.1), 72.0, -6.0, -28.0)
        .hands(v(0.27, 0.07, 0.36), out, 66.0)
        .legs(v(0.11, 0.145, -0.872), below, -146.0, -14.0);
    let kneel = Key::new(v(0.0, 0.49, -0.14), 54.0, 20.0, -20.0)
        .hands(v(0.24, 0.07, 0.34), out, 66.0)
        .leg(0, v(0.11, 0.145, -0.73), below, -144.0, -10.0)
        .leg(1, v(0.16, 0.3, -0.46), v(0.3, -0.1, 1.0), -48.0, 0.0);
    let lunge = Key::new(v(0.0, 0.49, -0.13), 20.0, 46.0, -28.0)
        .hands(v(0.23, 0.11, 0.33), out, 58.0)
        .leg(0, v(0.11, 0.185, -0.69), below, -87.0, 58.0)
        .foot(1, 0.06, 26.0);
    let rise = Key::new(v(0.02, 0.60, -0.09), 26.0, 30.0, -22.0)
        .arms([24.0, 16.0, 8.0, 40.0])
        .hand(0, v(0.23, 0.5, 0.2))
        .foot(0, -0.34, 58.0)
        .foot(1, 0.06, 18.0);
    let step = Key::new(v(0.01, 0.78, -0.03), 24.0, 18.0, -18.0)
        .arms([14.0, 15.0, 8.0, 30.0])
        .foot(0, -0.16, 34.0)
        .foot(1, 0.03, 10.0);
    let keys = [
        (0.0, lie.0),
        (0.45, press.0),
        (0.7, lift.0),
        (0.95, kneel.0),
        (1.3, lunge.0),
        (1.7, rise.0),
        (2.05, step.0),
        (2.5, idle::stance(0.0)),
    ];
    Clip::sample("get_up_front", 2.5, 20.0, |t| {
        Stance::between(&keys, t).pose(skeleton)
    })
}

/// Starts with the hips behind the origin and the feet ahead.
pub fn back(skeleton: &Skeleton) -> Clip {
    let behind = v(0.5, 0.3, -1.0);
    let up = v(0.12, 1.0, 0.2);
    let lie = Key::new(v(0.0, 0.128, -0.36), -88.0, 2.0, 6.0)
        .hands(v(0.33, 0.085, -0.4), v(0.8, -0.5, 0.0), 0.0)
        .legs(v(0.11, 0.088, 0.5), up, 62.0, 0.0);
    let curl = Key::new(v(0.0, 0.128, -0.36), -58.0, 46.0, 26.0)
        .hands(v(0.33, 0.078, -0.5), behind, 40.0)
        .legs(v(0.11, 0.094, 0.3), up, 30.0, 0.0);
    let sit = Key::new(v(0.0, 0.12, -0.35), -34.0, 48.0, 6.0)
        .hands(v(0.32, 0.08, -0.56), behind, 62.0)
        .legs(v(0.12, 0.082, 0.05), v(0.2, 1.0, 0.4), 6.0, 0.0);
    let push = Key::new(v(0.0, 0.25, -0.34), -22.0, 78.0, 4.0)
        .hands(v(0.3, 0.09, -0.42), behind, 62.0)
        .foot(0, -0.03, 18.0)
        .foot(1, -0.03, 18.0);
    let squat = Key::new(v(0.0, 0.43, -0.16), 14.0, 56.0, -24.0)
        .arms([52.0, 14.0, 8.0, 34.0])
        .foot(0, -0.035, 28.0)
        .foot(1, -0.035, 28.0);
    let rise = Key::new(v(0.0, 0.68, -0.08), 30.0, 24.0, -22.0)
        .arms([30.0, 13.0, 8.0, 30.0])
        .foot(0, -0.035, 22.0)
        .foot(1, -0.035, 22.0);
    let keys = [
        (0.0, lie.0),
        (0.5, curl.0),
        (0.95, sit.0),
        (1.35, push.0),
        (1.7, squat.0),
        (2.05, rise.0),
        (2.5, idle::stance(0.0)),
    ];
    Clip::sample("get_up_back", 2.5, 20.0, |t| {
        Stance::between(&keys, t).pose(skeleton)
    })
}
