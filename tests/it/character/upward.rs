//! Any up: upside down, turned worlds, planets, ships, and the turning from one up to another.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Sim, Stairs};

use super::support::*;

fn set_gravity(sim: &mut Sim, gravity: Vec3) {
    let world = sim.app.world_mut();
    let mut query = world.query::<&mut RapierConfiguration>();
    for mut config in query.iter_mut(world) {
        config.gravity = gravity;
    }
}

fn up_at_once(direction: UpDirection) -> CharacterUp {
    CharacterUp {
        direction,
        turn_rate: f32::INFINITY,
    }
}

#[test]
fn upside_down_a_ceiling_is_a_floor() {
    let mut found = Findings::new();
    for hz in RATES {
        for (direction, name) in [
            (UpDirection::World(Vec3::NEG_Y), "world"),
            (UpDirection::AgainstGravity, "against gravity"),
        ] {
            let mut sim = Sim::new(hz);
            set_gravity(&mut sim, Vec3::Y * G);
            sim.block(Vec3::new(0.0, 0.7, 0.0), Vec3::new(50.0, 0.2, 50.0));
            let who = runner(&mut sim, Vec3::ZERO);
            insert(&mut sim, who, up_at_once(direction));
            sim.seconds(1.5);
            let case = format!("{hz} Hz {name}");
            found.holds(format!("{case}: on ground"), sim.state(who).on_ground());
            found.near(format!("{case}: foot"), sim.position(who).y, 0.6, 0.001);
            let start = sim.position(who);
            sim.walk(who, Vec3::X);
            sim.seconds(2.0);
            let moved = sim.position(who) - start;
            found.within(format!("{case}: walked"), moved.x, 10.0, 0.001);
            found.near(format!("{case}: height"), moved.y, 0.0, 0.0005);
            sim.intent(who, |intent| intent.jump = true);
            let mut high = f32::MIN;
            for _ in 0..(hz as usize) {
                sim.ticks(1);
                high = high.max(start.y - sim.position(who).y);
            }
            found.near(format!("{case}: jump"), high, 1.2, 0.004);
        }
    }
}

/// A course of a floor, a wall to glide along, steps and a ramp, turned by `turn`; where a walker ends.
fn turned_course(hz: f64, turn: Quat) -> Vec<Vec3> {
    let mut sim = Sim::new(hz);
    let up = turn * Vec3::Y;
    set_gravity(&mut sim, -up * G);
    let base = Transform::from_rotation(turn);
    let stairs = Stairs {
        steps: 5,
        rise: 0.2,
        tread: 0.4,
        width: 8.0,
        landing: 5.0,
        make: Make::Boxes,
        ceiling: None,
    };
    sim.stairs(&stairs, base);
    sim.fixed(
        Collider::cuboid(5.0, 3.0, 0.5),
        base * Transform::from_xyz(-2.0, 2.0, -0.9),
    );
    let who = sim.spawn((
        Character::default(),
        prompt(),
        up_at_once(UpDirection::AgainstGravity),
        base * Transform::from_xyz(-4.0, 0.0, 0.0),
    ));
    sim.seconds(0.5);
    let mut path = Vec::new();
    for (degrees, time, jump) in [(-20.0, 1.0, false), (15.0, 0.5, true), (-5.0, 0.5, false)] {
        sim.intent(who, |intent| {
            intent.movement = turn * heading(degrees);
            intent.jump = jump;
        });
        sim.seconds(time);
        path.push(turn.inverse() * sim.position(who));
    }
    path
}

#[test]
fn a_turned_world_gives_the_same_walk_turned() {
    let mut found = Findings::new();
    for hz in RATES {
        let plain = turned_course(hz, Quat::IDENTITY);
        for (name, turn) in [
            (
                "quarter about z",
                Quat::from_rotation_z(core::f32::consts::FRAC_PI_2),
            ),
            ("half about x", Quat::from_rotation_x(core::f32::consts::PI)),
            ("skew", Quat::from_euler(EulerRot::XYZ, 0.7, -1.1, 2.3)),
        ] {
            let turned = turned_course(hz, turn);
            for (i, (a, b)) in plain.iter().zip(&turned).enumerate() {
                found.at_most(
                    format!("{hz} Hz {name} leg {i}: apart"),
                    a.distance(*b),
                    0.005,
                );
            }
        }
    }
}

