//! What Rapier and Bevy do to the unwary between two ticks, and that the set-up takes care of it.
//!
//! Compiled twice: with Bevy's multithreaded executor in the crate's own tests, and without it in
//! those of `embody_scenes`. Some of these traps exist in one of the two builds only.

use bevy::{ecs::message::MessageCursor, prelude::*, time::TimeUpdateStrategy};
use bevy_embody::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::geometry::CollisionEventFlags};
use embody_scenes::Sim;

const TICKS_PER_FRAME: [u32; 3] = [1, 2, 4];

/// Counts the ticks of a test.
#[derive(Resource, Default)]
struct Tick(u32);

/// A world without gravity whose frames have this many ticks.
fn weightless(ticks_per_frame: u32) -> Sim {
    let mut sim = Sim::new(60.0);
    sim.app
        .insert_resource(TimeUpdateStrategy::FixedTimesteps(ticks_per_frame))
        .init_resource::<Tick>()
        .add_systems(FixedLast, |mut tick: ResMut<Tick>| tick.0 += 1);
    set_gravity(&mut sim, Vec3::ZERO);
    sim
}

fn set_gravity(sim: &mut Sim, gravity: Vec3) {
    let world = sim.app.world_mut();
    let mut configuration = world.query::<&mut RapierConfiguration>();
    configuration
        .single_mut(world)
        .expect("one Rapier context")
        .gravity = gravity;
}

fn set_substeps(sim: &mut Sim, n: usize) {
    if let TimestepMode::Fixed { substeps, .. } =
        &mut *sim.app.world_mut().resource_mut::<TimestepMode>()
    {
        *substeps = n;
    }
}

/// Where Rapier has a body.
fn backend_position(sim: &mut Sim, entity: Entity) -> Vec3 {
    let handle = sim.get::<RapierRigidBodyHandle>(entity).0;
    let world = sim.app.world_mut();
    world
        .query::<&RapierRigidBodySet>()
        .single(world)
        .expect("one Rapier context")
        .bodies
        .get(handle)
        .expect("the body is known to Rapier")
        .translation()
}

fn with_child(sim: &mut Sim, body: Entity) {
    sim.spawn((Transform::from_xyz(0.0, 1.0, 0.0), ChildOf(body)));
}

#[test]
fn messages_are_delivered_once_and_their_buffers_do_not_grow() {
    #[derive(Resource, Default)]
    struct Seen {
        collisions: usize,
        masses: usize,
    }
    fn write(
        mut collisions: MessageWriter<CollisionEvent>,
        mut masses: MessageWriter<MassModifiedEvent>,
        body: Single<Entity, With<RigidBody>>,
    ) {
        let flags = CollisionEventFlags::empty();
        collisions.write(CollisionEvent::Started(*body, *body, flags));
        masses.write(MassModifiedEvent(*body));
    }
    // In the frame after the tick: buffers that flip twice per frame have lost them by then.
    fn read(
        mut seen: ResMut<Seen>,
        mut collisions: MessageReader<CollisionEvent>,
        mut masses: MessageReader<MassModifiedEvent>,
    ) {
        seen.collisions += collisions.read().count();
        seen.masses += masses.read().count();
    }
    let rapier_first = |app: &mut App| {
        app.add_plugins(rapier()).add_plugins(EmbodyPlugins);
    };
    let rapier_last = |app: &mut App| {
        app.add_plugins(EmbodyPlugins).add_plugins(rapier());
    };
    let rapier_left_to_us = |app: &mut App| {
        app.add_plugins(EmbodyPlugins);
    };
    let orders: [fn(&mut App); 3] = [rapier_first, rapier_last, rapier_left_to_us];
    for order in orders {
        let mut sim = Sim::with(60.0, order);
        sim.app
            .init_resource::<Seen>()
            .add_systems(FixedPostUpdate, write.before(PhysicsSet::SyncBackend))
            .add_systems(PreUpdate, read);
        sim.spawn((
            RigidBody::Dynamic,
            Collider::ball(0.5),
            Transform::default(),
        ));
        sim.ticks(100);
        let world = sim.app.world();
        assert_eq!(world.resource::<Seen>().collisions, 99);
        assert!(world.resource::<Seen>().masses >= 99);
        assert!(world.resource::<Messages<CollisionEvent>>().len() <= 2);
        assert!(world.resource::<Messages<MassModifiedEvent>>().len() <= 4);
    }
}

