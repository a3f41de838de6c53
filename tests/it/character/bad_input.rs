//! Numbers that are none: told once, and recovered from when they are mended.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::Collider;
use embody_scenes::Sim;

use super::{support::*, warnings};

/// Runs a scene with one bad thing in it: it must stay finite, tell about it at most once, and work
/// again when the bad thing is mended.
fn bad(
    found: &mut Findings,
    name: &str,
    spoil: impl Fn(&mut Sim, Entity),
    mend: impl Fn(&mut Sim, Entity),
    warned: bool,
) {
    for hz in [30.0, 240.0] {
        let mut sim = Sim::new(hz);
        warnings::unique_entities(&mut sim);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        let other = runner(&mut sim, Vec3::new(0.0, 0.0, 5.0));
        sim.seconds(0.5);
        spoil(&mut sim, who);
        let mut all_finite = true;
        for _ in 0..hz as usize {
            sim.ticks(1);
            all_finite &= finite(&sim, other);
        }
        let case = format!("{hz} Hz {name}");
        found.holds(format!("{case}: another finite"), all_finite);
        found.holds(format!("{case}: finite"), finite(&sim, who));
        let told = warnings::about(who);
        found.at_most(format!("{case}: warnings {told:?}"), told.len() as f32, 1.0);
        if warned {
            found.at_least(format!("{case}: warnings"), told.len() as f32, 1.0);
        }
        found.at_most(
            format!("{case}: warnings about another"),
            warnings::about(other).len() as f32,
            0.0,
        );
        // The rest of the world goes on.
        let before = sim.position(other).x;
        sim.walk(other, Vec3::X);
        sim.seconds(0.5);
        found.within(
            format!("{case}: another walks"),
            sim.position(other).x - before,
            2.5,
            0.001,
        );
        // Mended, it works.
        mend(&mut sim, who);
        sim.seconds(0.5);
        found.holds(format!("{case}: finite when mended"), finite(&sim, who));
        let before = sim.position(who);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        found.within(
            format!("{case}: walks when mended"),
            sim.position(who).x - before.x,
            2.5,
            0.01,
        );
    }
}

#[test]
fn an_intent_that_is_no_number_is_refused_once_and_recovered_from() {
    let mut found = Findings::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for axis in [Vec3::X, Vec3::Y, Vec3::ONE] {
            bad(
                &mut found,
                &format!("movement {value} {axis}"),
                |sim, who| {
                    sim.walk(
                        who,
                        Vec3::select(axis.cmpgt(Vec3::ZERO), Vec3::splat(value), Vec3::ZERO),
                    );
                },
                |sim, who| sim.walk(who, Vec3::ZERO),
                value.is_nan(),
            );
        }
        bad(
            &mut found,
            &format!("facing {value}"),
            |sim, who| {
                edit::<CharacterMotor>(sim, who, |motor| motor.turn_rate = Some(5.0));
                sim.intent(who, |intent| intent.facing = Some(Vec3::splat(value)));
            },
            |sim, who| {
                edit::<CharacterMotor>(sim, who, |motor| motor.turn_rate = None);
                sim.intent(who, |intent| intent.facing = None);
            },
            false,
        );
    }
}

