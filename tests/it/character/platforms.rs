//! Lifts, turntables, diagonal platforms, conveyors, ships: carried exactly, at every rate.

use core::f64::consts::TAU;

use bevy::{
    math::{DQuat, DVec3},
    prelude::*,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A slab whose top is at `y = 0` of its own frame, 6 m square.
fn slab() -> Collider {
    Collider::compound(vec![(
        Vec3::NEG_Y * 0.25,
        Quat::IDENTITY,
        Collider::cuboid(3.0, 0.25, 3.0),
    )])
}

/// Goes to and fro at constant speed with this stroke, metres.
fn triangle_wave(t: f64, speed: f64, stroke: f64) -> f64 {
    let phase = (t * speed / stroke).rem_euclid(2.0);
    stroke * if phase < 1.0 { phase } else { 2.0 - phase }
}

/// Largest distances of the foot above and below the top of a platform over `seconds`.
fn gap_range(
    sim: &mut Sim,
    rider: Entity,
    platform: Entity,
    top: f32,
    hz: f64,
    seconds: f64,
) -> (f32, f32) {
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    for _ in 0..(seconds * hz) as usize {
        sim.ticks(1);
        let gap = sim.position(rider).y - sim.position(platform).y - top;
        (low, high) = (low.min(gap), high.max(gap));
    }
    (low, high)
}

#[test]
fn a_lift_keeps_the_foot_within_a_centimetre_of_its_floor() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [0.5, 1.0, 3.0, -0.5, -1.0, -3.0] {
            for walking in [false, true] {
                let mut sim = Sim::new(hz);
                let lift = sim.mover(board(), later(move |t| DVec3::Y * speed * t));
                let rider = runner(&mut sim, Vec3::Y * 0.25);
                sim.seconds(0.25);
                if walking {
                    sim.walk(rider, Vec3::X * 0.15);
                }
                let (low, high) = gap_range(&mut sim, rider, lift, 0.25, hz, 2.25);
                let case = format!("{hz} Hz {speed} m/s walking {walking}");
                found.at_least(format!("{case}: lowest"), low, -0.01);
                found.at_most(format!("{case}: highest"), high, 0.01);
                let time = (2.25 * hz) as usize as f32 / hz as f32;
                let x = if walking { SPEED * 0.15 * time } else { 0.0 };
                found.near(format!("{case}: walked"), sim.position(rider).x, x, 0.003);
            }
        }
    }
}

#[test]
fn a_reversing_lift_keeps_the_foot_within_a_centimetre_of_its_floor() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [0.5, 1.0, 3.0] {
            let mut sim = Sim::new(hz);
            let stroke = speed * 0.8;
            let lift = sim.mover(
                board(),
                later(move |t| DVec3::Y * triangle_wave(t, speed, stroke)),
            );
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            sim.seconds(0.25);
            let mut off = 0;
            let (low, high) = gap_range(&mut sim, rider, lift, 0.25, hz, 6.0);
            off += usize::from(!sim.state(rider).on_ground());
            let case = format!("{hz} Hz {speed} m/s");
            found.at_least(format!("{case}: lowest"), low, -0.01);
            found.at_most(format!("{case}: highest"), high, 0.01);
            found.at_most(format!("{case}: off ground at the end"), off as f32, 0.0);
        }
    }
}

#[test]
fn a_lift_on_a_sine_keeps_the_foot_within_a_centimetre_of_its_floor() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let lift = sim.mover(board(), later(|t| DVec3::Y * 1.75 * (1.0 - t.cos())));
        let rider = runner(&mut sim, Vec3::Y * 0.25);
        sim.seconds(0.25);
        let (low, high) = gap_range(&mut sim, rider, lift, 0.25, hz, 10.0);
        found.at_least(format!("{hz} Hz: lowest"), low, -0.01);
        found.at_most(format!("{hz} Hz: highest"), high, 0.01);
    }
}

#[test]
fn a_velocity_driven_lift_carries_as_well() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [1.0, -1.0, 3.0] {
            let mut sim = Sim::new(hz);
            let lift = sim.spawn((
                RigidBody::KinematicVelocityBased,
                board(),
                Transform::IDENTITY,
                Velocity::default(),
            ));
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            sim.seconds(0.5);
            edit::<Velocity>(&mut sim, lift, |v| v.linear = Vec3::new(1.0, speed, 0.0));
            let (low, high) = gap_range(&mut sim, rider, lift, 0.25, hz, 2.0);
            let case = format!("{hz} Hz {speed} m/s");
            found.at_least(format!("{case}: lowest"), low, -0.01);
            found.at_most(format!("{case}: highest"), high, 0.01);
            let slip = sim.position(rider).x - sim.position(lift).x;
            found.near(format!("{case}: slip"), slip, 0.0, 0.01);
        }
    }
}

