//! Smooth motion on screen: what is shown between two ticks lies between their poses.
//!
//! Physics runs at the rate of [`Time<Fixed>`], frames are drawn at another. With
//! [`EmbodyInterpolationPlugin`], which [`EmbodyPlugins`](crate::EmbodyPlugins) contains, the
//! [`Transform`] of every [`Interpolated`] entity holds, outside the fixed schedules, a pose between
//! those of the last two ticks; inside them it holds the exact pose. Characters, vehicles and the
//! bones of ragdolls are interpolated by themselves; add [`Interpolated`] to other bodies that are seen
//! moving. To leave one out, give it [`NotInterpolated`]; to leave all out, as on a server, disable the
//! plugin:
//!
//! ```
//! # use bevy::prelude::*;
//! # use bevy_embody::{interpolation::EmbodyInterpolationPlugin, prelude::*};
//! # let mut app = App::new();
//! app.add_plugins(EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>());
//! ```
//!
//! A jump is not drawn as a motion; [`Teleported`] says what counts as one. A
//! rotation written outside the fixed schedules, as by a mouse, is shown at once and leaves the
//! translation smooth.
//!
//! The easing itself is that of [`bevy_transform_interpolation`].

use bevy::{ecs::system::SystemChangeTick, prelude::*};
use bevy_rapier3d::prelude::{PhysicsSet, RigidBody};
use bevy_transform_interpolation::{
    LastEasingTick, NoTransformEasing, RotationEasingState, TransformEasingPlugin,
    TransformEasingSystems, TranslationEasingState, prelude::TransformInterpolationPlugin,
    reset_easing_states_on_transform_change,
};

// Not by glob: Rapier's `TransformInterpolation` is another thing of the same name.
pub use bevy_transform_interpolation::prelude::{RotationInterpolation, TranslationInterpolation};

use crate::{Teleported, backend::handles::update_character_controls};

/// Shows this entity between the poses of the last two ticks; see the [module](self).
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_embody::prelude::*;
/// # use bevy_rapier3d::prelude::*;
/// # fn spawn(mut commands: Commands) {
/// commands.spawn((RigidBody::Dynamic, Collider::ball(0.5), Interpolated));
/// # }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(TranslationInterpolation, RotationInterpolation)]
pub struct Interpolated;

/// Leaves this entity out, a character for example: it is shown where the last tick ended.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[require(NoTransformEasing)]
pub struct NotInterpolated;

/// Adds interpolation between ticks. Without it [`Interpolated`] does nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyInterpolationPlugin;

impl Plugin for EmbodyInterpolationPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Interpolated>()
            .register_type::<NotInterpolated>()
            .add_observer(show_teleported_at_once);
        // An error here means that the app has registered it itself.
        let _ = app.try_register_required_components::<TranslationInterpolation, Shown>();
        #[cfg(feature = "character")]
        {
            use crate::character::Character;
            let _ = app.try_register_required_components::<Character, Interpolated>();
            let _ = app.try_register_required_components::<Character, MovedBySolver>();
            // What is no character any more is moved by the game again.
            app.add_observer(|removed: On<Remove, Character>, mut commands: Commands| {
                if let Ok(mut entity) = commands.get_entity(removed.entity) {
                    entity.try_remove::<MovedBySolver>();
                }
            });
        }
        #[cfg(feature = "vehicle")]
        {
            use crate::vehicle::Vehicle;
            let _ = app.try_register_required_components::<Vehicle, Interpolated>();
        }

        #[cfg(feature = "ragdoll")]
        {
            use crate::ragdoll::{FollowRoot, RagdollBone};
            let _ = app.try_register_required_components::<RagdollBone, Interpolated>();
            let _ = app.try_register_required_components::<FollowRoot, Interpolated>();
        }

        app.add_systems(
            RunFixedMainLoop,
            (
                keep_outside_writes
                    .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop)
                    .before(reset_easing_states_on_transform_change),
                remember_shown
                    .in_set(RunFixedMainLoopSystems::AfterFixedMainLoop)
                    .after(TransformEasingSystems::UpdateEasingTick),
            ),
        )
        .add_systems(
            FixedPostUpdate,
            notice_jumps
                .in_set(PhysicsSet::SyncBackend)
                .before(update_character_controls),
        )
        .add_systems(
            FixedLast,
            leave_resting_alone.after(TransformEasingSystems::UpdateEnd),
        );
    }

    // The app may have added the crate's own plugins, before or after this one.
    fn finish(&self, app: &mut App) {
        if !app.is_plugin_added::<TransformInterpolationPlugin>() {
            app.add_plugins(TransformInterpolationPlugin::default());
        }
        if !app.is_plugin_added::<TransformEasingPlugin>() {
            app.add_plugins(TransformEasingPlugin);
        }
    }
}

