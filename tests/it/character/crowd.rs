//! Characters among characters: they collide, in an order that does not matter.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Deepest overlap of any two upright capsules of radius 0.3, metres.
fn overlap(sim: &Sim, crowd: &[Entity]) -> f32 {
    let feet: Vec<Vec3> = crowd.iter().map(|&who| sim.position(who)).collect();
    let mut deepest = f32::MIN;
    for (i, a) in feet.iter().enumerate() {
        for b in &feet[..i] {
            let gap = *a - *b;
            // The axes of the capsules are 1.2 m long.
            let rise = (gap.y.abs() - 1.2).max(0.0);
            deepest = deepest.max(0.6 - Vec3::new(gap.x, rise, gap.z).length());
        }
    }
    deepest
}

#[test]
fn two_characters_that_walk_at_each_other_stop_in_the_middle() {
    let mut found = Findings::new();
    for hz in RATES {
        for yaw in [0.0, 33.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let along = heading(yaw);
            let pair = [
                runner(&mut sim, -along * 2.0),
                runner(&mut sim, along * 2.0),
            ];
            sim.seconds(0.3);
            sim.walk(pair[0], along);
            sim.walk(pair[1], -along);
            let mut deepest = f32::MIN;
            // They meet after 0.34 s. Later any rounding would lead them past each other.
            for _ in 0..(0.6 * hz) as usize {
                sim.ticks(1);
                deepest = deepest.max(overlap(&sim, &pair));
            }
            let case = format!("{hz} Hz {yaw}°");
            let (a, b) = (sim.position(pair[0]), sim.position(pair[1]));
            found.at_most(format!("{case}: deepest overlap"), deepest, 0.01);
            found.at_most(
                format!("{case}: overlap at rest"),
                overlap(&sim, &pair),
                0.001,
            );
            found.near(format!("{case}: gap"), a.distance(b), 0.6, 0.045);
            found.at_most(
                format!("{case}: middle off"),
                ((a + b) * 0.5).with_y(0.0).length(),
                0.005,
            );
            found.at_most(format!("{case}: risen"), a.y.max(b.y), 0.002);
        }
    }
}

#[test]
fn a_character_walks_round_a_standing_one() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let idler = runner(&mut sim, Vec3::ZERO);
        let walker = runner(&mut sim, Vec3::new(-2.0, 0.0, 0.2));
        sim.seconds(0.3);
        sim.walk(walker, Vec3::X);
        let mut deepest = f32::MIN;
        for _ in 0..(2.0 * hz) as usize {
            sim.ticks(1);
            deepest = deepest.max(overlap(&sim, &[idler, walker]));
        }
        found.at_most(format!("{hz} Hz: deepest overlap"), deepest, 0.005);
        found.at_least(format!("{hz} Hz: passed"), sim.position(walker).x, 1.0);
        found.at_most(
            format!("{hz} Hz: the other moved"),
            sim.position(idler).length(),
            0.001,
        );
    }
}

#[test]
fn following_at_the_same_speed_is_no_collision() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let queue: Vec<Entity> = (0..6)
            .map(|i| runner(&mut sim, Vec3::X * (i as f32 * 0.65)))
            .collect();
        sim.seconds(0.3);
        for &who in &queue {
            sim.walk(who, Vec3::X);
        }
        // Each may wait for the one before it to be seen moving; then all are as fast as one alone.
        sim.seconds(0.5);
        let start: Vec<f32> = queue.iter().map(|&who| sim.position(who).x).collect();
        sim.seconds(3.0);
        for (i, (&who, start)) in queue.iter().zip(start).enumerate() {
            found.within(
                format!("{hz} Hz number {i}"),
                sim.position(who).x - start,
                15.0,
                0.005,
            );
        }
    }
}

