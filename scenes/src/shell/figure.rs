//! A simple body for a character: trunk, head and a nose that shows where it faces.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;

use super::camera::{CameraMode, CameraRig, ViewEase};

/// On a character: gives it a figure of this colour.
#[derive(Component, Clone, Copy, Debug)]
pub struct FigureOf(pub Color);

impl Default for FigureOf {
    fn default() -> Self {
        Self(Color::srgb(0.95, 0.45, 0.15))
    }
}

/// The parts of a figure; the root hangs below the character.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Root,
    Trunk,
    Head,
}

/// Height of the trunk's mesh without its round ends and radius, metres.
const TRUNK: (f32, f32) = (0.8, 0.27);
const HEAD_RADIUS: f32 = 0.2;

/// Gives every [`FigureOf`] a body that follows the character's height.
pub(super) struct FigurePlugin;

impl Plugin for FigurePlugin {
    fn build(&self, app: &mut App) {
        app.add_observer(build_figure)
            .add_systems(Update, (follow_height, follow_view));
    }
}

fn build_figure(
    added: On<Add, FigureOf>,
    mut commands: Commands,
    figures: Query<&FigureOf>,
    meshes: Option<ResMut<Assets<Mesh>>>,
    materials: Option<ResMut<Assets<StandardMaterial>>>,
) {
    let (Some(mut meshes), Some(mut materials)) = (meshes, materials) else {
        return;
    };
    let Ok(FigureOf(color)) = figures.get(added.entity) else {
        return;
    };
    let cloth = materials.add(StandardMaterial {
        base_color: *color,
        perceptual_roughness: 0.7,
        ..default()
    });
    let skin = materials.add(StandardMaterial {
        base_color: Color::srgb(0.96, 0.8, 0.66),
        perceptual_roughness: 0.8,
        ..default()
    });
    let dark = materials.add(Color::srgb(0.15, 0.16, 0.2));
    let trunk = meshes.add(Capsule3d::new(TRUNK.1, TRUNK.0));
    let head = meshes.add(Sphere::new(HEAD_RADIUS).mesh().uv(24, 16));
    let nose = meshes.add(Cone::new(0.05, 0.14));
    let visor = meshes.add(Cuboid::new(0.3, 0.06, 0.12));
    let pack = meshes.add(Cuboid::new(0.34, 0.45, 0.16));

    commands.entity(added.entity).insert(Visibility::default());
    commands.spawn((
        Name::new("figure"),
        Part::Root,
        Transform::default(),
        Visibility::default(),
        ChildOf(added.entity),
        children![
            (
                Part::Trunk,
                Mesh3d(trunk),
                MeshMaterial3d(cloth.clone()),
                Transform::default(),
                children![(
                    Mesh3d(pack),
                    MeshMaterial3d(dark.clone()),
                    Transform::from_xyz(0.0, 0.12, 0.27),
                )],
            ),
            (
                Part::Head,
                Mesh3d(head),
                MeshMaterial3d(skin.clone()),
                Transform::default(),
                children![
                    (
                        Mesh3d(nose),
                        MeshMaterial3d(skin),
                        Transform::from_xyz(0.0, -0.03, -0.23)
                            .with_rotation(Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2)),
                    ),
                    (
                        Mesh3d(visor),
                        MeshMaterial3d(dark),
                        Transform::from_xyz(0.0, 0.06, -0.14),
                    ),
                ],
            ),
        ],
    ));
}

/// Keeps the head on top and the trunk between it and the floor, at any height.
fn follow_height(
    time: Res<Time>,
    characters: Query<(&CharacterState, &Character)>,
    roots: Query<(&ChildOf, &Children), With<Part>>,
    mut parts: Query<(&Part, &mut Transform)>,
) {
    let blend = 1.0 - ops::exp(-20.0 * time.delta_secs());
    for (parent, children) in &roots {
        let Ok((state, character)) = characters.get(parent.parent()) else {
            continue;
        };
        let height = if state.height > 0.0 {
            state.height
        } else {
            character.shape.height()
        };
        for child in children {
            let Ok((part, mut transform)) = parts.get_mut(*child) else {
                continue;
            };
            let (at, stretch) = match part {
                Part::Root => continue,
                Part::Head => (height - HEAD_RADIUS, 1.0),
                Part::Trunk => {
                    let tall = height - 1.6 * HEAD_RADIUS;
                    (tall * 0.5, tall / (TRUNK.0 + 2.0 * TRUNK.1))
                }
            };
            let first = transform.translation == Vec3::ZERO;
            let blend = if first { 1.0 } else { blend };
            transform.translation.y += (at - transform.translation.y) * blend;
            transform.scale.y += (stretch - transform.scale.y) * blend;
        }
    }
}

/// Shows steps as ramps, and hides the player's own figure when the camera is in its head.
fn follow_view(
    fixed: Res<Time<Fixed>>,
    rigs: Query<&CameraRig>,
    characters: Query<(&Transform, &ViewEase), Without<Part>>,
    mut roots: Query<(&ChildOf, &Part, &mut Transform, &mut Visibility)>,
) {
    let inside = rigs.iter().any(|rig| rig.mode == CameraMode::FirstPerson);
    for (parent, part, mut transform, mut visibility) in &mut roots {
        if *part != Part::Root {
            continue;
        }
        let Ok((character, view)) = characters.get(parent.parent()) else {
            continue;
        };
        let offset = view.offset(fixed.overstep_fraction());
        transform.translation = character.rotation.inverse() * offset;
        visibility.set_if_neq(if inside {
            Visibility::Hidden
        } else {
            Visibility::Inherited
        });
    }
}
