//! From the engine to the wheels.
//!
//! The engine (or motor) turns a shaft; the clutch joins it to the gearbox; final drive and
//! differentials hand the torque to the wheels: each driven wheel gets its share of
//! `torque × gear × final drive × efficiency`. Shaft speed is the same share-weighted mean of wheel
//! speeds, so that no energy is made.
//!
//! All of it is one small linear system, solved implicitly with the tyres in [`super::solve`];
//! clutch, limited-slip and locked differentials and brakes are friction rows in it, exact however
//! strong.

mod config;
mod engine;
mod gearbox;

pub use config::{
    Clutch, Differential, DrivenAxle, Drivetrain, ElectricMotor, Engine, Gearbox, PowerSource,
    Shifting, TorquePoint,
};
pub(crate) use engine::{Power, motor_power, power};
pub(crate) use gearbox::{Box as GearboxState, Shift};

use core::f32::consts::TAU;

/// Radians per second of revolutions per minute.
pub(crate) fn from_rpm(rpm: f32) -> f32 {
    rpm * (TAU / 60.0)
}
