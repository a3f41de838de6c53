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

/// How far around a box is searched for what comes from the side, metres.
const AROUND: f32 = 0.15;

/// A triangle's corners in the axes of its mesh, and its number there.
pub(crate) type Part = ([Vec3; 3], u32);

/// What of so many meshes is near one asker. Where a mesh has more than so many triangles near, every
/// look searches.
pub(crate) struct MeshMemory<const MESHES: usize, const TRIANGLES: usize>([Near; MESHES]);

impl<const MESHES: usize, const TRIANGLES: usize> Default for MeshMemory<MESHES, TRIANGLES> {
    fn default() -> Self {
        Self(core::array::from_fn(|_| Near::default()))
    }
}

/// A place for what of one mesh is near.
#[derive(Default)]
struct Near {
    /// Whose it is. The shape is kept alive: nothing else can be at its address, and who changes it
    /// changes a copy.
    of: Option<(ColliderHandle, SharedShape)>,
    /// Where the triangles were searched for, in the axes of the mesh.
    searched: Nodes,
    triangles: Vec<Part>,
    /// Whether there were too many.
    dense: bool,
    /// Whether the mesh was near in this tick.
    used: bool,
}

impl<const MESHES: usize, const TRIANGLES: usize> MeshMemory<MESHES, TRIANGLES> {
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
        take: &mut impl FnMut(Part),
    ) {
        let nodes = area.nodes(position);
        let mut place = self.place(collider, shape);
        if let Some(near) = &mut place
            && !near.searched.hold(&nodes)
        {
            let way = position.rotation.inverse() * way;
            near.search(&nodes, way, mesh, TRIANGLES);
        }
        let Some(near) = place.filter(|near| !near.dense) else {
            for index in mesh.bvh().leaves(|node| nodes.meet(node)) {
                let t = mesh.triangle(index);
                take(([t.a, t.b, t.c], index));
            }
            return;
        };
        for t in &near.triangles {
            let ([a, b, c], _) = t;
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
            near.triangles.reserve(TRIANGLES);
        }
        Some(near)
    }
}

impl Near {
    fn search(&mut self, nodes: &Nodes, way: Vec3, mesh: &TriMesh, most: usize) {
        self.searched = nodes.ahead(way, AROUND);
        self.triangles.clear();
        self.dense = false;
        let searched = &self.searched;
        for index in mesh.bvh().leaves(|node| searched.meet(node)) {
            if self.triangles.len() == most {
                self.triangles.clear();
                self.dense = true;
                return;
            }
            let t = mesh.triangle(index);
            self.triangles.push(([t.a, t.b, t.c], index));
        }
    }
}
