//! The set-up works whoever adds Rapier, and tells what is wrong.

use std::{
    collections::BTreeSet,
    sync::{Arc, Mutex},
};

use bevy::{
    app::PluginGroupBuilder,
    ecs::{schedule::MultiThreadedExecutor, system::SystemParam},
    prelude::*,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

#[derive(SystemParam)]
struct Hooks<'w> {
    _time: Res<'w, Time>,
}

impl BevyPhysicsHooks for Hooks<'_> {}

fn embody() -> PluginGroupBuilder {
    EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>()
}

fn rapier() -> RapierPhysicsPlugin<NoUserData> {
    RapierPhysicsPlugin::default().in_schedule(FixedPostUpdate)
}

fn sim(plugins: fn(&mut App)) -> Sim {
    Sim::with(60.0, plugins)
}

fn problems(sim: &Sim) -> Vec<EmbodyProblem> {
    let diagnosis = sim.app.world().resource::<EmbodyDiagnosis>();
    diagnosis.problems().to_vec()
}

fn mode(sim: &Sim) -> TimestepMode {
    *sim.app.world().resource::<TimestepMode>()
}

const SIXTIETH: TimestepMode = TimestepMode::Fixed {
    dt: 0.016_666_668,
    substeps: 1,
};

/// A body falls for a second: it has fallen for exactly one step per tick.
fn assert_falls(sim: &mut Sim) {
    let body = sim.dynamic(Collider::ball(0.5), Transform::default(), 1.0);
    sim.ticks(60);
    let speed = sim.get::<Velocity>(body).linear.y;
    assert!((speed + 9.81).abs() < 1e-3, "{speed} m/s");
}

#[test]
fn rapier_is_added_when_the_app_does_not() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    assert_eq!(mode(&sim), SIXTIETH);
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), []);
}

#[test]
fn rapier_may_be_added_before() {
    let mut sim = sim(|app| {
        app.add_plugins((rapier(), embody()));
    });
    assert_eq!(mode(&sim), SIXTIETH);
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), []);
}

#[test]
fn rapier_may_be_added_after() {
    let mut sim = sim(|app| {
        app.add_plugins((embody(), rapier()));
    });
    assert_eq!(mode(&sim), SIXTIETH);
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), []);
}

#[test]
fn rapier_with_hooks_of_the_game_is_not_added_twice() {
    let with_hooks = |app: &mut App| {
        let rapier = RapierPhysicsPlugin::<Hooks>::default().in_schedule(FixedPostUpdate);
        app.add_plugins((rapier, embody()));
    };
    let mut sim = sim(with_hooks);
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), []);
    let world = sim.app.world_mut();
    let contexts = world
        .query::<&RapierContextSimulation>()
        .iter(world)
        .count();
    assert_eq!(contexts, 1);
}

#[test]
fn interpolation_plugins_of_the_app_are_used() {
    use bevy_transform_interpolation::prelude::TransformInterpolationPlugin;
    for first in [true, false] {
        let mut sim = Sim::with(60.0, move |app: &mut App| {
            if first {
                app.add_plugins((TransformInterpolationPlugin::default(), EmbodyPlugins));
            } else {
                app.add_plugins((EmbodyPlugins, TransformInterpolationPlugin::default()));
            }
        });
        assert_falls(&mut sim);
    }
}

#[test]
fn a_wrong_schedule_is_reported() {
    let mut sim = sim(|app| {
        let rapier = RapierPhysicsPlugin::<NoUserData>::default().in_fixed_schedule();
        app.add_plugins((rapier, embody()));
    });
    let expected = [EmbodyProblem::OtherSchedule {
        schedule: "FixedUpdate".into(),
    }];
    assert_eq!(problems(&sim), expected);
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), expected);
}

#[test]
fn rapier_without_systems_is_reported() {
    let sim = sim(|app| {
        let rapier = rapier().with_default_system_setup(false);
        app.add_plugins((rapier, embody()));
    });
    assert_eq!(problems(&sim), [EmbodyProblem::NoSchedule]);
}

