//! What a course looks like: its triangles, colours and materials on the spawned entities.

use bevy::{
    asset::RenderAssetUsages,
    light::NotShadowCaster,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

use bevy_embody::prelude::*;

use crate::course::{Course, CourseNode, Material, Surface, extras::BodyKind};

/// Gives every [`CourseNode`] its looks, as soon as it is spawned.
pub(super) struct CourseViewPlugin;

impl Plugin for CourseViewPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Paints>().add_observer(dress);
    }
}

/// One material for each of the course's.
#[derive(Resource, Default)]
struct Paints(Vec<Handle<StandardMaterial>>);

fn dress(
    added: On<Add, CourseNode>,
    mut commands: Commands,
    course: Res<Course>,
    nodes: Query<&CourseNode>,
    mut paints: ResMut<Paints>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let Some(node) = nodes
        .get(added.entity)
        .ok()
        .and_then(|node| course.nodes.get(node.0))
    else {
        return;
    };
    if paints.0.is_empty() {
        paints.0 = course
            .materials
            .iter()
            .map(material)
            .chain([Color::srgb(0.75, 0.75, 0.75).into()])
            .map(|paint| materials.add(paint))
            .collect();
    }
    // The last one is for surfaces without a material of their own.
    let plain = paints.0.len() - 1;
    let painted = |surface: &Surface| {
        let place = surface.material.unwrap_or(plain).min(plain);
        let clear = course.materials.get(place).is_some_and(|paint| paint.blend);
        (paints.0[place].clone(), clear)
    };
    let mut entity = commands.entity(added.entity);
    entity.insert(Visibility::default());
    if node.extras.body != BodyKind::Fixed {
        entity.insert(Interpolated);
    }
    for surface in &node.surfaces {
        let (paint, clear) = painted(surface);
        let mut look = commands.spawn((Mesh3d(meshes.add(mesh(surface))), MeshMaterial3d(paint)));
        look.insert(ChildOf(added.entity));
        if clear {
            look.insert(NotShadowCaster);
        }
    }
}

fn mesh(surface: &Surface) -> Mesh {
    let mut mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, surface.positions.clone())
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, surface.normals.clone())
    .with_inserted_indices(Indices::U32(surface.indices.clone()));
    if !surface.colors.is_empty() {
        mesh.insert_attribute(Mesh::ATTRIBUTE_COLOR, surface.colors.clone());
    }
    mesh
}

fn material(paint: &Material) -> StandardMaterial {
    let [red, green, blue, alpha] = paint.base_color;
    let [r, g, b] = paint.emissive;
    StandardMaterial {
        base_color: Color::linear_rgba(red, green, blue, alpha),
        emissive: LinearRgba::rgb(r, g, b),
        perceptual_roughness: paint.roughness,
        metallic: paint.metallic,
        reflectance: 0.3,
        alpha_mode: if paint.blend {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        // Water and glass are seen from inside too.
        cull_mode: (!paint.blend).then_some(bevy::render::render_resource::Face::Back),
        double_sided: paint.blend,
        ..default()
    }
}
