//! Collecting the pieces from the physics world.

use bevy::prelude::*;
use bevy_rapier3d::rapier::geometry::{Collider, ColliderHandle};

use super::{Area, Geometry, Mover, MoverMemory, MoverPose, Neighbourhood, Piece, break_down};

/// What to collect.
pub(crate) struct Request<'a> {
    pub mover: &'a Mover,
    /// Where the mover starts, relative to the origin.
    pub pose: MoverPose,
    /// World position of the origin.
    pub origin: Vec3,
    /// Lower corner of the box to look in, relative to the origin.
    pub low: Vec3,
    /// Upper corner of the box to look in, relative to the origin.
    pub high: Vec3,
    /// Pieces farther than this from the mover's start are left out, metres.
    pub reach: f32,
    /// Points, relative to the origin, to find the sensors that hold them: the mover's middle and foot.
    pub middle: Vec3,
    pub foot: Vec3,
    /// How far the box will move in the next ticks, metres.
    pub way: Vec3,
}

impl Neighbourhood {
    /// Adds the pieces of a collider's shape that the request asks for. `slack` is how much farther
    /// to look, because the obstacle itself moves, metres.
    pub fn add_shape(
        &mut self,
        request: &Request,
        memory: &mut MoverMemory,
        obstacle: u32,
        (handle, collider): (ColliderHandle, &Collider),
        slack: f32,
    ) {
        let area = Area {
            origin: request.origin,
            boxes: &[(request.low, request.high)],
            grow: slack,
        };
        let skin = self.obstacles[obstacle as usize].skin;
        let (shape, position) = (collider.shared_shape(), collider.position());
        let mut take = |geometry: Geometry, part| {
            self.queries += 1;
            let found = request.mover.separation(&geometry, &request.pose);
            let clearance = found.distance - skin;
            // Also drops what is not finite.
            if clearance < request.reach + slack {
                self.pieces.push(Piece {
                    geometry,
                    obstacle,
                    part,
                    clearance,
                    normal: found.normal,
                    point: found.point,
                });
            }
        };
        match shape.as_trimesh() {
            Some(mesh) => {
                let take = &mut |t, part| take(Geometry::Triangle(t), part);
                area.recall(memory, request.way, handle, shape, mesh, position, take);
            }
            None => break_down(&area, shape, position, &mut take),
        }
    }
}