#[test]
fn a_planet_is_walked_round() {
    let mut found = Findings::new();
    for hz in RATES {
        let (center, radius) = (Vec3::new(10.0, -20.0, 5.0), 20.0);
        let mut sim = Sim::new(hz);
        sim.fixed(Collider::ball(radius), Transform::from_translation(center));
        let who = runner(&mut sim, center + Vec3::Y * radius);
        edit::<CharacterMotor>(&mut sim, who, |motor| motor.gravity = Some(G));
        insert(&mut sim, who, up_at_once(UpDirection::AwayFrom(center)));
        sim.seconds(0.5);
        let (mut low, mut high, mut off) = (f32::MAX, f32::MIN, 0);
        let mut angle = 0.0;
        for _ in 0..(8.0 * hz) as usize {
            let before = (sim.position(who) - center).normalize();
            // Always onwards in the plane x y.
            sim.walk(who, before.cross(Vec3::Z));
            sim.ticks(1);
            let arm = sim.position(who) - center;
            low = low.min(arm.length());
            high = high.max(arm.length());
            angle += ops::atan2(before.cross(arm).length(), before.dot(arm));
            off += usize::from(!sim.state(who).on_ground());
            let up = sim.get::<Transform>(who).rotation * Vec3::Y;
            off += usize::from(up.distance(arm.normalize()) > 0.02);
        }
        found.near(format!("{hz} Hz: lowest"), low, radius, 0.005);
        found.near(format!("{hz} Hz: highest"), high, radius, 0.005);
        found.at_most(
            format!("{hz} Hz: ticks off ground or not upright"),
            off as f32,
            0.0,
        );
        // 40 m on a circle of 20 m.
        found.within(format!("{hz} Hz: way round"), angle, 2.0, 0.005);
    }
}

#[test]
fn standing_on_the_side_of_a_planet_does_not_drift() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.fixed(Collider::ball(15.0), Transform::IDENTITY);
        let out = Vec3::new(1.0, -0.6, 0.3).normalize();
        let who = runner(&mut sim, out * 15.2);
        edit::<CharacterMotor>(&mut sim, who, |motor| motor.gravity = Some(G));
        insert(&mut sim, who, up_at_once(UpDirection::AwayFrom(Vec3::ZERO)));
        sim.seconds(1.0);
        let start = sim.position(who);
        sim.seconds(10.0);
        found.at_most(
            format!("{hz} Hz: drift"),
            sim.position(who).distance(start),
            0.001,
        );
        found.holds(format!("{hz} Hz: on ground"), sim.state(who).on_ground());
    }
}

#[test]
fn a_new_up_is_turned_to_at_the_asked_rate() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let motor = CharacterMotor {
            gravity: Some(0.0),
            ..default()
        };
        let who = sim.spawn((
            Character::default(),
            motor,
            CharacterUp {
                direction: UpDirection::World(Vec3::Y),
                turn_rate: 1.0,
            },
            Transform::IDENTITY,
        ));
        sim.seconds(0.2);
        edit::<CharacterUp>(&mut sim, who, |up| {
            up.direction = UpDirection::World(Vec3::X);
        });
        sim.seconds(0.7);
        let up = sim.state(who).up;
        let turned = ops::acos(up.dot(Vec3::Y).clamp(-1.0, 1.0));
        found.near(
            format!("{hz} Hz: turned in 0.7 s"),
            turned,
            0.7,
            1.1 / hz as f32,
        );
        let rotation = sim.get::<Transform>(who).rotation;
        found.at_most(
            format!("{hz} Hz: pose follows"),
            (rotation * Vec3::Y).distance(up),
            1e-3,
        );
        sim.seconds(1.5);
        found.at_most(
            format!("{hz} Hz: arrived"),
            sim.state(who).up.distance(Vec3::X),
            1e-3,
        );
        // Right over, where no axis is better than another.
        edit::<CharacterUp>(&mut sim, who, |up| {
            up.direction = UpDirection::World(Vec3::NEG_X);
        });
        sim.seconds(4.0);
        found.at_most(
            format!("{hz} Hz: turned over"),
            sim.state(who).up.distance(Vec3::NEG_X),
            1e-3,
        );
    }
}

