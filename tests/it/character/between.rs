//! Between things that move and things that give way; grooves; edits under one who rests.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Patch, Sim};

use super::support::*;

#[test]
fn a_wall_pushes_a_character_along_whoever_stands_behind() {
    let mut found = Findings::new();
    for hz in RATES {
        for behind in ["nobody", "a friend", "a crate"] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let wall = sim.mover(Collider::cuboid(0.5, 2.0, 2.0), |t| {
                Transform::from_xyz((-1.5 + 0.5 * (t - 0.5).max(0.0)) as f32, 2.0, 0.0)
            });
            let pushed = runner(&mut sim, Vec3::ZERO);
            match behind {
                "a friend" => {
                    runner(&mut sim, Vec3::X * 0.62);
                }
                "a crate" => {
                    let at = Transform::from_xyz(0.82, 0.5, 0.0);
                    let crate_ = sim.dynamic(Collider::cuboid(0.5, 0.5, 0.5), at, 20.0);
                    insert(&mut sim, crate_, LockedAxes::ROTATION_LOCKED);
                }
                _ => {}
            }
            let mut deep = f32::MIN;
            for _ in 0..(5.0 * hz) as usize {
                sim.ticks(1);
                deep = deep.max(depth_in(&sim, pushed, wall));
            }
            found.at_most(format!("{hz} Hz {behind}: depth"), deep, 0.01);
            found.at_least(
                format!("{hz} Hz {behind}: pushed to"),
                sim.position(pushed).x,
                -1.5 + 0.5 * 4.5 + 0.5 + 0.29,
            );
        }
    }
}

#[test]
fn a_lift_raises_its_rider_with_a_load_on_the_head() {
    let mut found = Findings::new();
    for hz in RATES {
        for load in ["a friend", "a crate"] {
            let mut sim = Sim::new(hz);
            let lift = sim.mover(Collider::cuboid(1.5, 0.25, 1.5), |t| {
                Transform::from_xyz(0.0, (1.0 * (t - 0.5).max(0.0)) as f32, 0.0)
            });
            let rider = runner(&mut sim, Vec3::Y * 0.25);
            if load == "a friend" {
                runner(&mut sim, Vec3::Y * 2.07);
            } else {
                let at = Transform::from_xyz(0.0, 2.3, 0.0);
                let crate_ = sim.dynamic(Collider::cuboid(0.5, 0.2, 0.5), at, 20.0);
                insert(&mut sim, crate_, LockedAxes::ROTATION_LOCKED);
            }
            let mut off: f32 = 0.0;
            for _ in 0..(2.0 * hz) as usize {
                sim.ticks(1);
                off = off.max((sim.position(rider).y - sim.position(lift).y - 0.25).abs());
            }
            found.at_most(format!("{hz} Hz {load}: off the lift"), off, 0.02);
        }
    }
}

#[test]
fn a_door_that_swings_takes_along_who_stands_in_its_way() {
    let mut found = Findings::new();
    for hz in RATES {
        for rate in [0.5, 1.0, 2.0, 4.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let door = sim.mover(
                Collider::compound(vec![(
                    Vec3::X,
                    Quat::IDENTITY,
                    Collider::cuboid(1.0, 1.5, 0.04),
                )]),
                move |t| {
                    let angle = (rate * (t - 0.5).max(0.0)).min(1.5);
                    Transform::from_xyz(0.0, 1.55, 0.0)
                        .with_rotation(Quat::from_rotation_y(-angle as f32))
                },
            );
            let who = runner(&mut sim, Vec3::new(1.2, 0.0, 0.5));
            let mut deep = f32::MIN;
            for _ in 0..((0.5 + 1.5 / rate + 0.5) * hz) as usize {
                sim.ticks(1);
                deep = deep.max(depth_in(&sim, who, door));
            }
            let case = format!("{hz} Hz {rate} rad/s");
            found.at_most(format!("{case}: depth"), deep, 0.01);
            // On the side that the door came to, not behind it.
            found.at_least(format!("{case}: side"), sim.position(who).z, 0.3);
        }
    }
}

#[test]
fn a_deck_that_rolls_about_an_axis_far_below_keeps_its_rider() {
    let mut found = Findings::new();
    for hz in RATES {
        for peak in [0.2, 1.0, 4.0] {
            let mut sim = Sim::new(hz);
            let path = move |t: f64| {
                let angle = 0.3 * ((t - 0.5).max(0.0) * peak / 0.3).sin();
                Transform::from_rotation(Quat::from_rotation_z(angle as f32))
            };
            let deck = Collider::compound(vec![(
                Vec3::Y * 2.75,
                Quat::IDENTITY,
                Collider::cuboid(3.0, 0.25, 3.0),
            )]);
            sim.mover(deck, path);
            let rider = runner(&mut sim, Vec3::Y * 3.0);
            sim.seconds(0.5);
            let mut slip: f32 = 0.0;
            for tick in 1..=(4.0 * hz) as usize {
                sim.ticks(1);
                let pose = path(0.5 + tick as f64 / hz);
                slip = slip.max(
                    sim.position(rider)
                        .distance(pose.transform_point(Vec3::Y * 3.0)),
                );
            }
            // A round foot that stands upright leans on the deck beside its lowest point.
            found.at_most(format!("{hz} Hz {peak} rad/s: slip"), slip, 0.03);
        }
    }
}

