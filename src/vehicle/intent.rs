//! What the driver or an AI asks of a vehicle; read once per tick.

use bevy::prelude::*;

/// What a vehicle is asked to do. The game writes it in `FixedUpdate` or before; the tick that
/// follows uses it. It is never written by the plugin. Values outside their range are cut to it,
/// what is no number counts as 0.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct VehicleIntent {
    /// Accelerator, `0..=1`.
    pub throttle: f32,
    /// Foot brake, `0..=1`.
    pub brake: f32,
    /// Hand brake, `0..=1`.
    pub handbrake: f32,
    /// Steering wheel, −1 (full left) to 1 (full right).
    pub steer: f32,
    /// Clutch pedal, 0 (closed) to 1 (open).
    pub clutch: f32,
    /// Gear.
    pub gear: Gear,
    /// Whether the starter turns a stalled engine.
    pub starter: bool,
    /// Turning in the air, −1 to 1: nose up, nose right, roll right.
    pub air: Vec3,
}

/// A gear that is asked for.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Gear {
    /// Forward; an automatic chooses which, a manual box keeps the one it has.
    #[default]
    Drive,
    /// None.
    Neutral,
    /// Backward; refused when driving forward.
    Reverse,
    /// This one: −1 reverse, 0 neutral, from 1 on forward. Cut to what the box has.
    Number(i8),
}

impl VehicleIntent {
    /// The same within its ranges.
    pub(crate) fn clean(&self) -> Self {
        let part = |v: f32| if v > 0.0 { v.min(1.0) } else { 0.0 };
        let signed = |v: f32| if v.is_nan() { 0.0 } else { v.clamp(-1.0, 1.0) };
        Self {
            throttle: part(self.throttle),
            brake: part(self.brake),
            handbrake: part(self.handbrake),
            steer: signed(self.steer),
            clutch: part(self.clutch),
            gear: self.gear,
            starter: self.starter,
            air: Vec3::new(signed(self.air.x), signed(self.air.y), signed(self.air.z)),
        }
    }
}