fn rapier() -> RapierPhysicsPlugin<NoUserData> {
    RapierPhysicsPlugin::default().in_schedule(FixedPostUpdate)
}

#[test]
fn contact_messages_of_a_long_run_do_not_pile_up() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    sim.spawn((
        RigidBody::Dynamic,
        Collider::ball(0.5),
        Restitution {
            coefficient: 1.0,
            combine_rule: CoefficientCombineRule::Max,
        },
        ActiveEvents::COLLISION_EVENTS | ActiveEvents::CONTACT_FORCE_EVENTS,
        ContactForceEventThreshold(0.0),
        Transform::from_xyz(0.0, 1.0, 0.0),
    ));
    let mut cursor = MessageCursor::<CollisionEvent>::default();
    let mut seen = 0;
    for _ in 0..600 {
        sim.ticks(1);
        let world = sim.app.world();
        seen += cursor
            .read(world.resource::<Messages<CollisionEvent>>())
            .count();
        assert!(world.resource::<Messages<CollisionEvent>>().len() <= 4);
        assert!(world.resource::<Messages<ContactForceEvent>>().len() <= 4);
    }
    assert!(seen > 10, "only {seen} contacts began or ended");
}

#[test]
fn a_kinematic_body_with_a_child_moves_as_written_at_every_frame_rate() {
    for per_frame in TICKS_PER_FRAME {
        let mut sim = weightless(per_frame);
        let body = sim.kinematic(Collider::ball(0.5), Transform::default());
        with_child(&mut sim, body);
        sim.app.add_systems(
            FixedUpdate,
            |mut bodies: Query<&mut Transform, With<RigidBody>>| {
                for mut transform in &mut bodies {
                    transform.translation.x += 0.1;
                }
            },
        );
        let mut expected = 0.0f32;
        for _ in 0..10 {
            sim.ticks(1);
            for _ in 0..per_frame {
                expected += 0.1;
            }
            assert_eq!(
                sim.position(body).x,
                expected,
                "{per_frame} ticks per frame"
            );
            assert_eq!(backend_position(&mut sim, body).x, expected);
        }
    }
}

#[test]
fn a_kinematic_body_that_is_a_child_moves_with_its_parent_at_every_frame_rate() {
    for per_frame in TICKS_PER_FRAME {
        let mut sim = weightless(per_frame);
        let ship = sim.spawn((Name::new("ship"), Transform::default()));
        let deck = sim.kinematic(Collider::ball(0.5), Transform::from_xyz(0.0, 1.0, 0.0));
        sim.app.world_mut().entity_mut(deck).insert(ChildOf(ship));
        sim.app.add_systems(
            FixedUpdate,
            |ship: Single<&mut Transform, With<Name>>, tick: Res<Tick>| {
                ship.into_inner().translation.x = 0.5 * (tick.0 + 1) as f32;
            },
        );
        sim.ticks(8);
        let ticks = 8 * per_frame;
        let there = backend_position(&mut sim, deck);
        assert!(
            there.distance(Vec3::new(0.5 * ticks as f32, 1.0, 0.0)) < 1e-5,
            "{per_frame} ticks per frame: {there}"
        );
    }
}

#[test]
fn a_transform_written_in_a_tick_is_not_lost() {
    for per_frame in TICKS_PER_FRAME {
        for child in [false, true] {
            let mut sim = weightless(per_frame);
            let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 1.0);
            if child {
                with_child(&mut sim, body);
            }
            // The second write of a frame is the one that gets lost, and the first after a rest.
            sim.app.add_systems(
                FixedUpdate,
                |mut bodies: Query<&mut Transform, With<RigidBody>>, tick: Res<Tick>| {
                    if tick.0 >= 9 && tick.0 < 15 {
                        for mut transform in &mut bodies {
                            transform.translation = Vec3::new(0.0, 100.0 + tick.0 as f32, 0.0);
                        }
                    }
                },
            );
            sim.app.add_systems(
                FixedLast,
                |bodies: Query<&Transform, With<RigidBody>>, tick: Res<Tick>| {
                    let expected = match tick.0 {
                        0..9 => 0.0,
                        9..15 => 100.0 + tick.0 as f32,
                        15.. => 114.0,
                    };
                    for transform in &bodies {
                        assert_eq!(transform.translation.y, expected, "in tick {}", tick.0);
                    }
                },
            );
            sim.ticks(20usize.div_ceil(per_frame as usize));
            assert_eq!(backend_position(&mut sim, body).y, 114.0);
        }
    }
}

