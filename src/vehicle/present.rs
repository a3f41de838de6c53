//! Where wheels are seen: travel, steering and spin, between the last two ticks.

use bevy::{prelude::*, transform::helper::TransformHelper};

use super::{
    config::Vehicle,
    report::VehicleReport,
    state::VehicleState,
    wheel::{Wheel, WheelOf},
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
    vehicles: Query<(&VehicleState, &VehicleReport)>,
    mut poses: Query<&mut WheelPose>,
) {
    for (state, report) in &vehicles {
        if !report.solved && !report.asleep {
            continue;
        }
        for (i, &wheel) in report.wheels.iter().enumerate() {
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

/// A wheel that does not hang right under its vehicle.
pub(super) struct Elsewhere {
    wheel: Entity,
    vehicle: Entity,
    parent: Option<Entity>,
    local: Transform,
}

/// Puts every wheel where it is seen.
pub(super) fn show(
    clock: Res<Time<Fixed>>,
    vehicles: Query<&GlobalTransform, With<Vehicle>>,
    mut transforms: ParamSet<(
        Query<(
            Entity,
            &Wheel,
            &WheelOf,
            &WheelPose,
            Option<&ChildOf>,
            &mut Transform,
        )>,
        TransformHelper,
        Query<&mut Transform>,
    )>,
    mut elsewhere: Local<Vec<Elsewhere>>,
) {
    elsewhere.clear();
    let part = clock.overstep_fraction();
    for (entity, wheel, of, pose, parent, mut transform) in &mut transforms.p0() {
        let Ok(vehicle) = vehicles.get(of.0) else {
            continue;
        };
        let mut local = place(wheel, pose, part);
        local.scale = transform.scale;
        let parent = parent.map(ChildOf::parent);
        if parent != Some(of.0) {
            elsewhere.push(Elsewhere {
                wheel: entity,
                vehicle: of.0,
                parent,
                local,
            });
            continue;
        }
        // Metres are metres, also under a vehicle whose model is scaled.
        local.translation /= vehicle.scale();
        if local.is_finite() {
            transform.set_if_neq(local);
        }
    }
    // Down from the root, as the parents' places in the world are not known yet in this frame.
    let helper = transforms.p1();
    let global = |entity| helper.compute_global_transform(entity).ok();
    elsewhere.retain_mut(|at| {
        let vehicle = global(at.vehicle).map(|v| v.compute_transform().with_scale(Vec3::ONE));
        let parent = at.parent.map_or(Some(GlobalTransform::IDENTITY), global);
        let Some((vehicle, parent)) = vehicle.zip(parent) else {
            return false;
        };
        let scale = at.local.scale;
        let world = vehicle * at.local.with_scale(Vec3::ONE);
        at.local = GlobalTransform::from(world)
            .reparented_to(&parent)
            .with_scale(scale);
        at.local.is_finite()
    });
    let mut all = transforms.p2();
    for at in elsewhere.drain(..) {
        if let Ok(mut transform) = all.get_mut(at.wheel) {
            transform.set_if_neq(at.local);
        }
    }
}

/// Where a wheel is in its vehicle's axes, this part of the way between the last two ticks.
fn place(wheel: &Wheel, pose: &WheelPose, part: f32) -> Transform {
    let (before, now) = (&pose.before, &pose.now);
    let lerp = |a: f32, b: f32| a + (b - a) * part;
    // The short way round.
    let turn = core::f32::consts::TAU;
    let turned = (now.spin_angle - before.spin_angle + 1.5 * turn).rem_euclid(turn) - 0.5 * turn;
    let down = wheel.direction.normalize_or(Vec3::NEG_Y);
    let out = wheel.suspension.travel - lerp(before.compression, now.compression);
    let lean = if wheel.attachment.x < 0.0 {
        -wheel.camber
    } else {
        wheel.camber
    };
    Transform {
        translation: wheel.attachment + down * out,
        // Rolling forward turns about the left.
        rotation: Quat::from_axis_angle(down, lerp(before.steer, now.steer))
            * Quat::from_rotation_z(lean)
            * Quat::from_rotation_x(-(before.spin_angle + turned * part)),
        scale: Vec3::ONE,
    }
}
