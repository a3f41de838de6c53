//! From glTF to plain arrays.

use std::path::Path;

use bevy::prelude::*;
use gltf::{Gltf, material::AlphaMode, mesh::Mode};

use super::{
    Course, CourseError, Material, Node, Surface,
    extras::{ColliderSpec, EXTRAS_KEY, NodeExtras},
};

pub(super) fn load(path: &Path) -> Result<Course, CourseError> {
    let bytes = std::fs::read(path).map_err(|error| CourseError::Read(path.into(), error))?;
    from_slice(&bytes)
}

pub(super) fn from_slice(bytes: &[u8]) -> Result<Course, CourseError> {
    let gltf = Gltf::from_slice(bytes).map_err(CourseError::Gltf)?;
    let blob = gltf.blob.as_deref().unwrap_or_default();
    let mut course = Course {
        nodes: Vec::new(),
        materials: gltf.materials().map(|m| material(&m)).collect(),
    };
    let scene = gltf.default_scene().or_else(|| gltf.scenes().next());
    for root in scene.iter().flat_map(gltf::Scene::nodes) {
        add(&root, Transform::IDENTITY, blob, &mut course)?;
    }
    Ok(course)
}

/// Adds a node and those below it, each with its pose in the world.
fn add(
    node: &gltf::Node,
    parent: Transform,
    blob: &[u8],
    course: &mut Course,
) -> Result<(), CourseError> {
    let name = node
        .name()
        .map_or_else(|| format!("node {}", node.index()), str::to_owned);
    let (translation, rotation, scale) = node.transform().decomposed();
    let problem = |problem: &str| CourseError::Node {
        node: name.clone(),
        problem: problem.to_owned(),
    };
    if scale.iter().any(|s| (s - 1.0).abs() > 1e-5) {
        return Err(problem("is scaled; apply the scale to its mesh"));
    }
    let transform = parent
        * Transform::from_translation(translation.into())
            .with_rotation(Quat::from_array(rotation).normalize());
    let mut surfaces = Vec::new();
    for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
        if primitive.mode() != Mode::Triangles {
            return Err(problem("has a mesh that is not made of triangles"));
        }
        surfaces.push(
            surface(&primitive, blob)
                .ok_or_else(|| problem("has a mesh without corners or normals"))?,
        );
    }
    let extras = extras(node).map_err(|error| CourseError::Extras {
        node: name.clone(),
        error,
    })?;
    if surfaces.is_empty()
        && matches!(
            extras.collider,
            Some(ColliderSpec::Trimesh | ColliderSpec::Convex)
        )
    {
        return Err(problem(
            "takes its collider from a mesh that it does not have",
        ));
    }
    let loaded = Node {
        name: name.clone(),
        transform,
        surfaces,
        extras,
    };
    if loaded.extras.collider.is_some() && super::spawn::collider(&loaded).is_none() {
        return Err(problem("has a collider whose numbers make no shape"));
    }
    course.nodes.push(loaded);
    for child in node.children() {
        add(&child, transform, blob, course)?;
    }
    Ok(())
}

fn extras(node: &gltf::Node) -> Result<NodeExtras, serde_json::Error> {
    let Some(raw) = node.extras() else {
        return Ok(NodeExtras::default());
    };
    let mut all: serde_json::Value = serde_json::from_str(raw.get())?;
    match all.get_mut(EXTRAS_KEY) {
        Some(ours) => serde_json::from_value(ours.take()),
        None => Ok(NodeExtras::default()),
    }
}

fn surface(primitive: &gltf::Primitive, blob: &[u8]) -> Option<Surface> {
    let reader = primitive.reader(|buffer| (buffer.index() == 0).then_some(blob));
    let positions: Vec<[f32; 3]> = reader.read_positions()?.collect();
    let normals: Vec<[f32; 3]> = reader.read_normals()?.collect();
    let colors = reader
        .read_colors(0)
        .map(|colors| colors.into_rgba_f32().collect())
        .unwrap_or_default();
    let indices = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect(),
        None => (0..u32::try_from(positions.len()).ok()?).collect(),
    };
    Some(Surface {
        positions,
        normals,
        colors,
        indices,
        material: primitive.material().index(),
    })
}

fn material(material: &gltf::Material) -> Material {
    let pbr = material.pbr_metallic_roughness();
    Material {
        name: material.name().unwrap_or_default().to_owned(),
        base_color: pbr.base_color_factor(),
        roughness: pbr.roughness_factor(),
        metallic: pbr.metallic_factor(),
        emissive: material.emissive_factor(),
        blend: material.alpha_mode() == AlphaMode::Blend,
    }
}
