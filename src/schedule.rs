//! When things happen in a tick, and the set-up of a fixed-step physics world.

use bevy::{app::AnimationSystems, ecs::schedule::SingleThreadedExecutor, prelude::*};
use bevy_rapier3d::prelude::PhysicsSet;

use crate::backend::{checks, setup, teleport};

/// The places of a tick where `bevy_embody` works.
///
/// The first three run in `FixedPostUpdate`, around Rapier's [`PhysicsSet`]s; what a game writes in
/// `FixedUpdate` is used by the same tick.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EmbodySystems {
    /// Before the physics backend takes over component changes: bodies are built and switched.
    ///
    /// A change of a component made here or earlier acts in this tick.
    Prepare,
    /// Between the backend's synchronisation and its step: sense, solve, write.
    ///
    /// Writes go straight to the backend's bodies. Before this set they would be overwritten by
    /// the components, and components written here wait for the next tick.
    Drive,
    /// After the results are written back: state, events, diagnostics.
    React,
    /// Once per frame in `PostUpdate`, after animation and before transforms are propagated: what is
    /// shown, such as skeletons between their animation and their bodies.
    Present,
}

/// The fixed-step set-up that every system stands on: physics in `FixedPostUpdate` at the rate of
/// [`Time<Fixed>`], in the order of [`EmbodySystems`].
///
/// Rapier's plugin is added unless the app adds it itself, before or after this one; an app that
/// does should put it `.in_schedule(FixedPostUpdate)`. The tick rate is that of [`Time<Fixed>`],
/// also when it changes at run time; Rapier's
/// [`TimestepMode`](bevy_rapier3d::prelude::TimestepMode) is only asked for its substeps.
/// Settings that cannot work are reported once, see [`EmbodyDiagnosis`](crate::EmbodyDiagnosis).
///
/// `FixedPostUpdate` runs its systems in line: physics makes nearly all of them wait for each other,
/// and an executor with threads would only hand them over, at some 20 microseconds each. Work inside
/// a system is shared among threads all the same. A game with systems there that gain by it gives the
/// schedule Bevy's [`MultiThreadedExecutor`](bevy::ecs::schedule::MultiThreadedExecutor) again, after
/// adding this plugin, by [`Schedule::set_executor`].
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyCorePlugin;

impl Plugin for EmbodyCorePlugin {
    fn build(&self, app: &mut App) {
        checks::add_checks(app);
        setup::add_clock(app);
        teleport::add_teleports(app);
        app.register_type::<crate::Teleported>();
        // Here and not when the app is finished, so that whoever wants another sets it afterwards.
        app.edit_schedule(FixedPostUpdate, |schedule| {
            schedule.set_executor(SingleThreadedExecutor::new());
        });
        app.configure_sets(
            FixedPostUpdate,
            (
                EmbodySystems::Prepare.before(PhysicsSet::SyncBackend),
                EmbodySystems::Drive
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
                EmbodySystems::React.after(PhysicsSet::Writeback),
            ),
        )
        .configure_sets(
            PostUpdate,
            EmbodySystems::Present
                .after(AnimationSystems)
                .before(TransformSystems::Propagate),
        );
    }

    // Here every plugin of the app is known, whatever the order in which they were added.
    fn finish(&self, app: &mut App) {
        setup::add_physics(app);
        checks::check_schedules(app);
        setup::adopt_timestep(app);
    }
}
