//! The smallest use of the character controller: a light, a floor, some blocks and a character
//! that walks with W, A, S, D and jumps with Space.
//!
//! With `--headless`, or without a display, W is held for some seconds and the way is printed.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

fn main() -> AppExit {
    App::new()
        .add_plugins(embody_scenes::shell::demo_plugins("bevy_embody: character"))
        .add_plugins(EmbodyPlugins)
        .add_systems(Startup, (spawn_level, spawn_character))
        .add_systems(FixedUpdate, walk)
        .run()
}

fn spawn_level(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mut block = |at: Vec3, size: Vec3| {
        commands.spawn((
            RigidBody::Fixed,
            Collider::cuboid(size.x / 2.0, size.y / 2.0, size.z / 2.0),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(materials.add(Color::srgb(0.5, 0.6, 0.65))),
            Transform::from_translation(at),
        ));
    };
    block(Vec3::new(0.0, -0.5, 0.0), Vec3::new(60.0, 1.0, 60.0));
    for step in 0..6u8 {
        let height = 0.25 * f32::from(step + 1);
        block(Vec3::new(0.0, height / 2.0, -3.0 - f32::from(step)), Vec3::new(4.0, height, 1.0));
    }
    commands.spawn((DirectionalLight::default(), Transform::default().looking_to(Vec3::new(1.0, -2.0, -1.0), Vec3::Y)));
}

fn spawn_character(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, mut materials: ResMut<Assets<StandardMaterial>>) {
    commands.spawn((Character::default(), Transform::from_xyz(0.0, 0.0, 3.0), Visibility::default())).with_children(|body| {
        body.spawn((
            Mesh3d(meshes.add(Capsule3d::new(0.3, 1.2))),
            MeshMaterial3d(materials.add(Color::srgb(0.9, 0.5, 0.2))),
            Transform::from_xyz(0.0, 0.9, 0.0),
        ));
        body.spawn((Camera3d::default(), Transform::from_xyz(0.0, 4.0, 7.0).looking_at(Vec3::Y, Vec3::Y)));
    });
}

fn walk(keys: Res<ButtonInput<KeyCode>>, mut intent: Single<&mut CharacterIntent>) {
    let axis = |minus, plus| f32::from(keys.pressed(plus)) - f32::from(keys.pressed(minus));
    intent.movement = Vec3::new(axis(KeyCode::KeyA, KeyCode::KeyD), 0.0, axis(KeyCode::KeyW, KeyCode::KeyS));
    intent.jump = keys.pressed(KeyCode::Space);
}
