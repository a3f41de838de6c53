//! Follows a vehicle from behind, or looks over its bonnet.

use bevy::{math::ops, prelude::*, time::Real};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use super::{CameraMode, CameraRig, arm::reach};
use crate::shell::Player;

/// How fast the camera swings behind the vehicle, and tilts with it, per second.
const SWING: f32 = 3.5;
const TILT: f32 = 4.0;
/// How long after the mouse moved it stays where it was turned, seconds.
const PATIENCE: f32 = 1.5;

/// On a vehicle: from where it is looked at.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct Seat {
    /// The point that the camera looks at from behind, in the vehicle's axes.
    pub target: Vec3,
    /// Eyes of the driver, in the vehicle's axes.
    pub eyes: Vec3,
    /// Length of the arm, metres, at a zoom of 1.
    pub distance: f32,
}

/// Places the camera.
pub(super) fn chase(
    time: Res<Time<Real>>,
    physics: ReadRapierContext,
    mut cameras: Query<(&mut CameraRig, &mut Transform), Without<Player>>,
    players: Query<(Entity, &Transform, &Seat, &VehicleTelemetry), With<Player>>,
) {
    let Ok((vehicle, pose, seat, telemetry)) = players.single() else {
        return;
    };
    let seconds = time.delta_secs();
    for (mut rig, mut camera) in &mut cameras {
        if rig.mode == CameraMode::Fixed {
            continue;
        }
        let first = rig.eye == 0.0;
        let blend = |rate: f32| {
            if first {
                1.0
            } else {
                1.0 - ops::exp(-rate * seconds)
            }
        };
        // On the ground up is the vehicle's, so loops and banks are followed; in the air the world's.
        let up = if telemetry.grounded > 1 {
            pose.rotation * Vec3::Y
        } else {
            Vec3::Y
        };
        let own = rig.base * Vec3::Y;
        let tilt = Quat::IDENTITY.slerp(Quat::from_rotation_arc(own, up), blend(TILT));
        rig.base = (tilt * rig.base).normalize();
        rig.idle += seconds;
        let ahead = rig.base.inverse() * (pose.rotation * Vec3::NEG_Z);
        let heading = ops::atan2(-ahead.x, -ahead.z);
        if rig.idle > PATIENCE {
            let off = (heading - rig.yaw + core::f32::consts::PI)
                .rem_euclid(core::f32::consts::TAU)
                - core::f32::consts::PI;
            rig.yaw += off * blend(SWING);
        }
        rig.eye = 1.0;
        if rig.mode == CameraMode::FirstPerson {
            // The head turns against the car.
            let turned = if rig.idle > PATIENCE {
                0.0
            } else {
                rig.yaw - heading
            };
            camera.rotation = pose.rotation * Quat::from_rotation_y(turned);
            camera.translation = pose.transform_point(seat.eyes);
            continue;
        }
        let rotation = rig.rotation();
        let target = pose.transform_point(seat.target);
        let back = rotation * Vec3::Z;
        let length = seat.distance * rig.distance / CameraRig::DISTANCE;
        reach(&mut rig, &physics, vehicle, target, back, length, seconds);
        camera.rotation = rotation;
        camera.translation = target + back * rig.arm;
    }
}
