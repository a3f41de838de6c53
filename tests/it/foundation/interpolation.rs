//! Between ticks, motion is smooth and a jump is a jump.

use std::time::Duration;

use bevy::{prelude::*, time::TimeUpdateStrategy};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

const HZ: f64 = 10.0;
const FRAMES_PER_TICK: usize = 4;
/// Farther away than anything in these tests moves by itself, metres.
const FAR: f32 = 1000.0;

/// Ten ticks a second, four frames a tick, no gravity.
fn sim() -> Sim {
    let mut sim = Sim::with(HZ, EmbodyPlugins);
    let frame = Duration::from_secs_f64(1.0 / HZ / FRAMES_PER_TICK as f64);
    sim.app
        .insert_resource(TimeUpdateStrategy::ManualDuration(frame));
    let world = sim.app.world_mut();
    let mut configuration = world.query::<&mut RapierConfiguration>();
    configuration
        .single_mut(world)
        .expect("one Rapier context")
        .gravity = Vec3::ZERO;
    sim
}

fn ball(sim: &mut Sim, speed: f32) -> Entity {
    let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 1.0);
    sim.app
        .world_mut()
        .entity_mut(body)
        .insert((Interpolated, Velocity::linear(Vec3::X * speed)));
    body
}

/// The places that are shown during so many frames, along x.
fn shown(sim: &mut Sim, entity: Entity, frames: usize) -> Vec<f32> {
    (0..frames)
        .map(|_| {
            sim.ticks(1);
            sim.position(entity).x
        })
        .collect()
}

/// Whether each place belongs to the motion before a jump of this length or after it.
fn assert_no_smear(places: &[f32], jump: f32) {
    for x in places {
        let (before, after) = (x.abs(), (x - jump).abs());
        assert!(before.min(after) < 0.1 * jump.abs(), "smeared: {places:?}");
    }
    assert!(
        (places[places.len() - 1] - jump).abs() < 0.1 * jump.abs(),
        "it did not arrive: {places:?}"
    );
}

#[test]
fn a_moving_body_is_shown_smoothly_one_tick_behind() {
    let mut sim = sim();
    let body = ball(&mut sim, 8.0);
    let places = shown(&mut sim, body, 10 * FRAMES_PER_TICK);
    // Each frame covers as much as the one before, once two ticks are known.
    for pair in places[2 * FRAMES_PER_TICK..].windows(2) {
        let step = pair[1] - pair[0];
        assert!((step - 0.2).abs() < 1e-4, "a step of {step} m: {places:?}");
    }
    // The last frame ends with a tick: the one before it is shown.
    let last = places[places.len() - 1];
    assert!((last - 8.0 * 0.9).abs() < 1e-4, "{last}");
}

#[test]
fn a_body_without_the_component_is_shown_where_it_is() {
    let mut sim = sim();
    let body = ball(&mut sim, 8.0);
    sim.app.world_mut().entity_mut(body).remove::<(
        Interpolated,
        bevy_embody::interpolation::TranslationInterpolation,
    )>();
    let places = shown(&mut sim, body, 10 * FRAMES_PER_TICK);
    let last = places[places.len() - 1];
    assert!((last - 8.0).abs() < 1e-4, "{last}");
}

#[test]
fn a_tick_sees_the_exact_pose() {
    #[derive(Resource, Default)]
    struct Seen(Vec<f32>);
    let mut sim = sim();
    sim.app.init_resource::<Seen>().add_systems(
        FixedUpdate,
        |body: Single<&Transform, With<Interpolated>>, mut seen: ResMut<Seen>| {
            seen.0.push(body.translation.x);
        },
    );
    ball(&mut sim, 8.0);
    sim.ticks(10 * FRAMES_PER_TICK);
    for (tick, x) in sim.app.world().resource::<Seen>().0.iter().enumerate() {
        assert!((x - 0.8 * tick as f32).abs() < 1e-4, "tick {tick}: {x}");
    }
}

#[test]
fn characters_are_interpolated_by_themselves() {
    let mut sim = sim();
    let character = sim.character(Character::default(), Vec3::ZERO);
    assert!(sim.app.world().get::<Interpolated>(character).is_some());
    let mut exact = Sim::new(HZ);
    let character = exact.character(Character::default(), Vec3::ZERO);
    assert!(exact.app.world().get::<Interpolated>(character).is_none());
}

#[test]
fn a_dynamic_body_moved_by_the_game_in_a_tick_is_not_smeared() {
    let mut sim = sim();
    let body = ball(&mut sim, 8.0);
    sim.ticks(5 * FRAMES_PER_TICK);
    sim.app.add_systems(
        FixedUpdate,
        |mut body: Single<&mut Transform, With<Interpolated>>, mut done: Local<u32>| {
            *done += 1;
            if *done == 3 {
                body.translation.x = FAR;
            }
        },
    );
    let places = shown(&mut sim, body, 6 * FRAMES_PER_TICK);
    assert_no_smear(&places, FAR);
}

#[test]
fn a_character_moved_by_the_game_in_a_tick_is_not_smeared() {
    let mut sim = sim();
    let character = sim.character(Character::default(), Vec3::ZERO);
    sim.ticks(5 * FRAMES_PER_TICK);
    sim.app.add_systems(
        FixedUpdate,
        |mut character: Single<&mut Transform, With<Character>>, mut done: Local<u32>| {
            *done += 1;
            if *done == 3 {
                character.translation.x = FAR;
            }
        },
    );
    let places = shown(&mut sim, character, 6 * FRAMES_PER_TICK);
    assert_no_smear(&places, FAR);
}

