//! From touched ground to the contacts of the solve.

use arrayvec::ArrayVec;
use bevy::{math::ops, prelude::*};

use super::{Found, Surroundings, bend::Bend, sense::Touch};
use crate::{
    backend::{
        hold::Hold,
        rigid::{GroundMotion, Rigid},
    },
    vehicle::{
        config::Vehicle,
        report::VehicleReport,
        solve::{Contact, GroundBody, MOST_WHEELS},
        state::VehicleState,
        surface::SurfaceFriction,
    },
};

/// Below this speed against the ground a carcass remembers what others did to it, metres per second.
const SLOW: f32 = 2.0;

/// A body that joints hold counts as at least the vehicle's mass over this: what else hangs on them
/// takes its part, but how much of it only the physics step knows.
const LIGHTEST: f32 = 8.0;

/// A body lies flat on a floor if the cosine between its face and the floor is above this: whatever presses
/// on it stays within the friction of the floor.
const FLAT: f32 = 0.97;

/// Faster than this against the floor that it lies on, a loose body leaves it, or is not held by its
/// friction, metres per second.
const LEAVING: f32 = 1.0;

/// A loose body that turns by more than this in a tick is not followed on its way round, radians.
const SPINNING: f32 = 0.3;

/// A spring that lies flatter on the ground counts as one at this cosine.
const LEAST_COSINE: f32 = 0.05;