#[test]
fn a_turntable_keeps_the_radius_within_a_millimetre_over_ten_turns() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, center) in [("here", Vec3::ZERO), ("there", Vec3::new(40.0, 5.0, -30.0))] {
            let mut sim = Sim::new(hz);
            let table = sim.mover(Collider::cylinder(0.25, 4.0), move |t| {
                let angle = TAU * (t - 0.5).max(0.0);
                Transform::from_translation(center)
                    .with_rotation(DQuat::from_rotation_y(angle).as_quat())
            });
            let radii = [0.0, 1.0, 3.0];
            let riders = radii.map(|r| runner(&mut sim, center + Vec3::new(r, 0.25, 0.0)));
            sim.seconds(0.5);
            let mut off = [0f32; 3];
            let mut arc = [0f32; 3];
            for _ in 0..(10.0 * hz) as usize {
                sim.ticks(1);
                let turn = sim.get::<Transform>(table).rotation;
                for i in 0..3 {
                    let arm = (sim.position(riders[i]) - center).with_y(0.0);
                    off[i] = off[i].max((arm.length() - radii[i]).abs());
                    arc[i] = arc[i].max(arm.distance(turn * Vec3::X * radii[i]));
                }
            }
            for i in 0..3 {
                let case = format!("{hz} Hz {name} radius {}", radii[i]);
                found.at_most(format!("{case}: radius off"), off[i], 0.001);
                found.at_most(format!("{case}: left behind"), arc[i], 0.003);
                let facing = sim.get::<Transform>(riders[i]).rotation * Vec3::X;
                let turn = sim.get::<Transform>(table).rotation * Vec3::X;
                found.at_most(format!("{case}: facing off"), facing.distance(turn), 0.003);
            }
        }
    }
}

#[test]
fn a_table_that_turns_about_a_tilted_axis_carries_along_its_arc() {
    // A wheel of small tilt: the rider goes up, down and round.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let axis = DVec3::new(0.15, 1.0, 0.1).normalize();
        let turn =
            move |t: f64| DQuat::from_axis_angle(axis, TAU * 0.3 * (t - 0.5).max(0.0)).as_quat();
        let table = sim.mover(Collider::cuboid(4.0, 0.25, 4.0), move |t| {
            Transform::from_rotation(turn(t))
        });
        let rider = runner(&mut sim, Vec3::new(2.0, 0.25, 0.0));
        sim.seconds(0.5);
        // The centre of the capsule's lower ball is what the carrying keeps above the plane.
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        let mut slip: f32 = 0.0;
        let mut off = 0;
        for _ in 0..(6.0 * hz) as usize {
            sim.ticks(1);
            let rotation = sim.get::<Transform>(table).rotation;
            let ball = rotation.inverse() * (sim.position(rider) + Vec3::Y * 0.3);
            (low, high) = (low.min(ball.y), high.max(ball.y));
            slip = slip.max(ball.with_y(0.0).distance(Vec3::X * 2.0));
            off += usize::from(!sim.state(rider).on_ground());
        }
        found.at_least(format!("{hz} Hz: lowest"), low, 0.55 - 0.01);
        found.at_most(format!("{hz} Hz: highest"), high, 0.55 + 0.01);
        found.at_most(format!("{hz} Hz: ticks off"), off as f32, 0.0);
        // The foot is carried, the ball above it leans by up to the tilt.
        found.at_most(format!("{hz} Hz: slip"), slip, 0.15);
    }
}

#[test]
fn a_diagonal_descent_does_not_shake_sideways() {
    let mut found = Findings::new();
    for hz in RATES {
        for velocity in [
            DVec3::new(2.0, -2.0, 0.0),
            DVec3::new(1.0, -3.0, 0.5),
            DVec3::new(2.0, 2.0, -1.0),
        ] {
            let mut sim = Sim::new(hz);
            let platform = sim.mover(board(), later(move |t| velocity * t));
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            sim.seconds(0.5);
            let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                let offset = sim.position(rider) - sim.position(platform);
                (low, high) = (low.min(offset), high.max(offset));
            }
            let case = format!("{hz} Hz {velocity}");
            found.at_most(format!("{case}: jitter in x"), high.x - low.x, 0.0001);
            found.at_most(format!("{case}: jitter in z"), high.z - low.z, 0.0001);
            found.at_most(format!("{case}: in height"), high.y - low.y, 0.01);
        }
    }
}

