//! A facing that the game writes, as a first-person camera does.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// How far the facing is turned about +Y from -Z, radians.
fn yaw(sim: &Sim, who: Entity) -> f32 {
    let ahead = sim.get::<Transform>(who).rotation * Vec3::NEG_Z;
    ops::atan2(-ahead.x, -ahead.z)
}

fn turn(sim: &mut Sim, who: Entity, degrees: f32) {
    edit::<Transform>(sim, who, |t| t.rotate_y(degrees.to_radians()));
}

#[test]
fn a_slow_turn_by_the_game_is_kept_while_walking_and_while_standing() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, shape) in [
            ("capsule", Character::capsule(0.3, 1.8)),
            ("box", Character::cuboid(0.6, 1.8, 0.4)),
        ] {
            for way in [Vec3::ZERO, Vec3::X] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let who = runner_with(&mut sim, shape.clone(), Vec3::ZERO);
                sim.seconds(0.2);
                sim.walk(who, way);
                let start = sim.position(who);
                for _ in 0..200 {
                    turn(&mut sim, who, 0.05);
                    sim.ticks(1);
                }
                let case = format!("{hz} Hz {name} {way}");
                found.near(
                    format!("{case}: turned"),
                    yaw(&sim, who).to_degrees(),
                    10.0,
                    0.02,
                );
                found.near(
                    format!("{case}: walked"),
                    (sim.position(who) - start).dot(way),
                    way.length() * SPEED * 200.0 / hz as f32,
                    0.005,
                );
            }
        }
    }
}

#[test]
fn turning_the_character_keeps_it_on_the_platform_it_rides() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in [0.05, 2.0] {
            let mut sim = Sim::new(hz);
            let platform = sim.mover(Collider::cuboid(3.0, 0.25, 3.0), |t| {
                Transform::from_xyz((3.0 * (t - 0.5).max(0.0)) as f32, -0.25, 0.0)
            });
            let who = runner(&mut sim, Vec3::new(0.5, 0.0, 0.5));
            sim.seconds(1.0);
            let offset = sim.position(who) - sim.position(platform);
            let mut slowest = f32::MAX;
            for _ in 0..(2.0 * hz) as usize {
                turn(&mut sim, who, degrees);
                sim.ticks(1);
                slowest = slowest.min(sim.state(who).platform_velocity.x);
            }
            let case = format!("{hz} Hz {degrees}° a tick");
            found.at_most(
                format!("{case}: slipped"),
                (sim.position(who) - sim.position(platform)).distance(offset),
                0.002,
            );
            found.near(format!("{case}: platform velocity"), slowest, 3.0, 0.01);
        }
    }
}

#[test]
fn turning_the_character_on_a_turntable_adds_to_the_turntables_own_turn() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let table = sim.mover(Collider::cylinder(0.25, 3.0), |t| {
            Transform::from_xyz(0.0, -0.25, 0.0)
                .with_rotation(Quat::from_rotation_y(0.5 * t as f32))
        });
        let who = runner(&mut sim, Vec3::new(2.0, 0.0, 0.0));
        sim.seconds(0.5);
        let start = yaw(&sim, who);
        let place = sim.get::<Transform>(table).rotation.inverse() * sim.position(who);
        for _ in 0..hz as usize {
            turn(&mut sim, who, 30.0 / hz as f32);
            sim.ticks(1);
        }
        found.near(
            format!("{hz} Hz: turned"),
            (yaw(&sim, who) - start).to_degrees(),
            30.0 + 0.5f32.to_degrees(),
            0.1,
        );
        let now = sim.get::<Transform>(table).rotation.inverse() * sim.position(who);
        found.at_most(format!("{hz} Hz: slipped"), now.distance(place), 0.003);
    }
}

#[test]
fn a_facing_is_turned_to_only_at_a_turn_rate() {
    let mut found = Findings::new();
    for hz in RATES {
        for (rate, wanted) in [(None, 0.0), (Some(1.0), 0.5), (Some(100.0), 1.2)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let who = runner(&mut sim, Vec3::ZERO);
            edit::<CharacterMotor>(&mut sim, who, |motor| motor.turn_rate = rate);
            sim.seconds(0.5);
            let facing = Quat::from_rotation_y(1.2) * Vec3::NEG_Z;
            sim.intent(who, |intent| intent.facing = Some(facing));
            sim.seconds(0.5);
            found.near(format!("{hz} Hz {rate:?}"), yaw(&sim, who), wanted, 0.001);
        }
    }
}
