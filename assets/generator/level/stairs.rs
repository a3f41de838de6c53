//! Stairs.

use bevy::prelude::*;
use embody_scenes::course::layout::{self, APPROACH, Flight, Place, spiral};

use super::{Level, signs::Sign};
use crate::{mesh::Mesh, paint::Paint};

pub fn build(level: &mut Level) {
    let flights = layout::flights();
    for flight in &flights {
        if flight.boxes {
            boxes(level, flight);
        } else {
            mesh(level, flight);
        }
        level.station(
            &flight.place,
            &Sign {
                station: &flight.name,
                kind: "STAIRS",
                title: &format!("{:.0}/{:.0} CM", flight.rise * 100.0, flight.tread * 100.0),
                paint: Paint::Teal,
            },
        );
    }
    landing(level, &flights);
    spiral_stair(level);
}

fn tint(step: usize) -> u8 {
    if step.is_multiple_of(2) { 255 } else { 205 }
}

fn boxes(level: &mut Level, flight: &Flight) {
    for step in 0..flight.steps {
        let height = flight.rise * (step + 1) as f32;
        let size = Vec3::new(layout::STAIR_WIDTH, height, flight.tread);
        let z = -APPROACH - flight.tread * (step as f32 + 0.5);
        let mut mesh = Mesh::default();
        mesh.tint(tint(step)).cuboid(Paint::Teal, Vec3::ZERO, size);
        level.add(
            format!("{}.step_{}", flight.name, step + 1),
            &flight.place,
            Vec3::new(0.0, 0.5 * height, z),
            mesh,
            super::solid(super::boxed(size)),
        );
    }
}

fn mesh(level: &mut Level, flight: &Flight) {
    let mut mesh = Mesh::default();
    let w = 0.5 * layout::STAIR_WIDTH;
    for step in 0..flight.steps {
        let (low, high) = (flight.rise * step as f32, flight.rise * (step + 1) as f32);
        let (near, far) = (
            -flight.tread * step as f32,
            -flight.tread * (step + 1) as f32,
        );
        let at = Vec3::new;
        mesh.tint(tint(step))
            .polygon(
                Paint::Teal,
                &[
                    at(-w, low, near),
                    at(w, low, near),
                    at(w, high, near),
                    at(-w, high, near),
                ],
            )
            .polygon(
                Paint::Teal,
                &[
                    at(-w, high, near),
                    at(w, high, near),
                    at(w, high, far),
                    at(-w, high, far),
                ],
            )
            .polygon(
                Paint::Teal,
                &[
                    at(w, 0.0, near),
                    at(w, 0.0, far),
                    at(w, high, far),
                    at(w, high, near),
                ],
            )
            .polygon(
                Paint::Teal,
                &[
                    at(-w, 0.0, far),
                    at(-w, 0.0, near),
                    at(-w, high, near),
                    at(-w, high, far),
                ],
            );
    }
    let (top, back) = (layout::STAIR_TOP, -flight.run());
    mesh.polygon(
        Paint::Teal,
        &[
            Vec3::new(w, 0.0, back),
            Vec3::new(-w, 0.0, back),
            Vec3::new(-w, top, back),
            Vec3::new(w, top, back),
        ],
    );
    level.solid_mesh(
        format!("{}.flight", flight.name),
        &flight.place,
        Vec3::new(0.0, 0.0, -APPROACH),
        mesh,
    );
}

/// The landing that all flights lead to.
fn landing(level: &mut Level, flights: &[Flight]) {
    let (Some(first), Some(last)) = (flights.first(), flights.last()) else {
        return;
    };
    let width = (first.place.origin.z - last.place.origin.z) + layout::STAIR_WIDTH;
    let middle = Vec3::new(
        layout::STAIR_TOP_X - 0.5 * layout::STAIR_LANDING,
        0.0,
        0.5 * (first.place.origin.z + last.place.origin.z),
    );
    let world = Place::new(0.0, 0.0, layout::Heading::North);
    level.standing(
        "stairs.landing",
        &world,
        middle,
        Vec3::new(layout::STAIR_LANDING, layout::STAIR_TOP, width),
        Paint::Stone,
    );
}

fn spiral_stair(level: &mut Level) {
    let radii = [spiral::COLUMN, spiral::OUTER];
    let mut mesh = Mesh::default();
    for step in 0..spiral::STEPS {
        let from = spiral::STEP_DEGREES * step as f32;
        let last = step + 1 == spiral::STEPS;
        let to = if last {
            360.0
        } else {
            from + spiral::STEP_DEGREES
        };
        let high = spiral::RISE * (step + 1) as f32;
        mesh.tint(tint(step)).sector(
            [Paint::Teal; 2],
            Vec3::ZERO,
            radii,
            [from, to],
            [spiral::RISE * step as f32, high],
            if last { 20 } else { 5 },
        );
    }
    level.solid_mesh("stairs_spiral.treads", &spiral::PLACE, spiral::CENTER, mesh);
    let height = spiral::RISE * spiral::STEPS as f32 + 1.0;
    let mut column = Mesh::default();
    column.round(
        Paint::Stone,
        Vec3::Y * (-0.5 * height),
        [spiral::COLUMN; 2],
        height,
        32,
    );
    level.add(
        "stairs_spiral.column",
        &spiral::PLACE,
        spiral::CENTER + Vec3::Y * (0.5 * height),
        column,
        super::solid(embody_scenes::course::extras::ColliderSpec::Cylinder {
            height,
            radius: spiral::COLUMN,
        }),
    );
    level.station(
        &spiral::PLACE,
        &Sign {
            station: "stairs_spiral",
            kind: "STAIRS",
            title: "SPIRAL",
            paint: Paint::Teal,
        },
    );
}