#[test]
fn a_platform_that_moves_sideways_carries_fully() {
    let mut found = Findings::new();
    for hz in RATES {
        for cross in [0.0, 0.2] {
            let mut sim = Sim::new(hz);
            let platform = sim.mover(board(), later(|t| DVec3::X * 3.0 * t));
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            sim.seconds(0.5);
            sim.walk(rider, Vec3::Z * cross);
            sim.seconds(1.0);
            let (moved, carried) = (sim.position(rider), sim.position(platform));
            let case = format!("{hz} Hz with {cross} across");
            found.near(format!("{case}: carried"), moved.x, 3.0, 0.001);
            found.near(format!("{case}: platform"), carried.x, 3.0, 0.001);
            found.near(format!("{case}: walked"), moved.z, cross * SPEED, 0.002);
            let state = sim.state(rider);
            found.near(
                format!("{case}: velocity of the platform"),
                state.platform_velocity.x,
                3.0,
                0.01,
            );
            found.near(format!("{case}: own velocity"), state.velocity.x, 0.0, 0.01);
        }
    }
}

#[test]
fn a_rider_walks_on_a_moving_platform_as_on_land() {
    // Galilean shift: the same walk on the moving platform and beside it.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let big = Collider::cuboid(20.0, 0.25, 20.0);
        let platform = sim.mover(big.clone(), later(|t| DVec3::new(4.0, 1.0, -2.0) * t));
        sim.fixed(big, Transform::from_xyz(200.0, 0.0, 0.0));
        for offset in [Vec3::ZERO, Vec3::X * 200.0] {
            // Something to run into.
            let pillar = Collider::cuboid(0.5, 2.0, 0.5);
            if offset == Vec3::ZERO {
                sim.mover(
                    pillar,
                    later(|t| DVec3::new(4.0, 2.25, 0.2) + DVec3::new(4.0, 1.0, -2.0) * t),
                );
            } else {
                sim.fixed(
                    pillar,
                    Transform::from_translation(offset + Vec3::new(4.0, 2.25, 0.2)),
                );
            }
        }
        let rider = runner(&mut sim, Vec3::Y * 0.25);
        let walker = runner(&mut sim, Vec3::new(200.0, 0.25, 0.0));
        sim.seconds(0.5);
        for who in [rider, walker] {
            sim.walk(who, heading(8.0));
        }
        let mut apart: f32 = 0.0;
        for _ in 0..(2.0 * hz) as usize {
            sim.ticks(1);
            let on = sim.position(rider) - sim.position(platform);
            let off = sim.position(walker) - Vec3::X * 200.0;
            apart = apart.max(on.distance(off));
        }
        found.at_most(format!("{hz} Hz: farthest apart"), apart, 0.01);
    }
}

#[test]
fn a_conveyor_carries_at_its_speed_and_in_its_own_axes() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let belt = sim.fixed(
            Collider::cuboid(20.0, 0.5, 20.0),
            Transform::from_xyz(0.0, -0.5, 0.0).with_rotation(Quat::from_rotation_y(0.5)),
        );
        insert(
            &mut sim,
            belt,
            SurfaceVelocity {
                linear: Vec3::X * 2.0,
                angular: Vec3::ZERO,
            },
        );
        let rider = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        let start = sim.position(rider);
        sim.seconds(2.0);
        let moved = sim.position(rider) - start;
        let wanted = Quat::from_rotation_y(0.5) * Vec3::X * 4.0;
        found.at_most(format!("{hz} Hz: off"), moved.distance(wanted), 0.005);
        let ground = sim.state(rider).ground;
        found.at_most(
            format!("{hz} Hz: ground velocity off"),
            ground.velocity.distance(wanted * 0.5),
            0.01,
        );
        // Against the belt at its own speed it stands.
        let start = sim.position(rider);
        sim.walk(rider, -wanted.normalize() * 2.0 / SPEED);
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: treadmill"),
            sim.position(rider).distance(start),
            0.05,
        );
    }
}

#[test]
fn a_turning_surface_carries_along_its_arc() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let disc = sim.fixed(
            Collider::cylinder(0.5, 6.0),
            Transform::from_xyz(0.0, -0.5, 0.0),
        );
        let rider = runner(&mut sim, Vec3::X * 2.0);
        sim.seconds(0.3);
        insert(
            &mut sim,
            disc,
            SurfaceVelocity {
                linear: Vec3::ZERO,
                angular: Vec3::Y * core::f32::consts::TAU,
            },
        );
        sim.seconds(3.0);
        let arm = sim.position(rider).with_y(0.0);
        found.near(format!("{hz} Hz: radius"), arm.length(), 2.0, 0.001);
    }
}

