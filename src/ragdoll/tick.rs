//! One tick of one ragdoll: where each bone should be, what it becomes, and how it is driven there.

use core::f32::consts::TAU;

use bevy::prelude::*;

use super::{
    bone::BoneTies,
    config::Ragdoll,
    intent::{BoneControl, part},
    math::{
        inertialize::{Moving, PoseOffset},
        rotation::{angle, angular_velocity, from_rotation_vector, rotation_vector},
    },
    plan::{PlannedBone, RagdollPlan},
    pose::BonePose,
    state::{BoneBody, BoneState},
};
use crate::backend::{
    handles::{RapierContextEntityLink, RapierRigidBodyHandle},
    joints::{BodyMotion, JointWorlds, MotorRows},
};

/// Damping that makes a motor hold still up to its greatest torque: dry friction, newton-metre-seconds.
const DRY: f32 = 1.0e3;
/// The engine turns infinite torques into numbers that are none when the clock stands.
const MOST: f32 = 1.0e6;
/// A pose that changes by less than this in a tick wakes nobody, radians or metres.
const STILL: f32 = 1.0e-4;

/// A bone in this tick.
#[derive(Clone, Copy)]
pub(super) struct Slot {
    /// Whether it is cut off from the bone that bears it.
    pub severed: bool,
    pub entity: Entity,
    pub link: RapierContextEntityLink,
    pub handle: RapierRigidBodyHandle,
    pub motion: BodyMotion,
    /// What it is from this tick on.
    pub body: BoneBody,
    /// The pose asked for at the end of this tick and at the end of the last.
    pub target: BonePose,
    pub before: BonePose,
    pub strength: f32,
    pub pin: f32,
    /// Whether it is sent to its pose by velocities.
    pub keyed: bool,
    /// Whether the pose asked for is another one from this tick on, and `before` is worth nothing.
    pub anew: bool,
}

/// A force and a torque about the centre of mass for one tick.
#[derive(Clone, Copy)]
pub(super) struct BoneForce {
    pub link: RapierContextEntityLink,
    pub handle: RapierRigidBodyHandle,
    pub force: Vec3,
    pub torque: Vec3,
}

/// Where a bone was and how it moved before this tick, and where it is sent.
#[derive(Clone, Copy)]
pub(super) struct Way {
    was: Moving,
    sent: BonePose,
    /// Whether it follows the pose.
    follows: bool,
    target: BonePose,
    before: BonePose,
}

/// The pose asked for, where the bone that bears it is elsewhere than asked: at its joint.
fn borne_by(parent: BonePose, asked_parent: &BonePose, asked: &BonePose) -> Vec3 {
    let arm = asked_parent.rotation.inverse() * (asked.position - asked_parent.position);
    parent.position + parent.rotation * arm
}

