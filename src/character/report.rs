//! What a tick decided about a character, on its way from the solver to the physics world and to
//! the events. Lives within one tick.

use bevy::prelude::*;

use super::{intent::Stance, state::GroundState};
use crate::backend::{motion::WorldPose, neighbourhood::MoverMemory};

/// The decisions of one tick.
#[derive(Component, Default)]
pub(crate) struct CharacterReport {
    /// Whether the motor had anything to do.
    pub woken: bool,
    /// Whether the character was solved this tick.
    pub solved: bool,
    /// Mean own velocity over the tick, metres per second.
    pub mean: Vec3,
    /// Ground state when the tick began.
    pub was: GroundState,
    /// Ground when the tick began.
    pub left: Option<Entity>,
    pub jumped: bool,
    /// Whether gravity pulls it off the ground.
    pub lifted: bool,
    /// Whether the game put it somewhere before the tick.
    pub placed: bool,
    /// Where to be at the end of the tick.
    pub target: Option<WorldPose>,
    pub impulses: Vec<BodyImpulse>,
    pub happened: Happened,
    pub hits: Vec<NewHit>,
    /// Blocking entities of the last two ticks, to tell a new hit from a lasting contact.
    pub touching: Vec<Entity>,
    pub touched: Vec<Entity>,
}

impl CharacterReport {
    /// Whether anything happened that events tell of.
    pub fn tells(&self) -> bool {
        let Happened {
            landed,
            left,
            stepped,
            stance,
            crushed,
        } = &self.happened;
        *left
            || landed.is_some()
            || stepped.is_some()
            || stance.is_some()
            || crushed.is_some()
            || !self.hits.is_empty()
    }
}

/// What a character remembers of the meshes around it. Changes nothing of what it finds.
#[derive(Component, Default)]
pub(crate) struct CharacterMemory(pub MoverMemory);

/// An impulse for a dynamic body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyImpulse {
    pub body: Entity,
    /// At once, newton-seconds, world axes.
    pub impulse: Vec3,
    /// Evenly over the tick, newtons, world axes.
    pub force: Vec3,
    /// World, metres.
    pub point: Vec3,
    /// Whether a sleeping body wakes up by it.
    pub wake: bool,
}

/// Rare happenings of one tick.
#[derive(Clone, Copy, Default)]
pub(crate) struct Happened {
    pub landed: Option<(Entity, f32, f32)>,
    pub left: bool,
    pub stepped: Option<f32>,
    pub stance: Option<(Stance, f32, f32)>,
    pub crushed: Option<(Entity, Option<Entity>, f32)>,
}

/// A blocking contact that began.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NewHit {
    pub other: Entity,
    pub point: Vec3,
    pub normal: Vec3,
    pub speed: f32,
    pub impulse: Vec3,
}
