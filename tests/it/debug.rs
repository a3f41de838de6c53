//! What is seen of characters: the gizmo and inspector plugins in an app without a window.

use bevy::{
    asset::AssetPlugin,
    gizmos::{GizmoAsset, GizmoPlugin, config::GizmoConfigStore},
    image::ImagePlugin,
    input::InputPlugin,
    mesh::skinning::SkinnedMeshInverseBindposes,
    prelude::*,
    shader::Shader,
    window::WindowPlugin,
};
use bevy_egui::{EguiContext, EguiPrimaryContextPass, PrimaryEguiContext, egui};
use bevy_embody::{
    debug::{CharacterGizmos, InspectorPanel, StepTrail},
    prelude::*,
};
use embody_scenes::Sim;

fn embody() -> impl PluginGroup {
    EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>()
}

/// An app in which this plugin draws.
fn drawn(plugin: impl Plugin) -> Sim {
    Sim::with(
        60.0,
        (
            AssetPlugin::default(),
            // Bevy's own gizmos ask for meshes.
            |app: &mut App| {
                app.init_asset::<Mesh>()
                    .init_asset::<SkinnedMeshInverseBindposes>();
            },
            GizmoPlugin,
            embody(),
            plugin,
        ),
    )
}

#[test]
fn every_shape_is_drawn_around_its_body_and_no_line_is_lost() {
    let mut sim = drawn(EmbodyDebugPlugin);
    sim.floor(0.0);
    sim.block(Vec3::new(0.0, 1.0, 2.0), Vec3::new(60.0, 2.0, 1.0));
    // The lowest point of this hull is not at its origin.
    let hull: Vec<Vec3> = [-0.3, 0.3]
        .iter()
        .flat_map(|x| [2.0, 3.7].map(|y| [-0.3, 0.3].map(|z| Vec3::new(*x, y, z))))
        .flatten()
        .collect();
    let shapes = [
        Character::capsule(0.3, 1.8),
        Character::cylinder(0.3, 1.8),
        Character::cuboid(0.6, 1.8, 0.4),
        Character {
            shape: CharacterShape::ConvexHull { points: hull },
            ..default()
        },
    ];
    let all: Vec<Entity> = shapes
        .into_iter()
        .enumerate()
        .map(|(i, shape)| sim.character(shape, Vec3::new(10.0 * i as f32 - 15.0, 0.0, 0.0)))
        .collect();
    sim.seconds(0.3);
    for &who in &all {
        sim.walk(who, Vec3::Z);
    }
    sim.seconds(1.0);
    for &who in &all {
        let trail = sim.app.world().get::<StepTrail>(who);
        assert!(
            trail.is_some_and(|trail| trail.last().is_some()),
            "an attempt at the wall is remembered"
        );
    }
    // One at a time, so that the lines are its own.
    for &who in &all {
        for &other in &all {
            let mut other_one = sim.app.world_mut().entity_mut(other);
            let far = if other == who { 0.0 } else { 500.0 };
            other_one
                .get_mut::<Transform>()
                .expect("a character has a transform")
                .translation
                .y = far;
        }
        sim.ticks(3);
        let foot = sim.position(who);
        let near = lines(&sim)
            .into_iter()
            .filter(|point| point.y < 100.0 && (point.x - foot.x).abs() < 5.0)
            .collect::<Vec<_>>();
        let (low, high) = near
            .iter()
            .fold((f32::MAX, f32::MIN), |(l, h), p| (l.min(p.y), h.max(p.y)));
        assert!(!near.is_empty() && near.iter().all(|p| p.is_finite()));
        assert!((-0.2..0.05).contains(&low), "{who}: lowest line at {low}");
        assert!((1.65..2.1).contains(&high), "{who}: highest line at {high}");
    }
    // Switched off, nothing is drawn; and what is no character leaves no trail.
    sim.app
        .world_mut()
        .resource_mut::<GizmoConfigStore>()
        .config_mut::<CharacterGizmos>()
        .0
        .enabled = false;
    sim.app.world_mut().entity_mut(all[0]).remove::<Character>();
    sim.ticks(2);
    assert!(lines(&sim).is_empty());
    assert!(sim.app.world().get::<StepTrail>(all[0]).is_none());
}

