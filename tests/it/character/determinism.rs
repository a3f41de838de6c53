//! Equal bits: replays, saves, spawn order, frames of several ticks, one thread or two.

use std::{env, fs, process::Command};

use bevy::{
    math::ops,
    prelude::*,
    tasks::{AsyncComputeTaskPool, ComputeTaskPool, IoTaskPool, TaskPoolBuilder},
    time::TimeUpdateStrategy,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Mover, Patch, Sim, Stairs};

use super::support::*;

/// A name for hashing that does not depend on entity ids.
#[derive(Component, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Id(u32);

/// FNV-1a.
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    fn floats(&mut self, values: &[f32]) {
        for value in values {
            for byte in value.to_bits().to_le_bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
}

fn hash(sim: &mut Sim) -> u64 {
    let world = sim.app.world_mut();
    let mut query = world.query::<(&Id, &Transform, Option<&CharacterState>)>();
    let mut all: Vec<_> = query.iter(world).collect();
    all.sort_by_key(|(id, ..)| **id);
    let mut hash = Hash(0xcbf2_9ce4_8422_2325);
    for (_, transform, state) in all {
        hash.floats(&transform.translation.to_array());
        hash.floats(&transform.rotation.to_array());
        if let Some(state) = state {
            hash.floats(&state.velocity.to_array());
            hash.floats(&state.residual.to_array());
            hash.floats(&[state.height, state.air_time]);
        }
    }
    hash.0
}

/// The order in which the parts of the level are spawned.
#[derive(Clone, Copy, Debug, Default)]
struct Order {
    /// By how much the list of parts is turned.
    turn: usize,
    /// Whether the crates hang in the air instead of resting on the floor.
    ///
    /// Rapier computes a contact from the side of the body that was there first, so between a crate
    /// and what it rests on the order of spawning shows in the last bits.
    crates_hang: bool,
}

/// Everything there is in one level: mesh, steps, ramp, lift, table, crates, a crowd.
fn level(sim: &mut Sim, order: Order) -> Vec<Entity> {
    type Part = Box<dyn Fn(&mut Sim)>;
    let mut parts: Vec<Part> = vec![
        Box::new(|sim| {
            sim.floor(0.0);
        }),
        Box::new(|sim| {
            let hills = Patch::terrain(40, 0.5, |x, z| 0.4 * ops::sin(x) * ops::cos(z * 0.7));
            sim.fixed(hills.collider(), Transform::from_xyz(-10.0, 0.2, 5.0));
        }),
        Box::new(|sim| {
            let stairs = Stairs {
                steps: 6,
                rise: 0.2,
                tread: 0.3,
                width: 4.0,
                landing: 1.0,
                make: Make::Boxes,
                ceiling: None,
            };
            sim.stairs(&stairs, Transform::from_xyz(4.0, 0.0, -3.0));
        }),
        Box::new(|sim| {
            sim.ramp(Make::Mesh, Vec3::new(-6.0, 0.0, -6.0), 0.5, 8.0, 4.0);
        }),
        Box::new(|sim| {
            sim.mover(Collider::cuboid(1.0, 0.1, 1.0), |t| {
                Transform::from_xyz(3.0, 0.6 - 0.5 * (2.0 * t).cos() as f32, 3.0)
            });
        }),
        Box::new(|sim| {
            sim.mover(Collider::cylinder(0.1, 1.5), |t| {
                Transform::from_xyz(-3.0, 0.1, 2.0).with_rotation(Quat::from_rotation_y(t as f32))
            });
        }),
    ];
    for i in 0..6 {
        let lift = if order.crates_hang { 0.1 } else { 0.0 };
        let at = Vec3::new(2.0 + 2.0 * i as f32, 0.3 + lift, -8.0);
        parts.push(Box::new(move |sim| {
            let mass = 5.0 * (i + 1) as f32;
            let crate_ = sim.dynamic(
                Collider::cuboid(0.3, 0.3, 0.3),
                Transform::from_translation(at),
                mass,
            );
            insert(sim, crate_, Id(100 + i));
            if order.crates_hang {
                let level = LockedAxes::ROTATION_LOCKED | LockedAxes::TRANSLATION_LOCKED_Y;
                insert(sim, crate_, (level, GravityScale(0.0)));
            }
        }));
    }
    let turn = order.turn % parts.len();
    parts.rotate_left(turn);
    for part in &parts {
        part(sim);
    }
    (0..12)
        .map(|i| {
            let foot = Vec3::new((i % 4) as f32 * 1.5 - 2.0, 1.5, (i / 4) as f32 * 1.5 - 2.0);
            let who = runner(sim, foot);
            insert(sim, who, Id(i));
            who
        })
        .collect()
}

/// What the characters are asked in a tick.
fn script(sim: &mut Sim, crowd: &[Entity], tick: usize) {
    for (i, &who) in crowd.iter().enumerate() {
        let wish = heading((i * 67 + tick / 40 * 131) as f32);
        sim.intent(who, |intent| {
            intent.movement = wish;
            intent.jump = (tick + i * 13) % 50 < 3;
            intent.sprint = i % 3 == 0;
            intent.stance = if (tick / 60 + i).is_multiple_of(4) {
                Stance::Crouch
            } else {
                Stance::Stand
            };
        });
    }
}

fn replay(hz: f64, ticks: usize, order: Order) -> Vec<u64> {
    let mut sim = Sim::threaded(hz);
    let crowd = level(&mut sim, order);
    (0..ticks)
        .map(|tick| {
            script(&mut sim, &crowd, tick);
            sim.ticks(1);
            hash(&mut sim)
        })
        .collect()
}

fn first_difference(a: &[u64], b: &[u64]) -> Option<usize> {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).position(|(a, b)| a != b)
}

