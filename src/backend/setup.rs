//! Brings up Rapier in the fixed schedule and keeps its step equal to the fixed clock.

use bevy::{prelude::*, transform::systems::mark_dirty_trees};
use bevy_rapier3d::{plugin::RapierTransformPropagateSet, prelude::*};

/// Adds Rapier to `FixedPostUpdate` unless the app already has it.
pub(crate) fn add_physics(app: &mut App) {
    // Registered first, or Rapier's own insertion leaves buffers that never flip.
    app.add_message::<CollisionEvent>()
        .add_message::<ContactForceEvent>()
        .add_message::<MassModifiedEvent>();
    app.insert_resource(TimestepMode::Fixed {
        dt: 1.0 / 64.0,
        substeps: 1,
    });
    if !app.is_plugin_added::<RapierPhysicsPlugin<NoUserData>>() {
        app.add_plugins(
            RapierPhysicsPlugin::<NoUserData>::default().in_schedule(FixedPostUpdate),
        );
    }
    app.add_systems(FixedFirst, follow_fixed_clock).add_systems(
        FixedPostUpdate,
        mark_dirty_trees
            .in_set(PhysicsSet::SyncBackend)
            .after(bevy_rapier3d::plugin::systems::update_character_controls)
            .before(RapierTransformPropagateSet),
    );
}

/// Makes Rapier's step as long as the tick that is about to run.
fn follow_fixed_clock(time: Res<Time<Fixed>>, mut mode: ResMut<TimestepMode>) {
    let tick = time.timestep().as_secs_f32();
    if let TimestepMode::Fixed { dt, .. } = mode.bypass_change_detection()
        && *dt != tick
    {
        *dt = tick;
    }
}
