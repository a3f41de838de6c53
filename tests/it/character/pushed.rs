//! Being pushed: bodies that run into a character, kinematic walls, opt-outs.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn a_body_that_runs_into_a_character_pushes_it_according_to_its_mass() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut moved = Vec::new();
        for mass in [1.0, 10.0, 70.0, 700.0] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            let floor = sim.floor(0.0);
            insert(&mut sim, floor, Friction::coefficient(0.0));
            let ball = sim.dynamic(
                Collider::ball(0.4),
                Transform::from_xyz(-2.0, 0.9, 0.0),
                mass,
            );
            insert(
                &mut sim,
                ball,
                (Velocity::linear(Vec3::X * 4.0), GravityScale(0.0)),
            );
            let target = sim.spawn((Character::default(), Transform::IDENTITY));
            sim.seconds(2.0);
            let pushed = sim.position(target).x;
            moved.push(pushed);
            let hits = take_events(&mut sim).hit;
            let case = format!("{hz} Hz {mass} kg");
            found.holds(
                format!("{case}: hit told"),
                hits.iter().any(|h| h.entity == target && h.other == ball),
            );
            found.holds(format!("{case}: finite"), finite(&sim, target));
            // No more than the ball brought along.
            found.at_most(format!("{case}: pushed"), pushed, 4.0 * 2.0);
            found.at_least(format!("{case}: pushed"), pushed, -0.001);
        }
        for pair in moved.windows(2) {
            found.holds(
                format!("{hz} Hz: a heavier ball pushes farther, {moved:?}"),
                pair[1] > pair[0],
            );
        }
        found.at_least(format!("{hz} Hz: 700 kg pushes"), moved[3], 0.2);
    }
}

#[test]
fn a_character_that_is_not_pushed_by_bodies_stands_like_a_rock() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = sim.floor(0.0);
        insert(&mut sim, floor, Friction::coefficient(0.0));
        let ball = sim.dynamic(
            Collider::ball(0.4),
            Transform::from_xyz(-2.0, 0.9, 0.0),
            700.0,
        );
        insert(
            &mut sim,
            ball,
            (Velocity::linear(Vec3::X * 4.0), GravityScale(0.0)),
        );
        let character = Character {
            pushed_by_bodies: false,
            ..default()
        };
        let rock = runner_with(&mut sim, character, Vec3::ZERO);
        sim.seconds(2.0);
        found.at_most(
            format!("{hz} Hz: moved"),
            sim.position(rock).length(),
            0.001,
        );
        // The engine lets a body of ten times the mass sink in a little.
        found.at_most(format!("{hz} Hz: ball stopped"), sim.position(ball).x, -0.6);
    }
}

#[test]
fn a_kinematic_wall_pushes_an_idle_character_along() {
    // Half (0.5, 2, 2) from x = -3 at 2 m/s: known to pass through an idle character elsewhere.
    let mut found = Findings::new();
    for hz in RATES {
        for idle in [0.0, 4.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let wall = sim.mover(Collider::cuboid(0.5, 2.0, 2.0), move |t| {
                Transform::from_xyz((-3.0 + 2.0 * (t - idle).max(0.0)) as f32, 2.0, 0.0)
            });
            let idler = runner(&mut sim, Vec3::ZERO);
            sim.seconds(idle);
            let mut overlap = f32::MIN;
            for _ in 0..(4.0 * hz) as usize {
                sim.ticks(1);
                overlap = overlap.max(sim.position(wall).x + 0.5 - (sim.position(idler).x - 0.3));
            }
            let case = format!("{hz} Hz idle {idle} s");
            found.at_most(format!("{case}: deepest overlap"), overlap, 0.01);
            found.near(
                format!("{case}: pushed to"),
                sim.position(idler).x,
                5.0 + 0.5 + 0.3,
                0.03,
            );
            found.near(format!("{case}: height"), sim.position(idler).y, 0.0, 0.002);
        }
    }
}

#[test]
fn a_body_that_cannot_be_pushed_pushes_like_a_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        for pushed in [true, false] {
            let mut sim = Sim::new(hz);
            let floor = sim.floor(0.0);
            insert(&mut sim, floor, Friction::coefficient(0.0));
            let block = sim.dynamic(
                Collider::cuboid(0.5, 0.5, 0.5),
                Transform::from_xyz(-2.0, 0.55, 0.0),
                20.0,
            );
            insert(
                &mut sim,
                block,
                (
                    Velocity::linear(Vec3::X * 2.0),
                    GravityScale(0.0),
                    LockedAxes::ROTATION_LOCKED,
                    NotPushable,
                ),
            );
            let idler = runner_with(
                &mut sim,
                Character {
                    pushed_by_bodies: pushed,
                    ..default()
                },
                Vec3::ZERO,
            );
            sim.seconds(2.0);
            let case = format!("{hz} Hz pushed {pushed}");
            if pushed {
                let gap = sim.position(idler).x - sim.position(block).x;
                found.near(format!("{case}: pushed ahead"), gap, 0.8, 0.02);
                found.near(
                    format!("{case}: block goes on"),
                    sim.position(block).x,
                    2.0,
                    0.05,
                );
            } else {
                found.near(format!("{case}: stays"), sim.position(idler).x, 0.0, 0.02);
            }
        }
    }
}
