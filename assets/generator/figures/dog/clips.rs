//! Standing, walking, trotting on the spot while the ground passes, and lying down.

use bevy::math::DVec3;

use super::{
    bones::at,
    pose::{Leg, Stance, stand},
};
use crate::figures::{
    clip::Clip,
    curve::{clear, ease, hermite, hill, keys, wave},
    skeleton::Skeleton,
};

/// What makes a gait; degrees, metres and seconds.
#[derive(Clone, Copy, Debug)]
pub struct Gait {
    pub name: &'static str,
    pub speed: f64,
    pub cycle: f64,
    pub duty: f64,
    /// Part of the cycle at which each leg comes down: front left and right, back left and right.
    pub strikes: [f64; 4],
    /// How far ahead of where they stand the paws come down, in front and at the back.
    pub ahead: [f64; 2],
    pub lift: f64,
    /// How low the body is carried and how far it goes up and down.
    pub body: [f64; 2],
    /// How the back bends sideways and the body rolls.
    pub swing: [f64; 2],
}

pub const WALK: Gait = Gait {
    name: "walk",
    speed: 0.9,
    cycle: 0.72,
    duty: 0.62,
    strikes: [0.25, 0.75, 0.0, 0.5],
    ahead: [0.235, 0.22],
    lift: 0.055,
    body: [0.026, 0.005],
    swing: [5.0, 2.0],
};

pub const TROT: Gait = Gait {
    name: "trot",
    speed: 1.9,
    cycle: 0.46,
    duty: 0.42,
    strikes: [0.5, 0.0, 0.0, 0.5],
    ahead: [0.225, 0.2],
    lift: 0.085,
    body: [0.026, 0.016],
    swing: [2.0, 1.0],
};

impl Gait {
    fn leg(&self, i: usize, u: f64) -> Leg {
        let u = u.rem_euclid(1.0);
        let front = i < 2;
        let (rest, ahead) = if front {
            (at::FRONT[4], self.ahead[0])
        } else {
            (at::BACK[3], self.ahead[1])
        };
        let travel = self.speed * self.cycle;
        let ground = |u: f64| rest + DVec3::Z * (ahead - travel * u);
        let (reach, push) = if front { (-12.0, 34.0) } else { (-14.0, 38.0) };
        let blade = if front { 11.0 } else { 0.0 };
        let lean = |s: f64| keys(&[(0.0, reach), (0.45, 0.0), (1.0, push)], s);
        if u < self.duty {
            let s = u / self.duty;
            return Leg {
                paw: ground(u),
                lean: lean(s),
                toes: 0.0,
                blade: blade * (1.0 - 2.0 * ease(s)),
            };
        }
        let air = 1.0 - self.duty;
        let w = (u - self.duty) / air;
        let (off, on) = (ground(self.duty), ground(0.0));
        let slope = -travel * air;
        let bump = 16.0 * w * w * (1.0 - w) * (1.0 - w);
        let rise = 0.25 * clear(w);
        // The foot folds back as the leg comes forwards.
        let fold = if front { 50.0 } else { 16.0 };
        Leg {
            paw: DVec3::new(
                rest.x,
                rest.y + self.lift * bump + rise,
                hermite([off.z, on.z], [slope, slope], w),
            ),
            lean: push + (reach - push) * ease(w) + fold * hill(w),
            toes: 55.0 * hill(w.sqrt()),
            blade: blade * (2.0 * ease(w) - 1.0),
        }
    }

    fn stance(&self, u: f64) -> Stance {
        let mut made = stand();
        let left = wave(u + 0.25);
        let twice = wave(2.0 * u + 0.12);
        let [low, bounce] = self.body;
        made.hips.y -= low + bounce * twice;
        made.pelvis = [
            0.8 * wave(2.0 * u),
            self.swing[1] * wave(u),
            -self.swing[0] * 0.6 * left,
        ];
        made.back = [-0.8 * wave(2.0 * u), 0.0, self.swing[0] * left];
        made.neck = [4.0 + 3.0 * twice, 0.0, -self.swing[0] * 0.3 * left];
        made.head[0] -= 4.0 * twice;
        made.tail = [8.0 + 3.0 * twice, 11.0 * wave(u + 0.1)];
        made.legs = [0, 1, 2, 3].map(|i| self.leg(i, u - self.strikes[i]));
        made
    }

    pub fn clip(&self, skeleton: &Skeleton) -> Clip {
        Clip::sample(self.name, self.cycle, 50.0, |t| {
            self.stance((t / self.cycle).rem_euclid(1.0)).pose(skeleton)
        })
        .looping(self.speed)
    }
}

fn idle_stance(u: f64) -> Stance {
    let mut made = stand();
    let (breath, slow) = (wave(2.0 * u), wave(u));
    made.hips.y -= 0.002 * (1.0 + breath);
    made.back[0] = -0.8 * breath;
    made.neck = [-1.5 * breath, 0.0, 9.0 * slow];
    made.head = [
        6.0 + 2.0 * breath,
        0.0,
        8.0 * wave(u - 0.06) + 8.0 * wave(0.06),
    ];
    made.tail = [6.0, 13.0 * wave(8.0 * u)];
    made
}

/// Breathes, looks about and wags.
pub fn idle(skeleton: &Skeleton) -> Clip {
    Clip::sample("idle", 4.0, 20.0, |t| {
        idle_stance((t / 4.0).rem_euclid(1.0)).pose(skeleton)
    })
    .looping(0.0)
}

/// Lies down from standing, and stays.
pub fn lie(skeleton: &Skeleton) -> Clip {
    let start = idle_stance(0.0);
    let legs = |stance: &mut Stance, front: [f64; 3], back: [f64; 3]| {
        for (i, leg) in stance.legs.iter_mut().enumerate() {
            let ([y, z, lean], rest) = if i < 2 {
                (front, at::FRONT[4])
            } else {
                (back, at::BACK[3])
            };
            leg.paw = DVec3::new(rest.x + 0.012, y, z);
            leg.lean = lean;
        }
    };
    let mut bow = start.clone();
    bow.hips = DVec3::new(0.0, 0.4, -0.33);
    bow.pelvis[0] = 14.0;
    bow.neck[0] = -8.0;
    legs(&mut bow, [0.03, 0.27, -24.0], [0.03, -0.36, -24.0]);
    let mut down = start.clone();
    down.hips = DVec3::new(0.0, 0.221, -0.335);
    down.pelvis[0] = 2.0;
    down.back[0] = -2.0;
    down.neck[0] = -4.0;
    down.head[0] = 10.0;
    down.tail = [-4.0, 22.0];
    legs(&mut down, [0.03, 0.345, -84.0], [0.03, -0.24, -84.0]);
    let keys = [(0.0, start), (0.6, bow), (1.3, down)];
    Clip::sample("lie", 1.3, 25.0, |t| {
        Stance::between(&keys, t).pose(skeleton)
    })
}
