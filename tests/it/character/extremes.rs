//! Tunnelling, crushing, overlaps, bad input, things that vanish: always a defined, finite state.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Patch, Sim};

use super::{support::*, warnings};

/// Runs a raw character at a thin wall at x = 3 and returns how far its middle came.
fn shoot(hz: f64, speed: f32, wall: &Collider, degrees: f32, floor: bool) -> f32 {
    let mut sim = Sim::new(hz);
    if floor {
        sim.floor(0.0);
    }
    sim.fixed(wall.clone(), Transform::from_xyz(3.0, 0.0, 0.0));
    let shot = raw(&mut sim, Vec3::ZERO);
    sim.ticks(2);
    let mut far = f32::MIN;
    // Until it must have come to the wall, and a little on.
    let way = speed * ops::cos(degrees.to_radians()) * sim.dt();
    for _ in 0..(4.0 / way).ceil() as usize + 2 {
        set_velocity(&mut sim, shot, heading(degrees) * speed);
        sim.ticks(1);
        far = far.max(sim.position(shot).x);
    }
    far
}

#[test]
fn nothing_is_fast_enough_to_pass_a_wall_a_millimetre_thick() {
    let mut found = Findings::new();
    let sheet = Patch::new(
        Vec3::new(0.0, -400.0, -400.0),
        Vec3::Z * 800.0,
        Vec3::Y * 800.0,
        7,
        7,
    );
    let walls = [
        ("box", Collider::cuboid(0.0005, 400.0, 400.0)),
        ("mesh", sheet.collider()),
    ];
    for hz in RATES {
        for (name, wall) in &walls {
            for speed in [30.0, 300.0, 3000.0] {
                for degrees in [0.0, 40.0, 75.0] {
                    for floor in [true, false] {
                        let far = shoot(hz, speed, wall, degrees, floor);
                        let case =
                            format!("{hz} Hz {name} {speed} m/s at {degrees}° floor {floor}");
                        found.at_most(format!("{case}: came to x"), far, 2.7 + 0.0015);
                        if degrees == 0.0 {
                            found.at_least(format!("{case}: came to x"), far, 2.7 - 0.025);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_fall_at_300_metres_per_second_ends_on_a_floor_a_millimetre_thick() {
    let mut found = Findings::new();
    for hz in RATES {
        for mesh in [true, false] {
            let mut sim = Sim::new(hz);
            if mesh {
                let sheet = Patch::new(
                    Vec3::new(-50.0, 0.0, -50.0),
                    Vec3::Z * 100.0,
                    Vec3::X * 100.0,
                    3,
                    3,
                );
                sim.fixed(sheet.collider(), Transform::IDENTITY);
            } else {
                sim.block(Vec3::NEG_Y * 0.0005, Vec3::new(100.0, 0.001, 100.0));
            }
            let faller = sim.spawn((
                Character::default(),
                CharacterMotor {
                    max_fall_speed: 300.0,
                    ..default()
                },
                Transform::from_xyz(0.3, 40.0, 0.2),
            ));
            sim.ticks(2);
            set_velocity(&mut sim, faller, Vec3::NEG_Y * 300.0);
            sim.seconds(1.0);
            let case = format!("{hz} Hz mesh {mesh}");
            found.near(
                format!("{case}: height"),
                sim.position(faller).y,
                0.0,
                0.002,
            );
            found.holds(format!("{case}: on ground"), sim.state(faller).on_ground());
        }
    }
}

#[test]
fn a_wall_that_closes_crushes_and_lets_go_again() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [0.5, 3.0, 20.0] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            sim.floor(0.0);
            // A fixed wall with its face at x = 0.3, a door that closes on it and opens again.
            let fixed = sim.block(Vec3::new(0.8, 2.0, 0.0), Vec3::new(1.0, 4.0, 8.0));
            let open = 4.0;
            let door = sim.mover(Collider::cuboid(0.5, 2.0, 4.0), move |t| {
                let closed =
                    (speed * t).min(open) - (speed * (t - open / speed - 1.0)).clamp(0.0, open);
                Transform::from_xyz((-0.5 + 0.2 - open + closed) as f32, 2.0, 0.0)
            });
            let who = runner(&mut sim, Vec3::new(-0.2, 0.0, 0.0));
            let (mut deep, mut crushed_ticks) = (f32::MIN, 0);
            for _ in 0..((open / speed + 0.9) * hz) as usize {
                sim.ticks(1);
                deep = deep.max(depth_in(&sim, who, fixed));
                crushed_ticks += usize::from(sim.state(who).crushed);
            }
            let case = format!("{hz} Hz {speed} m/s");
            let told = take_events(&mut sim).crushed;
            found.near(format!("{case}: Crushed told"), told.len() as f32, 1.0, 0.0);
            if let Some(told) = told.first() {
                found.holds(format!("{case}: entity"), told.entity == who);
                found.holds(format!("{case}: by the door"), told.by == door);
                found.holds(
                    format!("{case}: against the wall"),
                    told.against == Some(fixed),
                );
                found.at_least(format!("{case}: depth told"), told.depth, 0.0);
            }
            found.at_least(format!("{case}: ticks crushed"), crushed_ticks as f32, 1.0);
            found.at_most(format!("{case}: deepest in the fixed wall"), deep, 0.001);
            found.holds(format!("{case}: finite"), finite(&sim, who));
            // The door opens: free again, and not thrown.
            sim.seconds(1.0 + open / speed);
            found.holds(format!("{case}: still crushed"), !sim.state(who).crushed);
            let foot = sim.position(who);
            found.near(format!("{case}: height afterwards"), foot.y, 0.0, 0.002);
            found.at_most(format!("{case}: x afterwards"), foot.x, 0.001);
            found.at_least(format!("{case}: x afterwards"), foot.x, -1.5);
            sim.walk(who, Vec3::Z);
            let start = sim.position(who).z;
            sim.seconds(0.5);
            found.within(
                format!("{case}: walks again"),
                sim.position(who).z - start,
                2.5,
                0.02,
            );
        }
    }
}

#[test]
fn a_lift_crushes_against_a_ceiling_and_not_through_it() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [0.5, 3.0] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            let roof = sim.block(Vec3::Y * 3.5, Vec3::new(8.0, 1.0, 8.0));
            let lift = sim.mover(Collider::cuboid(2.0, 0.25, 2.0), move |t| {
                Transform::from_xyz(0.0, (-0.25 + (speed * t).min(2.0)) as f32, 0.0)
            });
            let who = runner(&mut sim, Vec3::ZERO);
            let mut deep = f32::MIN;
            for _ in 0..((2.0 / speed + 0.5) * hz) as usize {
                sim.ticks(1);
                deep = deep.max(depth_in(&sim, who, roof));
            }
            let told = take_events(&mut sim).crushed;
            let case = format!("{hz} Hz {speed} m/s");
            found.near(format!("{case}: Crushed told"), told.len() as f32, 1.0, 0.0);
            found.holds(
                format!("{case}: by the lift against the roof"),
                told.first()
                    .is_some_and(|c| c.by == lift && c.against == Some(roof)),
            );
            found.at_most(format!("{case}: deepest in the roof"), deep, 0.001);
            found.holds(format!("{case}: finite"), finite(&sim, who));
        }
    }
}

#[test]
fn a_character_that_starts_inside_a_box_comes_out_at_the_recovery_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for recovery in [0.5, 3.0] {
            for (name, push, velocity) in [
                ("idle", Vec3::ZERO, Vec3::ZERO),
                ("pushing in", Vec3::NEG_X, Vec3::NEG_X * SPEED),
            ] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let block = sim.block(Vec3::new(-1.0, 2.0, 0.0), Vec3::new(2.0, 4.0, 10.0));
                // 0.2 m deep: the face is at x = 0.
                let character = Character {
                    recovery_speed: recovery,
                    ..default()
                };
                let who = sim.spawn((character, prompt(), Transform::from_xyz(0.1, 0.0, 0.0)));
                sim.walk(who, push);
                let mut fastest: f32 = 0.0;
                let time = f64::from(0.2 / recovery);
                for _ in 0..(time * 0.5 * hz).floor() as usize {
                    let before = sim.position(who).x;
                    sim.ticks(1);
                    fastest = fastest.max((sim.position(who).x - before) * hz as f32);
                }
                let case = format!("{hz} Hz {name} recovery {recovery} {velocity}");
                found.at_most(format!("{case}: fastest"), fastest, recovery * 1.01);
                sim.seconds(time * 1.5 + 0.1);
                found.at_most(format!("{case}: depth"), depth_in(&sim, who, block), 0.001);
                found.near(format!("{case}: x"), sim.position(who).x, 0.3, 0.025);
                found.near(format!("{case}: height"), sim.position(who).y, 0.0, 0.002);
                found.at_most(
                    format!("{case}: launched"),
                    sim.state(who).velocity.length(),
                    0.01,
                );
            }
        }
    }
}

