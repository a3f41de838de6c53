//! A ragdoll of a loaded figure, by one component.

use bevy::{
    asset::AssetPlugin,
    gltf::{
        GltfAssetLabel, GltfLoaderSettings, GltfPlugin, convert_coordinates::GltfConvertCoordinates,
    },
    image::ImagePlugin,
    mesh::MeshPlugin,
    prelude::*,
    world_serialization::WorldSerializationPlugin,
};
use bevy_embody::{
    prelude::*,
    ragdoll::{BoneShape, SkinReport},
};
use embody_scenes::Sim;

use super::support::*;
use crate::character::warnings;

/// Bones that each figure had when it was said to be ready.
#[derive(Resource, Default)]
struct Ready(Vec<(Entity, usize)>);

fn loaded(wish: RagdollFromSkin, scale: Vec3) -> (Sim, Entity) {
    let assets = AssetPlugin {
        file_path: concat!(env!("CARGO_MANIFEST_DIR"), "/assets").into(),
        ..default()
    };
    let mut sim = Sim::with(
        60.0,
        (
            assets,
            ImagePlugin::default(),
            MeshPlugin,
            WorldSerializationPlugin,
            |app: &mut App| {
                app.init_asset::<StandardMaterial>()
                    .init_asset::<AnimationClip>()
                    .register_type::<MeshMaterial3d<StandardMaterial>>();
            },
            GltfPlugin::default(),
            EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>(),
        ),
    );
    sim.floor(0.0);
    warnings::unique_entities(&mut sim);
    sim.app.init_resource::<Ready>().add_observer(
        |ready: On<RagdollReady>, bones: Query<&Bones>, mut all: ResMut<Ready>| {
            let count = bones.get(ready.entity).map_or(0, |b| b.iter().count());
            all.0.push((ready.entity, count));
        },
    );
    let server = sim.app.world().resource::<AssetServer>().clone();
    let scene = server
        .load_builder()
        .with_settings(|settings: &mut GltfLoaderSettings| {
            settings.convert_coordinates = Some(GltfConvertCoordinates {
                rotate_scene_entity: true,
                ..default()
            });
        })
        .load(GltfAssetLabel::Scene(0).from_asset("human.glb"));
    let at = Transform::from_xyz(1.0, 0.0, 2.0)
        .with_rotation(Quat::from_rotation_y(0.6))
        .with_scale(scale);
    let entity = sim.spawn((WorldAssetRoot(scene), wish, at));
    for _ in 0..2000 {
        sim.ticks(1);
        if sim.app.world().get::<SkinReport>(entity).is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    sim.ticks(2);
    (sim, entity)
}

#[test]
fn a_loaded_human_is_a_ragdoll_that_fills_its_skin_and_falls_with_it() {
    let mut wish = RagdollFromSkin::default();
    wish.ragdoll.mass = 78.0;
    let (mut sim, entity) = loaded(wish, Vec3::ONE);
    let mut findings = Findings::new();
    let ready = &sim.app.world().resource::<Ready>().0;
    findings.holds(
        format!("ready with its bones, once: {ready:?}"),
        *ready == [(entity, 19)],
    );
    let report = sim.get::<SkinReport>(entity);
    findings.holds(
        format!("level {:?}", report.detail),
        report.detail == HumanoidDetail::Bodies19,
    );
    findings.near("bones", report.bones.len() as f32, 26.0, 0.0);
    findings.near("matched", report.found.matched.len() as f32, 22.0, 0.0);
    // Fingers and thumbs go with their hands.
    findings.near("merged", report.found.merged.len() as f32, 4.0, 0.0);
    findings.holds("nothing is left", report.found.left.is_empty());
    findings.near("fitted", report.fitted.len() as f32, 19.0, 0.0);
    let profile = sim.get::<Ragdoll>(entity).profile;
    // What the generator of the figure has: joints, and the thickness of its limbs.
    let near = |name: &str, at: Vec3| {
        profile
            .bone(name)
            .map_or(f32::MAX, |b| b.position.distance(at))
    };
    findings.at_most(
        "hips, m",
        near("pelvis", Vec3::new(0.0, 0.955, 0.0)),
        2.0e-3,
    );
    // It faces -Z here and +Z in the file, so its left is at -X.
    findings.at_most(
        "left knee, m",
        near("shin_l", Vec3::new(-0.094, 0.51, -0.012)),
        2.0e-3,
    );
    findings.at_most("head, m", near("head", Vec3::new(0.0, 1.58, 0.008)), 2.0e-3);
    for (name, low, high) in [
        ("upper_arm_l", 0.03, 0.07),
        ("forearm_r", 0.025, 0.06),
        ("thigh_l", 0.06, 0.11),
        ("shin_r", 0.035, 0.075),
        ("head", 0.08, 0.13),
    ] {
        let Some(BoneShape::Capsule { radius, .. }) = profile.bone(name).map(|b| b.shape) else {
            findings.holds(format!("{name} is a capsule"), false);
            continue;
        };
        let middle = 0.5 * (low + high);
        findings.near(
            format!("{name}: radius, m"),
            radius,
            middle,
            0.5 * (high - low),
        );
    }
    // Bodies begin where the joints are, and the joints stay with them.
    let apart = |sim: &Sim| {
        let all = bones(sim, entity);
        let apart = |b: &Entity| {
            let tied = sim.get::<BoneJoint>(*b);
            let joint = sim.get::<GlobalTransform>(tied.joint).compute_transform();
            let asked = joint.transform_point(tied.offset.position);
            asked.distance(sim.position(*b))
        };
        all.iter().map(apart).fold(0.0, f32::max)
    };
    findings.near("bodies", bones(&sim, entity).len() as f32, 19.0, 0.0);
    let head = sim.position(bone(&sim, entity, "head"));
    findings.at_least("it falls from where it stood: head, m", head.y, 1.2);
    sim.seconds(3.0);
    findings.at_most("skin off the bodies, m", apart(&sim), 0.01);
    let head = sim.position(bone(&sim, entity, "head"));
    findings.at_most("it has fallen: head, m", head.y, 0.5);
    let (_, mass) = momentum(&sim, entity);
    findings.near("mass, kg", mass, 78.0, 0.01);
    findings.at_most(
        "speed at rest, m/s",
        worst(&sim, entity, |o| o.velocity.length()),
        0.3,
    );
}

#[test]
fn a_mirrored_or_stretched_skin_is_told_and_has_no_bones() {
    let mut findings = Findings::new();
    for scale in [Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, 1.5, 1.0)] {
        let (mut sim, entity) = loaded(RagdollFromSkin::default(), scale);
        sim.ticks(20);
        findings.holds(format!("{scale}: no bones"), bones(&sim, entity).is_empty());
        let told = warnings::about(entity);
        let named = told
            .iter()
            .filter(|line| line.contains("RagdollFromSkin") && line.contains(&scale.to_string()));
        findings.near(format!("{scale}: {told:?}"), named.count() as f32, 1.0, 0.0);
        let ready = sim.app.world().resource::<Ready>().0.len();
        findings.near(format!("{scale}: ready"), ready as f32, 0.0, 0.0);
    }
}

#[test]
fn a_skin_that_is_twice_as_large_is_a_figure_twice_as_large() {
    let mut findings = Findings::new();
    let (mut sim, entity) = loaded(RagdollFromSkin::default(), Vec3::splat(2.0));
    let told = warnings::about(entity);
    findings.holds(format!("nothing is told: {told:?}"), told.is_empty());
    let head = sim.position(bone(&sim, entity, "head")).y;
    findings.near("head, m", head, 3.16, 0.1);
    sim.seconds(1.0);
    findings.holds("finite", finite(&sim, entity));
    let gap = worst(&sim, entity, |o| o.gap);
    findings.at_most("gap, m", gap, 0.01);
}
