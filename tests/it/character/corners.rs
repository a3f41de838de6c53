//! Corners, funnels and creases of any angle: no swing, no reversal, no jitter.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::{Make, Sim};

use super::support::*;

const ANGLES: [f32; 5] = [30.0, 60.0, 90.0, 120.0, 150.0];

/// What happened while a character was held in a corner.
#[derive(Default)]
struct Held {
    /// Range of the motion across and along the corner's bisector after the first 5 ticks, metres.
    side: f32,
    along: f32,
    /// Ticks after the first 5 in which it moved against what was asked.
    reversals: usize,
}

fn hold(sim: &mut Sim, walker: Entity, push: Vec3, ticks: usize) -> Held {
    sim.walk(walker, push);
    let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
    let mut held = Held::default();
    let mut last = sim.position(walker);
    for tick in 0..ticks {
        sim.ticks(1);
        let now = sim.position(walker);
        if tick >= 5 {
            (low, high) = (low.min(now), high.max(now));
            held.reversals += usize::from((now - last).dot(push) < -1e-6);
        }
        last = now;
    }
    held.side = high.z - low.z;
    held.along = high.x - low.x;
    held
}

fn check(found: &mut Findings, case: &str, held: &Held) {
    found.at_most(format!("{case}: side movement"), held.side, 0.0001);
    found.at_most(format!("{case}: movement along"), held.along, 0.0001);
    found.at_most(format!("{case}: reversals"), held.reversals as f32, 0.0);
}

/// Where the foot of a character of radius 0.3 is when it touches both walls, from the apex.
fn seat(angle: f32) -> Vec3 {
    Vec3::NEG_X * (0.3 / ops::sin(angle * 0.5))
}

/// A character this far, metres, before it touches both walls of a corner of boxes.
fn before_corner(hz: f64, degrees: f32, gap: f32) -> (Sim, Entity) {
    let angle = degrees.to_radians();
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    sim.corner(Make::Boxes, Vec3::ZERO, angle);
    let walker = runner(&mut sim, seat(angle) + Vec3::NEG_X * gap);
    (sim, walker)
}

fn corner_held(make: Make) {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in ANGLES {
            let angle = degrees.to_radians();
            // Straight in, and from both sides as far as the corner holds it.
            let off = (90.0 - degrees * 0.5) * 0.6;
            for side in [0.0, off, -off] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                sim.corner(make, Vec3::ZERO, angle);
                let foot = seat(angle) + Vec3::NEG_X * 0.03;
                let walker = runner(&mut sim, foot);
                sim.seconds(0.2);
                let held = hold(&mut sim, walker, heading(side), 200);
                let case = format!("{hz} Hz {make:?} {degrees}° pushed at {side}°");
                check(&mut found, &case, &held);
                // It does go in.
                let gap = sim.position(walker).distance(seat(angle));
                found.at_most(
                    format!("{case}: away from the seat"),
                    gap,
                    0.022 / ops::sin(angle * 0.5),
                );
            }
        }
    }
}

#[test]
fn a_character_held_in_a_corner_of_boxes_rests() {
    corner_held(Make::Boxes);
}

#[test]
fn a_character_held_in_a_corner_of_triangles_rests() {
    corner_held(Make::Mesh);
}

#[test]
fn running_into_a_corner_does_not_swing_from_wall_to_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in ANGLES {
            let (mut sim, walker) = before_corner(hz, degrees, 1.0);
            sim.seconds(0.2);
            sim.walk(walker, Vec3::X);
            // One metre of run-up and the first touch; then the 200 ticks.
            sim.ticks((hz * 0.2).ceil() as usize);
            let held = hold(&mut sim, walker, Vec3::X, 200);
            check(
                &mut found,
                &format!("{hz} Hz {degrees}° after a run"),
                &held,
            );
        }
    }
}

#[test]
fn leaving_a_corner_is_as_fast_as_on_open_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in ANGLES {
            let (mut sim, walker) = before_corner(hz, degrees, 0.01);
            sim.walk(walker, Vec3::X);
            sim.seconds(0.5);
            let start = sim.position(walker).x;
            sim.walk(walker, Vec3::NEG_X);
            sim.seconds(0.5);
            let moved = start - sim.position(walker).x;
            found.within(format!("{hz} Hz {degrees}°"), moved, SPEED * 0.5, 0.002);
        }
    }
}

