//! The smallest use: drive with W, A, S, D, brake with S, handbrake with Space, R for reverse.
//! With `--headless`, or without a display, W is held for 5 seconds and the way is printed.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

fn main() -> AppExit {
    App::new()
        .add_plugins(embody_scenes::shell::demo_plugins("vehicle"))
        .add_plugins(EmbodyPlugins)
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, drive)
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
    let mut block = |at: Transform, size: Vec3| {
        commands.spawn((
            RigidBody::Fixed,
            Collider::cuboid(size.x / 2.0, size.y / 2.0, size.z / 2.0),
            Mesh3d(meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(stone.clone()),
            at,
        ));
    };
    block(
        Transform::from_xyz(0.0, -0.5, 0.0),
        Vec3::new(400.0, 1.0, 400.0),
    );
    let ramp = Transform::from_xyz(0.0, 0.0, -60.0).with_rotation(Quat::from_rotation_x(0.2));
    block(ramp, Vec3::new(6.0, 0.4, 12.0));
    let preset = VehiclePreset::sports_car();
    let car = preset.spawn(&mut commands, Transform::default());
    commands
        .entity(car)
        .insert((Visibility::default(), Interpolated));
    let paint = materials.add(Color::srgb(0.9, 0.5, 0.2));
    commands.spawn((
        ChildOf(car),
        Mesh3d(meshes.add(Cuboid::from_size(preset.hull))),
        MeshMaterial3d(paint),
        Transform::from_translation(preset.hull_center),
    ));
    let behind = Transform::from_xyz(0.0, 4.0, 10.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((ChildOf(car), Camera3d::default(), behind));
}

fn drive(keys: Res<ButtonInput<KeyCode>>, mut intent: Single<&mut VehicleIntent>) {
    let held = |key| f32::from(keys.pressed(key));
    intent.throttle = held(KeyCode::KeyW);
    intent.brake = held(KeyCode::KeyS);
    intent.handbrake = held(KeyCode::Space);
    intent.steer = held(KeyCode::KeyD) - held(KeyCode::KeyA);
    intent.gear = if keys.pressed(KeyCode::KeyR) {
        Gear::Reverse
    } else {
        Gear::Drive
    };
}
