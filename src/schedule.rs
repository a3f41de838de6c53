//! When things happen in a tick, and the set-up of a fixed-step physics world.

use bevy::prelude::*;
use bevy_rapier3d::prelude::PhysicsSet;

use crate::backend::setup;

/// The places of a tick where `bevy_embody` works.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EmbodySystems {
    /// Before the physics backend takes over component changes: bodies are built and switched.
    Prepare,
    /// Between the backend's synchronisation and its step: sense, solve, write.
    Drive,
    /// After the results are written back: state, events, diagnostics.
    React,
    /// Once per frame in `PostUpdate`: what is shown.
    Present,
}

/// The fixed-step set-up that every system stands on: physics in `FixedPostUpdate` at the rate of
/// [`Time<Fixed>`], in the order of [`EmbodySystems`].
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyCorePlugin;

impl Plugin for EmbodyCorePlugin {
    fn build(&self, app: &mut App) {
        setup::add_physics(app);
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
            EmbodySystems::Present.before(TransformSystems::Propagate),
        );
    }
}
