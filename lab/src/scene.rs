//! The scenes that can be measured. A new one is a function and a line in [`SCENES`].

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::{
    Sim,
    wavy::{FASTEST, StableId, Walker, Wavy},
};

use crate::side::Side;

/// A world to measure.
pub struct Scene {
    pub name: &'static str,
    pub about: &'static str,
    /// Ticks until it is as it stays.
    pub warm_up: usize,
    /// Fills an empty world with this many characters.
    pub build: fn(&mut Sim, Side, u32),
}

/// All scenes.
pub const SCENES: &[Scene] = &[
    Scene {
        name: "characters",
        about: "a crowd walking over wavy terrain with stairs, pillars and crates",
        warm_up: 120,
        build: characters,
    },
    Scene {
        name: "idle",
        about: "a crowd standing on wavy terrain, nothing else there moves",
        warm_up: 300,
        build: idle,
    },
];

/// The scene of this name.
pub fn find(name: &str) -> Result<&'static Scene, String> {
    SCENES
        .iter()
        .find(|scene| scene.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = SCENES.iter().map(|scene| scene.name).collect();
            format!(
                "there is no scene `{name}`; there are: {}",
                names.join(", ")
            )
        })
}

#[derive(Resource)]
struct Ground(Wavy);

fn characters(sim: &mut Sim, side: Side, count: u32) {
    let wavy = Wavy::for_characters(count);
    let world = sim.app.world_mut();
    wavy.spawn_ground(world);
    wavy.spawn_crates(world, count);
    for i in 0..count {
        side.spawn(world, wavy.start(i), (StableId(i), Walker::new(i)));
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
        side.spawn(world, wavy.resting_place(i, steepest), StableId(i));
    }
}