#[test]
fn a_transform_written_between_ticks_is_not_lost() {
    for per_frame in TICKS_PER_FRAME {
        let mut sim = weightless(per_frame);
        let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 1.0);
        with_child(&mut sim, body);
        for i in 0..10 {
            let place = Vec3::new(i as f32, 50.0, 0.0);
            sim.place(body, place);
            sim.ticks(1);
            assert_eq!(sim.position(body), place);
            assert_eq!(backend_position(&mut sim, body), place);
        }
    }
}

/// What the tests below do to bodies from `Drive`, each tick.
#[derive(Resource, Clone, Copy)]
enum Push {
    Impulse(Vec3),
    Force(Vec3),
    Nothing,
}

fn push(mut sets: Query<&mut RapierRigidBodySet>, push: Res<Push>) {
    for mut set in &mut sets {
        for (_, body) in set.bodies.iter_mut() {
            // A force stays on a Rapier body until it is reset.
            body.reset_forces(true);
            match *push {
                Push::Impulse(impulse) => body.apply_impulse(impulse, true),
                Push::Force(force) => body.add_force(force, true),
                Push::Nothing => {}
            }
        }
    }
}

#[test]
fn impulses_written_in_drive_act_once_and_are_not_overwritten_by_the_velocity() {
    for per_frame in TICKS_PER_FRAME {
        for substeps in [1, 4] {
            let mut sim = weightless(per_frame);
            set_substeps(&mut sim, substeps);
            sim.app
                .insert_resource(Push::Impulse(Vec3::X * 3.0))
                .add_systems(FixedPostUpdate, push.in_set(EmbodySystems::Drive));
            let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 2.0);
            sim.ticks(10);
            let ticks = (10 * per_frame) as f32;
            let speed = sim.get::<Velocity>(body).linear.x;
            assert!(
                (speed - 1.5 * ticks).abs() < 1e-4 * ticks,
                "{speed} m/s after {ticks} ticks with {substeps} substeps"
            );
            sim.app.insert_resource(Push::Nothing);
            sim.ticks(10);
            assert_eq!(sim.get::<Velocity>(body).linear.x, speed);
        }
    }
}

#[test]
fn forces_written_in_drive_act_for_one_tick_whatever_the_substeps() {
    for per_frame in TICKS_PER_FRAME {
        for substeps in [1, 4] {
            let mut sim = weightless(per_frame);
            set_substeps(&mut sim, substeps);
            sim.app
                .insert_resource(Push::Force(Vec3::X * 12.0))
                .add_systems(FixedPostUpdate, push.in_set(EmbodySystems::Drive));
            let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 2.0);
            sim.ticks(10);
            let time = (10 * per_frame) as f32 * sim.dt();
            let speed = sim.get::<Velocity>(body).linear.x;
            assert!(
                (speed - 6.0 * time).abs() < 1e-4,
                "{speed} m/s after {time} s with {substeps} substeps"
            );
            sim.app.insert_resource(Push::Nothing);
            sim.ticks(10);
            assert_eq!(sim.get::<Velocity>(body).linear.x, speed);
        }
    }
}

#[test]
fn force_components_written_in_fixed_update_act_in_the_same_tick() {
    let mut sim = weightless(1);
    let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 2.0);
    sim.ticks(1);
    sim.app.world_mut().entity_mut(body).insert((
        ExternalImpulse {
            impulse: Vec3::X * 2.0,
            ..default()
        },
        ExternalForce {
            force: Vec3::Y * 120.0,
            ..default()
        },
    ));
    sim.ticks(1);
    let velocity = sim.get::<Velocity>(body).linear;
    assert!(
        (velocity - Vec3::new(1.0, 1.0, 0.0)).length() < 1e-5,
        "{velocity}"
    );
}

