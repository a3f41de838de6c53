//! Half-spaces: floors without an end.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

fn half_space(sim: &mut Sim, normal: Vec3) -> Entity {
    let collider = Collider::halfspace(normal).expect("a normal");
    sim.fixed(collider, Transform::IDENTITY)
}

#[test]
fn a_half_space_is_landed_on_stood_on_and_walked_on() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        half_space(&mut sim, Vec3::Y);
        let who = runner(&mut sim, Vec3::new(0.0, 0.5, 0.0));
        sim.seconds(1.0);
        let start = sim.position(who);
        found.holds(format!("{hz} Hz: on ground"), sim.state(who).on_ground());
        found.near(format!("{hz} Hz: foot"), start.y, 0.0, 0.001);
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: stands still"),
            sim.position(who).distance(start),
            0.0,
        );
        sim.walk(who, Vec3::X);
        sim.seconds(2.0);
        let moved = sim.position(who) - start;
        found.within(format!("{hz} Hz: walked"), moved.x, 10.0, 0.001);
        found.near(format!("{hz} Hz: height"), moved.y, 0.0, 0.0005);
        // A crate on it, far away, is found as on any floor.
        let crate_ = sim.dynamic(
            Collider::cuboid(0.3, 0.3, 0.3),
            Transform::from_xyz(20.0, 0.3, 0.0),
            30.0,
        );
        sim.seconds(3.0);
        found.at_least(format!("{hz} Hz: pushed"), sim.position(crate_).x, 20.2);
    }
}

#[test]
fn every_shape_stands_on_a_half_space_that_leans() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, shape) in [
            ("capsule", Character::capsule(0.3, 1.8)),
            ("cylinder", Character::cylinder(0.3, 1.8)),
            ("box", Character::cuboid(0.6, 1.8, 0.4)),
        ] {
            let mut sim = Sim::new(hz);
            let angle = 20f32.to_radians();
            half_space(&mut sim, Vec3::new(-ops::sin(angle), ops::cos(angle), 0.0));
            let who = runner_with(&mut sim, shape, Vec3::new(0.0, 1.0, 0.0));
            sim.seconds(1.5);
            let start = sim.position(who);
            let case = format!("{hz} Hz {name}");
            found.holds(format!("{case}: on ground"), sim.state(who).on_ground());
            sim.seconds(2.0);
            found.at_most(
                format!("{case}: slides"),
                sim.position(who).distance(start),
                0.0005,
            );
        }
    }
}

#[test]
fn a_velocity_beyond_all_bounds_neither_hangs_nor_ends_in_nowhere() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [1.0e6, 3.0e8, 1.0e30] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let who = raw(&mut sim, Vec3::ZERO);
            sim.seconds(0.2);
            set_velocity(&mut sim, who, Vec3::new(speed, 0.0, speed));
            sim.seconds(0.2);
            found.holds(format!("{hz} Hz {speed} m/s: finite"), finite(&sim, who));
        }
    }
}
