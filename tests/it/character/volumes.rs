//! Water and ladders.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A pool 20 m square and 4 m deep with its surface at y = 0, and a rim around it.
fn pool(sim: &mut Sim, flow: Vec3) -> Entity {
    sim.floor(-4.0);
    sim.block(Vec3::new(-15.0, -2.0, 0.0), Vec3::new(10.0, 4.0, 40.0));
    sim.spawn((
        Collider::cuboid(10.0, 2.0, 10.0),
        Sensor,
        WaterVolume { flow },
        Transform::from_xyz(0.0, -2.0, 0.0),
    ))
}

#[test]
fn who_walks_into_water_swims_and_does_not_sink_like_a_stone() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        pool(&mut sim, Vec3::ZERO);
        let who = runner(&mut sim, Vec3::new(-12.0, 0.0, 0.0));
        sim.seconds(0.3);
        found.holds(
            format!("{hz} Hz: walks on land"),
            sim.state(who).mode == MovementMode::Walk,
        );
        sim.walk(who, Vec3::X);
        sim.seconds(1.5);
        found.holds(
            format!("{hz} Hz: swims in water"),
            sim.state(who).mode == MovementMode::Swim,
        );
        sim.walk(who, Vec3::ZERO);
        let mut low = f32::MAX;
        for _ in 0..(5.0 * hz) as usize {
            sim.ticks(1);
            low = low.min(sim.position(who).y);
        }
        found.at_least(format!("{hz} Hz: lowest foot"), low, -3.5);
        found.at_most(
            format!("{hz} Hz: at rest"),
            sim.state(who).velocity.length(),
            0.5,
        );
        found.at_least(
            format!("{hz} Hz: head near the surface or above"),
            sim.position(who).y,
            -2.6,
        );
        found.at_most(
            format!("{hz} Hz: does not walk on water"),
            sim.position(who).y,
            -0.4,
        );
    }
}

#[test]
fn swimming_goes_in_all_directions_at_the_swimming_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for way in [Vec3::X, Vec3::Z, Vec3::NEG_Y, Vec3::new(0.6, -0.8, 0.0)] {
            let mut sim = Sim::new(hz);
            sim.spawn((
                Collider::cuboid(50.0, 50.0, 50.0),
                Sensor,
                WaterVolume::default(),
                Transform::IDENTITY,
            ));
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.5);
            sim.walk(who, way);
            sim.seconds(1.0);
            let start = sim.position(who);
            sim.seconds(1.0);
            let moved = (sim.position(who) - start).dot(way);
            found.within(format!("{hz} Hz {way}"), moved, 3.0, 0.05);
        }
    }
}

#[test]
fn flowing_water_carries_swimmers() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.spawn((
            Collider::cuboid(50.0, 50.0, 50.0),
            Sensor,
            WaterVolume {
                flow: Vec3::new(1.5, 0.0, -0.5),
            },
            Transform::IDENTITY,
        ));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(2.0);
        let start = sim.position(who);
        sim.seconds(2.0);
        let moved = (sim.position(who) - start).with_y(0.0);
        found.at_most(
            format!("{hz} Hz: off"),
            moved.distance(Vec3::new(3.0, 0.0, -1.0)),
            0.15,
        );
    }
}

#[test]
fn who_leaves_the_water_walks_again() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let water = pool(&mut sim, Vec3::ZERO);
        let who = runner(&mut sim, Vec3::new(0.0, -2.0, 0.0));
        sim.seconds(0.5);
        found.holds(
            format!("{hz} Hz: swims"),
            sim.state(who).mode == MovementMode::Swim,
        );
        sim.app.world_mut().despawn(water);
        sim.seconds(2.0);
        found.holds(
            format!("{hz} Hz: drained"),
            sim.state(who).mode == MovementMode::Walk,
        );
        found.near(
            format!("{hz} Hz: on the bottom"),
            sim.position(who).y,
            -4.0,
            0.01,
        );
    }
}

/// A wall with its face at x = 0 (towards -X), 5 m high, a ladder on it, a platform on top.
fn ladder(sim: &mut Sim) {
    sim.floor(0.0);
    sim.block(Vec3::new(5.0, 2.5, 0.0), Vec3::new(10.0, 5.0, 10.0));
    sim.spawn((
        Collider::cuboid(0.5, 2.9, 0.4),
        Sensor,
        Ladder,
        // Local +Z to the climber: towards -X.
        Transform::from_xyz(-0.4, 2.9, 0.0)
            .with_rotation(Quat::from_rotation_y(-core::f32::consts::FRAC_PI_2)),
    ));
}

#[test]
fn a_ladder_is_climbed_up_at_its_speed_and_left_at_the_top() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        ladder(&mut sim);
        let who = runner(&mut sim, Vec3::new(-2.0, 0.0, 0.0));
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        found.holds(
            format!("{hz} Hz: climbs"),
            sim.state(who).mode == MovementMode::Climb,
        );
        sim.walk(who, Vec3::Y);
        sim.seconds(0.2);
        let start = sim.position(who).y;
        sim.seconds(0.5);
        found.within(
            format!("{hz} Hz: speed"),
            sim.position(who).y - start,
            1.25,
            0.02,
        );
        // Hangs on where it is when nothing is asked.
        sim.walk(who, Vec3::ZERO);
        sim.seconds(0.3);
        let hang = sim.position(who);
        sim.seconds(2.0);
        found.at_most(
            format!("{hz} Hz: hangs on"),
            sim.position(who).distance(hang),
            0.01,
        );
        // Up and over the top.
        sim.walk(who, Vec3::new(0.6, 0.8, 0.0));
        sim.seconds(2.5);
        sim.walk(who, Vec3::X * 0.2);
        sim.seconds(1.0);
        found.near(format!("{hz} Hz: on top"), sim.position(who).y, 5.0, 0.02);
        found.at_least(format!("{hz} Hz: over the edge"), sim.position(who).x, 0.1);
        found.holds(
            format!("{hz} Hz: walks"),
            sim.state(who).mode == MovementMode::Walk,
        );
    }
}

#[test]
fn a_ladder_is_climbed_down_to_the_floor_and_jumped_off() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        ladder(&mut sim);
        let who = runner(&mut sim, Vec3::new(-0.32, 3.0, 0.0));
        sim.walk(who, Vec3::new(0.1, -1.0, 0.0));
        sim.seconds(3.0);
        found.near(format!("{hz} Hz: down"), sim.position(who).y, 0.0, 0.02);
        // Up again and off.
        sim.walk(who, Vec3::new(0.6, 0.8, 0.0));
        sim.seconds(1.2);
        found.holds(
            format!("{hz} Hz: climbs"),
            sim.state(who).mode == MovementMode::Climb,
        );
        sim.walk(who, Vec3::NEG_X);
        sim.intent(who, |intent| intent.jump = true);
        sim.seconds(0.3);
        found.holds(
            format!("{hz} Hz: let go"),
            sim.state(who).mode == MovementMode::Walk,
        );
        sim.intent(who, |intent| intent.jump = false);
        sim.seconds(1.5);
        found.near(format!("{hz} Hz: landed"), sim.position(who).y, 0.0, 0.01);
        found.at_most(
            format!("{hz} Hz: away from the wall"),
            sim.position(who).x,
            -0.5,
        );
    }
}
