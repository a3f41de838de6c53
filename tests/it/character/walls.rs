//! Gliding along walls of every make, past seams, pillars and into ceilings.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Sim};

use super::support::*;

/// What the wall is.
#[derive(Clone, Copy, Debug)]
enum WallKind {
    Box,
    Mesh,
    Blocks,
    Kinematic,
    KinematicVelocity,
    NotPushable,
}

const KINDS: [WallKind; 6] = [
    WallKind::Box,
    WallKind::Mesh,
    WallKind::Blocks,
    WallKind::Kinematic,
    WallKind::KinematicVelocity,
    WallKind::NotPushable,
];

/// Spawns a wall 12 m long from `start` along `along`; it faces `along × up`.
fn spawn_wall(sim: &mut Sim, kind: WallKind, start: Vec3, along: Vec3) {
    let face = along.cross(Vec3::Y);
    let rotation = Quat::from_mat3(&Mat3::from_cols(along, Vec3::Y, face));
    let center = start + along * 6.0 + Vec3::Y * 1.5 - face * 0.5;
    let at = Transform::from_translation(center).with_rotation(rotation);
    let collider = Collider::cuboid(6.0, 1.5, 0.5);
    match kind {
        WallKind::Box => {
            sim.fixed(collider, at);
        }
        WallKind::Mesh => {
            sim.wall(Make::Mesh, start, along, 12.0, 3.0);
        }
        WallKind::Blocks => {
            for i in 0..12 {
                for j in 0..3 {
                    let offset = Vec3::new(i as f32 - 5.5, j as f32 - 1.0, 0.0);
                    sim.fixed(
                        Collider::cuboid(0.5, 0.5, 0.5),
                        at * Transform::from_translation(offset),
                    );
                }
            }
        }
        WallKind::Kinematic => {
            sim.kinematic(collider, at);
        }
        WallKind::KinematicVelocity => {
            sim.spawn((
                RigidBody::KinematicVelocityBased,
                collider,
                at,
                Velocity::default(),
            ));
        }
        WallKind::NotPushable => {
            // A heavy dynamic body that is a wall to characters, held by locked axes.
            sim.spawn((
                RigidBody::Dynamic,
                collider,
                LockedAxes::all(),
                NotPushable,
                at,
            ));
        }
    }
}

fn glide(
    found: &mut Findings,
    kind: WallKind,
    hz: f64,
    yaw: f32,
    motor: CharacterMotor,
    name: &str,
) {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    let along = heading(yaw);
    let face = along.cross(Vec3::Y);
    spawn_wall(&mut sim, kind, along * -2.0, along);
    let walker = sim.spawn((
        Character::default(),
        motor,
        Transform::from_translation(face * 0.32),
    ));
    sim.seconds(0.5);
    // Ten degrees into the wall.
    let (sin, cos) = ops::sin_cos(10f32.to_radians());
    sim.walk(walker, along * cos - face * sin);
    sim.seconds(0.4);
    let start = sim.position(walker);
    let mut last = start;
    let (mut least, mut away): (f32, f32) = (f32::MAX, f32::MIN);
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    let ticks = (5.0 / (f64::from(SPEED) * f64::from(cos)) * hz).round() as usize;
    for _ in 0..ticks {
        sim.ticks(1);
        let now = sim.position(walker);
        least = least.min((now - last).dot(along));
        away = away.max(now.dot(face));
        (low, high) = (low.min(now.y), high.max(now.y));
        last = now;
    }
    let seconds = ticks as f32 * sim.dt();
    let case = format!("{name} {kind:?} {hz} Hz wall at {yaw}°");
    found.within(
        format!("{case}: tangential speed"),
        (last - start).dot(along) / seconds,
        SPEED * cos,
        0.002,
    );
    found.at_least(
        format!("{case}: slowest tick"),
        least / sim.dt(),
        SPEED * cos * 0.98,
    );
    found.near(format!("{case}: distance kept"), last.dot(face), 0.3, 0.022);
    found.at_most(format!("{case}: height range"), high - low, 0.0005);
    found.at_most(format!("{case}: farthest from the wall"), away, 0.325);
}

#[test]
fn a_wall_glide_keeps_the_tangential_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for yaw in [0.0, 25.0] {
            for kind in [WallKind::Box, WallKind::Mesh, WallKind::Blocks] {
                glide(&mut found, kind, hz, yaw, prompt(), "prompt");
            }
        }
    }
}

#[test]
fn a_glide_along_a_resting_kinematic_body_is_as_fast() {
    let mut found = Findings::new();
    for hz in RATES {
        for kind in [
            WallKind::Kinematic,
            WallKind::KinematicVelocity,
            WallKind::NotPushable,
        ] {
            glide(&mut found, kind, hz, 0.0, prompt(), "prompt");
        }
    }
}

#[test]
fn a_wall_glide_with_limited_acceleration_is_as_fast() {
    let mut found = Findings::new();
    for hz in RATES {
        for kind in KINDS {
            glide(
                &mut found,
                kind,
                hz,
                -65.0,
                CharacterMotor::default(),
                "default",
            );
        }
    }
}