#[test]
fn a_step_that_is_not_the_tick_is_reported_and_the_tick_wins() {
    let mut sim = sim(|app| {
        app.insert_resource(TimestepMode::Fixed {
            dt: 0.02,
            substeps: 3,
        })
        .add_plugins(embody());
    });
    let fixed = sim.dt();
    let expected = [EmbodyProblem::DifferentTimestep {
        rapier: 0.02,
        fixed,
    }];
    assert_eq!(problems(&sim), expected);
    assert_eq!(
        mode(&sim),
        TimestepMode::Fixed {
            dt: fixed,
            substeps: 3
        }
    );
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), expected);
}

#[test]
fn a_step_equal_to_the_tick_is_not_reported() {
    let mut sim = sim(|app| {
        app.insert_resource(TimestepMode::Fixed {
            dt: 1.0 / 60.0,
            substeps: 2,
        })
        .add_plugins(embody());
    });
    assert_falls(&mut sim);
    assert_eq!(problems(&sim), []);
}

#[test]
fn a_step_written_at_run_time_is_reported_once_and_the_tick_wins() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    for dt in [0.05, 0.07] {
        sim.app
            .insert_resource(TimestepMode::Fixed { dt, substeps: 1 });
        sim.ticks(2);
        assert_eq!(mode(&sim), SIXTIETH);
    }
    assert!(matches!(
        problems(&sim)[..],
        [EmbodyProblem::DifferentTimestep { rapier: 0.05, .. }]
    ));
}

#[test]
fn a_tick_rate_changed_at_run_time_is_followed_without_a_report() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    for hz in [30.0, 240.0, 64.0] {
        sim.set_hz(hz);
        sim.ticks(2);
        let TimestepMode::Fixed { dt, .. } = mode(&sim) else {
            panic!("the mode has changed");
        };
        assert!((dt - sim.dt()).abs() < 1e-8, "{dt} s at {hz} Hz");
    }
    assert_eq!(problems(&sim), []);
}

#[test]
fn a_variable_timestep_is_reported_once() {
    let mut sim = sim(|app| {
        app.insert_resource(TimestepMode::Variable {
            max_dt: 0.1,
            time_scale: 1.0,
            substeps: 1,
        })
        .add_plugins(embody());
    });
    sim.ticks(10);
    assert_eq!(problems(&sim), [EmbodyProblem::NotFixedTimestep]);
}

#[test]
fn an_interpolated_timestep_set_at_run_time_is_reported_once() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    sim.ticks(2);
    assert_eq!(problems(&sim), []);
    sim.app.insert_resource(TimestepMode::Interpolated {
        dt: 0.01,
        time_scale: 1.0,
        substeps: 1,
    });
    sim.ticks(10);
    assert_eq!(problems(&sim), [EmbodyProblem::NotFixedTimestep]);
}

#[test]
fn the_first_scaled_body_is_reported() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    let ball = || (RigidBody::Dynamic, Collider::ball(0.5));
    sim.spawn((ball(), Transform::default()));
    sim.ticks(2);
    assert_eq!(problems(&sim), []);
    let parent = sim.spawn(Transform::from_scale(Vec3::splat(2.0)));
    let entity = sim.spawn((ball(), Transform::from_xyz(5.0, 0.0, 0.0), ChildOf(parent)));
    sim.ticks(1);
    sim.spawn((ball(), Transform::from_scale(Vec3::splat(3.0))));
    sim.ticks(2);
    let scale = Vec3::splat(2.0);
    assert_eq!(
        problems(&sim),
        [EmbodyProblem::ScaledBody { entity, scale }]
    );
}

#[test]
fn a_missing_context_is_reported_when_there_are_bodies() {
    let mut sim = sim(|app| {
        app.insert_resource(RapierContextInitialization::NoAutomaticRapierContext)
            .add_plugins(embody());
    });
    sim.ticks(3);
    assert_eq!(problems(&sim), []);
    sim.spawn((RigidBody::Dynamic, Transform::default()));
    sim.ticks(3);
    assert_eq!(problems(&sim), [EmbodyProblem::NoContext]);
}

#[test]
fn a_character_plugin_without_the_core_is_reported() {
    let sim = sim(|app| {
        app.add_plugins(CharacterPlugin);
    });
    let plugin = "CharacterPlugin";
    assert_eq!(problems(&sim), [EmbodyProblem::NoCore { plugin }]);
    let sim = self::sim(|app| {
        app.add_plugins((CharacterPlugin, EmbodyCorePlugin));
    });
    assert_eq!(problems(&sim), []);
}

