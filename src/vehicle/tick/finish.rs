//! Forces, state and telemetry after the solve.

use bevy::{math::ops, prelude::*};

use super::{
    Axes, Found, Surroundings, brakes::BrakeTorques, driveline::Driveline, outside::Outside,
};
use crate::{
    backend::rigid::Rigid,
    vehicle::{
        drivetrain::from_rpm,
        output::{VehicleTelemetry, WheelContact, WheelState},
        report::{GroundPush, VehicleReport, WheelEvent},
        solve::{Chassis, Contact, GroundBody, Spin},
        state::VehicleState,
    },
};

/// Everything that the solve and its preparation left.
pub(super) struct Solved<'a, 'c> {
    pub rigid: &'a Rigid,
    pub axes: &'a Axes,
    pub found: &'a [Found],
    pub chassis: &'a Chassis,
    pub grounds: &'a [GroundBody],
    pub contacts: &'a [Contact<'c>],
    pub spin: &'a Spin,
    pub line: &'a Driveline,
    pub outside: &'a Outside,
    pub brakes: &'a BrakeTorques,
}

pub(super) fn finish(
    s: &Surroundings,
    state: &mut VehicleState,
    telemetry: &mut VehicleTelemetry,
    report: &mut VehicleReport,
    solved: Solved,
) {
    let dt = s.dt;
    let (rigid, axes) = (solved.rigid, solved.axes);
    let mut force = Vec3::ZERO;
    let mut torque = Vec3::ZERO;
    let mut torques = [0.0; super::MOST_WHEELS];
    report.outputs.clear();
    report
        .outputs
        .extend(s.wheels.iter().map(|_| WheelState::default()));
    for (i, found) in solved.found.iter().enumerate() {
        let wheel = s.wheels[i];
        let start = state.wheels[i].spin;
        let spin = finite(solved.spin.w[i] as f32);
        // A wheel that is spun up turns the body the other way.
        torques[i] = wheel.inertia * (spin - start) / dt;
        torque += found.axle * torques[i];
        let last = &mut state.wheels[i];
        last.spin = spin;
        last.angle = (last.angle + spin * dt).rem_euclid(core::f32::consts::TAU);
        let limit = wheel.suspension.travel;
        let compression = found.compression.clamp(0.0, limit);
        last.compression_rate = (compression - last.compression) / dt;
        last.compression = compression;
        let out = &mut report.outputs[i];
        out.compression = compression;
        out.spin = spin;
        out.steer_angle = found.angle;
        out.abs = solved.brakes.abs[i];
        out.brake_torque =
            solved.line.brakes[i].map_or(0.0, |row| (solved.spin.impulse(row) as f32 / dt).abs());
    }
    let clutch = solved
        .line
        .clutch
        .map_or(0.0, |row| solved.spin.impulse(row) as f32 / dt);
    state.clutch_torque = finite(clutch);
    let mut landed = [false; super::MOST_WHEELS];
    let (mut road, mut road_weight) = (Vec3::ZERO, 0.0f32);
    for contact in solved.contacts {
        let i = contact.wheel;
        let wheel = s.wheels[i];
        let impulse = contact.normal * contact.push
            + contact.along * contact.grip.x
            + contact.across * contact.grip.y;
        let pushed = impulse / dt;
        if contact.push <= 0.0 || !pushed.is_finite() {
            continue;
        }
        landed[i] = true;
        force += pushed;
        torque += contact.arm.cross(pushed);
        let last = &mut state.wheels[i];
        let Some(touch) = solved.found[i].contact else {
            continue;
        };
        if let Some(body) = report.ground_bodies[i] {
            let changed = (pushed + last.ground_force).length() > 0.01 * pushed.length()
                || last.ground != Some(touch.entity);
            report.pushes.push(GroundPush {
                body,
                force: -pushed,
                point: rigid.center + contact.arm,
                wake: changed,
            });
        }
        last.slip = contact.combined;
        last.ground_force = -pushed;
        last.ground_speed = report.ground_speeds[i];
        let load = contact.push / dt;
        // What gives way under the vehicle is less of a ground to it.
        let body = contact.ground.map(|(index, _)| &solved.grounds[index]);
        let weight = load * body.map_or(1.0, |g| g.mass / (g.mass + rigid.mass));
        road += report.ground_velocities[i] * weight;
        road_weight += weight;
        let grip = contact.grip / dt;
        let velocity = contact.velocity(solved.chassis, solved.grounds);
        let flat = Vec2::new(velocity.dot(contact.along), velocity.dot(contact.across));
        let drift = contact.ground_drift;
        last.expected = flat + Vec2::new(drift.dot(contact.along), drift.dot(contact.across));
        let out = &mut report.outputs[i];
        if let Some(patch) = &contact.patch {
            last.bristle = grip / patch.carcass;
            out.limit = patch.limit;
            let speed = contact.speed.max(1.0e-3);
            let sliding = patch.slide(contact.combined, contact.speed);
            let fast = contact.combined > 0.5;
            let slipping = fast && (sliding > 1.3 || (last.slipping && sliding > 0.9));
            if slipping != last.slipping {
                report.events.push((
                    i,
                    if slipping {
                        WheelEvent::SlipStarted(contact.combined)
                    } else {
                        WheelEvent::SlipEnded
                    },
                ));
                last.slipping = slipping;
            }
            if speed > 0.05 {
                let rim = last.spin * wheel.radius;
                out.slip_ratio = (rim - flat.x) / rim.abs().max(flat.x.abs()).max(1.0e-3);
                out.slip_angle = ops::atan2(-flat.y, flat.x.abs().max(1.0e-3));
            }
        }
        let closing = -contact.start_velocity(solved.chassis).dot(contact.normal);
        if last.ground.is_none() {
            report.events.push((
                i,
                WheelEvent::Landed(touch.entity, closing.max(0.0), last.air_time),
            ));
        }
        last.ground = Some(touch.entity);
        last.air_time = 0.0;
        out.load = load;
        out.force = grip;
        out.suspension_force = load * contact.cosine;
        out.contact = Some(WheelContact {
            entity: touch.entity,
            point: rigid.center + contact.arm,
            normal: contact.normal,
            forward: contact.along,
            velocity: report.ground_velocities[i],
            friction: contact.surface,
        });
        let bottomed = contact.compression >= wheel.suspension.travel;
        if bottomed && !last.bottomed {
            let event = WheelEvent::BottomedOut(out.suspension_force);
            report.events.push((i, event));
        }
        last.bottomed = bottomed;
    }
    for (i, last) in state.wheels.iter_mut().enumerate() {
        if !landed[i] {
            if last.ground.take().is_some() {
                report.events.push((i, WheelEvent::LeftGround));
            }
            last.air_time += dt;
            last.bristle = Vec2::ZERO;
            last.slip = 0.0;
            last.ground_force = Vec3::ZERO;
            last.ground_speed = Vec3::ZERO;
            last.bottomed = false;
            if last.slipping {
                last.slipping = false;
                report.events.push((i, WheelEvent::SlipEnded));
            }
        }
        // What the shaft must have given, for the wheel to turn as it does.
        let wheel = s.wheels[i];
        let brake = solved.line.brakes[i].map_or(0.0, |row| solved.spin.impulse(row) as f32 / dt);
        let out = &mut report.outputs[i];
        out.drive_torque = if wheel.driven {
            torques[i] + out.force.x * wheel.radius - brake
        } else {
            0.0
        };
    }
    if let Some(shaft) = solved.line.engine {
        state.engine_speed = finite(solved.spin.w[shaft] as f32);
    }
    let total = force + solved.outside.force;
    report.force = total;
    report.torque = torque + solved.outside.torque;

    let road = road / road_weight;
    if road.is_finite() {
        state.ground_velocity = road;
    }
    let acceleration = total / rigid.mass;
    telemetry.speed = (rigid.velocity - state.ground_velocity).dot(axes.forward);
    telemetry.rpm = state.engine_speed.abs() / from_rpm(1.0);
    telemetry.gear = state.gear;
    telemetry.steer_angle = state.steer_angle;
    telemetry.acceleration = Vec3::new(
        acceleration.dot(axes.right),
        acceleration.dot(axes.up),
        -acceleration.dot(axes.forward),
    );
    telemetry.load = report.outputs.iter().map(|w| w.load).sum();
    telemetry.grounded = landed.iter().filter(|l| **l).count() as u32;
    telemetry.drag = solved.outside.drag;
    telemetry.asleep = false;
}

fn finite(v: f32) -> f32 {
    if v.is_finite() { v } else { 0.0 }
}