/// Makes of a bone what it is from this tick on, with the place and velocity that it had.
pub(super) fn change_over(
    worlds: &mut JointWorlds,
    slot: &Slot,
    parent: Option<&Way>,
    state: &mut BoneState,
    fade: f32,
    dt: f32,
) -> Way {
    let (old, new) = (state.body, slot.body);
    if state.target.is_none() {
        state.place = slot.before;
    }
    let was = Moving {
        position: state.place.position,
        rotation: state.place.rotation,
        velocity: state.velocity,
        spin: state.spin,
    };
    let in_pose = |body: BoneBody| matches!(body, BoneBody::Off | BoneBody::Kinematic);
    let parent = parent.filter(|p| p.follows);
    let leaves_physics = !in_pose(old) && in_pose(new);
    // Counted from something else than before, what is left of an offset begins anew.
    let rebased = in_pose(old) && in_pose(new) && state.borne != parent.is_some();
    let anew = slot.anew && in_pose(old) && in_pose(new);
    if state.target.is_some() && (leaves_physics || anew || (rebased && !state.offset.is_over())) {
        let to = followed(slot, parent, dt);
        let left = state.offset.duration - state.offset.age;
        let fade = if leaves_physics || anew { fade } else { left };
        state.offset = if fade > 0.0 {
            PoseOffset::between(&was, &to, fade)
        } else {
            PoseOffset::default()
        };
    }
    state.borne = parent.is_some();
    // Where it would be if it followed the pose.
    let mut sent = state.place;
    if in_pose(old) || in_pose(new) {
        state.offset.advance(dt);
        let base = match parent {
            Some(p) => borne_by(p.sent, &p.target, &slot.target),
            None => slot.target.position,
        };
        let (position, rotation) = state.offset.apply(base, slot.target.rotation);
        sent = BonePose { position, rotation };
    }
    let velocity = (sent.position - state.place.position) / dt;
    let spin = angular_velocity(state.place.rotation, sent.rotation, dt);
    let place = Some((state.place.position, state.place.rotation));
    let was_off = old == BoneBody::Off;
    let (link, handle) = (&slot.link, &slot.handle);
    match new {
        BoneBody::Off => {
            state.place = sent;
            state.velocity = velocity;
            state.spin = spin;
        }
        BoneBody::Kinematic => {
            if was_off {
                worlds.place(link, handle, place, Vec3::ZERO, Vec3::ZERO);
            }
            worlds.send(link, handle, sent.position, sent.rotation);
        }
        BoneBody::Dynamic if in_pose(old) => {
            let from = place.filter(|_| was_off);
            // As it moved, not as the pose moves from here on: who lets go of a figure may have stopped
            // moving it.
            let (velocity, spin) = match state.target {
                Some(_) => (state.velocity, state.spin),
                None => (velocity, spin),
            };
            worlds.place(link, handle, from, velocity, spin);
            state.offset = PoseOffset::default();
        }
        BoneBody::Fixed if was_off => {
            worlds.place(link, handle, place, Vec3::ZERO, Vec3::ZERO);
        }
        BoneBody::Dynamic | BoneBody::Fixed => {}
    }
    state.body = new;
    state.target = Some(slot.target);
    state.strength = slot.strength;
    state.pin = slot.pin;
    Way {
        was,
        sent,
        follows: in_pose(old) || in_pose(new),
        target: slot.target,
        before: slot.before,
    }
}

/// How a bone would move if it were where the pose has it, on the bone that bears it.
fn followed(slot: &Slot, parent: Option<&Way>, dt: f32) -> Moving {
    let (now, before) = (&slot.target, &slot.before);
    let spin = angular_velocity(before.rotation, now.rotation, dt);
    let (position, velocity) = match parent {
        Some(p) => {
            let was = BonePose {
                position: p.was.position,
                rotation: p.was.rotation,
            };
            let position = borne_by(was, &p.before, before);
            let arm = position - p.was.position;
            (position, p.was.velocity + p.was.spin.cross(arm))
        }
        None => (before.position, (now.position - before.position) / dt),
    };
    Moving {
        position,
        rotation: before.rotation,
        velocity,
        spin,
    }
}

/// Whether the pose that a bone is driven to moves, or is driven otherwise than before.
pub(super) fn stirs(slot: &Slot, parent: Option<&Slot>, state: &BoneState) -> bool {
    if slot.body != state.body {
        return true;
    }
    if slot.body != BoneBody::Dynamic {
        return false;
    }
    if slot.strength != state.strength || slot.pin != state.pin {
        return true;
    }
    if slot.strength == 0.0 && !slot.keyed {
        return false;
    }
    if (slot.pin > 0.0 || slot.keyed)
        && (slot.target.position.distance(slot.before.position) > STILL
            || angle(slot.before.rotation.inverse() * slot.target.rotation) > STILL)
    {
        return true;
    }
    parent.is_some_and(|p| {
        let now = p.target.rotation.inverse() * slot.target.rotation;
        let before = p.before.rotation.inverse() * slot.before.rotation;
        angle(before.inverse() * now) > STILL
    })
}

/// The bone that bears a bone, where their joint has not parted.
pub(super) fn bearer(plan: &RagdollPlan, slots: &[Option<Slot>], bone: usize) -> Option<usize> {
    let parent = plan.bones[bone].parent;
    parent.filter(|_| slots[bone].as_ref().is_some_and(|s| !s.severed))
}

/// Part of a tick by which its substeps look ahead on the mean.
fn lead(substeps: f32) -> f32 {
    (substeps + 1.0) / (2.0 * substeps)
}

