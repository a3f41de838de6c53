//! Where each wheel is and what it touches.

use arrayvec::ArrayVec;
use bevy::{math::ops, prelude::*};

use super::Surroundings;
use crate::{
    backend::{
        probe::{Probe, ProbeHit, ProbeShape, Seen},
        rigid::Rigid,
    },
    vehicle::{
        config::Vehicle,
        report::VehicleReport,
        solve::MOST_WHEELS,
        state::{GroundPlane, VehicleState},
        suspension::Law,
        wheel::{Wheel, WheelProbe},
    },
};

/// A wheel at the start of the tick.
#[derive(Clone, Copy)]
pub(in crate::vehicle) struct Found {
    /// Along the axle to the right, unit length, world axes.
    pub axle: Vec3,
    pub law: Law,
    /// Metres, 0 at droop; negative when the ground is below the reach.
    pub compression: f32,
    pub angle: f32,
    pub contact: Option<Touch>,
}

/// Ground that a wheel stands on, or could reach within the tick.
#[derive(Clone, Copy)]
pub(in crate::vehicle) struct Touch {
    pub entity: Entity,
    pub point: Vec3,
    pub normal: Vec3,
    pub cosine: f32,
}

pub(super) fn sense(
    s: &Surroundings,
    config: &Vehicle,
    state: &VehicleState,
    report: &VehicleReport,
    rigid: &Rigid,
    angles: &[f32],
    gravity: Vec3,
) -> ArrayVec<Found, MOST_WHEELS> {
    let least_cosine = ops::cos(config.max_ground_angle);
    s.wheels
        .iter()
        .enumerate()
        .map(|(i, wheel)| {
            let frame = frame(wheel, rigid, angles[i]);
            let law = Law::new(&wheel.suspension, report.shares[i]);
            let top = rigid.position + rigid.rotation * wheel.attachment;
            let travel = wheel.suspension.travel;
            let last = &state.wheels[i];
            let known = (state.probe_age + 1 < s.probe_every)
                .then_some(last.plane)
                .flatten()
                .and_then(|plane| extend(s, &plane));
            let touch = match known {
                Some(hit) => rest_on_plane(wheel, &frame, top, &hit, least_cosine),
                None => look(s, wheel, rigid, &frame, top, least_cosine, last.ground),
            };
            let mut found = Found {
                axle: frame.axle,
                law,
                compression: 0.0,
                angle: angles[i],
                contact: None,
            };
            // How far out the wheel can be by now.
            let extension = travel - last.compression;
            let farthest = if wheel.suspension.unsprung_mass > 0.0 {
                let pull = law.force(last.compression).max(0.0) / wheel.suspension.unsprung_mass
                    + gravity.dot(frame.down);
                // By Verlet's scheme, whose first step off the ground is half a one.
                let step = if last.ground.is_some() { 0.5 } else { 1.0 };
                let out =
                    (-last.compression_rate).max(0.0) * s.dt + step * pull.max(0.0) * s.dt * s.dt;
                extension + out
            } else {
                f32::INFINITY
            };
            match touch {
                Some((touch, length)) if length <= farthest.max(travel) => {
                    // Between droop and full bump the wheel cannot be farther than it got.
                    if length <= farthest || length >= travel {
                        found.compression = travel - length;
                        found.contact = Some(touch);
                    } else {
                        found.compression = travel - farthest;
                    }
                }
                _ => found.compression = travel - farthest.min(travel),
            }
            found
        })
        .collect()
}

/// The plane that a wheel was last found on, where its collider is now.
fn extend(s: &Surroundings, plane: &GroundPlane) -> Option<ProbeHit> {
    let (position, rotation) = s.view.collider_pose(plane.entity)?;
    Some(ProbeHit {
        distance: 0.0,
        point: position + rotation * plane.point,
        normal: rotation * plane.normal,
        entity: plane.entity,
    })
}

/// Keeps the planes that the wheels stand on, for the ticks that do not look.
pub(super) fn remember(s: &Surroundings, state: &mut VehicleState, found: &[Found]) {
    if s.probe_every <= 1 {
        return;
    }
    if state.probe_age + 1 < s.probe_every {
        state.probe_age += 1;
    } else {
        state.probe_age = 0;
    }
    for (last, found) in state.wheels.iter_mut().zip(found) {
        last.plane = found.contact.and_then(|touch| {
            let (position, rotation) = s.view.collider_pose(touch.entity)?;
            let back = rotation.inverse();
            Some(GroundPlane {
                entity: touch.entity,
                point: back * (touch.point - position),
                normal: back * touch.normal,
            })
        });
    }
}

struct Frame {
    axle: Vec3,
    down: Vec3,
    rotation: Quat,
}

fn frame(wheel: &Wheel, rigid: &Rigid, angle: f32) -> Frame {
    let down = wheel.direction.normalize_or(Vec3::NEG_Y);
    let lean = if wheel.attachment.x < 0.0 {
        -wheel.camber
    } else {
        wheel.camber
    };
    let rotation =
        rigid.rotation * Quat::from_axis_angle(down, angle) * Quat::from_rotation_z(lean);
    Frame {
        axle: rotation * Vec3::X,
        down: rigid.rotation * down,
        rotation,
    }
}

