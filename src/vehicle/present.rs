//! Where wheels are seen: travel, steering and spin, between the last two ticks.

use bevy::prelude::*;

use super::{
    config::Vehicle,
    report::VehicleReport,
    state::VehicleState,
    wheel::{Wheel, WheelOf, Wheels},
};

/// How a wheel stood after the last two ticks.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(crate) struct WheelPose {
    before: Stand,
    now: Stand,
}

#[derive(Clone, Copy, Debug, Default)]
struct Stand {
    compression: f32,
    steer: f32,
    spin_angle: f32,
}

/// Keeps the last two ticks of every wheel.
pub(super) fn remember(
    vehicles: Query<(&VehicleState, &VehicleReport, &Wheels)>,
    mut poses: Query<&mut WheelPose>,
) {
    for (state, report, tied) in &vehicles {
        if !report.solved && !report.asleep {
            continue;
        }
        for (i, wheel) in tied.iter().enumerate() {
            let (Some(dynamics), Some(out)) = (state.wheels.get(i), report.outputs.get(i)) else {
                continue;
            };
            if let Ok(mut pose) = poses.get_mut(wheel) {
                let pose = pose.bypass_change_detection();
                pose.before = pose.now;
                pose.now = Stand {
                    compression: dynamics.compression,
                    steer: out.steer_angle,
                    spin_angle: dynamics.angle,
                };
            }
        }
    }
}

/// Puts every wheel where it is seen.
pub(super) fn show(
    clock: Res<Time<Fixed>>,
    vehicles: Query<&Transform, (With<Vehicle>, Without<Wheel>)>,
    mut wheels: Query<(
        &Wheel,
        &WheelOf,
        &WheelPose,
        Option<&ChildOf>,
        &mut Transform,
    )>,
) {
    let part = clock.overstep_fraction();
    for (wheel, of, pose, parent, mut transform) in &mut wheels {
        let (before, now) = (&pose.before, &pose.now);
        let lerp = |a: f32, b: f32| a + (b - a) * part;
        // The short way round.
        let turn = core::f32::consts::TAU;
        let turned =
            (now.spin_angle - before.spin_angle + 1.5 * turn).rem_euclid(turn) - 0.5 * turn;
        let down = wheel.direction.normalize_or(Vec3::NEG_Y);
        let out = wheel.suspension.travel - lerp(before.compression, now.compression);
        let lean = if wheel.attachment.x < 0.0 {
            -wheel.camber
        } else {
            wheel.camber
        };
        let local = Transform {
            translation: wheel.attachment + down * out,
            // Rolling forward turns about the left.
            rotation: Quat::from_axis_angle(down, lerp(before.steer, now.steer))
                * Quat::from_rotation_z(lean)
                * Quat::from_rotation_x(-(before.spin_angle + turned * part)),
            scale: transform.scale,
        };
        let placed = match parent {
            Some(child) if child.parent() == of.0 => local,
            Some(_) => continue,
            None => match vehicles.get(of.0) {
                Ok(vehicle) => {
                    let mut placed = *vehicle * local;
                    placed.scale = transform.scale;
                    placed
                }
                Err(_) => continue,
            },
        };
        if placed.is_finite() {
            transform.set_if_neq(placed);
        }
    }
}
