//! What is kept of a platform's velocity by who leaves it.

use core::f64::consts::TAU;

use bevy::{
    math::{DQuat, DVec3, ops},
    prelude::*,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Jumps off a platform that moves with `velocity`; returns the velocity in the world a moment later.
fn leave(hz: f64, velocity: DVec3, rule: LeaveVelocity) -> Vec3 {
    let mut sim = Sim::new(hz);
    sim.mover(board(), later(move |t| velocity * t));
    let rider = runner_with(
        &mut sim,
        Character {
            leave_velocity: rule,
            ..default()
        },
        Vec3::Y * 0.25,
    );
    sim.seconds(1.0);
    sim.intent(rider, |intent| intent.jump = true);
    // No air control, so that only physics counts.
    edit::<CharacterMotor>(&mut sim, rider, |motor| {
        motor.air_acceleration = 0.0;
        motor.friction = 0.0;
    });
    sim.ticks(1);
    sim.state(rider).world_velocity()
}

#[test]
fn leaving_a_platform_keeps_as_much_of_its_velocity_as_configured() {
    let mut found = Findings::new();
    let jump = ops::sqrt(2.0 * G * 1.2);
    for hz in RATES {
        for (rule, x, y) in [
            (LeaveVelocity::Full, 3.0, 1.0),
            (LeaveVelocity::None, 0.0, 0.0),
            (LeaveVelocity::UpOnly, 0.0, 1.0),
        ] {
            let got = leave(hz, DVec3::new(3.0, 1.0, 0.0), rule);
            let case = format!("{hz} Hz {rule:?}");
            found.near(format!("{case}: sideways"), got.x, x, 0.02);
            found.near(format!("{case}: up"), got.y, y + jump, 0.03 + G / hz as f32);
            // Downward velocity of the platform is never kept by `UpOnly`.
            let got = leave(hz, DVec3::new(0.0, -1.0, 0.0), rule);
            let down = if rule == LeaveVelocity::Full {
                -1.0
            } else {
                0.0
            };
            found.near(
                format!("{case}: down"),
                got.y,
                down + jump,
                0.03 + G / hz as f32,
            );
        }
    }
}

#[test]
fn a_jump_from_a_turning_disc_keeps_the_tangent_velocity() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let rate = TAU * 0.25;
        let disc = sim.mover(Collider::cylinder(0.25, 4.0), move |t| {
            Transform::from_rotation(DQuat::from_rotation_y(rate * (t - 0.5).max(0.0)).as_quat())
        });
        let rider = runner(&mut sim, Vec3::new(3.0, 0.25, 0.0));
        edit::<CharacterMotor>(&mut sim, rider, |motor| motor.air_acceleration = 0.0);
        sim.seconds(1.0);
        sim.intent(rider, |intent| intent.jump = true);
        let turn = sim.get::<Transform>(disc).rotation;
        sim.seconds(0.4);
        let speed = 3.0 * rate as f32;
        let tangent = turn * Vec3::NEG_Z;
        let velocity = sim.state(rider).world_velocity().with_y(0.0);
        found.within(format!("{hz} Hz: speed"), velocity.length(), speed, 0.02);
        // The tangent at take-off, up to the turn of a tick.
        let off = velocity.normalize_or_zero().distance(tangent);
        found.at_most(
            format!("{hz} Hz: direction off"),
            off,
            0.01 + rate as f32 / hz as f32,
        );
    }
}

#[test]
fn a_jump_on_a_sinking_lift_is_not_pulled_back() {
    let mut found = Findings::new();
    for hz in RATES {
        for (sink, height) in [(3.0, 0.3), (3.0, 0.46), (1.0, 0.05)] {
            let mut sim = Sim::new(hz);
            let lift = sim.mover(board(), later(move |t| DVec3::NEG_Y * sink * t));
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            edit::<CharacterMotor>(&mut sim, rider, |motor| motor.jump_height = height);
            sim.seconds(1.0);
            sim.intent(rider, |intent| intent.jump = true);
            let mut high = f32::MIN;
            let time = 2.0 * f64::from(ops::sqrt(2.0 * height / G));
            for _ in 0..(time * hz).ceil() as usize {
                sim.ticks(1);
                high = high.max(sim.position(rider).y - sim.position(lift).y - 0.25);
            }
            // In the frame of the lift the jump has its full height.
            let case = format!("{hz} Hz sinking {sink}, jump {height}");
            let sampled = G / (8.0 * (hz * hz) as f32);
            found.near(case, high, height, 0.01 + sampled);
        }
    }
}

#[test]
fn stepping_from_a_platform_onto_other_ground_keeps_as_much_as_configured() {
    let mut found = Findings::new();
    for hz in RATES {
        for (rule, x) in [
            (LeaveVelocity::Full, 3.0),
            (LeaveVelocity::None, 0.0),
            (LeaveVelocity::UpOnly, 0.0),
        ] {
            // The other ground stands still, or goes along beside.
            for along in [false, true] {
                let mut sim = Sim::new(hz);
                let way = |z: f64| later(move |t| DVec3::new(3.0 * t, -0.25, z));
                sim.mover(board(), way(0.0));
                if along {
                    sim.mover(board(), way(6.0));
                } else {
                    sim.block(Vec3::new(0.0, -0.5, 23.0), Vec3::new(100.0, 1.0, 40.0));
                }
                let who = sim.spawn((
                    Character {
                        leave_velocity: rule,
                        ..default()
                    },
                    // On its own it keeps the velocity that it has.
                    CharacterMotor {
                        acceleration: 0.0,
                        friction: 0.0,
                        ..default()
                    },
                    Transform::from_xyz(0.0, 0.0, 2.0),
                ));
                sim.seconds(1.0);
                set_velocity(&mut sim, who, Vec3::Z * 2.0);
                sim.seconds(1.0);
                let state = sim.state(who);
                let case = format!("{hz} Hz {rule:?} along {along}");
                found.holds(format!("{case}: on ground"), state.on_ground());
                found.at_least(format!("{case}: over"), sim.position(who).z, 3.5);
                found.near(
                    format!("{case}: sideways"),
                    state.velocity.x,
                    if along { 0.0 } else { x },
                    0.02,
                );
                // Along the ground the length of the velocity is kept, so only the heading counts.
                found.at_least(format!("{case}: ahead"), state.velocity.z, 1.5);
            }
        }
    }
}