#[test]
fn a_start_inside_anything_ends_outside_or_at_rest() {
    let mut found = Findings::new();
    for hz in RATES {
        for case in 0..6 {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let name = match case {
                0 => {
                    sim.block(Vec3::Y, Vec3::splat(2.0));
                    "middle of a box"
                }
                1 => {
                    let mut mesh = Patch::default();
                    mesh.add_box(Vec3::Y, Vec3::splat(2.0));
                    sim.fixed(mesh.collider(), Transform::IDENTITY);
                    "middle of a closed mesh"
                }
                2 => {
                    let mesh = Patch::terrain(20, 0.5, |x, z| 0.3 * ops::sin(x + z));
                    sim.fixed(mesh.collider(), Transform::from_xyz(-5.0, 0.5, -5.0));
                    "across a terrain mesh"
                }
                3 => {
                    sim.wall(Make::Mesh, Vec3::new(-3.0, 0.0, 0.0), Vec3::X, 6.0, 3.0);
                    "across a sheet"
                }
                4 => {
                    for i in 0..4 {
                        for j in 0..11 {
                            for k in 0..11 {
                                let at = Vec3::new(j as f32 - 5.0, i as f32 + 0.5, k as f32 - 5.0)
                                    * 0.25;
                                sim.block(at, Vec3::splat(0.2));
                            }
                        }
                    }
                    "a grid of small boxes"
                }
                _ => {
                    sim.character(Character::default(), Vec3::ZERO);
                    "another character"
                }
            };
            let who = runner(&mut sim, Vec3::new(0.02, 0.01, 0.03));
            let mut farthest: f32 = 0.0;
            let mut always_finite = true;
            for _ in 0..(3.0 * hz) as usize {
                let before = sim.position(who);
                sim.ticks(1);
                farthest = farthest.max(sim.position(who).distance(before) * hz as f32);
                always_finite &= finite(&sim, who);
            }
            let case = format!("{hz} Hz {name}");
            found.holds(format!("{case}: finite"), always_finite);
            // Recovery is at 3 m/s; a fall from the top of the box adds some.
            found.at_most(format!("{case}: fastest"), farthest, 8.0);
            found.at_least(
                format!("{case}: above the floor"),
                sim.position(who).y,
                -0.002,
            );
            let before = sim.position(who);
            sim.seconds(1.0);
            found.at_most(
                format!("{case}: at rest"),
                sim.position(who).distance(before),
                0.01,
            );
        }
    }
}