#[test]
fn a_config_that_is_no_number_or_out_of_range_is_refused_once_and_recovered_from() {
    type Spoil = fn(&mut Character, f32);
    let fields: [(&str, Spoil, &[f32]); 9] = [
        (
            "radius",
            |c, v| {
                c.shape = CharacterShape::Capsule {
                    radius: v,
                    height: 1.8,
                }
            },
            &[f32::NAN, f32::INFINITY, 0.0, -1.0],
        ),
        (
            "height",
            |c, v| {
                c.shape = CharacterShape::Capsule {
                    radius: 0.3,
                    height: v,
                }
            },
            &[f32::NAN, f32::INFINITY, 0.0, -1.0],
        ),
        (
            "max_slope",
            |c, v| c.max_slope = v,
            &[f32::NAN, f32::INFINITY, -0.1],
        ),
        (
            "step height",
            |c, v| {
                c.step = Some(StepConfig {
                    height: v,
                    ..default()
                });
            },
            &[f32::NAN, f32::INFINITY, -1.0],
        ),
        (
            "ground_snap",
            |c, v| c.ground_snap = v,
            &[f32::NAN, f32::INFINITY, -1.0],
        ),
        (
            "recovery_speed",
            |c, v| c.recovery_speed = v,
            &[f32::NAN, -1.0],
        ),
        ("mass", |c, v| c.mass = v, &[f32::NAN, f32::INFINITY, -1.0]),
        (
            "push_strength",
            |c, v| c.push_strength = v,
            &[f32::NAN, -1.0],
        ),
        (
            "step_smoothing",
            |c, v| c.step_smoothing = v,
            &[f32::NAN, f32::INFINITY, -1.0],
        ),
    ];
    let mut found = Findings::new();
    for (field, spoil, values) in fields {
        for &value in values {
            bad(
                &mut found,
                &format!("{field} = {value}"),
                |sim, who| edit::<Character>(sim, who, |character| spoil(character, value)),
                |sim, who| {
                    edit::<Character>(sim, who, |character| *character = Character::default());
                },
                value.is_nan()
                    || value < 0.0
                    || ["radius", "height", "step_smoothing"].contains(&field),
            );
        }
    }
}

#[test]
fn a_motor_that_is_no_number_is_refused_once_and_recovered_from() {
    type Spoil = fn(&mut CharacterMotor, f32);
    let fields: [(&str, Spoil); 6] = [
        ("walk_speed", |m, v| m.walk_speed = v),
        ("acceleration", |m, v| m.acceleration = v),
        ("friction", |m, v| m.friction = v),
        ("jump_height", |m, v| m.jump_height = v),
        ("gravity_scale", |m, v| m.gravity_scale = v),
        ("max_fall_speed", |m, v| m.max_fall_speed = v),
    ];
    let mut found = Findings::new();
    for (field, spoil) in fields {
        bad(
            &mut found,
            &format!("{field} = NaN"),
            |sim, who| {
                edit::<CharacterMotor>(sim, who, |motor| spoil(motor, f32::NAN));
                sim.walk(who, Vec3::X);
            },
            |sim, who| {
                edit::<CharacterMotor>(sim, who, |motor| *motor = prompt());
                sim.walk(who, Vec3::ZERO);
            },
            true,
        );
    }
}

#[test]
fn a_transform_or_velocity_that_is_no_number_is_recovered_from() {
    let mut found = Findings::new();
    for value in [f32::NAN, f32::INFINITY] {
        bad(
            &mut found,
            &format!("position {value}"),
            |sim, who| sim.place(who, Vec3::new(value, 0.0, 0.0)),
            |sim, who| sim.place(who, Vec3::ZERO),
            false,
        );
        bad(
            &mut found,
            &format!("rotation {value}"),
            |sim, who| {
                edit::<Transform>(sim, who, |t| {
                    t.rotation = Quat::from_xyzw(value, 0.0, 0.0, 1.0);
                });
            },
            |sim, who| edit::<Transform>(sim, who, |t| *t = Transform::IDENTITY),
            false,
        );
        bad(
            &mut found,
            &format!("velocity {value}"),
            |sim, who| set_velocity(sim, who, Vec3::splat(value)),
            |sim, who| set_velocity(sim, who, Vec3::ZERO),
            false,
        );
    }
}

