//! The torques of a tick.

use arrayvec::ArrayVec;
use bevy::prelude::*;

use super::{BalanceState, Pendulum, RagdollBalance, Support, pressure};
use crate::{
    backend::{
        handles::{RapierContextEntityLink, RapierRigidBodyHandle},
        joints::JointWorlds,
    },
    ragdoll::{
        bone::{Bones, RagdollBone},
        config::Ragdoll,
        drive::BoneForces,
        intent::{RagdollMode, part},
        plan::RagdollPlan,
        profile::BoneShape,
        sever::is_cut,
        state::RagdollState,
        tick::BoneForce,
    },
};

/// What is so little above the lowest point of a figure is on the ground, metres.
const TOUCH: f32 = 0.03;
/// The ground bears a figure this far inside the rim of its soles, metres: at the rim itself they tip.
const RIM: f32 = 0.01;
/// Lower than this part of its height when it was made, it has fallen.
const FALLEN: f32 = 0.6;
/// With all assistance, what the world bears of the torque that the weight tips it with.
const ASSIST: f32 = 1.5;

/// Mass, centre of mass and its velocity.
fn middle(plan: &RagdollPlan, state: &RagdollState) -> (f32, Vec3, Vec3) {
    let (mut mass, mut center, mut velocity) = (0.0, Vec3::ZERO, Vec3::ZERO);
    for (i, (bone, known)) in plan.bones.iter().zip(&state.bones).enumerate() {
        if is_cut(plan, state, i) {
            continue;
        }
        let arm = known.place.rotation * bone.center;
        mass += bone.mass;
        center += (known.place.position + arm) * bone.mass;
        velocity += (known.velocity + known.spin.cross(arm)) * bone.mass;
    }
    (mass, center / mass, velocity / mass)
}

/// The points by which a bone may stand, world.
fn sole(plan: &RagdollPlan, state: &RagdollState, bone: usize) -> ArrayVec<Vec3, 8> {
    let at = &state.bones[bone].place;
    let world = |point: Vec3| at.position + at.rotation * point;
    match plan.bones[bone].shape {
        BoneShape::Box {
            center,
            rotation,
            half,
        } => {
            let side = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            let corner = |i| Vec3::new(side(i, 1), side(i, 2), side(i, 4)) * half;
            (0..8)
                .map(|i| world(center + rotation * corner(i)))
                .collect()
        }
        BoneShape::Capsule { from, to, radius } => [from, to]
            .map(|end| world(end) - Vec3::Y * radius)
            .into_iter()
            .collect(),
    }
}

/// A foot on the ground: its area, and the part of the weight that it bears.
struct Foot {
    bone: usize,
    area: Support,
    at: Vec2,
    share: f32,
}

/// Level coordinates.
fn level(point: Vec3) -> Vec2 {
    Vec2::new(point.x, point.z)
}

/// The bones of a foot: itself and what it bears.
fn of_foot<'a>(
    plan: &'a RagdollPlan,
    state: &'a RagdollState,
    foot: usize,
) -> impl Iterator<Item = usize> + 'a {
    (0..plan.bones.len())
        .filter(move |i| *i == foot || plan.bones[*i].parent == Some(foot))
        .filter(|i| !is_cut(plan, state, *i))
}

/// Adds the torques by which figures stand.
pub(in crate::ragdoll) fn stand(
    worlds: JointWorlds,
    mut forces: ResMut<BoneForces>,
    mut ragdolls: Query<(
        &Ragdoll,
        &RagdollPlan,
        &RagdollState,
        &RagdollBalance,
        &mut BalanceState,
        &Bones,
    )>,
    bones: Query<(
        &RagdollBone,
        &RapierContextEntityLink,
        &RapierRigidBodyHandle,
    )>,
    mut torques: Local<Vec<Vec3>>,
) {
    for (config, plan, state, balance, mut seen, tied) in &mut ragdolls {
        let mut now = BalanceState::default();
        torques.clear();
        torques.resize(plan.bones.len(), Vec3::ZERO);
        let gravity = bones.iter_many(tied.iter()).next();
        let gravity = gravity.and_then(|(_, link, _)| worlds.gravity(link));
        if let Some((gravity, true)) = gravity
            && state.mode == RagdollMode::Powered
            && state.bones.len() == plan.bones.len()
            && gravity.y < 0.0
            && balance.gain > 0.0
            && balance.gain.is_finite()
            && bones.iter_many(tied.iter()).any(|(_, link, handle)| {
                worlds.touches(link, handle, |other| tied.iter().any(|bone| bone == other))
            })
        {
            bear(
                config,
                plan,
                state,
                balance,
                -gravity.y,
                &mut now,
                &mut torques,
            );
        }
        seen.set_if_neq(now);
        for (bone, link, handle) in bones.iter_many(tied.iter()) {
            let torque = torques.get(bone.order).copied().unwrap_or_default();
            if torque != Vec3::ZERO {
                forces.add(BoneForce {
                    link: *link,
                    handle: *handle,
                    force: Vec3::ZERO,
                    torque,
                });
            }
        }
    }
}

