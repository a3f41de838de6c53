//! What a vehicle carries from tick to tick: all that a rollback must restore, beside its body's
//! transform and velocity.

use bevy::{
    ecs::{entity::MapEntities, reflect::ReflectMapEntities},
    prelude::*,
};

use super::intent::VehicleIntent;

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
    /// Velocity of the ground that the vehicle last stood on, world axes, metres per second. Speeds
    /// are measured against it, so that a deck, a train or a belt is ground like any other.
    pub ground_velocity: Vec3,
    /// Time for which the vehicle is not left to sleep, seconds.
    pub stay_awake: f32,
    /// What the last tick was asked: a change of it wakes a sleeper.
    pub asked: VehicleIntent,
    /// The wheels. Each finds its own by [`WheelDynamics::wheel`].
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
            ground_velocity: Vec3::ZERO,
            stay_awake: 0.0,
            asked: VehicleIntent::default(),
            wheels: Vec::new(),
        }
    }
}

/// The state of one wheel.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct WheelDynamics {
    /// Whose state this is; `None` is taken by the wheel at its place in [`Wheels`](super::Wheels).
    #[entities]
    pub wheel: Option<Entity>,
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
    /// Velocity of the ground in the last tick, world axes, metres per second. Of a dynamic body that at
    /// the start, at its centre of mass: how it changed tells whether anything else holds the body. Of
    /// other ground that under the wheel: how it changes tells how far the tick leaves the wheel behind.
    pub ground_speed: Vec3,
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
            wheel: None,
            spin: 0.0,
            angle: 0.0,
            compression: 0.0,
            compression_rate: 0.0,
            bristle: Vec2::ZERO,
            slip: 0.0,
            expected: Vec2::ZERO,
            ground_force: Vec3::ZERO,
            ground_speed: Vec3::ZERO,
            ground: None,
            plane: None,
            abs: 1.0,
            air_time: 0.0,
            slipping: false,
            bottomed: false,
        }
    }
}

/// No value of a state is beyond this in the units it has; what is was never computed here.
const MOST: f32 = 1.0e15;

impl VehicleState {
    /// Gives each of these wheels its own state, in their order, whichever were taken away, added or
    /// put in another order since the last tick.
    pub(crate) fn follow(&mut self, wheels: &[Entity]) {
        let fits = self.wheels.len() == wheels.len()
            && self
                .wheels
                .iter()
                .zip(wheels)
                .all(|(s, w)| s.wheel == Some(*w));
        if fits {
            return;
        }
        let before = core::mem::take(&mut self.wheels);
        self.wheels
            .extend(wheels.iter().enumerate().map(|(i, wheel)| {
                let own = before.iter().find(|s| s.wheel == Some(*wheel));
                let nobodys = before.get(i).filter(|s| s.wheel.is_none());
                WheelDynamics {
                    wheel: Some(*wheel),
                    ..own.or(nobodys).copied().unwrap_or_default()
                }
            }));
    }

    /// Replaces what is no number, as a broken message may bring it, by what a new vehicle has.
    pub(crate) fn heal(&mut self) {
        let scalars = [
            self.engine_speed,
            self.shifting,
            self.gear_age,
            self.steer_angle,
            self.clutch_torque,
            self.traction_cut,
            self.hill_hold,
            self.stay_awake,
        ];
        if !(sound(&scalars) && sound(&self.ground_velocity.to_array())) {
            *self = Self {
                gear: self.gear,
                asked: self.asked,
                wheels: core::mem::take(&mut self.wheels),
                ..Self::default()
            };
        }
        for wheel in &mut self.wheels {
            let scalars = [
                wheel.spin,
                wheel.angle,
                wheel.compression,
                wheel.compression_rate,
                wheel.slip,
                wheel.abs,
                wheel.air_time,
                wheel.bristle.x,
                wheel.bristle.y,
                wheel.expected.x,
                wheel.expected.y,
            ];
            let vectors = [wheel.ground_force, wheel.ground_speed];
            if !(sound(&scalars) && vectors.iter().all(|v| sound(&v.to_array()))) {
                *wheel = WheelDynamics {
                    wheel: wheel.wheel,
                    ..WheelDynamics::default()
                };
            }
        }
    }
}

fn sound(values: &[f32]) -> bool {
    values.iter().all(|v| v.abs() < MOST)
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
