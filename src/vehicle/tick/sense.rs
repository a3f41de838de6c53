//! Where each wheel is and what it touches.

use arrayvec::ArrayVec;
use bevy::{math::ops, prelude::*};

use super::Surroundings;
use crate::{
    backend::{
        neighbourhood::MOST_BOXES,
        probe::{Ground, Probe, ProbeHit, ProbeShape, Seen},
        rigid::Rigid,
    },
    vehicle::{
        config::Vehicle,
        report::VehicleReport,
        solve::MOST_WHEELS,
        state::{GroundPlane, VehicleState, WheelDynamics},
        suspension::Law,
        wheel::{Wheel, WheelProbe},
    },
};

/// For how many ticks ahead triangles of meshes are searched, and how far at most, metres.
const TICKS_AHEAD: f32 = 8.0;
const FARTHEST_AHEAD: f32 = 3.0;

const _: () = assert!(MOST_WHEELS <= MOST_BOXES, "a box for each wheel");

/// A wheel at the start of the tick.
#[derive(Clone, Copy)]
pub(in crate::vehicle) struct Found {
    /// Along the axle to the right, unit length, world axes.
    pub axle: Vec3,
    /// The way of the suspension, unit length, world axes.
    pub down: Vec3,
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
    report: &mut VehicleReport,
    rigid: &Rigid,
    angles: &[f32],
    gravity: Vec3,
    ground: &mut Ground,
) -> ArrayVec<Found, MOST_WHEELS> {
    let least_cosine = ops::cos(config.max_ground_angle);
    let places: ArrayVec<Place, MOST_WHEELS> = s
        .wheels
        .iter()
        .enumerate()
        .map(|(i, wheel)| place(s, wheel, rigid, angles[i], &state.wheels[i], state))
        .collect();
    let boxes: ArrayVec<(Vec3, Vec3), MOST_WHEELS> = places
        .iter()
        .zip(&s.wheels)
        .filter(|(place, _)| place.known.is_none())
        .map(|(place, wheel)| place.area(wheel, rigid.center))
        .collect();
    if !boxes.is_empty() {
        let way = rigid.velocity * (s.dt * TICKS_AHEAD);
        let (memory, origin) = (&mut report.meshes, rigid.center);
        let way = way.clamp_length_max(FARTHEST_AHEAD);
        ground.gather(memory, &s.view, origin, &boxes, way, s.handle, s.groups);
    }
    s.wheels
        .iter()
        .enumerate()
        .map(|(i, wheel)| {
            let law = Law::new(&wheel.suspension, report.shares[i]);
            let travel = wheel.suspension.travel;
            let last = &state.wheels[i];
            let place = &places[i];
            let frame = &place.frame;
            let touch = match place.known {
                Some(hit) => rest_on_plane(wheel, frame, place.top, &hit, least_cosine),
                None => look(ground, wheel, place, least_cosine, last.ground),
            };
            let mut found = Found {
                axle: frame.axle,
                down: frame.down,
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

/// Where a wheel's way begins, before anything of the ground is known.
struct Place {
    frame: Frame,
    /// Hub at full bump, world, metres.
    top: Vec3,
    /// How far above that probes begin, so that a hard landing still finds the ground, metres.
    raise: f32,
    /// How far below full droop they end, metres: as far as the wheel gets within the tick.
    ahead: f32,
    /// The plane that the wheel stands on, in ticks that do not look.
    known: Option<ProbeHit>,
}

fn place(
    s: &Surroundings,
    wheel: &Wheel,
    rigid: &Rigid,
    angle: f32,
    last: &WheelDynamics,
    state: &VehicleState,
) -> Place {
    let frame = frame(wheel, rigid, angle);
    let top = rigid.position + rigid.rotation * wheel.attachment;
    let closing = (rigid.velocity + rigid.spin.cross(top - rigid.center)).dot(frame.down);
    let known = (state.probe_age + 1 < s.probe_every)
        .then_some(last.plane)
        .flatten()
        .and_then(|plane| extend(s, &plane));
    Place {
        top,
        raise: wheel.suspension.travel + wheel.radius,
        ahead: 1.5 * closing.max(0.0) * s.dt,
        known,
        frame,
    }
}

impl Place {
    /// A ray down beside the wheel's middle.
    fn ray(&self, wheel: &Wheel, offset: Vec3, raise: f32) -> Probe {
        Probe {
            origin: self.top + offset - self.frame.down * raise,
            rotation: Quat::IDENTITY,
            direction: self.frame.down,
            reach: raise + wheel.suspension.travel + wheel.radius + self.ahead,
            shape: ProbeShape::Ray,
        }
    }

    /// A shape of the wheel's kind, `lower` than its hub.
    fn cast(&self, wheel: &Wheel, shape: ProbeShape, lower: f32, raise: f32) -> Probe {
        Probe {
            origin: self.top + self.frame.down * (lower - raise),
            rotation: self.frame.rotation,
            direction: self.frame.down,
            reach: raise + wheel.suspension.travel + self.ahead,
            shape,
        }
    }

    /// What the wheel feels with: the shape, and how much lower than its hub.
    fn shape(wheel: &Wheel) -> Option<(ProbeShape, f32)> {
        match wheel.probe {
            WheelProbe::Ray | WheelProbe::Rays { .. } => None,
            WheelProbe::Sphere { radius } => {
                let radius = radius.min(wheel.radius);
                Some((ProbeShape::Ball(radius), wheel.radius - radius))
            }
            WheelProbe::Cylinder => Some((ProbeShape::Wheel(wheel.radius, wheel.width * 0.5), 0.0)),
        }
    }

    /// The box that all its probes stay in, relative to `origin`.
    fn area(&self, wheel: &Wheel, origin: Vec3) -> (Vec3, Vec3) {
        let (mut low, mut high) = self.ray(wheel, Vec3::ZERO, self.raise).swept(origin);
        if let WheelProbe::Rays { .. } = wheel.probe {
            let aside = (self.frame.axle * (0.5 * wheel.width)).abs();
            (low, high) = (low - aside, high + aside);
        }
        if let Some((shape, lower)) = Self::shape(wheel) {
            let (a, b) = self.cast(wheel, shape, lower, self.raise).swept(origin);
            (low, high) = (low.min(a), high.max(b));
        }
        (low, high)
    }
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
    ground: &Ground,
    wheel: &Wheel,
    place: &Place,
    least_cosine: f32,
    stood_on: Option<Entity>,
) -> Option<(Touch, f32)> {
    let (frame, top) = (&place.frame, place.top);
    let ray = |offset: Vec3| {
        let from = |raise: f32| ground.probe(&place.ray(wheel, offset, raise));
        // Above the wheel may be the inside of something: a low bridge, a ledge.
        let hit = match from(place.raise)? {
            Seen::Ground(hit) if hit.distance < place.raise && stood_on != Some(hit.entity) => {
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
        let from = |raise: f32| match ground.probe(&place.cast(wheel, shape, lower, raise))? {
            Seen::Ground(mut hit) => {
                hit.distance -= raise;
                Some(hit)
            }
            Seen::Inside => None,
        };
        let mut hit = from(place.raise)?;
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
        WheelProbe::Sphere { .. } | WheelProbe::Cylinder => Place::shape(wheel)
            .and_then(|(shape, lower)| cast(shape, lower))
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
