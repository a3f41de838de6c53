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
        .add_systems(Update, show_wheels)
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
    let ground = Transform::from_xyz(0.0, -0.5, 0.0);
    block(ground, Vec3::new(400.0, 1.0, 400.0));
    let ramp = Transform::from_xyz(0.0, 0.0, -60.0).with_rotation(Quat::from_rotation_x(0.2));
    block(ramp, Vec3::new(6.0, 0.4, 12.0));
    let preset = VehiclePreset::sports_car();
    let car = preset.spawn(&mut commands, Transform::default());
    let seen = (Visibility::default(), Interpolated);
    commands.entity(car).insert(seen);
    let paint = materials.add(Color::srgb(0.9, 0.5, 0.2));
    commands.spawn((
        ChildOf(car),
        // Narrower than the hull, so that the wheels are seen.
        Mesh3d(meshes.add(Cuboid::from_size(preset.hull * Vec3::new(0.7, 0.8, 1.0)))),
        MeshMaterial3d(paint),
        Transform::from_translation(preset.hull_center),
    ));
    let behind = Transform::from_xyz(0.0, 3.0, 8.0).looking_at(Vec3::Y, Vec3::Y);
    commands.spawn((ChildOf(car), Camera3d::default(), behind));
}

fn show_wheels(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    wheels: Query<(Entity, &Wheel), Added<Wheel>>,
) {
    for (entity, wheel) in &wheels {
        // A cylinder's axis is Y, a wheel's is X.
        let lying = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
        let tire = Mesh::from(Cylinder::new(wheel.radius, wheel.width)).rotated_by(lying);
        let rubber = MeshMaterial3d(materials.add(Color::srgb(0.1, 0.1, 0.1)));
        let looks = (Mesh3d(meshes.add(tire)), rubber);
        commands.entity(entity).insert(looks);
    }
}

fn drive(keys: Res<ButtonInput<KeyCode>>, mut intent: Single<&mut VehicleIntent>) {
    let held = |key| f32::from(keys.pressed(key));
    intent.throttle = held(KeyCode::KeyW);
    intent.brake = held(KeyCode::KeyS);
    intent.handbrake = held(KeyCode::Space);
    intent.steer = held(KeyCode::KeyD) - held(KeyCode::KeyA);
    let gears = [Gear::Drive, Gear::Reverse];
    intent.gear = gears[usize::from(keys.pressed(KeyCode::KeyR))];
}