#[test]
fn inside_a_closed_mesh_box_all_walls_hold_from_the_inside() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let mut mesh = Patch::default();
        mesh.add_box(Vec3::Y * 2.0, Vec3::new(6.0, 4.0, 6.0));
        sim.fixed(mesh.collider(), Transform::IDENTITY);
        let who = runner(&mut sim, Vec3::new(0.3, 0.2, 0.1));
        let mut stayed = true;
        for i in 0..8 {
            sim.walk(who, heading(i as f32 * 50.0));
            sim.intent(who, |intent| intent.jump = i % 2 == 0);
            for _ in 0..hz as usize {
                sim.ticks(1);
                let foot = sim.position(who);
                stayed &= foot.x.abs() < 2.701 && foot.z.abs() < 2.701 && foot.y > -0.002;
            }
        }
        found.holds(format!("{hz} Hz: stayed inside"), stayed);
    }
}

#[test]
fn a_kilometre_below_the_world_a_character_just_falls() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::NEG_Y * 1000.0);
        sim.seconds(20.0);
        found.holds(format!("{hz} Hz: finite"), finite(&sim, who));
        // The fall is limited to 100 m/s, reached after 10.2 s and 510 m.
        let wanted = -1000.0 - 509.7 - 100.0 * (20.0 - 10.194);
        found.within(
            format!("{hz} Hz: fell to"),
            sim.position(who).y,
            wanted,
            0.01,
        );
        found.holds(
            format!("{hz} Hz: in the air"),
            sim.state(who).ground.state == GroundState::InAir,
        );
    }
}

#[test]
fn paused_time_changes_nothing_and_then_goes_on() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(0.3);
        sim.app.world_mut().resource_mut::<Time<Virtual>>().pause();
        let (before, state) = (sim.position(who), sim.state(who));
        for _ in 0..10 {
            sim.app.update();
        }
        found.holds(format!("{hz} Hz: position"), sim.position(who) == before);
        found.holds(format!("{hz} Hz: state"), sim.state(who) == state);
        sim.app
            .world_mut()
            .resource_mut::<Time<Virtual>>()
            .unpause();
        sim.seconds(0.5);
        found.within(
            format!("{hz} Hz: goes on"),
            sim.position(who).x - before.x,
            2.5,
            0.001,
        );
    }
}

/// When in a tick something vanishes.
#[derive(Clone, Copy, Debug)]
enum When {
    Between,
    FixedUpdate,
    AfterSync,
    AfterDrive,
}

