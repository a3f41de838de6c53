//! The smallest use: a loaded figure falls, is hit by a click or Space, and gets up when it lies still.
//! With `--headless`, or without a display, it is hit after a second, and what became of it is printed.

use bevy::{gltf::*, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

fn main() -> AppExit {
    App::new()
        .add_plugins((embody_scenes::shell::demo_plugins("ragdoll"), EmbodyPlugins))
        .add_systems(Startup, setup)
        .add_systems(Update, hit)
        .add_observer(stand)
        .add_observer(get_up)
        .run()
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    assets: Res<AssetServer>,
) {
    let light = Transform::default().looking_to(Vec3::new(1.0, -2.0, -1.5), Vec3::Y);
    commands.spawn((DirectionalLight::default(), light));
    commands.spawn((
        RigidBody::Fixed,
        Collider::halfspace(Vec3::Y).unwrap_or_default(),
        Mesh3d(meshes.add(Plane3d::default().mesh().size(60.0, 60.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.45, 0.6, 0.65))),
    ));
    // Files face +Z, figures here -Z.
    let turned = |settings: &mut GltfLoaderSettings| {
        settings.convert_coordinates = Some(convert_coordinates::GltfConvertCoordinates {
            rotate_scene_entity: true,
            ..default()
        });
    };
    let human = assets.load_builder().with_settings(turned);
    let human = human.load("human.glb#Scene0");
    commands.spawn((WorldAssetRoot(human), RagdollFromSkin::default()));
    let eye = Transform::from_xyz(3.0, 1.8, -3.5).looking_at(Vec3::Y * 0.6, Vec3::Y);
    commands.spawn((Camera3d::default(), eye));
}

/// The pose to get up to is that of the animation, here standing idle.
fn stand(
    _: On<RagdollReady>,
    mut commands: Commands,
    assets: Res<AssetServer>,
    mut graphs: ResMut<Assets<AnimationGraph>>,
    mut player: Single<(Entity, &mut AnimationPlayer)>,
) {
    let idle = assets.load(GltfAssetLabel::Animation(0).from_asset("human.glb"));
    let (graph, node) = AnimationGraph::from_clip(idle);
    let graph = AnimationGraphHandle(graphs.add(graph));
    commands.entity(player.0).insert(graph);
    player.1.play(node).repeat();
}

fn get_up(rests: On<CameToRest>, mut ragdolls: Query<(&mut RagdollIntent, &mut RagdollState)>) {
    if let Ok((mut intent, mut state)) = ragdolls.get_mut(rests.entity) {
        (intent.mode, state.rise_time) = (RagdollMode::GettingUp, 1.2);
    }
}

fn hit(
    mut commands: Commands,
    keys: Res<ButtonInput<KeyCode>>,
    clicks: Res<ButtonInput<MouseButton>>,
    ragdoll: Single<(Entity, &Transform, &mut RagdollIntent), With<Ragdoll>>,
) {
    let (entity, at, mut intent) = ragdoll.into_inner();
    if keys.just_pressed(KeyCode::Space) || clicks.just_pressed(MouseButton::Left) {
        intent.mode = RagdollMode::Limp;
        let chest = at.translation + Vec3::Y * 1.2;
        commands.hit(entity, chest, Vec3::new(0.0, 60.0, 180.0));
    }
}