/// Turns the limits of a bone's joint, and its drive, to where they are in this tick.
pub(super) fn drive(
    worlds: &mut JointWorlds,
    config: &Ragdoll,
    bone: &PlannedBone,
    slot: &Slot,
    parent: &Slot,
    ties: &BoneTies,
    (dt, substeps): (f32, f32),
) {
    let link = &slot.link;
    if let Some(joint) = ties.soft.or(ties.limit) {
        let (own, of) = (&slot.motion, &parent.motion);
        let spin = own.spin - of.spin;
        let bears = of.velocity + of.spin.cross(own.position - of.center);
        let slip = own.origin_velocity() - bears;
        // A limit that gives need not be met beforehand.
        let substep = if bone.joint.softness.is_some() {
            0.0
        } else {
            dt / substeps
        };
        if let Some(rows) = bone.aimed((of.rotation, own.rotation), spin, slip, (dt, substep)) {
            worlds.aim(link, joint, &rows);
        }
    }
    let Some(joint) = ties.drive else { return };
    let f2 = bone.frames.rotation2;
    if slot.keyed {
        worlds.drive(link, joint, f2, &MotorRows::default());
        return;
    }
    if slot.strength <= 0.0 {
        let rows = MotorRows {
            damping: Vec3::splat(DRY),
            most: bone.friction(),
            ..default()
        };
        worlds.drive(link, joint, f2, &rows);
        return;
    }
    let now = bone.within_limits(parent.target.rotation.inverse() * slot.target.rotation);
    let before = bone.within_limits(parent.before.rotation.inverse() * slot.before.rotation);
    let turn = rotation_vector(now * before.inverse());
    let aim = (from_rotation_vector(turn * lead(substeps)) * before * f2).normalize();
    let rate = TAU * config.drive.frequency * slot.strength.sqrt();
    let most = bone.joint.max_torque * config.drive.torque * slot.strength;
    let rows = MotorRows {
        stiffness: bone.carried * (rate * rate),
        damping: bone.carried * (2.0 * config.drive.damping_ratio * rate),
        velocity: aim.inverse() * turn * (config.drive.velocity / dt),
        most: most.max(bone.friction()).min(MOST),
    };
    worlds.drive(link, joint, aim, &rows);
}

/// Holds a bone, with so much mass that hangs on it, kilograms, at its place in the world, or lets it go.
pub(super) fn pin(
    worlds: &mut JointWorlds,
    config: &Ragdoll,
    plan: &RagdollPlan,
    slot: &Slot,
    mass: f32,
    ties: &mut BoneTies,
    (dt, substeps): (f32, f32),
) {
    let link = &slot.link;
    if !(slot.pin > 0.0 && slot.body == BoneBody::Dynamic) {
        if let Some(joint) = ties.pin.take() {
            worlds.untie(link, joint);
        }
        return;
    }
    if ties.pin.is_none() {
        ties.pin = worlds.pin(link, &slot.handle);
    }
    let Some(joint) = ties.pin else { return };
    let lead = lead(substeps);
    let way = slot.target.position - slot.before.position;
    let turn = rotation_vector(slot.target.rotation * slot.before.rotation.inverse());
    let position = slot.before.position + way * lead;
    let rotation = (from_rotation_vector(turn * lead) * slot.before.rotation).normalize();
    let rate = TAU * config.drive.pin_frequency * slot.pin.sqrt();
    let ratio = 2.0 * config.drive.damping_ratio.max(1.0) * rate;
    let rows = |carried: f32, velocity: Vec3| MotorRows {
        stiffness: Vec3::splat(carried * rate * rate),
        damping: Vec3::splat(carried * ratio),
        velocity: rotation.inverse() * velocity,
        most: MOST,
    };
    let slides = rows(mass, way / dt);
    let turns = rows(plan.inertia * mass / plan.mass, turn / dt);
    worlds.drive_pin(link, joint, position, rotation, &slides, &turns);
}

/// How hard a bone is driven in a mode.
pub(super) fn strength(powered: bool, asked: f32, control: &BoneControl) -> f32 {
    if powered {
        part(asked) * part(control.strength)
    } else {
        0.0
    }
}