/// Fifty characters that all walk to the middle; `order` is the order in which they are spawned.
fn gather(hz: f64, seconds: f64, order: &[usize]) -> (Sim, Vec<Entity>) {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    let mut crowd = vec![Entity::PLACEHOLDER; order.len()];
    let place = |i: usize| Vec3::new((i % 7) as f32 * 1.3 - 4.0, 0.0, (i / 7) as f32 * 1.1 - 4.0);
    for &i in order {
        crowd[i] = runner(&mut sim, place(i));
    }
    sim.seconds(0.2);
    for (i, &who) in crowd.iter().enumerate() {
        sim.walk(who, -place(i).normalize_or_zero() * 0.8);
    }
    sim.seconds(seconds);
    (sim, crowd)
}

#[test]
fn a_crowd_that_gathers_does_not_pile_up_or_interpenetrate() {
    let mut found = Findings::new();
    let order: Vec<usize> = (0..50).collect();
    for hz in RATES {
        let (mut sim, crowd) = gather(hz, 0.0, &order);
        let mut deepest = f32::MIN;
        for _ in 0..(4.0 * hz) as usize {
            sim.ticks(1);
            deepest = deepest.max(overlap(&sim, &crowd));
        }
        let highest = crowd
            .iter()
            .map(|&who| sim.position(who).y)
            .fold(f32::MIN, f32::max);
        found.at_most(format!("{hz} Hz: deepest overlap"), deepest, 0.02);
        found.at_most(
            format!("{hz} Hz: overlap at the end"),
            overlap(&sim, &crowd),
            0.005,
        );
        found.at_most(format!("{hz} Hz: highest foot"), highest, 0.002);
        let fastest = crowd
            .iter()
            .map(|&who| sim.state(who).velocity.length())
            .fold(0.0, f32::max);
        found.at_most(format!("{hz} Hz: fastest"), fastest, SPEED * 0.81);
    }
}

#[test]
fn the_order_in_which_characters_are_spawned_does_not_matter() {
    let mut found = Findings::new();
    let straight: Vec<usize> = (0..50).collect();
    let mixed: Vec<usize> = (0..50).map(|i| (i * 17 + 5) % 50).collect();
    for hz in [30.0, 120.0] {
        let (a, crowd_a) = gather(hz, 2.0, &straight);
        let (b, crowd_b) = gather(hz, 2.0, &mixed);
        let differ = crowd_a
            .iter()
            .zip(&crowd_b)
            .filter(|(x, y)| a.get::<Transform>(**x) != b.get::<Transform>(**y))
            .count();
        found.at_most(
            format!("{hz} Hz: characters that differ in any bit"),
            differ as f32,
            0.0,
        );
    }
}

#[test]
fn a_character_stands_on_the_head_of_another() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let flat = Character::cylinder(0.3, 1.8);
        let lower = runner_with(&mut sim, flat.clone(), Vec3::ZERO);
        let upper = runner_with(&mut sim, flat, Vec3::new(0.05, 2.0, 0.0));
        sim.seconds(2.0);
        found.near(
            format!("{hz} Hz: upper foot"),
            sim.position(upper).y,
            1.8,
            0.025,
        );
        found.near(
            format!("{hz} Hz: lower foot"),
            sim.position(lower).y,
            0.0,
            0.002,
        );
        found.holds(format!("{hz} Hz: on ground"), sim.state(upper).on_ground());
        found.holds(
            format!("{hz} Hz: the ground is the other"),
            sim.state(upper).ground.entity == Some(lower),
        );
    }
}

#[test]
fn a_character_despawned_in_a_crowd_leaves_the_rest_in_order() {
    let mut found = Findings::new();
    let order: Vec<usize> = (0..50).collect();
    let (mut sim, crowd) = gather(60.0, 1.0, &order);
    for &who in crowd.iter().step_by(3) {
        sim.app.world_mut().despawn(who);
        sim.ticks(1);
    }
    sim.seconds(1.0);
    let rest: Vec<Entity> = crowd
        .iter()
        .copied()
        .enumerate()
        .filter(|(i, _)| i % 3 != 0)
        .map(|(_, e)| e)
        .collect();
    found.at_most("overlap", overlap(&sim, &rest), 0.005);
    found.holds("finite", rest.iter().all(|&who| finite(&sim, who)));
}
