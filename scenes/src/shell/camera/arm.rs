//! Puts the camera on its arm, in front of what is in the way.

use bevy::{math::ops, prelude::*, time::Real};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use super::{CameraMode, CameraRig, ViewEase};
use crate::shell::Player;

/// Room that the camera keeps to walls, metres.
const CLEARANCE: f32 = 0.2;

/// How fast the arm grows back, and the eyes follow the height, per second.
const GROW: f32 = 6.0;
const EYE: f32 = 14.0;

/// Places the camera at the eyes or on its arm behind them.
pub(super) fn place(
    time: Res<Time<Real>>,
    fixed: Res<Time<Fixed>>,
    physics: ReadRapierContext,
    mut cameras: Query<(&mut CameraRig, &mut Transform), Without<Player>>,
    players: Query<(Entity, &Transform, &CharacterState, &Character, &ViewEase), With<Player>>,
) {
    let Ok((player, pose, state, character, view)) = players.single() else {
        return;
    };
    let seconds = time.delta_secs();
    let height = if state.height > 0.0 {
        state.height
    } else {
        character.shape.height()
    };
    for (mut rig, mut camera) in &mut cameras {
        if rig.mode == CameraMode::Fixed {
            continue;
        }
        let eye = height - 0.15;
        let blend = if rig.eye == 0.0 {
            1.0
        } else {
            1.0 - ops::exp(-EYE * seconds)
        };
        rig.eye += (eye - rig.eye) * blend;
        let up = rig.base * Vec3::Y;
        let eyes = pose.translation + view.offset(fixed.overstep_fraction()) + up * rig.eye;
        let rotation = rig.rotation();
        camera.rotation = rotation;
        if rig.mode == CameraMode::FirstPerson {
            camera.translation = eyes;
            continue;
        }
        let back = rotation * Vec3::Z;
        let length = rig.distance;
        reach(&mut rig, &physics, player, eyes, back, length, seconds);
        camera.translation = eyes + back * rig.arm;
    }
}

/// Sets the arm to what is free of the length that is wanted.
pub(super) fn reach(
    rig: &mut CameraRig,
    physics: &ReadRapierContext,
    player: Entity,
    eyes: Vec3,
    back: Vec3,
    length: f32,
    seconds: f32,
) {
    let free = free_length(physics, player, eyes, back, length);
    // In at once, or a wall would be looked through; out slowly, or pillars would make it hop.
    rig.arm = if free < rig.arm {
        free
    } else {
        rig.arm + (free - rig.arm) * (1.0 - ops::exp(-GROW * seconds))
    };
}

/// How far a ball can go from the eyes before it touches something other than the player.
fn free_length(
    physics: &ReadRapierContext,
    player: Entity,
    eyes: Vec3,
    back: Vec3,
    length: f32,
) -> f32 {
    let Ok(context) = physics.single() else {
        return length;
    };
    let ball = Collider::ball(CLEARANCE);
    let filter = QueryFilter::default()
        .exclude_sensors()
        .exclude_rigid_body(player);
    let options = ShapeCastOptions {
        max_time_of_impact: length,
        stop_at_penetration: false,
        ..default()
    };
    context
        .cast_shape(eyes, Quat::IDENTITY, back, &*ball.raw, options, filter)
        .map_or(length, |(_, hit)| hit.time_of_impact.clamp(0.0, length))
}