#[test]
fn a_rotation_or_scale_of_zero_is_recovered_from() {
    let mut found = Findings::new();
    for (name, spoilt) in [
        (
            "zero quaternion",
            Transform::from_rotation(Quat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
        ),
        (
            "long quaternion",
            Transform::from_rotation(Quat::from_xyzw(0.0, 3.0, 0.0, 4.0)),
        ),
        ("zero scale", Transform::from_scale(Vec3::ZERO)),
        ("flat", Transform::from_scale(Vec3::new(1.0, 0.0, 1.0))),
        ("scale that is no number", Transform::from_scale(Vec3::NAN)),
    ] {
        bad(
            &mut found,
            name,
            |sim, who| edit::<Transform>(sim, who, |t| *t = spoilt),
            |sim, who| edit::<Transform>(sim, who, |t| *t = Transform::IDENTITY),
            true,
        );
    }
}

#[test]
fn a_scale_of_zero_at_spawn_or_at_a_parent_is_recovered_from() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = sim.spawn((
            Character::default(),
            prompt(),
            Transform::from_scale(Vec3::ZERO),
        ));
        let parent = sim.spawn(Transform::IDENTITY);
        let child = sim.spawn((
            Character::default(),
            prompt(),
            Transform::from_xyz(5.0, 0.0, 0.0),
            ChildOf(parent),
        ));
        sim.seconds(0.3);
        edit::<Transform>(&mut sim, parent, |t| t.scale = Vec3::ZERO);
        sim.seconds(0.3);
        found.holds(format!("{hz} Hz: spawned flat"), finite(&sim, who));
        let state = sim.state(child);
        found.holds(
            format!("{hz} Hz: flat parent {state:?}"),
            state.velocity.is_finite() && state.ground.point.is_finite() && state.up.is_finite(),
        );
        edit::<Transform>(&mut sim, who, |t| *t = Transform::IDENTITY);
        edit::<Transform>(&mut sim, parent, |t| *t = Transform::IDENTITY);
        edit::<Transform>(&mut sim, child, |t| *t = Transform::from_xyz(5.0, 0.0, 0.0));
        sim.seconds(0.3);
        for (name, entity, from) in [("spawned flat", who, 0.0), ("flat parent", child, 5.0)] {
            let start = sim.position(entity);
            found.near(format!("{hz} Hz {name}: place"), start.x, from, 0.01);
            sim.walk(entity, Vec3::Z);
            sim.seconds(0.5);
            found.within(
                format!("{hz} Hz {name}: walks"),
                sim.position(entity).z - start.z,
                2.5,
                0.01,
            );
        }
    }
}

#[test]
fn a_bad_value_is_told_once_however_often_its_component_is_touched() {
    let mut found = Findings::new();
    let mut sim = Sim::new(60.0);
    warnings::unique_entities(&mut sim);
    sim.floor(0.0);
    let who = runner(&mut sim, Vec3::ZERO);
    sim.seconds(0.2);
    let touch = |sim: &mut Sim, jump: f32, mass: f32| {
        for _ in 0..30 {
            edit::<CharacterMotor>(sim, who, |motor| motor.jump_height = jump);
            edit::<Character>(sim, who, |character| character.mass = mass);
            sim.ticks(1);
        }
        warnings::about(who).len() as f32
    };
    found.near("bad height", touch(&mut sim, f32::NAN, 70.0), 1.0, 0.0);
    found.near("other bad height", touch(&mut sim, -1.0, 70.0), 2.0, 0.0);
    found.near("bad mass beside", touch(&mut sim, -1.0, 0.0), 3.0, 0.0);
    found.near("mended", touch(&mut sim, 1.2, 70.0), 3.0, 0.0);
    found.near("bad again", touch(&mut sim, -1.0, 70.0), 4.0, 0.0);
}

