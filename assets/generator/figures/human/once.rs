//! A jump and a blow to the chest, from standing to standing.

use super::{
    idle,
    pose::{Arm, Stance},
};
use crate::figures::{clip::Clip, skeleton::Skeleton};

fn arms(stance: &mut Stance, change: impl Fn(&mut Arm)) {
    stance.arms.iter_mut().for_each(change);
}

/// Both feet: so far up, the heel so far raised while the ball stays down.
fn feet(stance: &mut Stance, up: f64, heel: f64) {
    for leg in &mut stance.legs {
        let flat = leg.ankle;
        leg.on_ball(flat, heel);
        leg.ankle.y += up;
        if up > 0.0 {
            leg.toes = 0.0;
        }
    }
}

/// Crouches, leaves the ground at 0.32 s, lands at 0.78 s. The hips do not rise: what moves the
/// figure does that, so in the air the feet are drawn up.
pub fn jump(skeleton: &Skeleton) -> Clip {
    let start = idle::stance(0.0);
    let mut crouch = start.clone();
    crouch.hips.y = 0.72;
    crouch.hips.z = -0.07;
    crouch.pelvis[0] = 30.0;
    crouch.back[0] = 18.0;
    crouch.nod[0] = -24.0;
    arms(&mut crouch, |arm| arm.angles = [-30.0, 14.0, 4.0, 22.0]);
    feet(&mut crouch, 0.0, 22.0);
    let mut push = start.clone();
    push.hips.y = 0.985;
    push.hips.z = 0.02;
    push.pelvis[0] = 3.0;
    push.back[0] = -6.0;
    push.nod[0] = -8.0;
    arms(&mut push, |arm| {
        arm.angles = [55.0, 20.0, 4.0, 34.0];
        arm.shoulder = [12.0, 4.0];
    });
    feet(&mut push, 0.0, 34.0);
    let mut air = start.clone();
    air.hips.y = 0.97;
    air.pelvis[0] = 10.0;
    air.back[0] = 14.0;
    air.nod[0] = -10.0;
    arms(&mut air, |arm| arm.angles = [78.0, 38.0, 4.0, 48.0]);
    feet(&mut air, 0.24, 24.0);
    air.legs[0].ankle.z -= 0.06;
    air.legs[1].ankle.z += 0.02;
    let mut reach = start.clone();
    reach.hips.y = 0.955;
    reach.pelvis[0] = 6.0;
    reach.back[0] = 8.0;
    arms(&mut reach, |arm| arm.angles = [34.0, 42.0, 4.0, 36.0]);
    feet(&mut reach, 0.012, 12.0);
    let mut land = start.clone();
    land.hips.y = 0.745;
    land.hips.z = -0.06;
    land.pelvis[0] = 26.0;
    land.back[0] = 16.0;
    land.nod[0] = -16.0;
    arms(&mut land, |arm| arm.angles = [16.0, 34.0, 4.0, 42.0]);
    feet(&mut land, 0.0, 20.0);
    let keys = [
        (0.0, start.clone()),
        (0.2, crouch),
        (0.32, push),
        (0.54, air),
        (0.76, reach),
        (0.92, land),
        (1.3, start),
    ];
    Clip::sample("jump", 1.3, 30.0, |t| {
        Stance::between(&keys, t).pose(skeleton)
    })
}

/// A blow to the chest from the front.
pub fn hit(skeleton: &Skeleton) -> Clip {
    let start = idle::stance(0.0);
    let mut blow = start.clone();
    blow.hips.z -= 0.05;
    blow.hips.y -= 0.035;
    blow.pelvis = [-7.0, 3.0, 8.0];
    blow.back = [-20.0, -7.0, 17.0];
    blow.nod = [26.0, 4.0, -12.0];
    arms(&mut blow, |arm| {
        arm.angles = [42.0, 36.0, 4.0, 62.0];
        arm.shoulder = [6.0, 6.0];
    });
    blow.arms[0].angles[0] = 22.0;
    let mut fold = start.clone();
    fold.hips.z -= 0.075;
    fold.hips.y -= 0.075;
    fold.pelvis = [8.0, 2.0, 4.0];
    fold.back = [22.0, -3.0, 6.0];
    fold.nod = [4.0, 2.0, -6.0];
    arms(&mut fold, |arm| arm.angles = [38.0, 18.0, 26.0, 84.0]);
    let keys = [
        (0.0, start.clone()),
        (0.1, blow),
        (0.32, fold),
        (0.8, start),
    ];
    Clip::sample("hit", 0.8, 30.0, |t| {
        Stance::between(&keys, t).pose(skeleton)
    })
}
