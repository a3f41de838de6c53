//! Collecting the pieces from the physics world.

use bevy::prelude::*;
use bevy_rapier3d::rapier::{geometry::SharedShape, math::Pose};

use super::{Area, Mover, MoverPose, Neighbourhood, Piece, break_down};

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
}

impl Neighbourhood {
    /// Adds the pieces of a collider's shape that the request asks for. `slack` is how much farther
    /// to look, because the obstacle itself moves, metres.
    pub fn add_shape(
        &mut self,
        request: &Request,
        obstacle: u32,
        shape: &SharedShape,
        position: &Pose,
        slack: f32,
    ) {
        let area = Area {
            origin: request.origin,
            boxes: &[(request.low, request.high)],
            grow: slack,
        };
        let skin = self.obstacles[obstacle as usize].skin;
        break_down(&area, shape, position, &mut |geometry, part| {
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
        });
    }
}
