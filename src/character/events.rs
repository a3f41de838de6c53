//! What happens to a character now and then, as entity events: observe them on the character or
//! globally. They are triggered after the tick's physics, when all poses are final.

use bevy::prelude::*;

use super::intent::Stance;

/// It came down on ground that holds it.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Landed {
    /// The character.
    pub entity: Entity,
    /// The entity of the ground's collider.
    pub ground: Entity,
    /// Speed towards the ground at touch, metres per second.
    pub speed: f32,
    /// Time spent in the air, seconds.
    pub air_time: f32,
}

/// It left the ground: jumped, walked off an edge, or lost what it stood on.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct LeftGround {
    /// The character.
    pub entity: Entity,
    /// The entity of the ground's collider it left; it may be gone.
    pub ground: Option<Entity>,
    /// Whether it jumped.
    pub jumped: bool,
}

/// It climbed a step.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Stepped {
    /// The character.
    pub entity: Entity,
    /// How far the foot rose, metres.
    pub height: f32,
}

/// It ran into something, or something ran into it: triggered when a blocking contact begins.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Hit {
    /// The character.
    pub entity: Entity,
    /// The entity of the collider.
    pub other: Entity,
    /// Where, world, metres.
    pub point: Vec3,
    /// From the other towards the character, unit length.
    pub normal: Vec3,
    /// Closing speed along the normal, metres per second.
    pub speed: f32,
    /// Impulse that the other received, newton-seconds, world axes.
    pub impulse: Vec3,
}

/// Its height changed.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct StanceChanged {
    /// The character.
    pub entity: Entity,
    /// The stance reached.
    pub stance: Stance,
    /// Height before, metres.
    pub from: f32,
    /// Height now, metres.
    pub to: f32,
}

/// It is pinned between things that close on it. Triggered once when it begins.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Crushed {
    /// The character.
    pub entity: Entity,
    /// The entity of the collider that moves in on it.
    pub by: Entity,
    /// The entity of the collider it is pressed against.
    pub against: Option<Entity>,
    /// How deep the character is inside the one that moves in, metres.
    pub depth: f32,
}
