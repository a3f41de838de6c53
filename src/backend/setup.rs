//! Brings up Rapier in the fixed schedule and keeps its step equal to the fixed clock.

use bevy::{
    ecs::{
        message::MessageRegistry,
        schedule::{InternedScheduleLabel, IntoSystemSet, NodeId, Schedules, SystemSet},
    },
    prelude::*,
    transform::systems::mark_dirty_trees,
};
use bevy_rapier3d::{
    plugin::{RapierTransformPropagateSet, systems},
    prelude::*,
};

use super::{
    checks::{EmbodyDiagnosis, EmbodyProblem},
    hierarchy,
};

/// The step length that was last written to [`TimestepMode`], seconds: another value there was
/// written by someone else.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub(crate) struct FollowedStep(Option<f32>);

/// Keeps Rapier's step as long as the tick that is about to run.
pub(crate) fn add_clock(app: &mut App) {
    // Rapier's plugin, whenever it is added, keeps a mode that is already there.
    if !app.world().contains_resource::<TimestepMode>() {
        let dt = fixed_timestep(app.world());
        app.insert_resource(TimestepMode::Fixed { dt, substeps: 1 })
            .insert_resource(FollowedStep(Some(dt)));
    }
    app.init_resource::<FollowedStep>()
        .add_systems(FixedFirst, follow_fixed_clock);
}

/// Adds Rapier to `FixedPostUpdate` unless the app has it, and mends what its set-up leaves open.
pub(crate) fn add_physics(app: &mut App) {
    if !has_rapier(app) {
        let rapier = RapierPhysicsPlugin::<NoUserData>::default().in_schedule(FixedPostUpdate);
        app.add_plugins(rapier);
        // The app finishes only plugins that were there when it began to.
        let rapier = RapierPhysicsPlugin::<NoUserData>::default().in_schedule(FixedPostUpdate);
        Plugin::finish(&rapier, app);
    }
    register_messages(app.world_mut());
    for schedule in physics_schedules(app.world()) {
        // Without this, Bevy's multithreaded propagation skips bodies with children in every tick
        // but a frame's first, and the writeback then reverts their motion.
        app.add_systems(
            schedule,
            mark_dirty_trees
                .in_set(PhysicsSet::SyncBackend)
                .after(systems::update_character_controls)
                .before(RapierTransformPropagateSet),
        );
        hierarchy::add_mending(app, schedule);
    }
}

/// Whether any Rapier plugin is there, also one with hooks of the game's own.
fn has_rapier(app: &App) -> bool {
    app.is_plugin_added::<RapierPhysicsPlugin<NoUserData>>()
        || !physics_schedules(app.world()).is_empty()
}

/// The schedules that contain Rapier's systems.
pub(crate) fn physics_schedules(world: &World) -> Vec<InternedScheduleLabel> {
    let Some(schedules) = world.get_resource::<Schedules>() else {
        return Vec::new();
    };
    // A set of one system, whose name does not depend on the hooks. It has members only where the
    // system itself was added, not where others are ordered by it.
    let marker = systems::writeback_rigid_bodies.into_system_set().intern();
    schedules
        .iter()
        .filter_map(|(_, schedule)| {
            let graph = schedule.graph();
            let key = graph.system_sets.get_key(marker)?;
            graph
                .hierarchy()
                .neighbors(NodeId::Set(key))
                .next()
                .map(|_| schedule.label())
        })
        .collect()
}

/// Rapier inserts its message buffers without registering them, so that they would grow for ever;
/// registering twice would flip them twice.
fn register_messages(world: &mut World) {
    fn register<M: Message>(world: &mut World) {
        MessageRegistry::deregister_messages::<M>(world);
        MessageRegistry::register_message::<M>(world);
    }
    register::<CollisionEvent>(world);
    register::<ContactForceEvent>(world);
    register::<MassModifiedEvent>(world);
}

/// Replaces Rapier's own default mode, which nobody asked for, and compares any other with the
/// clock.
pub(crate) fn adopt_timestep(app: &mut App) {
    let tick = fixed_timestep(app.world());
    let world = app.world_mut();
    let followed = world.get_resource_or_init::<FollowedStep>().0;
    let mut problem = None;
    if let Some(mut mode) = world.get_resource_mut::<TimestepMode>() {
        if *mode == TimestepMode::default() {
            *mode = TimestepMode::Fixed {
                dt: tick,
                substeps: 1,
            };
        } else {
            problem = set_step(&mut mode, tick, followed);
        }
    }
    world.insert_resource(FollowedStep(Some(tick)));
    if let Some(problem) = problem {
        world
            .get_resource_or_init::<EmbodyDiagnosis>()
            .report(problem);
    }
}

/// Makes Rapier's step as long as the tick that is about to run.
fn follow_fixed_clock(
    time: Res<Time<Fixed>>,
    mut mode: ResMut<TimestepMode>,
    mut followed: ResMut<FollowedStep>,
    mut diagnosis: ResMut<EmbodyDiagnosis>,
) {
    // A new timestep set during a tick is the length of the next one, not of this.
    let tick = time.delta_secs();
    if tick <= 0.0 {
        return;
    }
    if let Some(problem) = set_step(mode.bypass_change_detection(), tick, followed.0) {
        diagnosis.report(problem);
    }
    followed.0 = Some(tick);
}

/// Writes the step length, keeping the substeps; tells what was wrong with what was there.
fn set_step(mode: &mut TimestepMode, tick: f32, followed: Option<f32>) -> Option<EmbodyProblem> {
    let TimestepMode::Fixed { dt, .. } = mode else {
        return Some(EmbodyProblem::NotFixedTimestep);
    };
    let asked = *dt;
    *dt = tick;
    // Two ways to round the same rate to a step differ in the last digits.
    let differs = (asked - tick).abs() > 1e-5 * tick;
    (differs && followed != Some(asked)).then_some(EmbodyProblem::DifferentTimestep {
        rapier: asked,
        fixed: tick,
    })
}

/// Length of a tick, seconds.
fn fixed_timestep(world: &World) -> f32 {
    world
        .get_resource::<Time<Fixed>>()
        .map_or(Time::<Fixed>::default().timestep(), Time::<Fixed>::timestep)
        .as_secs_f32()
}