/// The pose that was last left for the frame to draw; another one in the [`Transform`] was written
/// by the game.
#[derive(Component, Clone, Copy, Debug, Default)]
struct Shown(Option<(Vec3, Quat)>);

/// On kinematic bodies that one of this crate's systems moves, not the game.
#[derive(Component, Clone, Copy, Debug, Default)]
struct MovedBySolver;

/// Lets go of what the game has written since the last frame's easing: the next tick would reset it
/// to the end of the easing.
fn keep_outside_writes(
    mut eased: Query<(
        &Transform,
        &Shown,
        &mut TranslationEasingState,
        Option<&mut RotationEasingState>,
    )>,
    mut last_easing: ResMut<LastEasingTick>,
    now: SystemChangeTick,
) {
    for (transform, shown, mut translation, rotation) in &mut eased {
        let Some((shown_translation, shown_rotation)) = shown.0 else {
            continue;
        };
        if transform.translation != shown_translation {
            *translation = TranslationEasingState::default();
        }
        if let Some(mut rotation) = rotation
            && transform.rotation != shown_rotation
        {
            *rotation = RotationEasingState::default();
        }
    }
    // The easing crate's own rule would stop the translation of what is only turned, as by a mouse.
    **last_easing = now.this_run();
}

fn remember_shown(mut eased: Query<(&Transform, &mut Shown)>) {
    for (transform, mut shown) in &mut eased {
        shown.0 = Some((transform.translation, transform.rotation));
    }
}

/// Finds bodies that physics moves and that the game has moved in this tick, and shows their new
/// place at once.
fn notice_jumps(
    mut bodies: Query<(
        &Transform,
        &RigidBody,
        Has<MovedBySolver>,
        &mut TranslationEasingState,
        Option<&mut RotationEasingState>,
    )>,
) {
    for (transform, body, by_solver, mut translation, rotation) in &mut bodies {
        // To write the pose of any other kinematic body is how it is moved.
        let moved_by_physics = *body != RigidBody::KinematicPositionBased || by_solver;
        if let Some(start) = translation.start
            && moved_by_physics
            && transform.translation != start
        {
            // An easing without a start shows its end.
            translation.start = None;
            if let Some(mut rotation) = rotation {
                rotation.start = None;
            }
        }
    }
}

/// Easing would write the same pose each frame, which looks like a change to everyone who asks.
fn leave_resting_alone(
    mut eased: Query<(
        &mut TranslationEasingState,
        Option<&mut RotationEasingState>,
    )>,
) {
    for (mut translation, rotation) in &mut eased {
        if translation.start == translation.end {
            *translation = TranslationEasingState::default();
        }
        if let Some(mut rotation) = rotation
            && rotation.start == rotation.end
        {
            *rotation = RotationEasingState::default();
        }
    }
}

fn show_teleported_at_once(
    event: On<Teleported>,
    mut easing: Query<(
        &mut TranslationEasingState,
        Option<&mut RotationEasingState>,
    )>,
) {
    if let Ok((mut translation, rotation)) = easing.get_mut(event.entity) {
        *translation = TranslationEasingState::default();
        if let Some(mut rotation) = rotation {
            *rotation = RotationEasingState::default();
        }
    }
}