pub(super) fn build<'a>(
    s: &Surroundings<'a, '_, '_>,
    config: &Vehicle,
    state: &VehicleState,
    report: &mut VehicleReport,
    rigid: &Rigid,
    found: &[Found],
    grounds: &mut ArrayVec<GroundBody, MOST_WHEELS>,
    contacts: &mut ArrayVec<Contact<'a>, MOST_WHEELS>,
) {
    let own_mass = rigid.mass;
    let (mut ground_spin, mut standing) = (Vec3::ZERO, 0.0f32);
    let mut moved = [Vec3::ZERO; MOST_WHEELS];
    let mut falls = [Vec3::ZERO; MOST_WHEELS];
    let bend = bend(s, found, rigid.velocity - state.ground_velocity);
    // The step moves a body a little more by its last velocity than by its first: it is that much
    // nearer to the middle of the curve already.
    let ahead = (1.0 - s.view.end_share()) * s.dt;
    for (i, f) in found.iter().enumerate() {
        let Some(mut touch) = f.contact else { continue };
        let wheel = s.wheels[i];
        let last = &state.wheels[i];
        let Some(motion) = s.view.ground_motion(touch.entity, s.dt) else {
            continue;
        };
        let (friction, road) = s.surfaces.get(touch.entity).unwrap_or_default();
        let friction = friction.copied().filter(SurfaceFriction::is_sound);
        let friction = friction.unwrap_or_default();
        let road = road
            .filter(|r| r.is_sound())
            .zip(s.view.collider_pose(touch.entity));
        let ground_at = |point: Vec3| {
            let mut velocity = motion.velocity_at(point);
            if let Some((road, (origin, rotation))) = road {
                velocity +=
                    rotation * road.linear + (rotation * road.angular).cross(point - origin);
            }
            velocity
        };
        let arm = touch.point - rigid.center;
        let own_velocity = rigid.velocity + rigid.spin.cross(arm);
        let ground_start = ground_at(touch.point);
        let ground_end = match motion {
            // What spins like this shows the wheel another side of itself by then.
            GroundMotion::Free { rigid, .. } if rigid.spin.length() * s.dt > SPINNING => {
                ground_start
            }
            _ => ground_at(touch.point + own_velocity * s.dt),
        };
        // The step moves a body a little more by its last velocity than by its first: on a circle
        // that would lead inward.
        let ground_drift = (ground_start - ground_end) * (s.view.end_share() - 0.5);
        if !ground_start.is_finite() || !ground_end.is_finite() {
            continue;
        }
        if !matches!(motion, GroundMotion::Free { .. }) {
            let turned = bend.turn((own_velocity - ground_start) * ahead);
            touch.normal = (touch.normal + turned).normalize_or(touch.normal);
            // What the spring takes up along its axis is then what the ground does along the normal.
            touch.cosine = (-touch.normal.dot(f.down)).max(LEAST_COSINE);
        }
        let same_ground = last.ground == Some(touch.entity);
        let ground = match motion {
            // One that sleeps lies still as long as what it carries does not change; a new push wakes it.
            GroundMotion::Free { body, rigid } if !rigid.sleeping || !same_ground => {
                let index = grounds.iter().position(|g| g.entity == body);
                let index = index.unwrap_or_else(|| {
                    let hold = match s.view.hold(body, s.handle, touch.normal, touch.point) {
                        // What leaves its floor, as a stone that was squeezed out, is not held by it:
                        // it would meet the wheel like a rock that comes up.
                        Hold::Floor { normal, velocity }
                            if (ground_start - velocity).dot(normal) > LEAVING =>
                        {
                            Hold::Free
                        }
                        hold => hold,
                    };
                    let mut loose = ground_body(body, &rigid, hold, touch.normal, own_mass);
                    // Nor does friction hold one that shoots along its floor: with but its own mass behind
                    // it, such a wedge can lift no car.
                    if let Hold::Floor { velocity, .. } = hold
                        && (ground_start - velocity).length() > LEAVING
                    {
                        loose.flat_on = None;
                    }
                    grounds.push(loose);
                    grounds.len() - 1
                });
                let arm = touch.point - rigid.center;
                if same_ground {
                    let impulse = last.ground_force * s.dt;
                    grounds[index].pushed += impulse;
                    grounds[index].turned += arm.cross(impulse);
                    moved[index] = rigid.velocity - last.ground_speed;
                }
                falls[index] = s.view.gravity * rigid.gravity_scale * rigid.free_axes() * s.dt;
                Some((index, arm))
            }
            _ => None,
        };
        // What moves as it wills changes its velocity between two ticks. The vehicle keeps that of its
        // last tick for a part of this one, and stays behind by so much.
        let (body, jump) = match motion {
            GroundMotion::Free { body, rigid } => {
                report.ground_speeds[i] = rigid.velocity;
                (Some(body), Vec3::ZERO)
            }
            _ => {
                report.ground_speeds[i] = ground_end;
                (None, ground_start - last.ground_speed)
            }
        };
        report.ground_bodies[i] = body;
        report.ground_velocities[i] = ground_start;
        // A loose stone that rolls under a wheel is not the ground that the vehicle turns on.
        let share = match motion {
            GroundMotion::Free { rigid, .. } => rigid.mass / (rigid.mass + own_mass),
            _ => 1.0,
        };
        let belt = road.map_or(Vec3::ZERO, |(road, (_, rotation))| rotation * road.angular);
        ground_spin += (motion.spin() + belt) * share;
        standing += 1.0;
        let Some(along) = touch.normal.cross(f.axle).try_normalize() else {
            continue;
        };
        let across = along.cross(touch.normal);
        let velocity = own_velocity - ground_start;
        let flat = Vec2::new(velocity.dot(along), velocity.dot(across));
        let jump = Vec2::new(jump.dot(along), jump.dot(across)) * s.view.end_share();
        // Forces act as the wheel points in the middle of the tick; the velocities that they lead to
        // are those of its end, so slip is measured as the wheel points then.
        let half = (0.5 * s.dt * rigid.spin.dot(touch.normal)).clamp(-0.5, 0.5);
        let (sin, cos) = ops::sin_cos(half);
        let turned = |a: Vec3, b: Vec3| (a * cos - b * sin, b * cos + a * sin);
        let (along, across) = turned(along, across);
        let (end_along, end_across) = turned(along, across);
        let turn_slip = Vec2::new(
            velocity.dot(along - end_along),
            velocity.dot(across - end_across),
        );
        let speed = flat.length().max((last.spin * wheel.radius).abs());
        let mut bristle = if same_ground {
            last.bristle
        } else {
            Vec2::ZERO
        };
        if same_ground && speed < SLOW {
            bristle -= (flat + jump - last.expected) * s.dt;
        }
        // The last tick's impulse is where the solve begins.
        let before = if same_ground {
            last.ground_force * -s.dt
        } else {
            Vec3::ZERO
        };
        let lean = f.axle.dot(touch.normal).clamp(-1.0, 1.0);
        contacts.push(Contact {
            wheel: i,
            arm,
            normal: touch.normal,
            along,
            across,
            cosine: touch.cosine,
            ground_start,
            ground_end: ground_end + ground_drift,
            ground_drift,
            ground,
            law: f.law,
            compression: f.compression,
            bar: None,
            lone_bar: 0.0,
            tire: &wheel.tire,
            surface: friction.friction,
            radius: wheel.radius,
            bristle,
            turn_slip,
            // Leaning to the right pushes to the right.
            camber_slip: -wheel.tire.camber_stiffness * ops::asin(lean),
            mobility: Vec2::ZERO,
            push: before.dot(touch.normal).max(0.0),
            grip: Vec2::new(before.dot(along), before.dot(across)),
            combined: if same_ground { last.slip } else { 0.0 },
            speed,
            patch: None,
            answer: None,
        });
    }
    report.ground_spin = ground_spin / standing.max(1.0);
    for (i, ground) in grounds.iter_mut().enumerate() {
        ground.begin(moved[i], falls[i]);
    }
    join_bars(s, config, found, contacts);
}

