//! A kinematic character controller.

mod body;
mod checks;
mod config;
mod drive;
mod events;
mod guard;
mod intent;
mod measure;
mod motor;
mod output;
mod platform;
mod react;
mod report;
mod solver;
mod state;
mod surface;
mod tick;
mod validate;

use bevy::prelude::*;

use crate::{
    backend::{
        activity::Activity,
        checks::{EmbodyDiagnosis, EmbodyProblem},
        forces::ForcedBodies,
    },
    schedule::{EmbodyCorePlugin, EmbodySystems},
};

pub use config::{Character, CharacterShape, LeaveVelocity, SlopeSpeed, StepConfig};
pub use events::{Crushed, Hit, Landed, LeftGround, StanceChanged, Stepped};
pub use intent::{CharacterIntent, Stance};
pub use motor::{CharacterMotor, CustomMotor};
pub use output::{CharacterContact, CharacterContacts, StanceRefusal, StepAttempt, StepResult};
pub use state::{
    Anchor, CharacterState, Ground, GroundMaterial, GroundState, LastPose, MovementMode,
};
pub use surface::{
    CharacterFilter, CharacterIgnores, CharacterUp, Ladder, NotPushable, SurfaceGrip,
    SurfaceVelocity, UpDirection, WaterVolume,
};

/// The one system that solves all characters.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct SolveCharacters;

/// Adds the character controller. Needs [`EmbodyCorePlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct CharacterPlugin;

impl Plugin for CharacterPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Character>()
            .register_type::<CharacterMotor>()
            .register_type::<CustomMotor>()
            .register_type::<CharacterIntent>()
            .register_type::<CharacterState>()
            .register_type::<CharacterContacts>()
            .register_type::<CharacterIgnores>()
            .register_type::<CharacterUp>()
            .register_type::<SurfaceVelocity>()
            .register_type::<SurfaceGrip>()
            .register_type::<WaterVolume>()
            .register_type::<Ladder>()
            .register_type::<NotPushable>()
            .register_type::<Landed>()
            .register_type::<LeftGround>()
            .register_type::<Stepped>()
            .register_type::<Hit>()
            .register_type::<StanceChanged>()
            .register_type::<Crushed>()
            .init_resource::<Activity>()
            .init_resource::<ForcedBodies>()
            .init_resource::<measure::Stopwatch>()
            .add_observer(body::unmake)
            .add_systems(
                FixedPostUpdate,
                (
                    // One system each: handing over from one to the next costs an executor with
                    // threads more than many a character does.
                    checks::check_bodies
                        .pipe(checks::check_surroundings)
                        .pipe(guard::keep_finite)
                        .pipe(body::build_bodies)
                        .pipe(body::resize_colliders)
                        .in_set(EmbodySystems::Prepare),
                    measure::start
                        .pipe(motor::drive_motors)
                        .pipe(drive::refresh_world)
                        .pipe(drive::solve_characters)
                        .pipe(drive::apply_effects)
                        .pipe(measure::stop)
                        .in_set(SolveCharacters)
                        .in_set(EmbodySystems::Drive),
                    react::trigger_events.in_set(EmbodySystems::React),
                )
                    .run_if(any_with_component::<Character>),
            )
            // Also when the last character is gone. Rapier's list of changed bodies has got its memory
            // by then.
            .add_systems(
                FixedPostUpdate,
                drive::end_forces
                    .in_set(EmbodySystems::Drive)
                    .before(SolveCharacters),
            );
    }

    // Here every plugin of the app is known, whatever the order in which they were added.
    fn finish(&self, app: &mut App) {
        if !app.is_plugin_added::<EmbodyCorePlugin>() {
            app.world_mut()
                .get_resource_or_init::<EmbodyDiagnosis>()
                .report(EmbodyProblem::NoCore {
                    plugin: "CharacterPlugin",
                });
        }
    }
}
