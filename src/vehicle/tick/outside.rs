//! Forces from outside, before the solve: air, and the rider's balance.

use bevy::{math::ops, prelude::*};

use super::{Axes, Found, Surroundings};
use crate::{
    backend::rigid::Rigid,
    vehicle::{config::Vehicle, intent::VehicleIntent},
};

/// Air and control, about the centre of mass, world axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Outside {
    pub force: Vec3,
    pub torque: Vec3,
    pub drag: f32,
}

pub(super) fn outside_forces(
    s: &Surroundings,
    config: &Vehicle,
    rigid: &Rigid,
    axes: &Axes,
    asked: &VehicleIntent,
    speed: f32,
    grounded: usize,
    height: f32,
) -> Outside {
    let mut out = Outside::default();
    if let Some(aero) = &config.aero {
        let air = aero.forces(rigid.velocity, axes.forward, rigid.mass, s.dt);
        out.force += air.drag;
        out.drag = air.drag.length();
        let (mut front, mut rear) = (0.0f32, 0.0f32);
        for wheel in &s.wheels {
            front = front.min(wheel.attachment.z);
            rear = rear.max(wheel.attachment.z);
        }
        for (z, down) in [(front, air.down.x), (rear, air.down.y)] {
            let force = axes.up * -down;
            let at = rigid.position + rigid.rotation * (Vec3::Z * z) - rigid.center;
            out.force += force;
            out.torque += at.cross(force);
        }
        if grounded == 0 {
            let c = aero.air_control * asked.air;
            out.torque += axes.right * c.x - axes.up * c.y + axes.forward * c.z;
        }
    }
    if let Some(lean) = s.assists.lean
        && grounded > 0
    {
        // The lean at which gravity and centrifugal force balance.
        let turning = -rigid.spin.dot(axes.up) * speed;
        let gravity = s.view.gravity * rigid.gravity_scale;
        let g = gravity.length().max(0.1);
        let wanted = ops::atan(turning / g).clamp(-lean.max_lean, lean.max_lean);
        let up = -gravity.normalize_or(Vec3::NEG_Y);
        let level = axes.forward.cross(up).normalize_or(axes.right);
        let now = ops::atan2(-axes.right.dot(up), axes.right.dot(level));
        let rate = rigid.spin.dot(axes.forward);
        // About the contact line, not the centre: the wheels hold the foot.
        let turned = rigid.inverse_inertia * axes.forward;
        let inertia = 1.0 / turned.dot(axes.forward).max(1.0e-9) + rigid.mass * height * height;
        let w = core::f32::consts::TAU * lean.frequency;
        let (k, c) = (w * w, 2.0 * lean.damping * w);
        // Implicit in the lean's own motion.
        let soft = 1.0 + s.dt * (c + s.dt * k);
        let torque = inertia * (k * (wanted - now - s.dt * rate) - c * rate) / soft;
        // What falls over by gravity is held as well.
        let held =
            rigid.mass * g * height * ops::sin(now) - rigid.mass * height * turning * ops::cos(now);
        out.torque += axes.forward * (torque - held);
    }
    out
}

/// Height of the centre of mass above the contacts, metres.
pub(super) fn height(rigid: &Rigid, up: Vec3, found: &[Found]) -> f32 {
    let touched = found.iter().filter_map(|f| f.contact);
    let (sum, count) = touched.fold((0.0, 0.0f32), |(sum, count), touch| {
        (sum + (rigid.center - touch.point).dot(up), count + 1.0)
    });
    sum / count.max(1.0)
}