#[test]
fn a_body_spawned_in_a_tick_moves_in_it_and_is_seen_by_queries_from_the_next_on() {
    #[derive(Resource, Default)]
    struct Hits(Vec<bool>);
    let mut sim = weightless(1);
    set_gravity(&mut sim, Vec3::Y * -10.0);
    sim.ticks(1);
    sim.app
        .init_resource::<Hits>()
        .add_systems(FixedUpdate, |mut commands: Commands, tick: Res<Tick>| {
            if tick.0 == 1 {
                commands.spawn((
                    RigidBody::Dynamic,
                    Collider::ball(0.5),
                    Velocity::default(),
                    Transform::from_xyz(3.0, 0.0, 0.0),
                ));
            }
        })
        .add_systems(
            FixedPostUpdate,
            (|context: ReadRapierContext, mut hits: ResMut<Hits>| -> Result {
                let hit = context.single()?.cast_ray(
                    Vec3::ZERO,
                    Vec3::X,
                    10.0,
                    true,
                    QueryFilter::default(),
                );
                hits.0.push(hit.is_some());
                Ok(())
            })
            .in_set(EmbodySystems::Drive),
        );
    sim.ticks(2);
    assert_eq!(sim.app.world().resource::<Hits>().0, [false, true]);
    let world = sim.app.world_mut();
    let velocity = world.query::<&Velocity>().single(world).expect("one body");
    assert!(
        (velocity.linear.y + 20.0 / 60.0).abs() < 1e-5,
        "{velocity:?}"
    );
}

#[test]
fn a_falling_body_follows_the_closed_form_through_changes_of_the_tick_rate() {
    const GRAVITY: f64 = 9.81;
    for substeps in [1, 3] {
        let mut sim = Sim::new(30.0);
        set_gravity(&mut sim, Vec3::Y * -GRAVITY as f32);
        set_substeps(&mut sim, substeps);
        let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 1.0);
        let world = sim.app.world_mut();
        let iterations = world
            .query::<&RapierContextSimulation>()
            .single(world)
            .expect("one Rapier context")
            .integration_parameters
            .num_solver_iterations;
        // Rapier integrates velocity, then position, this many times per tick.
        let parts = (substeps * iterations) as f64;
        let (mut y, mut v) = (0.0, 0.0);
        for (hz, ticks) in [(30.0, 30), (120.0, 120), (50.0, 25)] {
            sim.set_hz(hz);
            sim.ticks(ticks);
            let h = 1.0 / (hz * parts);
            for _ in 0..ticks * parts as usize {
                v -= GRAVITY * h;
                y += v * h;
            }
            let speed = f64::from(sim.get::<Velocity>(body).linear.y);
            assert!((speed - v).abs() < 1e-3, "at {hz} Hz: {speed} m/s, not {v}");
            let height = f64::from(sim.position(body).y);
            assert!((height - y).abs() < 1e-3, "at {hz} Hz: {height} m, not {y}");
        }
        assert!(
            matches!(
                *sim.app.world().resource::<TimestepMode>(),
                TimestepMode::Fixed { substeps: kept, .. } if kept == substeps
            ),
            "the game's substeps are lost"
        );
        assert!(sim.app.world().resource::<EmbodyDiagnosis>().is_healthy());
    }
}

#[test]
fn a_body_below_a_turned_parent_goes_where_it_flies() {
    for ticks_per_frame in TICKS_PER_FRAME {
        let mut sim = weightless(ticks_per_frame);
        let parent = sim.spawn(
            Transform::from_xyz(3.0, -1.0, 2.0).with_rotation(Quat::from_euler(
                EulerRot::YXZ,
                1.2,
                0.4,
                -0.3,
            )),
        );
        let place = Transform::from_xyz(4.0, 0.5, -2.0);
        let velocity = Vec3::new(2.0, 1.0, -1.0);
        let body = sim.spawn((
            RigidBody::Dynamic,
            Collider::ball(0.5),
            Velocity {
                linear: velocity,
                angular: Vec3::Y,
            },
            place,
            ChildOf(parent),
        ));
        let start = sim
            .get::<Transform>(parent)
            .transform_point(place.translation);
        sim.ticks(60);
        let seconds = sim.app.world().resource::<Tick>().0 as f32 / 60.0;
        sim.app.world_mut().run_schedule(PostUpdate);
        let at = sim.get::<GlobalTransform>(body).translation();
        let wanted = start + velocity * seconds;
        assert!(
            at.distance(wanted) < 1e-3,
            "{ticks_per_frame} ticks a frame: at {at}, not {wanted}"
        );
        let turned = sim.get::<GlobalTransform>(body).rotation();
        let wanted = sim.get::<Transform>(parent).rotation;
        assert!(
            (turned * (Quat::from_rotation_y(seconds) * wanted).inverse())
                .angle_between(Quat::IDENTITY)
                < 1e-2,
            "{ticks_per_frame} ticks a frame: turned by {turned}"
        );
    }
}