/// The ground of a wheel, and how far down it holds the hub from full bump, metres.
fn look(
    s: &Surroundings,
    wheel: &Wheel,
    rigid: &Rigid,
    frame: &Frame,
    top: Vec3,
    least_cosine: f32,
    stood_on: Option<Entity>,
) -> Option<(Touch, f32)> {
    let travel = wheel.suspension.travel;
    // From above the hub, so that a hard landing still finds the ground.
    let raise = travel + wheel.radius;
    let arm = top - rigid.center;
    let closing = (rigid.velocity + rigid.spin.cross(arm)).dot(frame.down);
    let ahead = 1.5 * closing.max(0.0) * s.dt;
    let ray = |offset: Vec3| {
        let from = |raise: f32| {
            let probe = Probe {
                origin: top + offset - frame.down * raise,
                rotation: Quat::IDENTITY,
                direction: frame.down,
                reach: raise + travel + wheel.radius + ahead,
                shape: ProbeShape::Ray,
            };
            s.view.probe(&probe, s.handle, s.groups)
        };
        // Above the wheel may be the inside of something: a low bridge, a ledge.
        let hit = match from(raise)? {
            Seen::Ground(hit) if hit.distance < raise && stood_on != Some(hit.entity) => {
                // Ground that the hub sank into, or something above the wheel that is none: cargo.
                match from(0.0) {
                    Some(Seen::Ground(below)) => below,
                    _ => hit,
                }
            }
            Seen::Ground(hit) => hit,
            Seen::Inside => match from(0.0)? {
                Seen::Ground(hit) => hit,
                Seen::Inside => return None,
            },
        };
        rest_on_plane(wheel, frame, top + offset, &hit, least_cosine)
    };
    let cast = |shape: ProbeShape, lower: f32| {
        let from = |raise: f32| {
            let probe = Probe {
                origin: top + frame.down * (lower - raise),
                rotation: frame.rotation,
                direction: frame.down,
                reach: raise + travel + ahead,
                shape,
            };
            match s.view.probe(&probe, s.handle, s.groups)? {
                Seen::Ground(mut hit) => {
                    hit.distance -= raise;
                    Some(hit)
                }
                Seen::Inside => None,
            }
        };
        let mut hit = from(raise)?;
        // As with a ray: its upper half is above the hub.
        if hit.distance < -wheel.radius && stood_on != Some(hit.entity) {
            hit = from(0.0).unwrap_or(hit);
        }
        let cosine = -hit.normal.dot(frame.down);
        if cosine < least_cosine {
            return None;
        }
        let length = hit.distance;
        let hub = top + frame.down * length;
        // Where along the tread's width it touches is chance on flat ground.
        let point = hit.point - frame.axle * (hit.point - hub).dot(frame.axle);
        let touch = Touch {
            entity: hit.entity,
            point,
            normal: hit.normal,
            cosine,
        };
        Some((touch, length))
    };
    match wheel.probe {
        WheelProbe::Ray => ray(Vec3::ZERO),
        WheelProbe::Rays { count } => {
            let n = count.clamp(2, 8);
            let mut nearest: Option<(Touch, f32)> = None;
            let (mut length, mut normal, mut point, mut hits) = (0.0, Vec3::ZERO, Vec3::ZERO, 0.0);
            for i in 0..n {
                let part = (f32::from(i) + 0.5) / f32::from(n) - 0.5;
                if let Some((touch, reach)) = ray(frame.axle * (part * wheel.width)) {
                    if nearest.is_none_or(|(_, least)| reach < least) {
                        nearest = Some((touch, reach));
                    }
                    length += reach;
                    normal += touch.normal;
                    point += touch.point;
                    hits += 1.0;
                }
            }
            let (mut touch, _) = nearest?;
            touch.normal = normal.normalize_or(touch.normal);
            touch.point = point / hits;
            touch.cosine = (-touch.normal.dot(frame.down)).max(least_cosine);
            Some((touch, length / hits))
        }
        // A wall in a swept shape's way hides the ground; the middle ray does not mind it.
        WheelProbe::Sphere { radius } => {
            let radius = radius.min(wheel.radius);
            cast(ProbeShape::Ball(radius), wheel.radius - radius).or_else(|| ray(Vec3::ZERO))
        }
        WheelProbe::Cylinder => cast(ProbeShape::Wheel(wheel.radius, wheel.width * 0.5), 0.0)
            .or_else(|| ray(Vec3::ZERO)),
    }
}

/// The disc of a wheel on the plane that a ray found.
fn rest_on_plane(
    wheel: &Wheel,
    frame: &Frame,
    top: Vec3,
    hit: &ProbeHit,
    least_cosine: f32,
) -> Option<(Touch, f32)> {
    let n = hit.normal;
    let cosine = -n.dot(frame.down);
    if cosine < least_cosine.max(0.05) {
        return None;
    }
    let inward = n - frame.axle * n.dot(frame.axle);
    let part = inward.length();
    if part < 0.05 {
        return None;
    }
    let length = ((top - hit.point).dot(n) - wheel.radius * part) / cosine;
    let point = top + frame.down * length - inward * (wheel.radius / part);
    let touch = Touch {
        entity: hit.entity,
        point,
        normal: n,
        cosine,
    };
    Some((touch, length))
}