#[test]
fn a_character_that_rapier_moves_or_that_is_a_sensor_is_reported_once() {
    let mut sim = sim(|app| {
        app.add_plugins(embody());
    });
    sim.spawn((Character::default(), Transform::default()));
    sim.spawn((
        Character::default(),
        RigidBody::KinematicPositionBased,
        Collider::ball(0.3),
        Transform::from_xyz(5.0, 0.0, 0.0),
    ));
    sim.ticks(2);
    assert_eq!(problems(&sim), []);
    let body = RigidBody::Dynamic;
    let [twice, _] = [10.0, 15.0]
        .map(|x| sim.spawn((Character::default(), body, Transform::from_xyz(x, 0.0, 0.0))));
    let [sensor, _] = [20.0, 25.0].map(|x| {
        sim.spawn((
            Character::default(),
            Sensor,
            Transform::from_xyz(x, 0.0, 0.0),
        ))
    });
    sim.ticks(2);
    assert_eq!(
        problems(&sim),
        [
            EmbodyProblem::MovedTwice {
                entity: twice,
                body
            },
            EmbodyProblem::SensorCharacter { entity: sensor },
        ]
    );
}

#[test]
fn each_problem_says_what_to_do() {
    let texts = [
        EmbodyProblem::NotFixedTimestep,
        EmbodyProblem::DifferentTimestep {
            rapier: 0.02,
            fixed: 0.01,
        },
        EmbodyProblem::OtherSchedule {
            schedule: "Update".into(),
        },
        EmbodyProblem::NoSchedule,
        EmbodyProblem::NoContext,
        EmbodyProblem::ScaledBody {
            entity: Entity::PLACEHOLDER,
            scale: Vec3::ONE,
        },
        EmbodyProblem::NoCore { plugin: "APlugin" },
        EmbodyProblem::MovedTwice {
            entity: Entity::PLACEHOLDER,
            body: RigidBody::Dynamic,
        },
        EmbodyProblem::SensorCharacter {
            entity: Entity::PLACEHOLDER,
        },
    ]
    .map(|problem| problem.to_string());
    let cures = [
        "TimestepMode::Fixed",
        "Time::<Fixed>::from_hz",
        "in_schedule(FixedPostUpdate)",
        "with_default_system_setup",
        "RapierContextSimulation",
        "scaled child",
        "EmbodyPlugins",
        "KinematicPositionBased",
        "CharacterFilter",
    ];
    for (text, cure) in texts.iter().zip(cures) {
        assert!(text.contains(cure), "{text}");
    }
}

/// The threads on which two systems of `FixedPostUpdate` that need nothing from each other run, over
/// many ticks.
fn threads(sim: &mut Sim) -> BTreeSet<String> {
    #[derive(Resource, Default)]
    struct Seen(Arc<Mutex<BTreeSet<String>>>);
    fn look(seen: Res<Seen>) {
        let me = format!("{:?}", std::thread::current().id());
        std::thread::sleep(core::time::Duration::from_micros(200));
        seen.0.lock().expect("no poison").insert(me);
    }
    let app = &mut sim.app;
    app.init_resource::<Seen>()
        .add_systems(FixedPostUpdate, (look, look, look, look));
    sim.ticks(20);
    let seen = sim.app.world().resource::<Seen>().0.clone();
    let seen = seen.lock().expect("no poison");
    seen.clone()
}

#[test]
fn systems_of_a_tick_run_in_line_unless_the_game_wants_threads() {
    let mut in_line = sim(|app| {
        app.add_plugins(embody());
    });
    let me = format!("{:?}", std::thread::current().id());
    assert_eq!(threads(&mut in_line), BTreeSet::from([me]));
    let mut threaded = sim(|app| {
        app.add_plugins(embody());
        app.edit_schedule(FixedPostUpdate, |schedule| {
            schedule.set_executor(MultiThreadedExecutor::new());
        });
    });
    let by = threads(&mut threaded);
    let pool = bevy::tasks::ComputeTaskPool::get().thread_num();
    assert!(pool < 2 || by.len() > 1, "{by:?} of {pool}");
}