#[test]
fn on_a_ship_that_rolls_and_turns_the_deck_stays_down() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        // The whole loop in about 8 s, with roll and way.
        let path = |t: f64| {
            let t = (t - 0.5).max(0.0);
            let turn = bevy::math::DQuat::from_rotation_z(0.8 * t)
                * bevy::math::DQuat::from_rotation_x(0.3 * t.sin());
            Transform::from_xyz((5.0 * t) as f32, (2.0 * t.sin()) as f32, 0.0)
                .with_rotation(turn.as_quat())
        };
        let ship = sim.mover(Collider::cuboid(5.0, 0.25, 5.0), path);
        let crew = runner(&mut sim, Vec3::new(1.0, 0.25, 0.5));
        edit::<CharacterMotor>(&mut sim, crew, |motor| motor.gravity = Some(G));
        insert(&mut sim, crew, up_at_once(UpDirection::Of(ship, Vec3::Y)));
        sim.seconds(0.5);
        let (mut slip, mut off): (f32, usize) = (0.0, 0);
        for _ in 0..(6.0 * hz) as usize {
            sim.ticks(1);
            let pose = sim.get::<Transform>(ship);
            let local = pose.rotation.inverse() * (sim.position(crew) - pose.translation);
            slip = slip.max(local.distance(Vec3::new(1.0, 0.25, 0.5)));
            off += usize::from(!sim.state(crew).on_ground());
        }
        found.at_most(format!("{hz} Hz: slip"), slip, 0.005);
        found.at_most(format!("{hz} Hz: ticks off the deck"), off as f32, 0.0);
    }
}

#[test]
fn up_along_the_ground_walks_from_the_floor_up_the_wall() {
    // A quarter pipe: with up along the ground's normal it is all floor.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // A large tube seen from inside, radius 10, as facets of 5°.
        let mut mesh = embody_scenes::Patch::default();
        let point = |i: i32| {
            let angle = (5.0 * i as f32).to_radians();
            Vec3::new(10.0 * ops::sin(angle), 10.0 - 10.0 * ops::cos(angle), -5.0)
        };
        for i in 0..20 {
            mesh.add(point(i), Vec3::Z * 10.0, point(i + 1) - point(i), 1, 1);
        }
        sim.fixed(mesh.collider(), Transform::from_xyz(0.0, 0.01, 0.0));
        let who = runner(&mut sim, Vec3::NEG_X * 2.0);
        edit::<CharacterMotor>(&mut sim, who, |motor| motor.gravity = Some(G));
        insert(
            &mut sim,
            who,
            CharacterUp {
                direction: UpDirection::Ground,
                turn_rate: 10.0,
            },
        );
        sim.seconds(0.3);
        for _ in 0..(3.4 * hz) as usize {
            let up = sim.state(who).up;
            sim.walk(who, Vec3::NEG_Z.cross(up).normalize());
            sim.ticks(1);
        }
        // 2 m of floor and 15 m of arc to where it is upright.
        let foot = sim.position(who);
        found.at_least(format!("{hz} Hz: up the wall"), foot.y, 6.0);
        found.at_least(format!("{hz} Hz: out to the wall"), foot.x, 9.0);
        found.at_most(format!("{hz} Hz: up leans"), sim.state(who).up.y, 0.45);
    }
}

#[test]
fn who_is_spawned_anywhere_on_a_planet_stands_there_at_once() {
    let mut found = Findings::new();
    for hz in RATES {
        for out in [Vec3::NEG_Y, Vec3::X, Vec3::new(0.5, -0.7, 0.4).normalize()] {
            for shape in [Character::default(), Character::cuboid(0.6, 1.8, 0.4)] {
                let mut sim = Sim::new(hz);
                sim.fixed(Collider::ball(10.0), Transform::IDENTITY);
                let who = sim.spawn((
                    shape,
                    CharacterMotor {
                        gravity: Some(G),
                        ..prompt()
                    },
                    CharacterUp {
                        direction: UpDirection::AwayFrom(Vec3::ZERO),
                        ..default()
                    },
                    Transform::from_translation(out * 10.0)
                        .with_rotation(Quat::from_rotation_arc(Vec3::Y, out)),
                ));
                sim.ticks(1);
                let case = format!("{hz} Hz {out}");
                found.at_most(format!("{case}: up"), sim.state(who).up.distance(out), 1e-3);
                let mut off = 0.0f32;
                for _ in 0..hz as usize {
                    sim.ticks(1);
                    off = off.max(sim.position(who).distance(out * 10.0));
                }
                found.at_most(format!("{case}: moved"), off, 0.01);
                found.holds(format!("{case}: stands"), sim.state(who).on_ground());
                // A respawn on another side is as sudden.
                insert(
                    &mut sim,
                    who,
                    (
                        CharacterState::default(),
                        Transform::from_translation(out * -10.0),
                    ),
                );
                sim.ticks(1);
                found.at_most(
                    format!("{case}: up after a respawn"),
                    sim.state(who).up.distance(-out),
                    1e-3,
                );
            }
        }
    }
}

