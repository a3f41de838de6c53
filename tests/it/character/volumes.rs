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

#[test]
fn who_jumps_out_of_the_water_clears_a_bank_and_straight_up_only_hops() {
    let mut found = Findings::new();
    for hz in RATES {
        for (bank, wish) in [(0.0, Vec3::NEG_X), (0.3, Vec3::NEG_X), (0.3, Vec3::ZERO)] {
            let case = format!("{hz} Hz, bank {bank} m, {wish}");
            let mut sim = Sim::new(hz);
            pool(&mut sim, Vec3::ZERO);
            sim.block(
                Vec3::new(-15.0, bank - 1.0, 0.0),
                Vec3::new(10.0, 2.0, 40.0),
            );
            let who = runner(&mut sim, Vec3::new(-9.0, -2.5, 0.0));
            sim.seconds(0.2);
            sim.walk(who, wish);
            sim.intent(who, |intent| intent.jump = true);
            let high = highest(&mut sim, who, 2.0);
            sim.intent(who, |intent| intent.jump = false);
            sim.walk(who, Vec3::ZERO);
            sim.seconds(1.0);
            if wish == Vec3::ZERO {
                // Half of the jump height above where the waist comes out, 0.9 m up.
                found.near(format!("{case}: hops"), high, -0.9 + 0.6, 0.1);
            } else {
                let at = sim.position(who);
                found.near(format!("{case}: on the bank"), at.y, bank, 0.01);
                found.at_most(format!("{case}: behind the edge"), at.x, -10.0);
                found.near(format!("{case}: highest"), high, 0.6, 0.1);
            }
        }
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
fn a_ladder_leads_onto_the_ledge_wherever_above_it_its_volume_ends() {
    let mut found = Findings::new();
    for hz in RATES {
        for over in [0.0, 0.3, 0.9, 1.6] {
            for wish in [Vec3::X, Vec3::new(0.6, 0.8, 0.0)] {
                let case = format!("{hz} Hz, {over} m over the ledge, {wish}");
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                sim.block(Vec3::new(5.0, 1.5, 0.0), Vec3::new(10.0, 3.0, 10.0));
                let half = 0.5 * (3.0 + over);
                sim.spawn((
                    Collider::cuboid(0.5, half, 0.4),
                    Sensor,
                    Ladder,
                    Transform::from_xyz(-0.4, half, 0.0)
                        .with_rotation(Quat::from_rotation_y(-core::f32::consts::FRAC_PI_2)),
                ));
                let who = runner(&mut sim, Vec3::new(-1.0, 0.0, 0.0));
                sim.seconds(0.3);
                sim.walk(who, wish);
                let high = highest(&mut sim, who, 2.2);
                sim.walk(who, Vec3::ZERO);
                sim.seconds(0.7);
                found.near(format!("{case}: on top"), sim.position(who).y, 3.0, 0.02);
                found.at_least(format!("{case}: over the edge"), sim.position(who).x, 0.05);
                // The waist, 0.9 m up, leaves the volume within one tick, which the next one is told.
                let end = 3.0 + (over - 0.9f32).max(0.0) + 2.0 * 2.5 * sim.dt();
                found.at_most(format!("{case}: highest"), high, end + 0.06);
            }
        }
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

/// Sensors that mean nothing to a character, around a place.
fn other_sensors(sim: &mut Sim, at: Vec3) {
    for size in [2.0, 30.0] {
        sim.spawn((
            Collider::cuboid(size, size, size),
            Sensor,
            Transform::from_translation(at),
        ));
    }
}

#[test]
fn other_sensors_about_water_or_a_ladder_change_nothing() {
    let mut found = Findings::new();
    for hz in RATES {
        for first in [false, true] {
            let case = format!("{hz} Hz, others first {first}");
            let mut sim = Sim::new(hz);
            let at = Vec3::new(0.0, -2.0, 0.0);
            if first {
                other_sensors(&mut sim, at);
            }
            pool(&mut sim, Vec3::ZERO);
            if !first {
                other_sensors(&mut sim, at);
            }
            let who = runner(&mut sim, at);
            sim.seconds(0.5);
            found.holds(
                format!("{case}: swims"),
                sim.state(who).mode == MovementMode::Swim,
            );

            let mut sim = Sim::new(hz);
            let at = Vec3::new(-0.32, 2.0, 0.0);
            if first {
                other_sensors(&mut sim, at);
            }
            ladder(&mut sim);
            if !first {
                other_sensors(&mut sim, at);
            }
            let who = runner(&mut sim, Vec3::new(-2.0, 0.0, 0.0));
            sim.seconds(0.3);
            sim.walk(who, Vec3::X);
            sim.seconds(1.0);
            found.holds(
                format!("{case}: climbs"),
                sim.state(who).mode == MovementMode::Climb,
            );
        }
    }
}

#[test]
fn a_ladder_in_a_pool_is_climbed_by_who_swims_to_it() {
    let mut found = Findings::new();
    for hz in RATES {
        for ladder_first in [false, true] {
            let mut sim = Sim::new(hz);
            let ladder = (
                Collider::cuboid(0.4, 2.5, 0.5),
                Sensor,
                Ladder,
                // On the rim at x = -10; the climber is on its +X side.
                Transform::from_xyz(-9.6, -1.7, 0.0)
                    .with_rotation(Quat::from_rotation_y(core::f32::consts::FRAC_PI_2)),
            );
            if ladder_first {
                sim.spawn(ladder.clone());
            }
            pool(&mut sim, Vec3::ZERO);
            if !ladder_first {
                sim.spawn(ladder);
            }
            let who = runner(&mut sim, Vec3::new(-7.0, -2.0, 0.0));
            let case = format!("{hz} Hz, ladder first {ladder_first}");
            sim.seconds(0.5);
            found.holds(
                format!("{case}: swims"),
                sim.state(who).mode == MovementMode::Swim,
            );
            sim.walk(who, Vec3::NEG_X);
            sim.seconds(1.0);
            found.holds(
                format!("{case}: climbs"),
                sim.state(who).mode == MovementMode::Climb,
            );
            sim.seconds(2.5);
            found.near(format!("{case}: out"), sim.position(who).y, 0.0, 0.01);
            found.at_most(format!("{case}: on the rim"), sim.position(who).x, -10.0);
        }
    }
}

#[test]
fn who_stands_on_the_bottom_swims_when_there_is_water() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        pool(&mut sim, Vec3::X * 0.5);
        let who = runner(&mut sim, Vec3::new(0.0, -4.0, 0.0));
        sim.seconds(1.0);
        found.holds(
            format!("{hz} Hz: spawned on the bottom"),
            sim.state(who).mode == MovementMode::Swim,
        );
        found.at_least(
            format!("{hz} Hz: goes with the flow"),
            sim.position(who).x,
            0.3,
        );

        // A flood that rises over somebody who rests.
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(1.0);
        let path = sim.moving(|t| Transform::from_xyz(0.0, -2.5 + (0.5 * t).min(2.0) as f32, 0.0));
        sim.spawn((
            RigidBody::KinematicPositionBased,
            Collider::cuboid(20.0, 2.0, 20.0),
            Sensor,
            WaterVolume {
                flow: Vec3::Z * 0.5,
            },
            Transform::from_xyz(0.0, -2.5, 0.0),
            path,
        ));
        sim.seconds(1.0);
        found.holds(
            format!("{hz} Hz: wades"),
            sim.state(who).mode == MovementMode::Walk,
        );
        sim.seconds(5.0);
        found.holds(
            format!("{hz} Hz: flooded"),
            sim.state(who).mode == MovementMode::Swim,
        );
        found.at_least(format!("{hz} Hz: carried off"), sim.position(who).z, 0.3);

        // Water that is declared only later.
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let basin = sim.spawn((
            Collider::cuboid(20.0, 2.0, 20.0),
            Sensor,
            Transform::IDENTITY,
        ));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(1.0);
        insert(&mut sim, basin, WaterVolume::default());
        sim.ticks(3);
        found.holds(
            format!("{hz} Hz: declared later"),
            sim.state(who).mode == MovementMode::Swim,
        );
    }
}

#[test]
fn swimming_that_the_game_has_set_stays_until_the_game_ends_it() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::Y * 2.0);
        sim.ticks(2);
        edit::<CharacterState>(&mut sim, who, |state| state.mode = MovementMode::Swim);
        sim.walk(who, Vec3::Y);
        sim.seconds(1.0);
        found.holds(
            format!("{hz} Hz: swims on"),
            sim.state(who).mode == MovementMode::Swim,
        );
        let start = sim.position(who).y;
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: up"),
            sim.position(who).y - start,
            3.0,
            0.01,
        );
        edit::<CharacterState>(&mut sim, who, |state| state.mode = MovementMode::Walk);
        sim.walk(who, Vec3::ZERO);
        sim.seconds(3.0);
        found.near(format!("{hz} Hz: falls"), sim.position(who).y, 0.0, 0.001);
    }
}

