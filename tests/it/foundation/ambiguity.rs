//! The order of the crate's systems is not left to chance.

use bevy::{
    app::Plugins,
    ecs::schedule::{ScheduleLabel, SystemKey, SystemSet},
    prelude::*,
};
use bevy_embody::{prelude::*, ragdoll::RagdollSystems};
use embody_scenes::Sim;

/// Pairs of systems that use the same data without an order, at least one of them in one of the
/// crate's sets.
fn ambiguities<M>(label: impl ScheduleLabel, plugins: impl Plugins<M>) -> Vec<String> {
    let mut sim = Sim::with(60.0, plugins);
    sim.ticks(1);
    sim.app.world_mut().schedule_scope(label, |_, schedule| {
        let graph = schedule.graph();
        let ours: Vec<SystemKey> = [
            EmbodySystems::Prepare.intern(),
            EmbodySystems::Drive.intern(),
            EmbodySystems::React.intern(),
            EmbodySystems::Present.intern(),
            VehicleSystems::Prepare.intern(),
            VehicleSystems::Drive.intern(),
            VehicleSystems::React.intern(),
            VehicleSystems::Present.intern(),
            RagdollSystems::Prepare.intern(),
            RagdollSystems::Drive.intern(),
            RagdollSystems::React.intern(),
            CharacterRagdollSystems.intern(),
        ]
        .into_iter()
        .filter_map(|set| graph.systems_in_set(set).ok())
        .flatten()
        .copied()
        .collect();
        let name = |key: &SystemKey| {
            let mut systems = schedule.systems().expect("the schedule has run");
            systems
                .find(|(other, _)| other == key)
                .map(|(_, system)| system.name().to_string())
                .unwrap_or_default()
        };
        graph
            .conflicting_systems()
            .iter()
            .filter(|(a, b, _)| ours.contains(a) || ours.contains(b))
            .map(|(a, b, _)| format!("{} and {}", name(a), name(b)))
            .collect()
    })
}

#[test]
fn no_system_of_a_tick_is_ambiguous() {
    assert_eq!(ambiguities(FixedPostUpdate, EmbodyPlugins), [""; 0]);
}

#[test]
fn no_system_of_a_frame_is_ambiguous() {
    assert_eq!(ambiguities(PostUpdate, EmbodyPlugins), [""; 0]);
}

/// What no system of the crate looks at.
#[derive(Component)]
struct Marked;

#[test]
fn an_ambiguous_system_is_found() {
    let found = ambiguities(FixedPostUpdate, |app: &mut App| {
        app.add_plugins(EmbodyPlugins).add_systems(
            FixedPostUpdate,
            (
                (|_: Query<&mut Marked>| {}).in_set(EmbodySystems::Drive),
                |_: Query<&mut Marked>| {},
            ),
        );
    });
    assert_eq!(found.len(), 1, "{found:?}");
}
