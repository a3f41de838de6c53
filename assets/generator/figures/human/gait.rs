//! Walking and running on the spot, while the ground passes.

use bevy::math::DVec3;

use super::{
    bones::at,
    pose::{Leg, Stance, stand},
};
use crate::figures::{
    clip::Clip,
    curve::{clear, ease, hermite, keys, wave},
    skeleton::Skeleton,
};

/// What makes a gait; degrees and metres.
#[derive(Clone, Copy, Debug)]
pub struct Gait {
    pub name: &'static str,
    /// Keys per second.
    pub rate: f64,
    /// Metres per second.
    pub speed: f64,
    /// Seconds for a step of each foot.
    pub cycle: f64,
    /// Part of the cycle for which a foot is on the ground.
    pub duty: f64,
    /// How far ahead of the hips a foot comes down.
    pub strike: f64,
    /// How far outwards the feet are.
    pub width: f64,
    /// Toes up as the foot comes down, heel up as it leaves.
    pub roll: [f64; 2],
    /// Part of its time on the ground after which the heel rises.
    pub flat: f64,
    /// How high the ankle is swung.
    pub lift: f64,
    /// How steeply it leaves the ground and comes down, metres for the whole swing.
    pub clear: f64,
    /// Height of the hips, and how far it goes up and down.
    pub hips: [f64; 2],
    /// Part of the cycle at which the left leg carries most.
    pub carry: f64,
    /// 1 highest over the carrying leg, -1 lowest.
    pub vault: f64,
    pub sway: f64,
    /// Pelvis turned with the legs, and dropped at the free leg.
    pub pelvis: [f64; 2],
    pub lean: f64,
    /// Arms: middle, swing, elbow middle, elbow swing.
    pub arms: [f64; 4],
}

pub const WALK: Gait = Gait {
    name: "walk",
    rate: 40.0,
    speed: 1.3,
    cycle: 1.0,
    duty: 0.6,
    strike: 0.315,
    width: 0.085,
    roll: [18.0, 46.0],
    flat: 0.5,
    lift: 0.05,
    clear: 0.18,
    hips: [0.926, 0.014],
    carry: 0.3,
    vault: 1.0,
    sway: 0.022,
    pelvis: [6.0, 3.5],
    lean: 2.0,
    arms: [2.0, 22.0, 24.0, 10.0],
};

pub const RUN: Gait = Gait {
    name: "run",
    rate: 60.0,
    speed: 3.3,
    cycle: 0.72,
    duty: 0.3,
    strike: 0.24,
    width: 0.055,
    roll: [0.0, 52.0],
    flat: 0.36,
    lift: 0.25,
    clear: 0.45,
    hips: [0.92, 0.028],
    carry: 0.15,
    vault: -1.0,
    sway: 0.012,
    pelvis: [7.0, 3.0],
    lean: 9.0,
    arms: [2.0, 38.0, 88.0, 16.0],
};

impl Gait {
    /// The foot on the ground, at a part of the cycle since it came down.
    fn ground(&self, u: f64) -> Leg {
        let mut leg = stand().legs[0].clone();
        leg.foot[1] = 4.0;
        let ankle = DVec3::new(
            self.width,
            at::ANKLE.y,
            self.strike - self.speed * self.cycle * u,
        );
        let pitch = keys(
            &[
                (0.0, self.roll[0]),
                (0.16, 0.0),
                (self.flat, 0.0),
                (1.0, -self.roll[1]),
            ],
            u / self.duty,
        );
        if pitch > 0.0 {
            leg.on_heel(ankle, pitch);
        } else {
            leg.on_ball(ankle, -pitch);
        }
        leg
    }

    /// A leg at a part of its cycle.
    fn leg(&self, u: f64) -> Leg {
        let u = u.rem_euclid(1.0);
        if u < self.duty {
            return self.ground(u);
        }
        let air = 1.0 - self.duty;
        let w = (u - self.duty) / air;
        let (off, on) = (self.ground(self.duty), self.ground(0.0));
        let step = 1e-4;
        let (before, after) = (self.ground(self.duty - step), self.ground(step));
        let mix = |value: fn(&Leg) -> f64| {
            let slopes = [
                (value(&off) - value(&before)) / step * air,
                (value(&after) - value(&on)) / step * air,
            ];
            hermite([value(&off), value(&on)], slopes, w)
        };
        let mut leg = on.clone();
        let rest = 1.0 - w;
        let bump = self.lift * 16.0 * w * w * rest * rest + self.clear * clear(w);
        let path = mix(|leg| leg.ankle.y);
        leg.ankle = DVec3::new(mix(|leg| leg.ankle.x), path + bump, mix(|leg| leg.ankle.z));
        leg.foot[0] = hermite([off.foot[0], on.foot[0]], [0.0, 0.0], ease(w));
        leg.toes = off.toes * (1.0 - ease(w / 0.4));
        leg
    }

    fn stance(&self, u: f64) -> Stance {
        let mut made = stand();
        // One at the strike of the left foot, minus one at that of the right.
        let left = wave(u + 0.25);
        let carry = wave(u - self.carry + 0.25);
        let bounce = wave(2.0 * (u - self.carry) + 0.25);
        made.hips = DVec3::new(
            self.sway * carry,
            self.hips[0] + self.vault * self.hips[1] * bounce,
            0.0,
        );
        let [yaw, drop] = self.pelvis;
        made.pelvis = [0.5 * self.lean, -drop * carry, -yaw * left];
        made.back = [self.lean * 0.7 + 2.0, 1.2 * drop * carry, 2.0 * yaw * left];
        made.nod = [-self.lean * 0.9, 0.0, -yaw * left];
        let [middle, swing, elbow, bend] = self.arms;
        for (arm, ahead) in made.arms.iter_mut().zip([-left, left]) {
            arm.angles[0] = middle + swing * ahead;
            arm.angles[3] = elbow + bend * ahead;
            arm.angles[1] = 9.0 + 0.06 * (elbow - 20.0);
            arm.shoulder[1] = 4.0 * ahead;
            arm.grip = 24.0 + 0.45 * (elbow - 20.0).max(0.0);
        }
        made.legs = [self.leg(u), self.leg(u + 0.5)];
        made
    }

    pub fn clip(&self, skeleton: &Skeleton) -> Clip {
        Clip::sample(self.name, self.cycle, self.rate, |t| {
            // The end is the start to the bit.
            self.stance((t / self.cycle).rem_euclid(1.0)).pose(skeleton)
        })
        .looping(self.speed)
    }
}