/// How the road bends. How a loose body lies under a wheel says nothing of the way to come.
fn bend(s: &Surroundings, found: &[Found], velocity: Vec3) -> Bend {
    let loose = |touch: &Touch| {
        let motion = s.view.ground_motion(touch.entity, s.dt);
        matches!(motion, Some(GroundMotion::Free { .. }))
    };
    let road: ArrayVec<(Vec3, Vec3), MOST_WHEELS> = found
        .iter()
        .filter_map(|f| f.contact)
        .filter(|touch| !loose(touch))
        .map(|touch| (touch.point, touch.normal))
        .collect();
    Bend::of(&road, velocity)
}

/// A body under a wheel as far as it gives way: along what holds it, it does not.
fn ground_body(
    entity: Entity,
    rigid: &Rigid,
    hold: Hold,
    normal: Vec3,
    own_mass: f32,
) -> GroundBody {
    let inverse_mass = Mat3::from_diagonal(rigid.inverse_mass);
    let inverse_inertia = rigid.inverse_inertia;
    let (inverse_mass, inverse_inertia) = match hold {
        Hold::Free => (inverse_mass, inverse_inertia),
        Hold::Floor { normal: floor, .. } => {
            let along = Mat3::from_cols(floor * floor.x, floor * floor.y, floor * floor.z);
            let across = Mat3::IDENTITY - along;
            let turn = floor.dot(inverse_inertia * floor);
            (across * inverse_mass * across, along * turn)
        }
        Hold::Joints => {
            let heavier = (rigid.mass * LIGHTEST / own_mass).min(1.0);
            (inverse_mass * heavier, inverse_inertia * heavier)
        }
    };
    GroundBody {
        entity,
        velocity: Vec3::ZERO,
        spin: Vec3::ZERO,
        mass: rigid.mass,
        // A loose one that is lighter than the vehicle would be shot away.
        withstands: match hold {
            Hold::Joints => 1.0,
            Hold::Free | Hold::Floor { .. } => (rigid.mass / own_mass).min(1.0),
        },
        inverse_mass,
        inverse_inertia,
        flat_on: match hold {
            Hold::Floor { normal: floor, .. } if floor.dot(normal) > FLAT => Some(floor),
            _ => None,
        },
        pushed: Vec3::ZERO,
        turned: Vec3::ZERO,
    }
}

/// Ties the two sides of each axle by its anti-roll bar.
fn join_bars(
    s: &Surroundings,
    config: &Vehicle,
    found: &[Found],
    contacts: &mut ArrayVec<Contact, MOST_WHEELS>,
) {
    for (axle, bar) in config.anti_roll.iter().enumerate() {
        if !(*bar > 0.0) {
            continue;
        }
        // The outermost wheel of each side.
        let mut ends: [Option<usize>; 2] = [None, None];
        for (i, wheel) in s.wheels.iter().enumerate() {
            if usize::from(wheel.axle) == axle {
                let side = usize::from(wheel.attachment.x > 0.0);
                let farther = |j: usize| s.wheels[j].attachment.x.abs() < wheel.attachment.x.abs();
                if ends[side].is_none_or(farther) {
                    ends[side] = Some(i);
                }
            }
        }
        let [Some(left), Some(right)] = ends else {
            continue;
        };
        let at = |wheel| contacts.iter().position(|c| c.wheel == wheel);
        match (at(left), at(right)) {
            (Some(l), Some(r)) => {
                contacts[l].bar = Some((r, *bar));
                contacts[r].bar = Some((l, *bar));
            }
            // A hanging wheel gives way to the bar until its own spring holds it.
            (Some(one), None) => contacts[one].lone_bar = in_series(*bar, &found[right]),
            (None, Some(one)) => contacts[one].lone_bar = in_series(*bar, &found[left]),
            (None, None) => {}
        }
    }
}

fn in_series(bar: f32, hanging: &Found) -> f32 {
    let k = hanging.law.stiffness;
    bar * k / (bar + k).max(1.0e-6)
}
