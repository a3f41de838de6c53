//! Who is measured: our character controller or a peer, in otherwise equal apps.

use bevy::{prelude::*, transform::systems::mark_dirty_trees};
use bevy_embody::prelude::*;
use bevy_rapier3d::{
    plugin::{RapierTransformPropagateSet, systems::update_character_controls},
    prelude::*,
};
use clap::ValueEnum;
use embody_scenes::wavy::{FASTEST, Walker};
use serde::{Deserialize, Serialize};

use crate::probe::{Probe, begin, end};

/// Radius of every character, metres.
const RADIUS: f32 = 0.3;
/// Length of the cylindrical part of every character, metres.
const CYLINDER: f32 = 1.35;
/// Steepest ground, degrees.
const SLOPE: f32 = 50.0;
/// Highest step, metres.
const STEP: f32 = 0.4;
/// Least depth of a step, metres.
const LANDING: f32 = 0.05;
/// Reach down to the ground, metres.
const SNAP: f32 = 0.5;
/// Mass, kilograms.
const MASS: f32 = 70.0;

/// Whose controller moves the characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// `Character` of this project.
    Ours,
    /// `KinematicCharacterController` of `bevy_rapier3d`.
    Rapier,
}

impl Side {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Rapier => "rapier",
        }
    }

    /// Spawns a character that stands with its foot here.
    pub fn spawn(self, world: &mut World, foot: Vec3, extra: impl Bundle) {
        let foot = Transform::from_translation(foot);
        match self {
            Self::Ours => world.spawn((our_character(), our_motor(), foot, extra)),
            Self::Rapier => world.spawn((rapier_character(), foot, extra)),
        };
    }
}

/// Adds a side's controller and the probes around everything it does in a tick.
pub struct SidePlugin(pub Side);

impl Plugin for SidePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Probe>();
        match self.0 {
            // All sets of the plugin. What lies between them is the physics engine's own and would
            // be there without characters.
            Side::Ours => {
                use EmbodySystems::{Drive, Prepare, React};
                app.add_plugins(CharacterPlugin).add_systems(
                    FixedPostUpdate,
                    (
                        begin.before(Prepare),
                        end.after(Prepare).before(PhysicsSet::SyncBackend),
                        begin.after(PhysicsSet::SyncBackend).before(Drive),
                        end.after(Drive).before(PhysicsSet::StepSimulation),
                        begin.after(PhysicsSet::Writeback).before(React),
                        end.after(React),
                    ),
                );
            }
            // The controller has no gravity and keeps no velocity: the system that does so is as
            // small as it can be, and a part of the character's work, as it is on our side.
            Side::Rapier => {
                app.add_systems(
                    FixedPostUpdate,
                    (
                        (begin, fall_and_walk, end)
                            .chain()
                            .before(PhysicsSet::SyncBackend),
                        begin
                            .after(fall_and_walk)
                            .in_set(PhysicsSet::SyncBackend)
                            .before(update_character_controls),
                        end.after(update_character_controls)
                            .in_set(PhysicsSet::SyncBackend)
                            .before(mark_dirty_trees)
                            .before(RapierTransformPropagateSet),
                    ),
                );
            }
        }
    }
}

fn our_character() -> Character {
    Character {
        max_slope: SLOPE.to_radians(),
        step: Some(StepConfig {
            height: STEP,
            min_width: LANDING,
            onto_dynamic: true,
        }),
        ground_snap: SNAP,
        mass: MASS,
        ..Character::capsule(RADIUS, CYLINDER + 2.0 * RADIUS)
    }
}

fn our_motor() -> CharacterMotor {
    CharacterMotor {
        walk_speed: FASTEST,
        // As on the other side, a wish is a velocity at once.
        acceleration: f32::INFINITY,
        friction: f32::INFINITY,
        ..default()
    }
}

fn rapier_character() -> impl Bundle {
    let (low, high) = (Vec3::Y * RADIUS, Vec3::Y * (RADIUS + CYLINDER));
    (
        RigidBody::KinematicPositionBased,
        Collider::capsule(low, high, RADIUS),
        KinematicCharacterController {
            custom_mass: Some(MASS),
            offset: CharacterLength::Absolute(0.02),
            autostep: Some(CharacterAutostep {
                max_height: CharacterLength::Absolute(STEP),
                min_width: CharacterLength::Absolute(LANDING),
                include_dynamic_bodies: true,
            }),
            max_slope_climb_angle: SLOPE.to_radians(),
            min_slope_slide_angle: SLOPE.to_radians(),
            snap_to_ground: Some(CharacterLength::Absolute(SNAP)),
            apply_impulse_to_dynamic_bodies: true,
            ..default()
        },
        KinematicCharacterControllerOutput::default(),
    )
}

/// What a game has to do for Rapier's controller: gravity, and velocity to translation.
fn fall_and_walk(
    time: Res<Time>,
    mut characters: Query<(
        &mut KinematicCharacterController,
        &KinematicCharacterControllerOutput,
        Option<&Walker>,
    )>,
) {
    let dt = time.delta_secs();
    for (mut controller, output, walker) in &mut characters {
        // What was stopped does not go on falling.
        let fallen = if output.grounded {
            0.0
        } else {
            output.effective_translation.y.min(0.0)
        };
        let wish = walker.map_or(Vec3::ZERO, |walker| walker.wish);
        controller.translation = Some(wish * dt + Vec3::Y * (fallen - 9.81 * dt * dt));
    }
}