#[test]
fn the_speed_of_a_glide_is_the_projection_at_every_angle() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let angles = [5.0, 20.0, 45.0, 60.0, 80.0, 85.0];
        let mut walkers = Vec::new();
        for (i, degrees) in angles.into_iter().enumerate() {
            let z = i as f32 * 4.0;
            sim.block(Vec3::new(0.0, 1.5, z - 0.5), Vec3::new(30.0, 3.0, 1.0));
            let walker = runner(&mut sim, Vec3::new(-10.0, 0.0, z + 0.32));
            walkers.push((walker, degrees));
        }
        sim.seconds(0.5);
        for &(walker, degrees) in &walkers {
            sim.walk(walker, heading(-degrees));
        }
        sim.seconds(0.3);
        let start: Vec<f32> = walkers.iter().map(|w| sim.position(w.0).x).collect();
        sim.seconds(1.0);
        for (&(walker, degrees), start) in walkers.iter().zip(start) {
            let wanted = SPEED * ops::cos(f32::to_radians(degrees));
            let measured = sim.position(walker).x - start;
            found.within(
                format!("{hz} Hz {degrees}°: speed"),
                measured,
                wanted,
                0.002,
            );
        }
    }
}

#[test]
fn a_row_of_thin_pillars_is_passed_without_a_stop() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // Gaps of 0.2 m: the capsule sinks a little into each and rolls out again.
        for i in 0..30 {
            sim.block(
                Vec3::new(i as f32 * 0.4, 1.5, -0.1),
                Vec3::new(0.2, 3.0, 0.2),
            );
        }
        let walker = runner(&mut sim, Vec3::new(0.0, 0.0, 0.32));
        sim.seconds(0.5);
        sim.walk(walker, heading(-10.0));
        let mut last = sim.position(walker).x;
        let mut backwards: f32 = 0.0;
        for _ in 0..(2.0 * hz) as usize {
            sim.ticks(1);
            let now = sim.position(walker).x;
            backwards = backwards.max(last - now);
            last = now;
        }
        found.at_most(format!("{hz} Hz: backwards"), backwards, 1e-5);
        // Half the free speed is what a catch on an edge would not leave.
        found.at_least(format!("{hz} Hz: covered in 2 s"), last, 8.0);
    }
}

#[test]
fn walking_straight_at_a_wall_stops_at_it_without_side_motion() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            sim.wall(make, Vec3::new(3.0, 0.0, 5.0), Vec3::Z * -1.0, 10.0, 3.0);
            let face = Vec3::NEG_Z.cross(Vec3::Y);
            let walker = runner(&mut sim, Vec3::new(3.0, 0.0, 0.07) + face * 2.0);
            sim.seconds(0.2);
            sim.walk(walker, -face);
            sim.seconds(1.0);
            let foot = sim.position(walker);
            let case = format!("{hz} Hz {make:?}");
            found.near(
                format!("{case}: gap"),
                (foot - Vec3::X * 3.0).dot(face),
                0.3,
                0.022,
            );
            found.near(format!("{case}: side"), foot.z, 0.07, 1e-4);
            found.near(format!("{case}: height"), foot.y, 0.0, 1e-3);
            let velocity = sim.state(walker).velocity;
            found.at_most(format!("{case}: velocity left"), velocity.length(), 1e-3);
        }
    }
}

#[test]
fn a_jump_under_a_ceiling_falls_at_once_and_keeps_its_horizontal_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(0.0, 2.6, 0.0), Vec3::new(60.0, 1.0, 10.0));
        let walker = runner(&mut sim, Vec3::new(-10.0, 0.0, 0.0));
        sim.seconds(0.3);
        sim.walk(walker, Vec3::X);
        sim.seconds(0.3);
        sim.intent(walker, |intent| intent.jump = true);
        let start = sim.position(walker).x;
        let mut high: f32 = 0.0;
        for _ in 0..(0.6 * hz) as usize {
            sim.ticks(1);
            high = high.max(sim.position(walker).y);
        }
        // Head room 0.3 m; without a ceiling the jump would last 0.99 s.
        found.near(format!("{hz} Hz: highest"), high, 0.3, 0.022);
        found.within(
            format!("{hz} Hz: distance"),
            sim.position(walker).x - start,
            3.0,
            0.005,
        );
        found.holds(
            format!("{hz} Hz: down again"),
            sim.state(walker).on_ground(),
        );
    }
}

#[test]
fn a_wall_is_no_ground_to_jump_from() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            sim.wall(make, Vec3::new(0.0, -50.0, 5.0), Vec3::NEG_Z, 10.0, 100.0);
            let faller = runner(&mut sim, Vec3::new(0.32, 0.0, 0.0));
            sim.walk(faller, Vec3::NEG_X);
            sim.intent(faller, |intent| intent.jump = true);
            let mut grounded = 0;
            for _ in 0..hz as usize {
                sim.ticks(1);
                let state = sim.state(faller);
                grounded += usize::from(matches!(
                    state.ground.state,
                    GroundState::OnGround | GroundState::Steep
                ));
            }
            let case = format!("{hz} Hz {make:?}");
            found.at_most(format!("{case}: ticks with ground"), grounded as f32, 0.0);
            found.within(
                format!("{case}: fall"),
                -sim.position(faller).y,
                G * 0.5,
                0.04,
            );
        }
    }
}

#[test]
fn a_zigzag_of_mesh_is_followed_to_its_end() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // Corners of 120° in and out, every metre.
        let mut from = Vec3::ZERO;
        for i in 0..20 {
            let along = heading(if i % 2 == 0 { 30.0 } else { -30.0 });
            // Walls face `along × up`, which is +Z for +X.
            sim.wall(Make::Mesh, from, along, 1.0, 3.0);
            from += along;
        }
        let walker = runner(&mut sim, Vec3::new(0.3, 0.0, 1.0));
        sim.seconds(0.2);
        sim.walk(walker, heading(-20.0));
        sim.seconds(8.0);
        // The flanks that face it are at 50° to the walk: it passes all, at 3.2 m/s and more on them.
        found.at_least(format!("{hz} Hz: reached"), sim.position(walker).x, 16.0);
    }
}
