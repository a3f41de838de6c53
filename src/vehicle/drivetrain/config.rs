//! What a drivetrain is made of.

use bevy::prelude::*;

/// Everything between the throttle and the wheels. Which wheels are driven is told by
/// [`Wheel::driven`](crate::vehicle::Wheel::driven).
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Drivetrain {
    /// What makes the torque.
    pub source: PowerSource,
    /// Joins an engine to the gearbox; electric motors are always joined.
    pub clutch: Clutch,
    /// Gears.
    pub gearbox: Gearbox,
    /// Ratio of the final drive, turns of the propeller shaft for one of the wheels, above 0.
    pub final_drive: f32,
    /// Part of the torque that reaches the wheels, `0..=1`, above 0.
    pub efficiency: f32,
    /// Share and differential of each driven axle. An axle with driven wheels that is not listed gets
    /// a share of 1 and an open differential.
    pub axles: Vec<DrivenAxle>,
    /// Between the driven axles.
    pub center: Differential,
    /// Whether all driven wheels of one side turn together, as under a track.
    pub tracks: bool,
}

impl Default for Drivetrain {
    fn default() -> Self {
        Self {
            source: PowerSource::Engine(Engine::default()),
            clutch: Clutch::default(),
            gearbox: Gearbox::default(),
            final_drive: 3.9,
            efficiency: 0.9,
            axles: Vec::new(),
            center: Differential::Open,
            tracks: false,
        }
    }
}

/// What makes the torque.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum PowerSource {
    /// A combustion engine.
    Engine(Engine),
    /// An electric motor: the same torque forward and backward, from a standstill.
    Motor(ElectricMotor),
    /// For toys: each driven wheel is pushed with this force at full throttle, newtons, at least 0,
    /// backward in reverse. Clutch, gears and differentials are not used.
    Direct {
        /// Newtons for each driven wheel.
        force: f32,
    },
}

/// A combustion engine.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Engine {
    /// Torque at full throttle against engine speed, in the order of the speeds; straight lines
    /// between, constant outside.
    pub torque: Vec<TorquePoint>,
    /// Speed that the idle control keeps, revolutions per minute, above 0.
    pub idle: f32,
    /// Speed at which the limiter cuts the fuel, revolutions per minute, above the idle.
    pub redline: f32,
    /// Moment of inertia of crankshaft and flywheel, kg·m², above 0.
    pub inertia: f32,
    /// Braking torque with closed throttle at no speed, newton-metres, at least 0.
    pub friction: f32,
    /// Growth of the braking torque, newton-metres for each radian per second, at least 0.
    pub viscosity: f32,
    /// Speed below which the engine dies, revolutions per minute; `None` never stalls.
    /// [`VehicleIntent::starter`](crate::vehicle::VehicleIntent::starter) brings it back.
    pub stall: Option<f32>,
}

impl Default for Engine {
    fn default() -> Self {
        let point = |rpm, torque| TorquePoint { rpm, torque };
        Self {
            torque: vec![
                point(800.0, 110.0),
                point(2000.0, 150.0),
                point(3500.0, 170.0),
                point(5500.0, 155.0),
                point(6500.0, 130.0),
            ],
            idle: 850.0,
            redline: 6500.0,
            inertia: 0.15,
            friction: 15.0,
            viscosity: 0.05,
            stall: None,
        }
    }
}

/// A point of a torque curve.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct TorquePoint {
    /// Engine speed, revolutions per minute.
    pub rpm: f32,
    /// Torque, newton-metres.
    pub torque: f32,
}

/// An electric motor.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct ElectricMotor {
    /// Greatest torque, newton-metres, at least 0.
    pub torque: f32,
    /// Greatest power, watts, at least 0: above `power / torque` radians per second the torque falls.
    pub power: f32,
    /// Speed at which it cuts out, revolutions per minute, above 0.
    pub redline: f32,
    /// Moment of inertia of the rotor, kg·m², above 0.
    pub inertia: f32,
    /// Braking torque with closed throttle, newton-metres, at least 0: recuperation.
    pub recuperation: f32,
}

impl Default for ElectricMotor {
    fn default() -> Self {
        Self {
            torque: 310.0,
            power: 150.0e3,
            redline: 16_000.0,
            inertia: 0.05,
            recuperation: 40.0,
        }
    }
}

/// A friction clutch.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Clutch {
    /// Greatest torque it transmits when closed, newton-metres, at least 0. Less than the engine has
    /// lets it slip for ever.
    pub torque: f32,
    /// Whether it opens by itself near idle speed, so that the engine does not stall and the car does
    /// not creep. Without it the driver's pedal alone decides.
    pub automatic: bool,
}

impl Default for Clutch {
    fn default() -> Self {
        Self {
            torque: 500.0,
            automatic: true,
        }
    }
}

/// A gearbox.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Gearbox {
    /// Ratios of the forward gears, the first one first, above 0; at least one.
    pub forward: Vec<f32>,
    /// Ratio of the reverse gear, above 0.
    pub reverse: f32,
    /// Time without traction at each change of gear, seconds, at least 0.
    pub shift_time: f32,
    /// Who decides.
    pub shifting: Shifting,
}

impl Default for Gearbox {
    fn default() -> Self {
        Self {
            forward: vec![3.5, 2.0, 1.35, 1.0, 0.8],
            reverse: 3.3,
            shift_time: 0.25,
            shifting: Shifting::Automatic {
                up: 5500.0,
                down: 2000.0,
            },
        }
    }
}

/// Who decides about gears.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Shifting {
    /// The driver, through [`Gear::Number`](crate::vehicle::Gear::Number).
    Manual,
    /// The box, by engine speed; never up while driven wheels spin.
    Automatic {
        /// Shifts up above this, revolutions per minute.
        up: f32,
        /// Shifts down below this, revolutions per minute. Less than `up` by more than a step of the
        /// ratios, or the box hunts.
        down: f32,
    },
}

/// How an axle is driven.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct DrivenAxle {
    /// Which: [`Wheel::axle`](crate::vehicle::Wheel::axle).
    pub axle: u8,
    /// Its share of the torque, at least 0; all shares together count as 1.
    pub share: f32,
    /// Between its wheels.
    pub differential: Differential,
}

impl Default for DrivenAxle {
    fn default() -> Self {
        Self {
            axle: 0,
            share: 1.0,
            differential: Differential::Open,
        }
    }
}

/// What ties two outputs of a shaft.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Differential {
    /// Each output gets its share, whatever it turns at.
    #[default]
    Open,
    /// The slower output gets up to `bias` times the torque of the faster one, and at least the
    /// preload more.
    LimitedSlip {
        /// Torque bias ratio, at least 1.
        bias: f32,
        /// Torque that it holds without any load, newton-metres, at least 0.
        preload: f32,
    },
    /// Both turn together.
    Locked,
}