/// The points of all lines that were drawn in the last frame.
fn lines(sim: &Sim) -> Vec<Vec3> {
    let assets = sim.app.world().resource::<Assets<GizmoAsset>>();
    let mut points = Vec::new();
    for (_, asset) in assets.iter() {
        let buffer = asset.buffer();
        points.extend(buffer.list_positions.iter());
        // Strips are parted by points that are none.
        points.extend(buffer.strip_positions.iter().filter(|p| !p.is_nan()));
    }
    points
}

#[test]
fn the_inspector_draws_the_panel_of_a_character_and_of_none() {
    let mut sim = Sim::with(
        60.0,
        (
            AssetPlugin::default(),
            ImagePlugin::default(),
            WindowPlugin {
                primary_window: None,
                ..default()
            },
            InputPlugin,
            // For the renderer that is not here.
            |app: &mut App| {
                app.init_asset::<Shader>();
            },
            embody(),
            EmbodyInspectorPlugin,
        ),
    );
    let context = sim.spawn(PrimaryEguiContext);
    let texts = |sim: &mut Sim| {
        // Two passes: the first only finds out how large things are.
        for _ in 0..2 {
            let world = sim.app.world_mut();
            let mut egui = world.get_mut::<EguiContext>(context).expect("a context");
            let egui = egui.get_mut().clone();
            egui.begin_pass(egui::RawInput {
                screen_rect: Some(egui::Rect::from_min_size(
                    egui::Pos2::ZERO,
                    egui::vec2(1280.0, 2000.0),
                )),
                ..default()
            });
            world.run_schedule(EguiPrimaryContextPass);
            let mut output = egui.end_pass();
            // Nobody paints them.
            output.textures_delta.clear();
            let texts: Vec<String> = output
                .shapes
                .iter()
                .filter_map(|clipped| match &clipped.shape {
                    egui::Shape::Text(text) => Some(text.galley.text().to_string()),
                    _ => None,
                })
                .collect();
            sim.app.world_mut().insert_resource(Texts(texts));
        }
        sim.app.world().resource::<Texts>().0.join("\n")
    };
    let none = texts(&mut sim);
    assert!(none.contains("there is no character"), "{none}");
    sim.floor(0.0);
    let who = sim.character(Character::default(), Vec3::Y);
    sim.walk(who, Vec3::X);
    sim.seconds(1.0);
    let shown = texts(&mut sim);
    assert!(!shown.contains("there is no character"), "{shown}");
    for part in ["5.00 m/s own", "on ground", "Walk, Stand"] {
        assert!(shown.contains(part), "{part} is not in\n{shown}");
    }
    // Closed, it draws nothing.
    sim.app.world_mut().resource_mut::<InspectorPanel>().open = false;
    assert_eq!(texts(&mut sim), "");
}

/// The texts of the last pass.
#[derive(Resource)]
struct Texts(Vec<String>);

#[test]
fn a_ragdoll_in_any_mode_is_drawn() {
    let mut sim = drawn(bevy_embody::RagdollDebugPlugin);
    sim.floor(0.0);
    let all: Vec<Entity> = [
        RagdollMode::Limp,
        RagdollMode::Powered,
        RagdollMode::HitBoxes,
    ]
    .into_iter()
    .map(|mode| {
        let intent = RagdollIntent { mode, ..default() };
        sim.spawn((
            Ragdoll::default(),
            intent,
            Transform::from_xyz(0.0, 0.2, 0.0),
        ))
    })
    .collect();
    sim.seconds(0.5);
    for entity in all {
        // Whoever is asked for what it cannot do is off its pose, and is drawn so.
        let state = sim.get::<RagdollState>(entity);
        assert!(
            state.bones.len() == 19 && state.bones.iter().all(|b| b.place.position.is_finite())
        );
    }
}