#[test]
fn a_corner_that_turns_away_is_rounded_without_a_stop() {
    // A convex corner of 90°: glides along one side, then along the other.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(-5.0, 1.0, -5.0), Vec3::new(10.0, 2.0, 10.0));
        let walker = runner(&mut sim, Vec3::new(-2.0, 0.0, 0.32));
        sim.seconds(0.2);
        sim.walk(walker, heading(-45.0));
        let mut slowest = f32::MAX;
        for _ in 0..hz as usize {
            let before = sim.position(walker);
            sim.ticks(1);
            slowest = slowest.min(before.distance(sim.position(walker)) * hz as f32);
        }
        found.at_least(format!("{hz} Hz: slowest"), slowest, SPEED * ops::cos(0.8));
        found.at_least(
            format!("{hz} Hz: past the corner"),
            sim.position(walker).x,
            0.3,
        );
        found.at_most(format!("{hz} Hz: round it"), sim.position(walker).z, -0.5);
    }
}

#[test]
fn a_wedge_of_floor_and_low_ceiling_is_no_trap() {
    // An acute wedge: the ceiling comes down to 1.5 m ahead; it must stop and be able to go back.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let tilt = Quat::from_rotation_z(-20f32.to_radians());
        sim.fixed(
            bevy_rapier3d::prelude::Collider::cuboid(5.0, 0.25, 5.0),
            Transform::from_translation(Vec3::new(0.0, 2.2, 0.0) + tilt * Vec3::Y * 0.25)
                .with_rotation(tilt),
        );
        let walker = runner(&mut sim, Vec3::new(-3.0, 0.0, 0.0));
        sim.seconds(0.2);
        sim.walk(walker, Vec3::X);
        sim.seconds(2.0);
        let held = hold(&mut sim, walker, Vec3::X, 200);
        let case = format!("{hz} Hz");
        check(&mut found, &case, &held);
        let (deep, _) = depth(&mut sim, walker);
        found.at_most(format!("{case}: depth"), deep, 0.001);
        let start = sim.position(walker).x;
        sim.walk(walker, Vec3::NEG_X);
        sim.seconds(0.4);
        found.within(
            format!("{case}: way back"),
            start - sim.position(walker).x,
            2.0,
            0.01,
        );
    }
}

/// Steep walls around a point, each at this angle from level, all facing it.
fn funnel(sim: &mut Sim, walls: usize, degrees: f32) {
    for i in 0..walls {
        let turn = Quat::from_rotation_y(core::f32::consts::TAU * i as f32 / walls as f32);
        let tilt = turn * Quat::from_rotation_z(degrees.to_radians());
        let center = tilt * Vec3::new(4.0, -0.5, 0.0);
        sim.fixed(
            bevy_rapier3d::prelude::Collider::cuboid(5.0, 0.5, 8.0),
            Transform::from_translation(center).with_rotation(tilt),
        );
    }
}

#[test]
fn a_funnel_of_steep_walls_ends_the_fall() {
    let mut found = Findings::new();
    for hz in RATES {
        for walls in [2, 3, 4] {
            let mut sim = Sim::new(hz);
            funnel(&mut sim, walls, 60.0);
            let faller = sim.character(Character::default(), Vec3::new(0.4, 3.0, 0.2));
            sim.seconds(4.0);
            let case = format!("{hz} Hz {walls} walls");
            let before = sim.position(faller);
            let mut grounded = 0;
            for _ in 0..100 {
                sim.ticks(1);
                grounded += usize::from(sim.state(faller).on_ground());
            }
            found.at_most(
                format!("{case}: creep"),
                before.distance(sim.position(faller)),
                0.001,
            );
            found.at_least(
                format!("{case}: ticks on ground of 100"),
                grounded as f32,
                100.0,
            );
            let speed = sim.state(faller).velocity.length();
            found.at_most(format!("{case}: speed kept"), speed, 0.01);
            let (deep, _) = depth(&mut sim, faller);
            found.at_most(format!("{case}: depth"), deep, 0.001);
            // It is ground: a jump works.
            sim.intent(faller, |intent| intent.jump = true);
            let mut high = f32::MIN;
            for _ in 0..(hz * 0.6) as usize {
                sim.ticks(1);
                high = high.max(sim.position(faller).y);
            }
            found.near(format!("{case}: jump"), high - before.y, 1.2, 0.05);
        }
    }
}

#[test]
fn pushing_around_in_a_funnel_never_builds_up_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        funnel(&mut sim, 4, 60.0);
        let walker = runner(&mut sim, Vec3::new(0.0, 2.0, 0.0));
        sim.seconds(2.0);
        let mut fastest: f32 = 0.0;
        for i in 0..300 {
            sim.walk(walker, heading(i as f32 * 7.0));
            let before = sim.position(walker);
            sim.ticks(1);
            fastest = fastest.max(before.distance(sim.position(walker)) * hz as f32);
        }
        found.at_most(format!("{hz} Hz: fastest"), fastest, SPEED * 1.001);
    }
}