/// Works out what every joint of the legs bears.
fn bear(
    config: &Ragdoll,
    plan: &RagdollPlan,
    state: &RagdollState,
    balance: &RagdollBalance,
    gravity: f32,
    now: &mut BalanceState,
    torques: &mut [Vec3],
) {
    let (mass, center, velocity) = middle(plan, state);
    let mut low = f32::MAX;
    for i in (0..plan.bones.len()).filter(|i| !is_cut(plan, state, *i)) {
        low = sole(plan, state, i).iter().fold(low, |low, p| low.min(p.y));
    }
    let made = plan.bones.iter().map(|b| b.mass * b.bind.position.y);
    let made = made.sum::<f32>() / mass;
    let height = center.y - low;
    if !(height > FALLEN * made) {
        return;
    }
    let body = Pendulum { height, gravity };
    let mut feet: ArrayVec<Foot, 2> = ArrayVec::new();
    for name in &balance.feet {
        let named = |b: &&crate::ragdoll::plan::PlannedBone| {
            config
                .profile
                .bones
                .get(b.index)
                .is_some_and(|b| b.name == *name)
        };
        let Some(bone) = plan.bones.iter().position(|b| named(&b)) else {
            continue;
        };
        let points = of_foot(plan, state, bone).flat_map(|i| sole(plan, state, i));
        let area = Support::around(points.filter(|p| p.y < low + TOUCH).map(level));
        if !area.is_empty() {
            let foot = Foot {
                bone,
                area,
                at: Vec2::ZERO,
                share: 1.0,
            };
            if feet.try_push(foot).is_err() {
                break;
            }
        }
    }
    let soles = of_feet(plan, state, &feet, low);
    let area = Support::around(soles);
    if area.is_empty() {
        return;
    }
    let rest = area.middle();
    let capture = body.capture_point(level(center), level(velocity));
    let asked = pressure(capture, rest, balance.gain, &area);
    // A little inside of the rim.
    let asked = asked + (rest - asked).clamp_length_max((RIM - area.margin(asked)).max(0.0));
    let up = |p: Vec2| Vec3::new(p.x, low, p.y);
    *now = BalanceState {
        capture: up(capture),
        pressure: up(asked),
        margin: area.margin(capture),
        stands: true,
    };
    for foot in &mut feet {
        foot.at = foot.area.clamp(asked);
    }
    if let [a, b] = &mut feet[..] {
        let way = b.at - a.at;
        let share = (asked - a.at).dot(way) / way.length_squared().max(1.0e-9);
        b.share = share.clamp(0.0, 1.0);
        a.share = 1.0 - b.share;
    }
    let strength = |i: usize| state.bones[i].strength * config.drive.torque;
    for foot in &feet {
        // The ground's force goes through the centre of mass, so it turns nothing.
        let from = up(foot.at);
        let force = (center - up(asked)) * (foot.share * mass * gravity / height);
        let mut joint = foot.bone;
        while let Some(above) = plan.bones[joint].parent {
            let most = plan.bones[joint].joint.max_torque * strength(joint);
            let torque = (from - state.bones[joint].place.position).cross(force);
            let torque = torque.clamp_length_max(most);
            torques[above] += torque;
            torques[joint] -= torque;
            joint = above;
        }
    }
    let assist = part(balance.assist);
    if assist > 0.0 {
        let root = &state.bones[0];
        let upright = root.place.rotation * plan.bones[0].bind.rotation.inverse() * Vec3::Y;
        let (tips, damps) = (
            mass * gravity * height,
            mass * height * height * body.rate(),
        );
        let torque = upright.cross(Vec3::Y) * tips - root.spin.with_y(0.0) * damps;
        torques[0] += torque * (ASSIST * assist);
    }
}

/// Where all feet touch the ground, from above.
fn of_feet(
    plan: &RagdollPlan,
    state: &RagdollState,
    feet: &[Foot],
    low: f32,
) -> ArrayVec<Vec2, 48> {
    let mut all = ArrayVec::new();
    for foot in feet {
        for bone in of_foot(plan, state, foot.bone) {
            for point in sole(plan, state, bone) {
                if point.y < low + TOUCH && all.try_push(level(point)).is_err() {
                    return all;
                }
            }
        }
    }
    all
}
