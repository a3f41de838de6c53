//! Triangles of meshes that were near in the last ticks.
//!
//! A search in a large mesh waits for memory at nearly every node. What moves little in a tick finds
//! mostly the same triangles, so they are searched for in boxes that reach some ticks ahead, and kept,
//! corners included, until a box leaves its own. What is handed out is what a search would find.
//!
//! Each collider has a place of its own, though many share one shape. Places are used again with their
//! buffers, so that a way over the seams of a tiled terrain allocates only at the first of them.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    geometry::{ColliderHandle, SharedShape, TriMesh},
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
pub(crate) struct MeshMemory([Near; MOST_MESHES]);

/// A place for what of one mesh is near.
#[derive(Default)]
struct Near {
    /// Whose it is. The shape is kept alive: nothing else can be at its address, and who changes it
    /// changes a copy.
    of: Option<(ColliderHandle, SharedShape)>,
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
        for near in &mut self.0 {
            if !near.used {
                near.of = None;
            }
            near.used = false;
        }
    }

    /// Hands every triangle of a collider's mesh that may be in the area to `take`, in the axes of the
    /// mesh. `way` is how far, in the world, boxes will move before the next search, metres.
    pub fn triangles(
        &mut self,
        area: &Area,
        way: Vec3,
        collider: ColliderHandle,
        shape: &SharedShape,
        mesh: &TriMesh,
        position: &Pose,
        take: &mut impl FnMut([Vec3; 3]),
    ) {
        let nodes = area.nodes(position);
        let place = self.place(collider, shape).map(|near| {
            if !near.searched.hold(&nodes) {
                near.search(&nodes, position.rotation.inverse() * way, mesh);
            }
            near
        });
        let Some(near) = place.filter(|near| !near.dense) else {
            for index in mesh.bvh().leaves(|node| nodes.meet(node)) {
                let t = mesh.triangle(index);
                take([t.a, t.b, t.c]);
            }
            return;
        };
        for t in &near.triangles {
            let [a, b, c] = t;
            if nodes.meet_block(&Block::new(a.min(*b).min(*c), a.max(*b).max(*c))) {
                take(*t);
            }
        }
    }

    /// The place of a collider, or a free one that becomes its; `None` while all are others'.
    fn place(&mut self, collider: ColliderHandle, shape: &SharedShape) -> Option<&mut Near> {
        let whose = |near: &Near| near.of.as_ref().map(|(handle, _)| *handle);
        let own = self.0.iter().position(|n| whose(n) == Some(collider));
        let at = own.or_else(|| self.0.iter().position(|near| near.of.is_none()))?;
        let near = &mut self.0[at];
        near.used = true;
        let same = |(_, old): &(_, SharedShape)| Arc::ptr_eq(&old.0, &shape.0);
        if !near.of.as_ref().is_some_and(same) {
            near.of = Some((collider, shape.clone()));
            near.searched = Nodes::default();
            near.triangles.clear();
            near.triangles.reserve(MOST_TRIANGLES);
        }
        Some(near)
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
