//! The level, family by family.

pub mod ground;
mod machines;
mod obstacles;
mod places;
pub mod signs;
mod slopes;
mod stairs;

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{BodyKind, ColliderSpec, NodeExtras},
    layout::Place,
};

use crate::{mesh::Mesh, paint::Paint};

/// A node to be written.
pub struct Node {
    pub name: String,
    pub transform: Transform,
    pub mesh: Mesh,
    pub extras: NodeExtras,
}

/// All nodes.
#[derive(Default)]
pub struct Level {
    /// What its scene is called in the file.
    pub name: &'static str,
    pub nodes: Vec<Node>,
}

/// Builds everything.
pub fn build(level: &mut Level) {
    ground::build(level);
    stairs::build(level);
    slopes::build(level);
    obstacles::build(level);
    machines::build(level);
    places::build(level);
}

impl Level {
    /// Adds a node whose mesh and physics are in its own axes, at a point of a place.
    pub fn add(
        &mut self,
        name: impl Into<String>,
        place: &Place,
        at: Vec3,
        mesh: Mesh,
        extras: NodeExtras,
    ) {
        self.nodes.push(Node {
            name: name.into(),
            transform: place.transform(at),
            mesh,
            extras,
        });
    }

    /// Adds something that is only looked at.
    pub fn decor(&mut self, name: impl Into<String>, place: &Place, at: Vec3, mesh: Mesh) {
        self.add(name, place, at, mesh, NodeExtras::default());
    }

    /// Adds a fixed box by its middle and full size.
    pub fn block(
        &mut self,
        name: impl Into<String>,
        place: &Place,
        center: Vec3,
        size: Vec3,
        paint: Paint,
    ) {
        let mut mesh = Mesh::default();
        mesh.cuboid(paint, Vec3::ZERO, size);
        self.add(name, place, center, mesh, solid(boxed(size)));
    }

    /// Adds a fixed box that stands on the plaza.
    pub fn standing(
        &mut self,
        name: impl Into<String>,
        place: &Place,
        foot: Vec3,
        size: Vec3,
        paint: Paint,
    ) {
        self.block(name, place, foot + Vec3::Y * (0.5 * size.y), size, paint);
    }

    /// Adds a fixed mesh that collides as it looks.
    pub fn solid_mesh(&mut self, name: impl Into<String>, place: &Place, at: Vec3, mesh: Mesh) {
        self.add(name, place, at, mesh, solid(ColliderSpec::Trimesh));
    }
}

/// A box collider.
pub fn boxed(size: Vec3) -> ColliderSpec {
    ColliderSpec::Box {
        size: size.to_array(),
    }
}

/// Physics of a fixed thing.
pub fn solid(collider: ColliderSpec) -> NodeExtras {
    NodeExtras {
        collider: Some(collider),
        ..default()
    }
}

/// Physics of a thing that moves by the clock.
pub fn kinematic(
    collider: ColliderSpec,
    motion: embody_scenes::course::extras::Motion,
) -> NodeExtras {
    NodeExtras {
        body: BodyKind::Kinematic,
        motion: Some(motion),
        ..solid(collider)
    }
}

/// Physics of a thing that forces move.
pub fn dynamic(collider: ColliderSpec, mass: f32) -> NodeExtras {
    NodeExtras {
        body: BodyKind::Dynamic,
        mass: Some(mass),
        ..solid(collider)
    }
}
