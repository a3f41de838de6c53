//! What happens to a vehicle now and then, as entity events on the vehicle. They are triggered after
//! the tick's physics, when all poses are final.

use bevy::prelude::*;

/// A change of gear began.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct GearShifted {
    /// The vehicle.
    pub entity: Entity,
    /// Gear before: −1 reverse, 0 neutral, from 1 on forward.
    pub from: i8,
    /// Gear after.
    pub to: i8,
}

/// A wheel came down.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct WheelLanded {
    /// The vehicle.
    pub entity: Entity,
    /// The wheel.
    pub wheel: Entity,
    /// The entity of the ground's collider.
    pub ground: Entity,
    /// Speed towards the ground, metres per second.
    pub speed: f32,
    /// Time in the air, seconds.
    pub air_time: f32,
}

/// A wheel lost the ground.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct WheelLeftGround {
    /// The vehicle.
    pub entity: Entity,
    /// The wheel.
    pub wheel: Entity,
}

/// A suspension reached the end of its travel.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct BottomedOut {
    /// The vehicle.
    pub entity: Entity,
    /// The wheel.
    pub wheel: Entity,
    /// Force of the suspension, newtons.
    pub force: f32,
}

/// The engine died.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct EngineStalled {
    /// The vehicle.
    pub entity: Entity,
}

/// A tyre began to slide.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct SlipStarted {
    /// The vehicle.
    pub entity: Entity,
    /// The wheel.
    pub wheel: Entity,
    /// Speed of the slide, metres per second.
    pub speed: f32,
}

/// A tyre grips again.
#[derive(EntityEvent, Clone, Copy, Debug, PartialEq, Eq)]
pub struct SlipEnded {
    /// The vehicle.
    pub entity: Entity,
    /// The wheel.
    pub wheel: Entity,
}
