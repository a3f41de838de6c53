//! How bodies move in the tick that is about to run.

use bevy::prelude::*;
use bevy_rapier3d::rapier::{
    dynamics::{RigidBody, RigidBodyType},
    math::{AngularInertia, Pose},
};

use super::neighbourhood::{Dynamics, Motion, Obstacle, ObstacleKind};

/// A rigid pose in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorldPose {
    pub position: Vec3,
    pub rotation: Quat,
}

impl From<&Pose> for WorldPose {
    fn from(pose: &Pose) -> Self {
        Self {
            position: pose.translation,
            rotation: pose.rotation,
        }
    }
}

/// The pose of a body at the end of the tick, or `None` when it does not move.
pub(super) fn end_of_tick(body: &RigidBody, dt: f32) -> Option<Pose> {
    let end = match body.body_type() {
        RigidBodyType::Fixed => return None,
        RigidBodyType::KinematicPositionBased => *body.next_position(),
        RigidBodyType::KinematicVelocityBased => body.predict_position_using_velocity(dt),
        RigidBodyType::Dynamic => {
            if body.is_sleeping() {
                return None;
            }
            body.predict_position_using_velocity(dt)
        }
    };
    (end != *body.position()).then_some(end)
}

/// A symmetric matrix in full.
pub(super) fn symmetric(m: &AngularInertia) -> Mat3 {
    Mat3::from_cols(
        Vec3::new(m.m11, m.m12, m.m13),
        Vec3::new(m.m12, m.m22, m.m23),
        Vec3::new(m.m13, m.m23, m.m33),
    )
}

/// Fills in how a body moves this tick.
pub(super) fn describe_motion(obstacle: &mut Obstacle, body: &RigidBody, origin: Vec3, dt: f32) {
    match body.body_type() {
        RigidBodyType::Fixed => {}
        RigidBodyType::Dynamic => {
            obstacle.kind = ObstacleKind::Dynamic;
            let properties = body.mass_properties();
            let center = body.center_of_mass() - origin;
            let dynamics = Dynamics {
                linear_velocity: body.linvel(),
                angular_velocity: body.angvel(),
                center,
                inverse_mass: properties.effective_inv_mass,
                inverse_inertia: symmetric(&properties.effective_world_inv_inertia),
            };
            if !body.is_sleeping() {
                obstacle.motion = Motion {
                    pivot: center,
                    linear: dynamics.linear_velocity * dt,
                    turn: dynamics.angular_velocity * dt,
                };
            }
            obstacle.dynamics = Some(dynamics);
        }
        RigidBodyType::KinematicPositionBased | RigidBodyType::KinematicVelocityBased => {
            if let Some(end) = end_of_tick(body, dt) {
                let start = body.position();
                obstacle.kind = ObstacleKind::Kinematic;
                // Of the two quaternions of a turn the one by less than half a circle.
                let turn = end.rotation * start.rotation.inverse();
                let turn = if turn.w < 0.0 { -turn } else { turn };
                obstacle.motion = Motion {
                    pivot: start.translation - origin,
                    linear: end.translation - start.translation,
                    turn: if end.rotation == start.rotation {
                        Vec3::ZERO
                    } else {
                        turn.to_scaled_axis()
                    },
                };
            }
        }
    }
}
