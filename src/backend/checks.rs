//! Tells about settings that cannot work: each once, in words that say what to do.

use bevy::{ecs::schedule::ScheduleLabel, prelude::*};
use bevy_rapier3d::prelude::*;
use core::fmt;

use super::setup;
use crate::EmbodySystems;

/// What is wrong with the set-up of the app, as found at start-up and since.
///
/// Each kind of problem is kept, and logged as a warning, only the first time it is met.
#[derive(Resource, Clone, Debug, Default)]
pub struct EmbodyDiagnosis {
    problems: Vec<EmbodyProblem>,
}

impl EmbodyDiagnosis {
    /// The problems found, in the order in which they were found.
    pub fn problems(&self) -> &[EmbodyProblem] {
        &self.problems
    }

    /// Whether nothing wrong was found.
    pub fn is_healthy(&self) -> bool {
        self.problems.is_empty()
    }

    pub(crate) fn report(&mut self, problem: EmbodyProblem) {
        let kind = core::mem::discriminant(&problem);
        if self
            .problems
            .iter()
            .any(|known| core::mem::discriminant(known) == kind)
        {
            return;
        }
        tracing::warn!("{problem}");
        self.problems.push(problem);
    }
}

/// A wrong setting. Its text says what it leads to and what to do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum EmbodyProblem {
    /// [`TimestepMode`] is not `Fixed`.
    NotFixedTimestep,
    /// [`TimestepMode`] asks for another step than [`Time<Fixed>`].
    DifferentTimestep {
        /// What Rapier was asked for, seconds.
        rapier: f32,
        /// What it is given: the length of a tick, seconds.
        fixed: f32,
    },
    /// Rapier runs in another schedule than `FixedPostUpdate`.
    OtherSchedule {
        /// The name of that schedule.
        schedule: String,
    },
    /// Rapier's systems were not added to any schedule.
    NoSchedule,
    /// There are bodies, but no Rapier context that could hold them.
    NoContext,
    /// A plugin that stands on [`EmbodyCorePlugin`](crate::EmbodyCorePlugin) was added without it.
    NoCore {
        /// The name of that plugin.
        plugin: &'static str,
    },
    /// A character's body is moved by Rapier as well.
    MovedTwice {
        /// The first one met.
        entity: Entity,
        /// What its body is.
        body: RigidBody,
    },
    /// A character's collider is a sensor.
    SensorCharacter {
        /// The first one met.
        entity: Entity,
    },
    /// A body is scaled.
    ScaledBody {
        /// The first one met.
        entity: Entity,
        /// Its scale in the world.
        scale: Vec3,
    },
}

impl fmt::Display for EmbodyProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFixedTimestep => f.write_str(
                "Rapier's `TimestepMode` is variable or interpolated, so the physics step is not \
                 the tick of `Time<Fixed>`: speeds will depend on the frame rate. Insert \
                 `TimestepMode::Fixed`, or none; `Interpolated` gives smooth motion in its place.",
            ),
            Self::DifferentTimestep { rapier, fixed } => write!(
                f,
                "Rapier's `TimestepMode` asks for a step of {rapier} s, but a tick of \
                 `Time<Fixed>` is {fixed} s long. The tick wins. Set the rate with \
                 `Time::<Fixed>::from_hz`; of `TimestepMode` only `substeps` is used."
            ),
            Self::OtherSchedule { schedule } => write!(
                f,
                "Rapier runs in `{schedule}`, not in `FixedPostUpdate`: what bevy_embody computes \
                 reaches it late or not at all. Add \
                 `RapierPhysicsPlugin::<..>::default().in_schedule(FixedPostUpdate)`, or leave \
                 Rapier to `EmbodyPlugins`."
            ),
            Self::NoSchedule => f.write_str(
                "Rapier's plugin is there, but its systems are in no schedule, so nothing will \
                 move. Remove `with_default_system_setup(false)`, or add the systems to \
                 `FixedPostUpdate`.",
            ),
            Self::NoContext => f.write_str(
                "There are physics bodies, but no Rapier context to hold them, so they will not \
                 move. Spawn an entity with `RapierContextSimulation` and `DefaultRapierContext`, \
                 or do not insert `RapierContextInitialization::NoAutomaticRapierContext`.",
            ),
            Self::NoCore { plugin } => write!(
                f,
                "`{plugin}` was added without `EmbodyCorePlugin`, so nothing tells when its systems \
                 run beside Rapier's. Add `EmbodyCorePlugin` as well, or `EmbodyPlugins` in place of \
                 both."
            ),
            Self::MovedTwice { entity, body } => write!(
                f,
                "{entity} is a character with `RigidBody::{body:?}`, so Rapier and the character's \
                 solver both move it. Leave the component out, or set \
                 `RigidBody::KinematicPositionBased`. Other such characters are not reported."
            ),
            Self::SensorCharacter { entity } => write!(
                f,
                "{entity} is a character with a `Sensor`, so other characters and bodies pass \
                 through it. Put the sensor on a child; to let some pass through, use \
                 `CollisionGroups` or `CharacterFilter`. Other such characters are not reported."
            ),
            Self::ScaledBody { entity, scale } => write!(
                f,
                "{entity} has a `RigidBody` and a scale of {scale}. Only the shape of its \
                 collider is scaled; joints, offsets and sizes in metres are not. Give it a scale \
                 of 1 and put the mesh on a scaled child. Other scaled bodies are not reported."
            ),
        }
    }
}

/// Bodies spawned since the last tick.
#[derive(Resource, Default)]
struct NewBodies(Vec<Entity>);

/// Adds the checks that need a running world.
pub(crate) fn add_checks(app: &mut App) {
    app.init_resource::<EmbodyDiagnosis>()
        .init_resource::<NewBodies>()
        .add_observer(|add: On<Add, RigidBody>, mut new: ResMut<NewBodies>| {
            new.0.push(add.entity);
        })
        .add_systems(
            FixedPostUpdate,
            check_new_bodies
                .in_set(EmbodySystems::React)
                .run_if(|new: Res<NewBodies>| !new.0.is_empty()),
        );
}

fn check_new_bodies(
    mut new: ResMut<NewBodies>,
    mut diagnosis: ResMut<EmbodyDiagnosis>,
    poses: Query<&GlobalTransform, With<RigidBody>>,
    contexts: Query<(), With<RapierContextSimulation>>,
) {
    if contexts.is_empty() {
        diagnosis.report(EmbodyProblem::NoContext);
    }
    for entity in new.0.drain(..) {
        let Ok(pose) = poses.get(entity) else {
            continue;
        };
        let scale = pose.scale();
        // Scales that come out of a chain of parents are 1 only to rounding.
        if scale.is_finite() && !scale.abs_diff_eq(Vec3::ONE, 1e-4) {
            diagnosis.report(EmbodyProblem::ScaledBody { entity, scale });
        }
    }
}

/// Checks where Rapier's systems are.
pub(crate) fn check_schedules(app: &mut App) {
    let schedules = setup::physics_schedules(app.world());
    if schedules.contains(&FixedPostUpdate.intern()) {
        return;
    }
    let problem = match schedules.first() {
        Some(schedule) => EmbodyProblem::OtherSchedule {
            schedule: format!("{schedule:?}"),
        },
        None => EmbodyProblem::NoSchedule,
    };
    app.world_mut()
        .get_resource_or_init::<EmbodyDiagnosis>()
        .report(problem);
}