/// What is to be taken away in the next tick.
#[derive(Resource)]
struct Doomed(Option<(Entity, bool)>);

fn take_away(world: &mut World) {
    if let Some((entity, whole)) = world.resource_mut::<Doomed>().0.take() {
        if whole {
            world.despawn(entity);
        } else {
            world.entity_mut(entity).remove::<Collider>();
        }
    }
}

fn vanish(sim: &mut Sim, entity: Entity, whole: bool, when: When) {
    sim.app.insert_resource(Doomed(Some((entity, whole))));
    match when {
        When::Between => take_away(sim.app.world_mut()),
        When::FixedUpdate => {
            sim.app.add_systems(FixedUpdate, take_away);
        }
        When::AfterSync => {
            sim.app.add_systems(
                FixedPostUpdate,
                take_away
                    .after(PhysicsSet::SyncBackend)
                    .before(EmbodySystems::Drive),
            );
        }
        When::AfterDrive => {
            sim.app.add_systems(
                FixedPostUpdate,
                take_away
                    .after(EmbodySystems::Drive)
                    .before(PhysicsSet::StepSimulation),
            );
        }
    }
}

#[test]
fn a_platform_or_pushed_body_or_collider_may_vanish_at_any_moment() {
    let mut found = Findings::new();
    for hz in RATES {
        for when in [
            When::Between,
            When::FixedUpdate,
            When::AfterSync,
            When::AfterDrive,
        ] {
            for whole in [true, false] {
                for what in ["lift", "crate", "crate stood on"] {
                    let mut sim = Sim::new(hz);
                    warnings::unique_entities(&mut sim);
                    sim.floor(-5.0);
                    let lift = sim.mover(Collider::cuboid(5.0, 0.25, 5.0), |t| {
                        Transform::from_xyz(t as f32, -0.25, 0.0)
                    });
                    let crate_ = sim.dynamic(
                        Collider::cuboid(0.5, 0.5, 0.5),
                        Transform::from_xyz(1.0, 0.5, 0.0),
                        50.0,
                    );
                    let foot = if what == "crate stood on" {
                        Vec3::new(1.0, 1.0, 0.0)
                    } else {
                        Vec3::ZERO
                    };
                    let who = runner(&mut sim, foot);
                    sim.seconds(0.5);
                    if what == "crate" {
                        sim.walk(who, Vec3::X * 0.5);
                        sim.seconds(0.3);
                    }
                    vanish(
                        &mut sim,
                        if what == "lift" { lift } else { crate_ },
                        whole,
                        when,
                    );
                    let mut always = true;
                    for _ in 0..(hz * 1.5) as usize {
                        sim.ticks(1);
                        always &= finite(&sim, who);
                    }
                    let case = format!("{hz} Hz {what} whole {whole} {when:?}");
                    found.holds(format!("{case}: finite"), always);
                    if what == "lift" {
                        found.near(
                            format!("{case}: fell to the floor"),
                            sim.position(who).y,
                            -5.0,
                            0.01,
                        );
                    }
                    let told = warnings::about(who);
                    found.at_most(format!("{case}: warnings {told:?}"), told.len() as f32, 1.0);
                }
            }
        }
    }
}

#[test]
fn a_teleport_is_taken_as_it_is() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // A wall in between must not stop a teleport.
        sim.block(Vec3::new(5.0, 2.0, 0.0), Vec3::new(1.0, 4.0, 20.0));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        sim.place(who, Vec3::new(10.0, 0.0, 3.0));
        sim.ticks(1);
        found.at_most(
            format!("{hz} Hz: off"),
            sim.position(who).distance(Vec3::new(10.0, 0.0, 3.0)),
            0.001,
        );
        sim.place(who, Vec3::new(0.0, 3.0, 0.0));
        sim.ticks(1);
        found.near(format!("{hz} Hz: up"), sim.position(who).y, 3.0, 0.02);
        sim.seconds(2.0);
        found.near(
            format!("{hz} Hz: falls from there"),
            sim.position(who).y,
            0.0,
            0.002,
        );
    }
}

#[test]
fn the_tick_rate_may_change_at_any_time() {
    let mut found = Findings::new();
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let who = runner(&mut sim, Vec3::ZERO);
    sim.seconds(0.5);
    sim.walk(who, Vec3::X);
    for hz in [30.0, 240.0, 20.0, 144.0, 60.0] {
        sim.set_hz(hz);
        sim.ticks(1);
        let start = sim.position(who).x;
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz"),
            sim.position(who).x - start,
            SPEED,
            0.001,
        );
    }
}
