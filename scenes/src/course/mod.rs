//! The course: a level in a glTF file, every physical property of which is in the file.
//!
//! [`Course::load`] reads it without a renderer, [`spawn_course`] spawns bodies, colliders and the
//! components of `bevy_embody` for it, and [`CoursePlugin`] moves its platforms and turns the
//! gravity of its planet. A window finds the triangles and colours of a spawned entity through its
//! [`CourseNode`] and the [`Course`] resource.

mod error;
pub mod extras;
pub mod layout;
mod load;
mod motion;
mod planet;
mod spawn;

use std::path::{Path, PathBuf};

use bevy::prelude::*;

pub use error::CourseError;
pub use motion::{CourseMotion, pose_at};
pub use planet::{OnPlanet, Planet};
pub use spawn::{CourseNode, despawn_course, spawn_course};

use extras::NodeExtras;

/// A level as loaded. Insert it as a resource to find the mesh of a [`CourseNode`].
#[derive(Resource, Clone, Debug, Default)]
pub struct Course {
    /// The nodes, in the file's order.
    pub nodes: Vec<Node>,
    /// The materials that the nodes' surfaces name.
    pub materials: Vec<Material>,
}

/// A thing in a level.
#[derive(Clone, Debug, Default)]
pub struct Node {
    /// Its name in the file.
    pub name: String,
    /// Where it is; the scale is 1.
    pub transform: Transform,
    /// What it looks like: one surface per material, none for a thing that cannot be seen.
    pub surfaces: Vec<Surface>,
    /// Its physics.
    pub extras: NodeExtras,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Corner positions, metres, in the node's axes.
    pub positions: Vec<[f32; 3]>,
    /// Normals, one per corner.
    pub normals: Vec<[f32; 3]>,
    /// Linear RGBA, one per corner, multiplied with the material's; empty when there is none.
    pub colors: Vec<[f32; 4]>,
    /// Three corners per triangle, counter-clockwise seen from outside.
    pub indices: Vec<u32>,
    /// Place in [`Course::materials`].
    pub material: Option<usize>,
}

/// What a surface is painted with.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Its name in the file.
    pub name: String,
    /// Linear RGBA.
    pub base_color: [f32; 4],
    /// 0 is a mirror, 1 is matt.
    pub roughness: f32,
    /// 0 is not metal, 1 is.
    pub metallic: f32,
    /// Linear RGB of its own light.
    pub emissive: [f32; 3],
    /// Whether what is behind shows through.
    pub blend: bool,
}

impl Course {
    /// Reads a `.glb` file.
    ///
    /// # Errors
    /// When the file cannot be read, is no glTF 2.0, or says something about physics that is not
    /// understood; the error names the node.
    pub fn load(path: impl AsRef<Path>) -> Result<Self, CourseError> {
        load::load(path.as_ref())
    }

    /// Reads a `.glb` file that is in memory.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn from_slice(bytes: &[u8]) -> Result<Self, CourseError> {
        load::from_slice(bytes)
    }

    /// Where the walking course of this project is: `assets/course.glb` in the working directory, beside
    /// the executable, or in the source tree it was built from, whichever exists first.
    pub fn default_path() -> PathBuf {
        Self::path("course.glb")
    }

    /// Where the proving ground is that the driving stations are on; looked for as the course is.
    pub fn proving_ground_path() -> PathBuf {
        Self::path("proving_ground.glb")
    }

    /// Where the looks of the vehicles are; looked for as the course is.
    pub fn vehicles_path() -> PathBuf {
        Self::path("vehicles.glb")
    }

    /// Adds all of another level to this one.
    pub fn add(&mut self, other: Self) {
        let first = self.materials.len();
        self.materials.extend(other.materials);
        self.nodes.extend(other.nodes.into_iter().map(|mut node| {
            for surface in &mut node.surfaces {
                surface.material = surface.material.map(|material| material + first);
            }
            node
        }));
    }

    fn path(name: &str) -> PathBuf {
        let file = Path::new("assets").join(name);
        let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(&file);
        let beside = std::env::current_exe()
            .ok()
            .and_then(|exe| exe.parent().map(|folder| folder.join(&file)));
        [Some(file), beside]
            .into_iter()
            .flatten()
            .find(|path| path.is_file())
            .unwrap_or(built_from)
    }

    /// The node of this name and its place in [`nodes`](Self::nodes).
    pub fn node(&self, name: &str) -> Option<(usize, &Node)> {
        self.nodes
            .iter()
            .enumerate()
            .find(|(_, node)| node.name == name)
    }

    /// Where the walker of this station starts: foot, facing `-Z`.
    pub fn start(&self, station: &str) -> Option<Transform> {
        self.nodes
            .iter()
            .find(|node| node.extras.station.as_deref() == Some(station))
            .map(|node| node.transform)
    }
}

/// Moves the platforms of a spawned course and gives its planets their gravity.
///
/// Both happen in `FixedUpdate`, so they stop and slow down with the fixed clock.
#[derive(Clone, Copy, Debug, Default)]
pub struct CoursePlugin;

impl Plugin for CoursePlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((CourseMotionPlugin, planet::PlanetPlugin));
    }
}

pub use motion::CourseMotionPlugin;
