//! Standing and breathing.

use super::pose::{Stance, stand};
use crate::figures::{clip::Clip, curve::wave, skeleton::Skeleton};

const LENGTH: f64 = 4.0;

/// At a part of the cycle; 0 is where every clip that starts or ends upright does so.
pub fn stance(u: f64) -> Stance {
    let mut made = stand();
    let (breath, slow) = (wave(2.0 * u), wave(u));
    made.hips.x += 0.008 * slow;
    made.hips.y -= 0.003 * (1.0 + breath);
    made.pelvis[1] = -0.8 * slow;
    made.back[0] -= 1.2 * breath;
    made.back[1] = 1.6 * slow;
    made.nod[0] += 1.0 * breath;
    made.nod[2] = 3.0 * wave(u + 0.1) - 3.0 * wave(0.1);
    for arm in &mut made.arms {
        arm.shoulder[0] += 1.2 * breath;
        arm.angles[1] += 0.8 * breath;
        arm.angles[3] += 1.5 * slow;
    }
    made
}

pub fn clip(skeleton: &Skeleton) -> Clip {
    Clip::sample("idle", LENGTH, 10.0, |t| {
        stance((t / LENGTH).rem_euclid(1.0)).pose(skeleton)
    })
    .looping(0.0)
}
