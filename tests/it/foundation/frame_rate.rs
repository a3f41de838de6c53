//! A tick does the same, however many of them a frame has.

use std::time::Duration;

use bevy::{app::Plugins, prelude::*, time::TimeUpdateStrategy};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

const TICKS: usize = 240;

/// The bits of a pose.
type Bits = [u32; 7];

/// The poses of all entities for each tick.
#[derive(Resource, Default)]
struct Record(Vec<Vec<(Entity, Bits)>>);

fn record(mut record: ResMut<Record>, bodies: Query<(Entity, &Transform)>) {
    let mut poses: Vec<_> = bodies
        .iter()
        .map(|(entity, transform)| {
            let [x, y, z] = transform.translation.to_array();
            let [a, b, c, d] = transform.rotation.to_array();
            (entity, [x, y, z, a, b, c, d].map(f32::to_bits))
        })
        .collect();
    poses.sort_by_key(|(entity, _)| *entity);
    record.0.push(poses);
}

/// Drives the lift, throws a ball now and then, and asks the character to walk about.
fn script(
    record: Res<Record>,
    mut lift: Single<&mut Transform, With<Name>>,
    mut characters: Query<&mut CharacterIntent>,
    mut balls: Query<&mut ExternalImpulse>,
) {
    let tick = record.0.len();
    let phase = tick as f32 / 60.0;
    lift.translation = Vec3::new(phase, 0.5 + 0.2 * phase, 0.0);
    for mut intent in &mut characters {
        intent.movement = if tick % 100 < 60 {
            Vec3::X
        } else {
            Vec3::NEG_Z
        };
        intent.jump = tick % 45 == 20;
    }
    if tick % 40 == 10 {
        for mut impulse in &mut balls {
            impulse.impulse = Vec3::new(0.2, 3.0, -0.1);
        }
    }
}

fn run<M>(plugins: impl Plugins<M>, strategy: TimeUpdateStrategy) -> Vec<Vec<(Entity, Bits)>> {
    let mut sim = Sim::with(60.0, plugins);
    sim.floor(0.0);
    // Rapier takes bodies of one tick in the order of Bevy's tables, which is that of nothing here.
    sim.ticks(1);
    let lift = sim.kinematic(Collider::cuboid(1.0, 0.1, 1.0), Transform::default());
    sim.app
        .world_mut()
        .entity_mut(lift)
        .insert(Name::new("lift"));
    sim.spawn((Transform::from_xyz(0.0, 0.3, 0.0), ChildOf(lift)));
    sim.ticks(1);
    for i in 0..5u8 {
        let x = f32::from(i) * 0.3;
        let at = Transform::from_xyz(x, 2.0 + 3.0 * x, 0.1 * x);
        let ball = sim.dynamic(Collider::cuboid(0.2, 0.2, 0.2), at, 1.0);
        sim.app
            .world_mut()
            .entity_mut(ball)
            .insert((ExternalImpulse::default(), Interpolated));
        sim.spawn((Transform::from_xyz(0.0, 0.3, 0.0), ChildOf(ball)));
        sim.ticks(1);
    }
    sim.character(Character::default(), Vec3::new(-1.0, 0.0, 0.0));
    sim.ticks(1);
    sim.app
        .insert_resource(strategy)
        .init_resource::<Record>()
        .add_systems(FixedUpdate, script)
        .add_systems(
            FixedPostUpdate,
            record
                .after(EmbodySystems::React)
                .after(PhysicsSet::Writeback),
        );
    while sim.app.world().resource::<Record>().0.len() < TICKS {
        sim.ticks(1);
    }
    let mut ticks = core::mem::take(&mut sim.app.world_mut().resource_mut::<Record>().0);
    ticks.truncate(TICKS);
    ticks
}

fn exact() -> bevy::app::PluginGroupBuilder {
    EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>()
}

type Ticks = [Vec<(Entity, Bits)>];

fn assert_same(name: &str, expected: &Ticks, found: &Ticks) {
    for (tick, (expected, found)) in expected.iter().zip(found).enumerate() {
        // The numbers of the entities differ with the plugins, their order does not.
        for ((entity, a), (_, b)) in expected.iter().zip(found) {
            let [a, b] = [a, b].map(|bits| bits.map(f32::from_bits));
            assert!(
                a.map(f32::to_bits) == b.map(f32::to_bits),
                "{name}: in tick {tick} {entity} is at {b:?}, not at {a:?}",
            );
        }
        assert_eq!(expected.len(), found.len());
    }
}

#[test]
fn the_same_script_gives_the_same_bits_at_every_frame_rate() {
    let expected = run(exact(), TimeUpdateStrategy::FixedTimesteps(1));
    let distinct: std::collections::HashSet<_> = expected.iter().collect();
    assert!(distinct.len() > TICKS / 2, "nothing moves in the scene");
    for n in [2, 4] {
        let found = run(exact(), TimeUpdateStrategy::FixedTimesteps(n));
        assert_same(&format!("{n} ticks per frame"), &expected, &found);
    }
    for fps in [25.0, 144.0] {
        let frame = Duration::from_secs_f64(1.0 / fps);
        let found = run(exact(), TimeUpdateStrategy::ManualDuration(frame));
        assert_same(&format!("{fps} frames per second"), &expected, &found);
    }
}

#[test]
fn interpolation_does_not_change_a_bit_of_the_simulation() {
    let expected = run(exact(), TimeUpdateStrategy::FixedTimesteps(1));
    for fps in [25.0, 60.0, 144.0] {
        let frame = Duration::from_secs_f64(1.0 / fps);
        let found = run(EmbodyPlugins, TimeUpdateStrategy::ManualDuration(frame));
        assert_same(&format!("{fps} frames per second"), &expected, &found);
    }
}
