//! Triangles of meshes that were near in the last ticks.
//!
//! A search in a large mesh waits for memory at nearly every node. What moves little in a tick finds
//! mostly the same triangles, so they are searched for in boxes that reach some ticks ahead, and kept,
//! corners included, until a box leaves its own. What is handed out is what a search would find.

use std::sync::Arc;

use arrayvec::ArrayVec;
use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::{SharedShape, TriMesh},
    math::Pose,
};

use super::{
    Area,
    break_down::{Block, Nodes},
};

/// Meshes that are remembered at once.
const MOST_MESHES: usize = 4;
/// Triangles of a mesh that are remembered; where there are more, each tick searches.
const MOST_TRIANGLES: usize = 192;
/// How far around a box is searched for what comes from the side, metres.
const AROUND: f32 = 0.15;

/// What of meshes is near one vehicle.
#[derive(Default)]
pub(crate) struct MeshMemory(ArrayVec<Near, MOST_MESHES>);

/// What of one mesh is near.
struct Near {
    /// Kept alive: nothing else can be at its address, and who changes it changes a copy.
    shape: SharedShape,
    /// Where the triangles were searched for, in the axes of the mesh.
    searched: Nodes,
    triangles: Vec<[Vec3; 3]>,
    /// Whether there were too many.
    dense: bool,
    /// Whether the mesh was near in this tick.
    used: bool,
}

impl MeshMemory {
    /// Begins a tick: forgets what was not near in the last one.
    pub fn begin(&mut self) {
        if self.0.iter().any(|near| !near.used) {
            self.0.retain(|near| near.used);
        }
        for near in &mut self.0 {
            near.used = false;
        }
    }

    /// Hands every triangle of a mesh that may be in the area to `take`, in the axes of the mesh. `way` is
    /// how far, in the world, boxes will move before the next search, metres.
    pub fn triangles(
        &mut self,
        area: &Area,
        way: Vec3,
        shape: &SharedShape,
        mesh: &TriMesh,
        position: &Pose,
        take: &mut impl FnMut([Vec3; 3]),
    ) {
        let nodes = area.nodes(position);
        let own = |near: &Near| Arc::ptr_eq(&near.shape.0, &shape.0);
        let at = self.0.iter().position(own);
        let Some(at) = at.or_else(|| self.add(shape)) else {
            for index in mesh.bvh().leaves(|node| nodes.meet(node)) {
                let t = mesh.triangle(index);
                take([t.a, t.b, t.c]);
            }
            return;
        };
        let near = &mut self.0[at];
        near.used = true;
        if !near.searched.hold(&nodes) {
            near.search(&nodes, position.rotation.inverse() * way, mesh);
        }
        if near.dense {
            for index in mesh.bvh().leaves(|node| nodes.meet(node)) {
                let t = mesh.triangle(index);
                take([t.a, t.b, t.c]);
            }
            return;
        }
        for t in &near.triangles {
            let [a, b, c] = t;
            if nodes.meet_block(&Block::new(a.min(*b).min(*c), a.max(*b).max(*c))) {
                take(*t);
            }
        }
    }

    fn add(&mut self, shape: &SharedShape) -> Option<usize> {
        let near = Near {
            shape: shape.clone(),
            searched: Nodes::default(),
            triangles: Vec::with_capacity(MOST_TRIANGLES),
            dense: false,
            used: true,
        };
        self.0.try_push(near).ok()?;
        Some(self.0.len() - 1)
    }
}

impl Near {
    fn search(&mut self, nodes: &Nodes, way: Vec3, mesh: &TriMesh) {
        self.searched = nodes.ahead(way, AROUND);
        self.triangles.clear();
        self.dense = false;
        let searched = &self.searched;
        for index in mesh.bvh().leaves(|node| searched.meet(node)) {
            if self.triangles.len() == MOST_TRIANGLES {
                self.triangles.clear();
                self.dense = true;
                return;
            }
            let t = mesh.triangle(index);
            self.triangles.push([t.a, t.b, t.c]);
        }
    }
}
