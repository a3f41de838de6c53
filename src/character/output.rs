//! What a tick found out about a character; rebuilt each tick, never read back by the solver.

use bevy::prelude::*;

/// Everything a character touched in the last tick.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct CharacterContacts {
    /// The contacts, in an order that depends on the geometry alone.
    pub contacts: Vec<CharacterContact>,
    /// Why a change of height was refused in the last tick.
    pub stance_refused: Option<StanceRefusal>,
    /// What came of the last attempt to climb a step, if one was made in the last tick.
    pub step: Option<StepAttempt>,
    /// How far the last tick was pulled down to stay on the ground, metres; 0 if it was not.
    pub snapped: f32,
    /// Number of geometry queries (distance evaluations) that the last tick took.
    pub queries: u32,
}

impl CharacterContacts {
    /// Leaves only what holds for one who does nothing: what it touches.
    pub(crate) fn rest(&mut self) {
        self.step = None;
        self.snapped = 0.0;
        self.queries = 0;
        for contact in &mut self.contacts {
            contact.impulse = Vec3::ZERO;
            contact.blocked = false;
        }
    }
}

/// One thing touched.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct CharacterContact {
    /// The entity of the collider.
    pub entity: Entity,
    /// Where, world, metres.
    pub point: Vec3,
    /// From the thing towards the character, unit length.
    pub normal: Vec3,
    /// Distance of the surfaces, metres; negative is depth.
    pub distance: f32,
    /// Impulse that the thing received from the character, newton-seconds, world axes.
    pub impulse: Vec3,
    /// Whether the character's motion was stopped by it.
    pub blocked: bool,
}

/// Why a change of height was refused.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[non_exhaustive]
pub enum StanceRefusal {
    /// Something is in the way.
    Blocked {
        /// The entity of the collider that is in the way.
        by: Entity,
        /// Height that there is room for, metres.
        room: f32,
    },
    /// The height asked for is not a finite positive number.
    BadHeight(f32),
}

/// An attempt to climb a step.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct StepAttempt {
    /// Where the riser was touched, world, metres.
    pub point: Vec3,
    /// Direction of the attempt, world, unit length, level.
    pub direction: Vec3,
    /// What came of it.
    pub result: StepResult,
}

/// What came of an attempt to climb a step.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[non_exhaustive]
pub enum StepResult {
    /// Climbed; the foot rose by this much in this tick, metres.
    Climbed(f32),
    /// Nothing above the foot to stand on behind the riser.
    NoLanding,
    /// The landing is higher than the step height.
    TooHigh,
    /// The landing is too steep to stand on.
    TooSteep,
    /// The landing is less deep than the minimum width.
    TooNarrow,
    /// No room for the character above or in front.
    NoRoom,
    /// The landing is a dynamic body.
    Dynamic,
    /// The step would not have brought the character forward.
    NoProgress,
}

/// What other characters see of a character during a tick: where it is and where it wants to go.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct CharacterSnapshot {
    pub(crate) velocity: Vec3,
    pub(crate) margin: f32,
    pub(crate) active: bool,
}