#[test]
fn bodies_moved_by_the_game_between_ticks_are_not_smeared() {
    for frame in 0..FRAMES_PER_TICK {
        let mut sim = sim();
        let body = ball(&mut sim, 8.0);
        let character = sim.character(Character::default(), Vec3::Z * 10.0);
        sim.ticks(5 * FRAMES_PER_TICK + frame);
        sim.place(body, Vec3::X * FAR);
        sim.place(character, Vec3::X * FAR + Vec3::Z * 10.0);
        for _ in 0..3 * FRAMES_PER_TICK {
            sim.ticks(1);
            assert_no_smear(&[sim.position(body).x], FAR);
            assert_no_smear(&[sim.position(character).x], FAR);
        }
    }
}

#[test]
fn a_body_at_rest_is_not_touched() {
    let mut sim = sim();
    let body = ball(&mut sim, 0.0);
    sim.ticks(3 * FRAMES_PER_TICK);
    sim.app.add_systems(
        PostUpdate,
        |changed: Query<Entity, (Changed<Transform>, With<Interpolated>)>,
         mut frames: Local<u32>| {
            *frames += 1;
            assert!(
                *frames == 1 || changed.is_empty(),
                "changed in frame {}",
                *frames
            );
        },
    );
    sim.ticks(3 * FRAMES_PER_TICK);
    assert_eq!(sim.position(body), Vec3::ZERO);
}

/// Stops a body that moves and puts it where it was when the last tick began.
fn move_back(frame: usize, tell: bool) {
    let mut sim = sim();
    let body = ball(&mut sim, 8.0);
    sim.ticks(FRAMES_PER_TICK + frame);
    let world = sim.app.world_mut();
    world.entity_mut(body).insert(Velocity::default());
    if tell {
        world.trigger(Teleported { entity: body });
    }
    sim.place(body, Vec3::ZERO);
    let places = shown(&mut sim, body, 2 * FRAMES_PER_TICK);
    assert!(places.iter().all(|x| *x == 0.0), "{frame}: {places:?}");
}

#[test]
fn a_body_moved_back_by_the_game_to_where_it_was_a_tick_ago_stays_there() {
    for frame in 1..FRAMES_PER_TICK {
        move_back(frame, false);
    }
}

#[test]
fn a_body_said_to_be_teleported_to_where_it_is_shown_stays_there() {
    for frame in 0..FRAMES_PER_TICK {
        move_back(frame, true);
    }
}

#[test]
fn turning_between_ticks_keeps_the_turn_and_the_smooth_motion() {
    let mut sim = sim();
    let body = ball(&mut sim, 8.0);
    sim.ticks(3 * FRAMES_PER_TICK);
    let mut last = sim.position(body).x;
    for frame in 0..20u8 {
        let turn = Quat::from_rotation_y(0.1 * f32::from(frame));
        if let Some(mut transform) = sim.app.world_mut().get_mut::<Transform>(body) {
            transform.rotation = turn;
        }
        sim.ticks(1);
        let transform = sim.get::<Transform>(body);
        assert!(
            transform.rotation.angle_between(turn) < 1e-3,
            "frame {frame}"
        );
        let step = transform.translation.x - last;
        assert!(
            (step - 0.2).abs() < 1e-4,
            "frame {frame}: a step of {step} m"
        );
        last = transform.translation.x;
    }
}

/// The greatest speed that Rapier saw, metres per second.
#[derive(Resource, Default)]
struct Fastest(f32);

/// A platform that jumps in its fourth tick.
fn jumping_platform(tell: bool) -> (Sim, Entity) {
    let mut sim = sim();
    let platform = sim.kinematic(Collider::cuboid(2.0, 0.5, 2.0), Transform::default());
    sim.app
        .world_mut()
        .entity_mut(platform)
        .insert(Interpolated);
    sim.app
        .init_resource::<Fastest>()
        .add_systems(
            FixedUpdate,
            move |platform: Single<(Entity, &mut Transform), With<RigidBody>>,
                  mut ticks: Local<u32>,
                  mut commands: Commands| {
                let (entity, mut transform) = platform.into_inner();
                *ticks += 1;
                if *ticks == 4 {
                    transform.translation.x = FAR;
                    if tell {
                        commands.trigger(Teleported { entity });
                    }
                }
            },
        )
        .add_systems(
            FixedLast,
            |sets: Query<&RapierRigidBodySet>, mut fastest: ResMut<Fastest>| {
                for (_, body) in sets.iter().flat_map(|set| set.bodies.iter()) {
                    fastest.0 = fastest.0.max(body.linvel().length());
                }
            },
        );
    (sim, platform)
}

#[test]
fn a_kinematic_body_said_to_be_teleported_is_not_smeared_and_gets_no_velocity() {
    let (mut sim, platform) = jumping_platform(true);
    let places = shown(&mut sim, platform, 8 * FRAMES_PER_TICK);
    assert_no_smear(&places, FAR);
    assert_eq!(sim.app.world().resource::<Fastest>().0, 0.0);
}

#[test]
fn a_kinematic_body_not_said_to_be_teleported_moves() {
    let (mut sim, platform) = jumping_platform(false);
    let places = shown(&mut sim, platform, 8 * FRAMES_PER_TICK);
    let on_the_way = places.iter().any(|x| (0.2 * FAR..0.8 * FAR).contains(x));
    assert!(on_the_way, "{places:?}");
    let fastest = sim.app.world().resource::<Fastest>().0;
    assert!(fastest > 100.0, "{fastest} m/s");
}