#[test]
fn who_stands_on_a_log_that_turns_is_carried_off() {
    let mut found = Findings::new();
    for hz in RATES {
        for rate in [0.5, 3.0] {
            let mut sim = Sim::new(hz);
            sim.mover(Collider::cylinder(3.0, 0.8), move |t| {
                Transform::from_rotation(
                    Quat::from_rotation_z((-rate * (t - 0.5).max(0.0)) as f32)
                        * Quat::from_rotation_x(core::f32::consts::FRAC_PI_2),
                )
            });
            let who = runner(&mut sim, Vec3::Y * 0.8);
            sim.seconds(0.5 + 0.5 / rate);
            // After half a radian the top has gone 0.4 m along its arc.
            let arm = sim.position(who).x;
            found.at_least(format!("{hz} Hz {rate} rad/s: carried"), arm, 0.3);
        }
    }
}

#[test]
fn a_steep_groove_is_walked_along_at_full_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in [55.0f32, 65.0, 75.0] {
            for yaw in [0.0, 0.3, 1.1] {
                let mut sim = Sim::new(hz);
                let angle = degrees.to_radians();
                let (sin, cos) = ops::sin_cos(angle);
                let turn = Quat::from_rotation_y(yaw);
                // Two slopes that rise to both sides of a level line along +Z.
                let mut mesh = Patch::default();
                let along = turn * Vec3::Z * 30.0;
                let (left, right) = (
                    turn * Vec3::new(-cos, sin, 0.0) * 4.0,
                    turn * Vec3::new(cos, sin, 0.0) * 4.0,
                );
                let start = turn * Vec3::Z * -5.0;
                mesh.add(start, along, right, 15, 2);
                mesh.add(start + left, along, -left, 15, 2);
                sim.fixed(mesh.collider(), Transform::IDENTITY);
                // The ball of the foot touches both sides.
                let foot = Vec3::Y * (0.3 / cos - 0.3 + 0.001);
                let walker = runner(&mut sim, foot);
                sim.seconds(0.3);
                let from = sim.position(walker);
                sim.walk(walker, turn * Vec3::Z);
                sim.seconds(2.0);
                let case = format!("{hz} Hz {degrees}° yaw {yaw}");
                let way = sim.position(walker) - from;
                found.within(format!("{case}: way"), way.dot(turn * Vec3::Z), 10.0, 0.01);
            }
        }
    }
}

#[test]
fn a_slope_limit_set_lower_acts_on_who_stands() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let tilt = 40f32.to_radians();
        sim.fixed(
            Collider::cuboid(20.0, 0.5, 20.0),
            Transform::from_rotation(Quat::from_rotation_z(tilt)),
        );
        let (_, normal) = slope_axes(tilt);
        let who = runner(&mut sim, foot_on_slope(normal * 0.5, tilt, 0.3));
        sim.seconds(1.0);
        let from = sim.position(who);
        edit::<Character>(&mut sim, who, |config| {
            config.max_slope = 20f32.to_radians();
        });
        sim.seconds(1.0);
        let slid = sim.position(who).distance(from);
        found.within(
            format!("{hz} Hz: slid"),
            slid,
            // The slide begins a tick after the edit.
            0.5 * G * ops::sin(tilt) * (1.0 - 1.0 / hz as f32).powi(2),
            0.02,
        );
    }
}

#[test]
fn ground_that_shrinks_lets_its_rester_down() {
    let mut found = Findings::new();
    for hz in RATES {
        for scaled in [false, true] {
            let mut sim = Sim::new(hz);
            let floor = sim.fixed(
                Collider::cuboid(200.0, 0.5, 200.0),
                Transform::from_xyz(0.0, -0.5, 0.0),
            );
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(1.0);
            if scaled {
                edit::<Transform>(&mut sim, floor, |pose| pose.scale.y = 0.5);
            } else {
                insert(&mut sim, floor, Collider::cuboid(200.0, 0.25, 200.0));
            }
            sim.seconds(1.0);
            found.near(
                format!("{hz} Hz scaled {scaled}: foot"),
                sim.position(who).y,
                -0.25,
                0.002,
            );
        }
    }
}
