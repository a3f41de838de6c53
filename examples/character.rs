//! The smallest use: walk with W, A, S, D, jump with Space.
//! With `--headless`, or without a display, W is held for 5 seconds and the way is printed.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

fn main() -> AppExit {
    App::new()
        .add_plugins(embody_scenes::shell::demo_plugins("character"))
        .add_plugins(EmbodyPlugins)
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, walk)
        .run()
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let light = Transform::default().looking_to(Vec3::new(1.0, -2.0, -1.5), Vec3::Y);
    commands.spawn((DirectionalLight::default(), light));
    let stone = materials.add(Color::srgb(0.45, 0.6, 0.65));
    let mut block = |x: f32, y: f32, z: f32, size: Vec3| {
        commands.spawn((
            RigidBody::Fixed,
            Collider::cuboid(size.x / 2.0, size.y / 2.0, size.z / 2.0),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(stone.clone()),
            Transform::from_xyz(x, y, z),
        ));
    };
    block(0.0, -0.5, 0.0, Vec3::new(60.0, 1.0, 60.0));
    block(0.0, 0.125, -3.0, Vec3::new(3.0, 0.25, 2.0));
    block(0.0, 0.25, -5.0, Vec3::new(3.0, 0.5, 2.0));
    block(4.0, 1.0, -4.0, Vec3::splat(2.0));
    let start = Transform::from_xyz(0.0, 0.0, 3.0);
    let body = commands.spawn((Character::default(), start, Visibility::default()));
    let parent = ChildOf(body.id());
    commands.spawn((
        parent.clone(),
        Mesh3d(meshes.add(Capsule3d::new(0.3, 1.2))),
        MeshMaterial3d(materials.add(Color::srgb(0.9, 0.5, 0.2))),
        Transform::from_xyz(0.0, 0.9, 0.0),
    ));
    let behind = Transform::from_xyz(0.0, 4.0, 7.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((parent, Camera3d::default(), behind));
}

fn walk(keys: Res<ButtonInput<KeyCode>>, mut intent: Single<&mut CharacterIntent>) {
    let held = |key| f32::from(keys.pressed(key));
    let right = held(KeyCode::KeyD) - held(KeyCode::KeyA);
    let back = held(KeyCode::KeyS) - held(KeyCode::KeyW);
    intent.movement = Vec3::new(right, 0.0, back);
    intent.jump = keys.pressed(KeyCode::Space);
}
