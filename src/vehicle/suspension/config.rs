//! What a suspension is made of.

use bevy::prelude::*;

/// The suspension of one wheel.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Suspension {
    /// Stiffness of the spring.
    pub spring: SpringRate,
    /// The damper.
    pub damping: Damper,
    /// How far the wheel moves from full droop to full bump, metres, above 0.
    pub travel: f32,
    /// Force at full droop, newtons, at least 0. More than the wheel's share of the weight keeps the
    /// wheel at droop until a bump overcomes it.
    pub preload: f32,
    /// By how much of itself the stiffness of the spring has grown at full bump, at least 0; 0 is a
    /// linear spring.
    pub progression: f32,
    /// Length of the bump stop, metres, `0..travel`.
    pub stop_length: f32,
    /// Stiffness that the bump stop adds, newtons per metre, at least 0.
    pub stop_stiffness: f32,
    /// Mass of wheel and hub, kilograms: how fast the wheel can follow ground that falls away. At 0
    /// it follows at once.
    pub unsprung_mass: f32,
}

impl Default for Suspension {
    fn default() -> Self {
        Self {
            spring: SpringRate::RideFrequency(1.5),
            damping: Damper::Ratio {
                bump: 0.4,
                rebound: 0.6,
            },
            travel: 0.25,
            preload: 0.0,
            progression: 0.0,
            stop_length: 0.04,
            stop_stiffness: 2.0e5,
            unsprung_mass: 25.0,
        }
    }
}

/// How stiff a spring is.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum SpringRate {
    /// Natural frequency on the wheel's static share of the mass, hertz, above 0: 1 is a limousine,
    /// 1.5 a car, 2.5 a sports car, 4 a kart. The static sag is `g / (2π f)²`, less what the preload
    /// carries.
    RideFrequency(f32),
    /// Newtons per metre, above 0.
    Stiffness(f32),
}

/// How strongly a damper brakes.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Damper {
    /// Fraction of critical on the wheel's static share of the mass, at least 0; 1 does not swing.
    Ratio {
        /// When compressed.
        bump: f32,
        /// When extended.
        rebound: f32,
    },
    /// Newton-seconds per metre, at least 0.
    Coefficient {
        /// When compressed.
        bump: f32,
        /// When extended.
        rebound: f32,
    },
}
