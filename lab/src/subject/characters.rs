//! Characters: our controller beside `KinematicCharacterController`.

use bevy::{prelude::*, transform::systems::mark_dirty_trees};
use bevy_embody::prelude::*;
use bevy_rapier3d::{
    plugin::{RapierTransformPropagateSet, systems::update_character_controls},
    prelude::*,
};
use embody_scenes::{
    Sim,
    harness::around_tick,
    terrain::StableId,
    wavy::{FASTEST, LOWEST, Walker, Wavy},
};

use super::{Bounds, Compared, Seen, Subject, Variant};
use crate::{
    probe::{begin, end},
    scene::Scene,
    side::Side,
};

pub const SUBJECT: Subject = Subject {
    name: "characters",
    one: "character",
    scenes: &[
        Scene {
            name: "characters",
            about: "a crowd walking over wavy terrain with stairs, pillars and crates",
            warm_up: 120,
            build: crowd,
        },
        Scene {
            name: "idle",
            about: "a crowd standing on wavy terrain, nothing else there moves",
            warm_up: 300,
            build: idle,
        },
    ],
    compared: &[Compared {
        scene: "characters",
        tag: "",
        label: "",
        ratio: Some(0.10),
        most: None,
    }],
    plugin: add_plugin,
    watch,
    // Nobody gets above this without being thrown.
    level: LOWEST - 0.1..6.0,
    count: 100,
    steps: 500,
    variants: &[Variant {
        scene: "idle",
        name: "idle",
        label: "idle",
        count: 1000,
        most: 0.3,
    }],
    bounds: Bounds {
        speed_up: 1.7,
        growth: 1.2,
    },
    together: false,
    counted: "What is timed is the characters' work alone: all our systems; for Rapier its controller's system and\n\
              the game's gravity.",
};

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

/// Spawns a character that stands with its foot here.
fn spawn(side: Side, world: &mut World, foot: Vec3, extra: impl Bundle) {
    let foot = Transform::from_translation(foot);
    match side {
        Side::Ours => world.spawn((our_character(), our_motor(), foot, extra)),
        Side::Rapier => world.spawn((rapier_character(), foot, extra)),
    };
}

fn add_plugin(app: &mut App, side: Side) {
    match side {
        // All sets of the plugin. What lies between them is the physics engine's own and would
        // be there without characters.
        Side::Ours => {
            use EmbodySystems::{Drive, Prepare, React};
            app.add_plugins(CharacterPlugin);
            around_tick(app, [Prepare, Drive, React], begin, end);
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

fn watch(world: &mut World) -> Vec<Seen> {
    let mut walkers = world.query::<(&StableId, &Walker, &Transform)>();
    walkers
        .iter(world)
        .map(|(id, walker, transform)| Seen {
            id: *id,
            at: transform.translation,
            wished: walker.wish.length(),
            upright: true,
        })
        .collect()
}

#[derive(Resource)]
struct Ground(Wavy);

fn crowd(sim: &mut Sim, side: Side, count: u32) {
    let wavy = Wavy::for_characters(count);
    let world = sim.app.world_mut();
    wavy.spawn_ground(world);
    wavy.spawn_crates(world, count);
    for i in 0..count {
        let extra = (StableId(i), Walker::new(i));
        spawn(side, world, wavy.start(i), extra);
    }
    sim.app
        .insert_resource(Ground(wavy))
        .add_systems(FixedUpdate, steer);
}

/// The game's part, the same on every side and not measured.
fn steer(
    ground: Res<Ground>,
    mut walkers: Query<(&mut Walker, &Transform, Option<&mut CharacterIntent>)>,
) {
    for (mut walker, transform, intent) in &mut walkers {
        walker.steer(&ground.0, transform.translation);
        if let Some(mut intent) = intent {
            intent.movement = walker.wish / FASTEST;
        }
    }
}

fn idle(sim: &mut Sim, side: Side, count: u32) {
    let wavy = Wavy::for_characters(count);
    let world = sim.app.world_mut();
    wavy.spawn_ground(world);
    let steepest = 40f32.to_radians();
    for i in 0..count {
        spawn(side, world, wavy.resting_place(i, steepest), StableId(i));
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