#[test]
fn touching_the_motor_or_the_config_rebuilds_nothing_while_the_shape_stays() {
    let mut found = Findings::new();
    for shape in [Character::default(), Character::cylinder(0.3, 1.8)] {
        let mut sim = Sim::new(60.0);
        sim.floor(0.0);
        let who = runner_with(&mut sim, shape, Vec3::ZERO);
        sim.seconds(0.2);
        let changed = |sim: &Sim| {
            sim.app
                .world()
                .entity(who)
                .get_ref::<Collider>()
                .expect("a character has a collider")
                .last_changed()
        };
        let before = changed(&sim);
        for i in 0..20 {
            edit::<CharacterMotor>(&mut sim, who, |motor| motor.walk_speed = 4.0 + i as f32);
            edit::<Character>(&mut sim, who, |character| character.max_slope = 0.5);
            sim.ticks(1);
        }
        found.holds("the collider is the same", changed(&sim) == before);
        edit::<Character>(&mut sim, who, |c| {
            c.shape = CharacterShape::Capsule {
                radius: 0.4,
                height: 1.7,
            }
        });
        sim.ticks(1);
        found.holds(
            "another shape has another collider",
            changed(&sim) != before,
        );
        found.near("height", sim.state(who).height, 1.7, 0.0);
    }
}

#[test]
fn a_capsule_a_hair_lower_than_its_two_radii_is_a_ball() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner_with(&mut sim, Character::capsule(0.5, 0.99995), Vec3::ZERO);
        sim.intent(who, |intent| intent.stance = Stance::Crouch);
        sim.seconds(0.5);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        found.at_least(format!("{hz} Hz"), sim.position(who).x, 1.0);
    }
}

#[test]
fn a_bad_up_belt_grip_or_flow_is_told_once_and_left_out() {
    let mut found = Findings::new();
    let nan = Vec3::NAN;
    let up = |direction| CharacterUp {
        direction,
        turn_rate: 6.0,
    };
    type Case = (&'static str, Box<dyn Fn(&mut EntityWorldMut)>);
    fn case(name: &'static str, bundle: impl Component + Copy) -> Case {
        (
            name,
            Box::new(move |entity| {
                entity.insert(bundle);
            }),
        )
    }
    // On the floor or on the character; the water holds the character.
    let on_floor = [
        case(
            "SurfaceVelocity",
            SurfaceVelocity {
                linear: nan,
                angular: Vec3::ZERO,
            },
        ),
        case(
            "SurfaceVelocity",
            SurfaceVelocity {
                linear: Vec3::ZERO,
                angular: Vec3::INFINITY,
            },
        ),
        case("SurfaceGrip", SurfaceGrip(f32::NAN)),
        case("SurfaceGrip", SurfaceGrip(-1.0)),
    ];
    let on_character = [
        case("CharacterUp::direction", up(UpDirection::World(nan))),
        case("CharacterUp::direction", up(UpDirection::World(Vec3::ZERO))),
        case("CharacterUp::direction", up(UpDirection::AwayFrom(nan))),
        case(
            "CharacterUp::turn_rate",
            CharacterUp {
                turn_rate: f32::NAN,
                ..default()
            },
        ),
    ];
    let in_water = [case("WaterVolume::flow", WaterVolume { flow: nan })];
    let cases = on_floor
        .iter()
        .map(|case| (0, case))
        .chain(on_character.iter().map(|case| (1, case)))
        .chain(in_water.iter().map(|case| (2, case)));
    for (place, (name, spoil)) in cases {
        let mut sim = Sim::new(60.0);
        warnings::unique_entities(&mut sim);
        let floor = sim.floor(0.0);
        let water = sim.spawn((
            Collider::cuboid(5.0, 5.0, 5.0),
            bevy_rapier3d::prelude::Sensor,
            Transform::IDENTITY,
        ));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.2);
        let spoilt = [floor, who, water][place];
        for _ in 0..20 {
            spoil(&mut sim.app.world_mut().entity_mut(spoilt));
            sim.walk(who, Vec3::X);
            sim.ticks(1);
        }
        let told = warnings::about(spoilt);
        found.holds(
            format!("{name}: told once {told:?}"),
            told.len() == 1 && told[0].contains(name),
        );
        found.holds(format!("{name}: finite"), finite(&sim, who));
        found.at_most(
            format!("{name}: stays upright"),
            sim.state(who).up.distance(Vec3::Y),
            0.001,
        );
    }
}
