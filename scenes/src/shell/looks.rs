//! From the triangles and materials of a level to Bevy's.

use bevy::{
    asset::RenderAssetUsages,
    light::NotShadowCaster,
    mesh::{Indices, PrimitiveTopology},
    prelude::*,
};

use crate::course::{Course, Material, Surface};

/// One material for each of a level's, and a plain one for surfaces that have none.
#[derive(Clone, Debug, Default)]
pub(super) struct Paints(Vec<(Handle<StandardMaterial>, bool)>);

impl Paints {
    /// Makes them at the first use.
    pub(super) fn fill(&mut self, course: &Course, materials: &mut Assets<StandardMaterial>) {
        if self.0.is_empty() {
            self.0 = course
                .materials
                .iter()
                .map(|paint| (material(paint), paint.blend))
                .chain([(Color::srgb(0.75, 0.75, 0.75).into(), false)])
                .map(|(paint, clear)| (materials.add(paint), clear))
                .collect();
        }
    }

    /// Hangs the surfaces of a thing below an entity.
    pub(super) fn dress(
        &self,
        commands: &mut Commands,
        meshes: &mut Assets<Mesh>,
        parent: Entity,
        surfaces: &[Surface],
    ) {
        let plain = self.0.len().saturating_sub(1);
        for surface in surfaces {
            let place = surface.material.unwrap_or(plain).min(plain);
            let Some((paint, clear)) = self.0.get(place).cloned() else {
                continue;
            };
            let mut look = commands.spawn((
                Mesh3d(meshes.add(mesh(surface))),
                MeshMaterial3d(paint),
                ChildOf(parent),
            ));
            if clear {
                look.insert(NotShadowCaster);
            }
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
