//! How well the joints of compared figures hold, and who of them sleeps.

use super::{World, about, pairs};
use crate::{
    bounds::{Check, Must},
    subject::{Joints, Subject},
};

/// Most mean gap of all joints, millimetres.
const GAP: f64 = 0.3;
/// Most part of the bodies that may be awake in the end.
const AWAKE: f64 = 0.4;

/// Prints both sides and judges ours.
pub fn judge(subject: &Subject, sides: &[Vec<World>], checks: &mut Vec<Check>) {
    let Some(worlds) = sides.first() else { return };
    for (compared, own, peer) in pairs(subject, worlds) {
        let seen = |world: &World| {
            world
                .runs
                .first()
                .map_or_else(Joints::default, |run| run.joints)
        };
        let (ours, rapier) = (seen(own), seen(peer));
        let line = |side: &str, joints: &Joints| {
            format!(
                "{side}: gap mean={:.3}mm largest={:.1}mm in the end {:.1}mm awake={}/{}",
                joints.mean_gap, joints.largest_gap, joints.end_gap, joints.awake, joints.bodies
            )
        };
        let about = about(subject, 1, compared.tag);
        println!("joints {about} {}", line("ours", &ours));
        println!("joints {about} {}", line("rapier", &rapier));
        let named = |what: &str| format!("{what} {}", compared.tag);
        let timing =
            |what: &str, value, must, bound| Check::timing(named(what), value, must, bound);
        // A quick run ends in the air.
        checks.push(timing("mean gap, mm", ours.mean_gap, Must::BeAtMost, GAP));
        let awake = ours.awake as f64 / (ours.bodies as f64).max(1.0);
        checks.push(timing("part awake in the end", awake, Must::BeBelow, AWAKE));
    }
}