#[test]
fn a_ladder_that_moves_takes_its_climber_along() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(-10.0);
        let ladder = sim.mover(Collider::cuboid(0.2, 4.0, 1.0), |t| {
            Transform::from_xyz((1.5 * t) as f32, 4.0, (0.5 * t) as f32)
        });
        let rungs = sim.spawn((
            Collider::cuboid(0.5, 4.0, 0.5),
            Sensor,
            Ladder,
            Transform::from_xyz(-0.6, 0.0, 0.0)
                .with_rotation(Quat::from_rotation_y(-core::f32::consts::FRAC_PI_2)),
            ChildOf(ladder),
        ));
        let _ = rungs;
        let who = runner(&mut sim, Vec3::new(-0.55, 2.0, 0.0));
        sim.walk(who, Vec3::X);
        sim.ticks(3);
        sim.walk(who, Vec3::ZERO);
        sim.seconds(0.5);
        let case = format!("{hz} Hz");
        found.holds(
            format!("{case}: climbs"),
            sim.state(who).mode == MovementMode::Climb,
        );
        let offset = sim.position(who) - sim.position(ladder);
        sim.seconds(2.0);
        found.at_most(
            format!("{case}: left behind"),
            (sim.position(who) - sim.position(ladder)).distance(offset),
            0.005,
        );
        // Up it goes at the speed of climbing, along with it.
        sim.walk(who, Vec3::Y);
        sim.seconds(0.4);
        let rise = sim.position(who) - sim.position(ladder) - offset;
        found.near(format!("{case}: climbs up"), rise.y, 1.0, 0.05);
        found.at_most(format!("{case}: beside"), rise.with_y(0.0).length(), 0.01);
        // Who jumps off keeps its velocity.
        sim.walk(who, Vec3::ZERO);
        sim.ticks(1);
        sim.intent(who, |intent| intent.jump = true);
        sim.ticks(1);
        found.near(
            format!("{case}: thrown off with it"),
            sim.state(who).velocity.z,
            0.5,
            0.01,
        );
    }
}