#[test]
fn without_a_direction_of_its_own_the_first_up_is_that_of_the_transform() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        // A wall at x = 0 that is a floor to who stands out from it.
        sim.block(Vec3::new(-0.5, 0.0, 0.0), Vec3::new(1.0, 50.0, 50.0));
        let out = Quat::from_rotation_arc(Vec3::Y, Vec3::X);
        let who = sim.spawn((
            Character::default(),
            CharacterMotor {
                gravity: Some(G),
                ..prompt()
            },
            CharacterUp {
                direction: UpDirection::Ground,
                ..default()
            },
            Transform::from_xyz(0.2, 0.0, 0.0).with_rotation(out),
        ));
        sim.seconds(1.0);
        found.holds(format!("{hz} Hz: stands"), sim.state(who).on_ground());
        found.near(
            format!("{hz} Hz: on the wall"),
            sim.position(who).x,
            0.0,
            0.001,
        );
        found.near(
            format!("{hz} Hz: not fallen"),
            sim.position(who).y,
            0.0,
            0.001,
        );
    }
}

#[test]
fn every_shape_stands_walks_and_is_stopped_by_walls_when_up_leans() {
    let mut found = Findings::new();
    let hull: Vec<Vec3> = [0.0, 1.8]
        .iter()
        .flat_map(|y| [-0.3, 0.3].map(|x| [-0.3, 0.3].map(|z| Vec3::new(x, *y, z))))
        .flatten()
        .collect();
    let hull = Character {
        shape: CharacterShape::ConvexHull { points: hull },
        ..default()
    };
    for hz in [30.0, 60.0, 240.0] {
        for up in [
            Vec3::new(1.0, 1.0, 0.0).normalize(),
            Vec3::new(-0.5, 0.3, 0.8).normalize(),
        ] {
            for (name, shape) in [
                ("capsule", Character::capsule(0.3, 1.8)),
                ("cylinder", Character::cylinder(0.3, 1.8)),
                ("box", Character::cuboid(0.6, 1.8, 0.6)),
                ("hull", hull.clone()),
            ] {
                let mut sim = Sim::new(hz);
                let turn = Quat::from_rotation_arc(Vec3::Y, up);
                let place = |at: Vec3| Transform::from_translation(turn * at).with_rotation(turn);
                sim.fixed(Collider::cuboid(20.0, 0.5, 20.0), place(Vec3::Y * -0.5));
                sim.fixed(
                    Collider::cuboid(0.5, 2.0, 10.0),
                    place(Vec3::new(3.5, 2.0, 0.0)),
                );
                let who = sim.spawn((
                    shape,
                    CharacterMotor {
                        gravity: Some(G),
                        ..prompt()
                    },
                    up_at_once(UpDirection::World(up)),
                    place(Vec3::Y * 0.1),
                ));
                sim.seconds(0.5);
                let at = |sim: &Sim| turn.inverse() * sim.position(who);
                let case = format!("{hz} Hz {name} up {up}");
                found.holds(format!("{case}: stands"), sim.state(who).on_ground());
                found.near(format!("{case}: foot"), at(&sim).y, 0.0, 0.001);
                sim.walk(who, turn * Vec3::Z);
                sim.seconds(1.0);
                found.near(format!("{case}: walks"), at(&sim).z, 5.0, 0.005);
                sim.walk(who, turn * Vec3::X);
                let mut deepest = f32::MIN;
                for _ in 0..hz as usize {
                    sim.ticks(1);
                    deepest = deepest.max(at(&sim).x);
                }
                found.near(format!("{case}: stops"), at(&sim).x, 2.7, 0.01);
                found.at_most(format!("{case}: never inside"), deepest, 2.701);
                found.near(format!("{case}: stays down"), at(&sim).y, 0.0, 0.002);
            }
        }
    }
}
