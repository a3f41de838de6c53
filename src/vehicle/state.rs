//! What a vehicle carries from tick to tick: all that a rollback must restore, beside its body's
//! transform and velocity.

use bevy::{
    ecs::{entity::MapEntities, reflect::ReflectMapEntities},
    prelude::*,
};

/// The state of a vehicle and its wheels. The same state, body, intents and world give the same bits.
#[derive(Component, Reflect, Clone, Debug, PartialEq, MapEntities)]
#[reflect(Component, Default, Debug, PartialEq, Clone, MapEntities)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct VehicleState {
    /// Speed of engine or motor shaft, radians per second; 0 until the first tick.
    pub engine_speed: f32,
    /// Whether the engine was brought to its idle speed, as the first tick does.
    pub started: bool,
    /// Whether the engine has died.
    pub stalled: bool,
    /// Gear: −1 reverse, 0 neutral, from 1 on forward.
    pub gear: i8,
    /// Time left without traction in a change of gear, seconds.
    pub shifting: f32,
    /// Time since the last change of gear ended, seconds.
    pub gear_age: f32,
    /// Steering angle of the middle of the axle, radians, positive to the right.
    pub steer_angle: f32,
    /// Torque that went through the clutch in the last tick, newton-metres at the engine.
    pub clutch_torque: f32,
    /// Part of the throttle that traction control left in the last tick, `0..=1`.
    pub traction_cut: f32,
    /// Time for which hill hold still keeps the brakes, seconds.
    pub hill_hold: f32,
    /// Whether the fuel is cut at the redline.
    pub limiting: bool,
    /// Ticks since the ground was last looked for; see [`ProbeInterval`](super::ProbeInterval).
    pub probe_age: u8,
    /// The wheels, in the order of [`Wheels`](super::Wheels).
    #[entities]
    pub wheels: Vec<WheelDynamics>,
}

impl Default for VehicleState {
    fn default() -> Self {
        Self {
            engine_speed: 0.0,
            started: false,
            stalled: false,
            gear: 1,
            shifting: 0.0,
            gear_age: 1.0e3,
            steer_angle: 0.0,
            clutch_torque: 0.0,
            traction_cut: 1.0,
            hill_hold: 0.0,
            limiting: false,
            probe_age: 0,
            wheels: Vec::new(),
        }
    }
}

/// The state of one wheel.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WheelDynamics {
    /// Spin, radians per second, positive rolls forward.
    pub spin: f32,
    /// Angle of the spin, radians, `0..2π`.
    pub angle: f32,
    /// Compression of the suspension, metres, 0 at droop.
    pub compression: f32,
    /// Rate of the compression, metres per second.
    pub compression_rate: f32,
    /// Deflection of the tyre along and across, metres.
    pub bristle: Vec2,
    /// Slip velocity of the patch, along and across together, metres per second.
    pub slip: f32,
    /// Velocity of the hub against the ground that the last tick led to, along and across, metres per
    /// second: what it is now beyond that was done by others, and deflects the tyre.
    pub expected: Vec2,
    /// Force of the last tick on the ground, world axes, newtons.
    pub ground_force: Vec3,
    /// The entity of the collider that the wheel stands on.
    #[entities]
    pub ground: Option<Entity>,
    /// The plane on which the wheel was last found, where it is not looked for each tick.
    #[entities]
    pub plane: Option<GroundPlane>,
    /// Part of the brake that the anti-lock system leaves on, `0..=1`.
    pub abs: f32,
    /// Time since it left the ground, seconds; 0 on it.
    pub air_time: f32,
    /// Whether it slips beyond its peak.
    pub slipping: bool,
    /// Whether it is at the end of its travel.
    pub bottomed: bool,
}

impl Default for WheelDynamics {
    fn default() -> Self {
        Self {
            spin: 0.0,
            angle: 0.0,
            compression: 0.0,
            compression_rate: 0.0,
            bristle: Vec2::ZERO,
            slip: 0.0,
            expected: Vec2::ZERO,
            ground_force: Vec3::ZERO,
            ground: None,
            plane: None,
            abs: 1.0,
            air_time: 0.0,
            slipping: false,
            bottomed: false,
        }
    }
}

/// A plane of ground, in the frame of its collider.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundPlane {
    /// The entity of the collider.
    #[entities]
    pub entity: Entity,
    /// A point of it, metres.
    pub point: Vec3,
    /// Unit length.
    pub normal: Vec3,
}