#[test]
fn replays_give_equal_bits() {
    for hz in [30.0, 120.0] {
        let first = replay(hz, 300, Order::default());
        for run in 0..2 {
            let again = replay(hz, 300, Order::default());
            assert_eq!(
                first_difference(&first, &again),
                None,
                "{hz} Hz, run {run}, first tick that differs"
            );
        }
        let mut distinct = first.clone();
        distinct.dedup();
        assert!(
            distinct.len() > 290,
            "the scene moves: {} of 300 ticks differ",
            distinct.len()
        );
    }
}

#[test]
fn the_order_in_which_other_things_are_spawned_does_not_matter() {
    for hz in [30.0, 120.0] {
        let hang = Order {
            crates_hang: true,
            ..default()
        };
        let first = replay(hz, 300, hang);
        for turn in 1..12 {
            let other = replay(hz, 300, Order { turn, ..hang });
            assert_eq!(
                first_difference(&first, &other),
                None,
                "{hz} Hz, parts turned by {turn}: first tick that differs"
            );
        }
    }
}

#[test]
fn the_number_of_ticks_in_a_frame_does_not_matter() {
    let mut ends = Vec::new();
    for per_frame in [1u32, 2, 4] {
        let mut sim = Sim::threaded(120.0);
        let crowd = level(&mut sim, Order::default());
        sim.app
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(per_frame));
        // The script changes with frames of four ticks alone.
        for tick in (0..240).step_by(4) {
            script(&mut sim, &crowd, tick);
            for _ in 0..4 / per_frame {
                sim.app.update();
            }
        }
        ends.push((per_frame, hash(&mut sim)));
    }
    assert!(
        ends.iter().all(|end| end.1 == ends[0].1),
        "ticks per frame and hash: {ends:x?}"
    );
}

/// A static level with a lift and a turntable, on which a save mid-way is restored.
fn save_course(sim: &mut Sim) -> (Entity, [Entity; 2]) {
    let stairs = Stairs {
        steps: 8,
        rise: 0.2,
        tread: 0.3,
        width: 6.0,
        landing: 3.0,
        make: Make::Mesh,
        ceiling: None,
    };
    sim.stairs(&stairs, Transform::IDENTITY);
    let movers = [
        sim.mover(Collider::cuboid(1.5, 0.1, 1.5), |t| {
            Transform::from_xyz(-20.0, (0.8 * (2.0 * t).sin()) as f32, 0.0)
        }),
        sim.mover(Collider::cylinder(0.1, 2.0), |t| {
            Transform::from_xyz(-30.0, 0.0, 0.0)
                .with_rotation(Quat::from_rotation_y((2.0 * t) as f32))
        }),
    ];
    (runner(sim, Vec3::new(-2.0, 0.0, 0.0)), movers)
}

#[test]
fn a_save_restored_gives_the_same_sixty_ticks_again() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, foot, lead) in [
            ("mid stair", Vec3::new(-2.0, 0.0, 0.0), 0.6),
            ("in the air", Vec3::new(-2.0, 3.0, 0.4), 0.3),
            ("on a lift", Vec3::new(-20.0, 0.1, 0.3), 0.8),
            ("on a turntable", Vec3::new(-29.0, 0.1, 0.0), 0.8),
        ] {
            let mut sim = Sim::threaded(hz);
            let (who, movers) = save_course(&mut sim);
            sim.place(who, foot);
            sim.seconds(0.2);
            sim.walk(
                who,
                Vec3::X * if name.starts_with("on") { 0.1 } else { 1.0 },
            );
            sim.seconds(lead);
            let saved = save(&sim, who);
            let platforms = movers.map(|mover| {
                let ticks = sim.app.world().get::<Mover>(mover).expect("a mover").ticks;
                (mover, sim.get::<Transform>(mover), ticks)
            });
            let physics = Physics::save(&mut sim);
            let run = |sim: &mut Sim| -> Vec<_> {
                (0..60)
                    .map(|tick| {
                        sim.intent(who, |intent| intent.jump = tick == 30);
                        sim.ticks(1);
                        (sim.get::<Transform>(who), sim.state(who))
                    })
                    .collect()
            };
            let first = run(&mut sim);
            for round in 0..2 {
                insert(&mut sim, who, saved.clone());
                for (mover, transform, ticks) in platforms {
                    insert(&mut sim, mover, transform);
                    edit::<Mover>(&mut sim, mover, |mover| mover.ticks = ticks);
                }
                physics.restore(&mut sim);
                let again = run(&mut sim);
                found.same(format!("{hz} Hz {name} round {round}"), &first, &again);
            }
        }
    }
}

