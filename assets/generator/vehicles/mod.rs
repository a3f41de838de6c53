//! The looks of the vehicle presets: a node for each body and one for its wheels, in the axes of the
//! vehicle. Where wheels are and how large they are comes from the presets themselves.

mod cars;
mod shapes;
mod small;
mod working;

use bevy::prelude::*;
use bevy_embody::vehicle::{VehiclePreset, Wheel};
use embody_scenes::course::layout::{Heading, Place};

use crate::{level::Level, mesh::Mesh, paint::Paint};

const ORIGIN: Place = Place::new(0.0, 0.0, Heading::North);

/// What a model is built around.
pub struct Frame {
    /// Full width, height and length of the hull.
    pub hull: Vec3,
    /// Its middle.
    pub middle: Vec3,
    pub wheels: Vec<Wheel>,
}

impl Frame {
    /// Where the axles are, along the vehicle.
    pub fn axles(&self) -> Vec<f32> {
        let mut all: Vec<f32> = self.wheels.iter().map(|wheel| wheel.attachment.z).collect();
        all.dedup();
        all
    }

    pub fn radius(&self) -> f32 {
        self.wheels.first().map_or(0.3, |wheel| wheel.radius)
    }

    /// Height of the underside.
    pub fn low(&self) -> f32 {
        self.middle.y - 0.5 * self.hull.y
    }

    /// Height of the top.
    pub fn high(&self) -> f32 {
        self.middle.y + 0.5 * self.hull.y
    }
}

/// Builds everything.
pub fn build(level: &mut Level) {
    for (name, preset) in VehiclePreset::all() {
        let frame = Frame {
            hull: preset.hull,
            middle: preset.hull_center,
            wheels: preset.wheels.clone(),
        };
        let mut body = Mesh::default();
        let mut rim = Paint::Silver;
        match name {
            "hatchback" => cars::hatchback(&mut body, &frame),
            "sports car" => cars::sports(&mut body, &frame),
            "suv" => cars::suv(&mut body, &frame),
            "electric car" => cars::electric(&mut body, &frame),
            "truck" => working::truck(&mut body, &frame),
            "forklift" => working::forklift(&mut body, &frame),
            "tracked vehicle" => working::tracked(&mut body, &frame),
            "kart" => small::kart(&mut body, &frame),
            "motorcycle" => small::motorcycle(&mut body, &frame),
            _ => {
                body.cuboid(Paint::Silver, frame.middle, frame.hull);
            }
        }
        if name == "tracked vehicle" {
            rim = Paint::Green;
        } else if name == "forklift" {
            rim = Paint::Yellow;
        }
        level.decor(name, &ORIGIN, Vec3::ZERO, body);
        if let Some(wheel) = preset.wheels.first() {
            let mut mesh = Mesh::default();
            shapes::wheel(&mut mesh, wheel.radius, wheel.width, rim);
            level.decor(format!("{name}.wheel"), &ORIGIN, Vec3::ZERO, mesh);
        }
    }
}