#[test]
fn a_platform_that_is_a_child_carries_too() {
    let mut found = Findings::new();
    for hz in RATES {
        // The child body of a plain parent that moves and turns, and the child collider of a body.
        for child_is_body in [true, false] {
            let mut sim = Sim::new(hz);
            let path = |t: f64| {
                let t = (t - 0.5).max(0.0);
                Transform::from_translation(DVec3::new(2.0 * t, 0.5 * t, 0.0).as_vec3())
                    .with_rotation(DQuat::from_rotation_y(0.8 * t).as_quat())
            };
            let mover = sim.moving(path);
            let parent = if child_is_body {
                sim.spawn((mover, Transform::IDENTITY))
            } else {
                sim.spawn((
                    mover,
                    Transform::IDENTITY,
                    RigidBody::KinematicPositionBased,
                ))
            };
            let offset = Transform::from_xyz(5.0, 1.0, 0.0);
            let deck = sim.spawn((board(), offset, ChildOf(parent)));
            if child_is_body {
                insert(&mut sim, deck, RigidBody::KinematicPositionBased);
            }
            let rider = runner(&mut sim, Vec3::new(5.5, 1.25, 0.0));
            sim.seconds(0.5);
            let (mut off, mut deck_off): (f32, f32) = (0.0, 0.0);
            for tick in 1..=(3.0 * hz) as usize {
                sim.ticks(1);
                let pose = path(0.5 + tick as f64 / hz);
                let at = sim.get::<GlobalTransform>(deck).translation();
                deck_off = deck_off.max(at.distance(pose.transform_point(offset.translation)));
                off = off.max(
                    sim.position(rider)
                        .distance(pose.transform_point(Vec3::new(5.5, 1.25, 0.0))),
                );
            }
            found.at_most(
                format!("{hz} Hz child is body {child_is_body}: deck off"),
                deck_off,
                0.001,
            );
            found.at_most(
                format!("{hz} Hz child is body {child_is_body}: off"),
                off,
                0.01,
            );
        }
    }
}

#[test]
fn a_ship_that_accelerates_keeps_its_crew_in_place() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        // Circles at up to 20 m/s and turns as it goes.
        let path = |t: f64| {
            let t = (t - 0.5).max(0.0);
            let angle = 0.2 * t * t;
            Transform::from_translation(
                DVec3::new(angle.cos() - 1.0, 0.0, angle.sin()).as_vec3() * 10.0,
            )
            .with_rotation(DQuat::from_rotation_y(-angle).as_quat())
        };
        let ship = sim.mover(slab(), path);
        let crew = runner(&mut sim, Vec3::new(1.5, 0.0, 1.0));
        sim.seconds(0.5);
        let (mut slip, mut off): (f32, usize) = (0.0, 0);
        for _ in 0..(5.0 * hz) as usize {
            sim.ticks(1);
            let pose = sim.get::<Transform>(ship);
            let local = pose.rotation.inverse() * (sim.position(crew) - pose.translation);
            slip = slip.max(local.distance(Vec3::new(1.5, 0.0, 1.0)));
            off += usize::from(!sim.state(crew).on_ground());
        }
        found.at_most(format!("{hz} Hz: slip"), slip, 0.003);
        found.at_most(format!("{hz} Hz: ticks off the deck"), off as f32, 0.0);
    }
}

#[test]
fn stepping_from_a_moving_platform_onto_land_stops_at_the_asked_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.mover(board(), later(|t| DVec3::X * 3.0 * t));
        // Land beside the platform's way, flush.
        sim.block(Vec3::new(0.0, -0.25, 13.0), Vec3::new(100.0, 1.0, 20.0));
        let rider = runner(&mut sim, Vec3::new(0.0, 0.25, 2.0));
        sim.seconds(1.0);
        sim.walk(rider, Vec3::Z * 0.5);
        sim.seconds(1.0);
        let before = sim.position(rider);
        sim.seconds(1.0);
        let moved = sim.position(rider) - before;
        found.near(format!("{hz} Hz: sideways"), moved.x, 0.0, 0.01);
        found.near(format!("{hz} Hz: forward"), moved.z, 2.5, 0.01);
        found.near(format!("{hz} Hz: height"), moved.y, 0.0, 0.002);
    }
}

#[test]
fn a_platform_that_moves_through_does_not_leave_the_rider_behind_after_a_restart() {
    // A platform that stops and starts again, many times.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let path = |t: f64| {
            let whole = t.floor();
            // Half a second of motion in each second.
            whole * 1.5 + (t - whole).min(0.5) * 3.0
        };
        let platform = sim.mover(board(), later(move |t| DVec3::new(path(t), 0.0, 0.0)));
        let rider = runner(&mut sim, Vec3::new(0.5, 0.25, 0.0));
        sim.seconds(0.5);
        let mut slip: f32 = 0.0;
        for _ in 0..(8.0 * hz) as usize {
            sim.ticks(1);
            let offset = sim.position(rider).x - sim.position(platform).x;
            slip = slip.max((offset - 0.5).abs());
        }
        found.at_most(format!("{hz} Hz: slip"), slip, 0.002);
    }
}
