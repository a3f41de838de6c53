//! Help for the driver: components that change what the driver asks, never the physics. Leave one out
//! and it costs nothing. One with a value out of its range is named in a warning and does nothing.

use bevy::prelude::*;

/// Anti-lock brakes: holds each braked wheel at a slip ratio instead of letting it lock.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct AntiLockBrakes {
    /// Slip ratio that is held, above 0 and at most 1. Near the peak of the tyre's curve it stops shortest;
    /// at 1 wheels lock.
    pub slip: f32,
    /// Speed below which wheels may lock, metres per second, at least 0.
    pub least_speed: f32,
}

impl Default for AntiLockBrakes {
    fn default() -> Self {
        Self {
            slip: 0.12,
            least_speed: 2.0,
        }
    }
}

/// Traction control: takes throttle away when driven wheels spin, but leaves as much as holds them at
/// their slip, so that they go on pushing.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct TractionControl {
    /// Slip ratio that is held, above 0; below 3 m/s the slip velocity over 3 m/s. Small is tame and slow,
    /// large lets the wheels spin. On a hill the engine is left what keeps the vehicle from rolling back.
    pub slip: f32,
}

impl Default for TractionControl {
    fn default() -> Self {
        Self { slip: 0.12 }
    }
}

/// Stability control: brakes single wheels when the vehicle turns more or less than it is steered.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct StabilityControl {
    /// Deviation of the yaw rate that is left alone, radians per second, at least 0.
    pub tolerance: f32,
    /// Brake torque for each radian per second beyond, newton-metre-seconds, at least 0.
    pub strength: f32,
}

impl Default for StabilityControl {
    fn default() -> Self {
        Self {
            tolerance: 0.08,
            strength: 15_000.0,
        }
    }
}

/// Hill hold: keeps the brakes for a moment after the pedal is released on a slope.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct HillHold {
    /// For how long, seconds, at least 0; throttle ends it at once.
    pub time: f32,
}

impl Default for HillHold {
    fn default() -> Self {
        Self { time: 2.0 }
    }
}

/// Keeps a two-wheeler upright and leans it into its turns: a torque about its long axis, while a
/// wheel is on the ground.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct LeanControl {
    /// Natural frequency of the lean, hertz, above 0.
    pub frequency: f32,
    /// Damping ratio, at least 0.
    pub damping: f32,
    /// Greatest lean, radians, `0..π/2`.
    pub max_lean: f32,
}

impl Default for LeanControl {
    fn default() -> Self {
        Self {
            frequency: 2.0,
            damping: 1.0,
            max_lean: 45f32.to_radians(),
        }
    }
}

fn at_least_0(value: f32) -> bool {
    value >= 0.0 && value.is_finite()
}

impl StabilityControl {
    pub(crate) fn is_sound(&self) -> bool {
        at_least_0(self.tolerance) && at_least_0(self.strength)
    }
}

impl HillHold {
    pub(crate) fn is_sound(&self) -> bool {
        at_least_0(self.time)
    }
}

impl LeanControl {
    pub(crate) fn is_sound(&self) -> bool {
        self.frequency > 0.0
            && self.frequency.is_finite()
            && at_least_0(self.damping)
            && (0.0..core::f32::consts::FRAC_PI_2).contains(&self.max_lean)
    }
}

impl AntiLockBrakes {
    pub(crate) fn is_sound(&self) -> bool {
        self.slip > 0.0 && self.slip <= 1.0 && at_least_0(self.least_speed)
    }

    /// The part of the brake to leave on, from the last one, after a tick of `dt` at a slip ratio.
    pub(crate) fn part(&self, last: f32, slip: f32, speed: f32, dt: f32) -> f32 {
        if speed < self.least_speed {
            return 1.0;
        }
        let excess = (-slip - self.slip) / self.slip;
        // Off within about 30 ms at twice the slip, on again within about 150 ms.
        let rate = if excess > 0.0 { 30.0 } else { 7.0 };
        (last - (excess.clamp(-1.0, 2.0) * rate * dt).clamp(-0.5, 0.7)).clamp(0.02, 1.0)
    }
}

impl TractionControl {
    pub(crate) fn is_sound(&self) -> bool {
        self.slip > 0.0 && self.slip.is_finite()
    }

    /// The part of the throttle to leave, from the last one, after a tick of `dt` at the greatest slip of a
    /// driven wheel.
    pub(crate) fn part(&self, last: f32, slip: f32, load: Load, dt: f32) -> f32 {
        let excess = ((slip - self.slip) / self.slip).max(-1.0);
        let rate = if excess > 0.0 { 15.0 } else { 4.0 };
        let slowed = load.held - load.slowing * self.slip * excess.max(0.0);
        let least = slowed.max(load.needed * Self::CLIMBS).clamp(0.02, 1.0);
        (last - (excess.min(2.0) * rate * dt).clamp(-0.5, 0.5)).clamp(least, 1.0)
    }

    /// How much more is left than keeps the vehicle where it is on a hill. With no more than that a wheel
    /// that grips again gains nothing until the throttle is back, and one that spins goes on pushing.
    const CLIMBS: f32 = 1.1;

    /// In which wheels that spin are slowed down, seconds: some ticks of the slowest game.
    pub(crate) const TIME: f32 = 0.15;
}

/// What driven wheels have to do, in parts of the throttle that gives them the torque for it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Load {
    /// Of what their tyres take up: with it their slip stays as it is.
    pub held: f32,
    /// Of what a slip of 1 is taken off them with within [`TractionControl::TIME`].
    pub slowing: f32,
    /// Of what keeps the vehicle from rolling down the hill.
    pub needed: f32,
}
