//! A click pushes the bone, or the loose thing, that the camera looks at.

use bevy::{
    prelude::*,
    window::{CursorGrabMode, CursorOptions, PrimaryWindow},
};
use bevy_embody::{bridge::CharacterRagdollState, prelude::*};
use bevy_rapier3d::prelude::*;

use super::{Player, camera::CameraRig};

/// How far a push reaches, metres.
const REACH: f32 = 60.0;
/// Newton-seconds: of a click, and with `Shift`.
const PUSH: [f32; 2] = [40.0, 150.0];
/// A person falls to a push of at least this, newton-seconds.
const KNOCK: f32 = 100.0;

/// Pushes by clicks while the pointer is grabbed, as the camera then aims at the middle of the window.
pub(super) struct ShootPlugin;

impl Plugin for ShootPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, shoot);
    }
}

fn shoot(
    mut commands: Commands,
    mouse: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    cursors: Query<&CursorOptions, With<PrimaryWindow>>,
    cameras: Query<&Transform, With<CameraRig>>,
    players: Query<Entity, With<Player>>,
    physics: ReadRapierContext,
    bones: Query<&BoneOf>,
    people: Query<&CharacterRagdollState>,
    mut loose: Query<(&RigidBody, &ReadMassProperties, &mut Velocity)>,
) {
    let grabbed = |c: &CursorOptions| c.grab_mode != CursorGrabMode::None;
    if !mouse.just_pressed(MouseButton::Left) || !cursors.iter().any(grabbed) {
        return;
    }
    let (Ok(eye), Ok(physics)) = (cameras.single(), physics.single()) else {
        return;
    };
    let ahead = *eye.forward();
    let push = PUSH[usize::from(keys.pressed(KeyCode::ShiftLeft))];
    // Persons are hit at their bones, not at their capsules.
    let target = |entity: Entity| !players.contains(entity) && !people.contains(entity);
    let filter = QueryFilter::default().exclude_sensors().predicate(&target);
    let Some((entity, way)) = physics.cast_ray(eye.translation, ahead, REACH, true, filter) else {
        return;
    };
    let point = eye.translation + ahead * way;
    if let Ok(BoneOf(ragdoll)) = bones.get(entity) {
        if push >= KNOCK && people.contains(*ragdoll) {
            commands.become_ragdoll(*ragdoll);
        }
        commands.hit(entity, point, ahead * push);
    } else if let Ok((RigidBody::Dynamic, mass, mut velocity)) = loose.get_mut(entity)
        && mass.mass > 0.0
    {
        velocity.linear += ahead * push / mass.mass;
    }
}
