//! Vehicles with real numbers, as data.
//!
//! Masses, dimensions, gear ratios and torque curves are those of typical vehicles of each kind. The
//! origin of each lies on the ground below the middle of its wheelbase, so that one spawned with its
//! translation on the road stands on it.

mod cars;
mod machines;
mod parts;
mod small;

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;

use super::{
    config::{Vehicle, VehicleMass},
    wheel::{Wheel, WheelOf},
};

/// A vehicle with its wheels, ready to be changed and spawned.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct VehiclePreset {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its mass.
    pub mass: VehicleMass,
    /// Full size of its hull, metres.
    pub hull: Vec3,
    /// Centre of its hull, metres.
    pub hull_center: Vec3,
    /// Its wheels.
    pub wheels: Vec<Wheel>,
}

impl VehiclePreset {
    /// Spawns the vehicle with a box for a hull, and its wheels as its children.
    pub fn spawn(&self, commands: &mut Commands, at: Transform) -> Entity {
        let half = self.hull * 0.5;
        let hull = Collider::compound(vec![(
            self.hull_center,
            Quat::IDENTITY,
            Collider::cuboid(half.x, half.y, half.z),
        )]);
        let vehicle = commands
            .spawn((self.vehicle.clone(), self.mass, hull, at))
            .id();
        for wheel in &self.wheels {
            commands.spawn((wheel.clone(), WheelOf(vehicle), ChildOf(vehicle)));
        }
        vehicle
    }

    /// Every preset with its name.
    pub fn all() -> [(&'static str, Self); 9] {
        [
            ("hatchback", Self::hatchback()),
            ("sports car", Self::sports_car()),
            ("suv", Self::suv()),
            ("truck", Self::truck()),
            ("kart", Self::kart()),
            ("forklift", Self::forklift()),
            ("electric car", Self::electric_car()),
            ("tracked vehicle", Self::tracked()),
            ("motorcycle", Self::motorcycle()),
        ]
    }
}