#[test]
fn a_character_is_rebuilt_from_its_saved_text() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::threaded(hz);
        let (who, _) = save_course(&mut sim);
        sim.seconds(0.2);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        let state = serde_json::to_string(&sim.state(who)).expect("the state is plain data");
        let config =
            serde_json::to_string(&sim.get::<Character>(who)).expect("the config is plain data");
        let intent = serde_json::to_string(&sim.get::<CharacterIntent>(who))
            .expect("the intent is plain data");
        // The motor has infinite accelerations, which text of this kind cannot hold.
        let motor =
            serde_json::to_string(&CharacterMotor::default()).expect("the motor is plain data");
        let transform = sim.get::<Transform>(who);
        let state_read: CharacterState =
            serde_json::from_str(&state).expect("reads what was written");
        found.holds(format!("{hz} Hz: state"), state_read == sim.state(who));
        found.holds(
            format!("{hz} Hz: config"),
            serde_json::from_str::<Character>(&config).ok() == Some(sim.get(who)),
        );
        found.holds(
            format!("{hz} Hz: motor"),
            serde_json::from_str::<CharacterMotor>(&motor).ok() == Some(CharacterMotor::default()),
        );
        // Another entity takes over where the first one was.
        sim.seconds(0.5);
        let wanted = (sim.get::<Transform>(who), sim.state(who));
        sim.app.world_mut().despawn(who);
        sim.ticks(2);
        let heir = sim.spawn((
            serde_json::from_str::<Character>(&config).expect("reads"),
            state_read,
            serde_json::from_str::<CharacterIntent>(&intent).expect("reads"),
            prompt(),
            transform,
        ));
        sim.seconds(0.5);
        found.holds(
            format!("{hz} Hz: pose"),
            sim.get::<Transform>(heir) == wanted.0,
        );
        found.holds(
            format!("{hz} Hz: velocity"),
            sim.state(heir).velocity == wanted.1.velocity,
        );
    }
}

const THREADS: &str = "EMBODY_TEST_THREADS";
const RESULT: &str = "EMBODY_TEST_RESULT";

#[test]
fn one_thread_or_two_give_equal_bits() {
    if let (Ok(threads), Ok(path)) = (env::var(THREADS), env::var(RESULT)) {
        // This is one of the two processes that the test below has started.
        let threads = threads.parse().expect("a number of threads");
        ComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(threads).build());
        AsyncComputeTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(threads).build());
        IoTaskPool::get_or_init(|| TaskPoolBuilder::new().num_threads(threads).build());
        assert_eq!(ComputeTaskPool::get().thread_num(), threads);
        let hashes = replay(60.0, 300, Order::default());
        let text: Vec<String> = hashes.iter().map(|hash| format!("{hash:016x}")).collect();
        fs::write(path, text.join("\n")).expect("the result can be written");
        return;
    }
    let own = env::current_exe().expect("a test knows its own binary");
    let runs = [1, 2, 4].map(|threads| {
        let path = env::temp_dir().join(format!("embody-threads-{}-{threads}", std::process::id()));
        let status = Command::new(&own)
            .args([
                "--exact",
                "character::determinism::one_thread_or_two_give_equal_bits",
            ])
            .env(THREADS, threads.to_string())
            .env(RESULT, &path)
            .output()
            .expect("the test binary can be started");
        assert!(
            status.status.success(),
            "{}",
            String::from_utf8_lossy(&status.stdout)
        );
        let hashes = fs::read_to_string(&path).expect("the other process has written its result");
        fs::remove_file(&path).expect("the result can be removed");
        assert_eq!(hashes.lines().count(), 300);
        hashes
    });
    for (run, threads) in runs[1..].iter().zip([2, 4]) {
        let differ = runs[0].lines().zip(run.lines()).position(|(a, b)| a != b);
        assert_eq!(
            differ, None,
            "first tick in which {threads} threads differ from 1"
        );
    }
}
