//! What tells a station: a pad where it starts, a sign beside it, and the mark of its start.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{ColliderSpec, NodeExtras},
    layout::{Heading, Place},
};

use super::{Level, solid};
use crate::{font, mesh::Mesh, paint::Paint};

/// Size of a sign's board.
const BOARD: Vec3 = Vec3::new(1.5, 0.62, 0.06);
/// Height of its middle.
const MIDDLE: f32 = 2.3;

/// What a sign says.
pub struct Sign<'a> {
    /// Name of the station.
    pub station: &'a str,
    /// The kind, small.
    pub kind: &'a str,
    /// The special thing, large.
    pub title: &'a str,
    /// Colour of its family.
    pub paint: Paint,
}

impl Level {
    /// Marks where a station starts.
    pub fn start(&mut self, station: &str, place: &Place, foot: Vec3) {
        self.add(
            format!("{station}.start"),
            place,
            foot,
            Mesh::default(),
            NodeExtras {
                station: Some(station.into()),
                ..default()
            },
        );
    }

    /// A station that starts at the origin of its place: mark, pad and sign.
    pub fn station(&mut self, place: &Place, sign: &Sign) {
        self.start(sign.station, place, Vec3::ZERO);
        let mut pad = Mesh::default();
        pad.round(sign.paint, Vec3::ZERO, [0.55, 0.55], 0.006, 32);
        pad.round(Paint::White, Vec3::ZERO, [0.42, 0.42], 0.009, 32);
        pad.round(sign.paint, Vec3::ZERO, [0.34, 0.34], 0.012, 32);
        self.decor(format!("{}.pad", sign.station), place, Vec3::ZERO, pad);
        self.sign(place, Vec3::new(-1.05, 0.0, -1.1), sign);
    }

    /// A sign that looks back at the walker and a little to the south, whence visitors come.
    pub fn sign(&mut self, place: &Place, foot: Vec3, sign: &Sign) {
        let mut mesh = Mesh::default();
        mesh.round(Paint::Slate, Vec3::ZERO, [0.05, 0.05], MIDDLE, 12)
            .round(sign.paint, Vec3::ZERO, [0.16, 0.16], 0.12, 20)
            .cuboid(Paint::Ink, Vec3::new(0.0, MIDDLE, 0.08), BOARD)
            .cuboid(
                sign.paint,
                Vec3::new(0.0, MIDDLE - 0.5 * BOARD.y - 0.03, 0.08),
                Vec3::new(BOARD.x, 0.06, BOARD.z),
            );
        let front = 0.08 + 0.5 * BOARD.z + 0.004;
        text(
            &mut mesh,
            sign.paint,
            sign.kind,
            Vec3::new(0.0, MIDDLE + 0.19, front),
            0.018,
            0.93 * BOARD.x,
        );
        text(
            &mut mesh,
            Paint::White,
            sign.title,
            Vec3::new(0.0, MIDDLE - 0.08, front),
            0.034,
            0.93 * BOARD.x,
        );
        let turn = match place.heading {
            Heading::North => 0.0f32,
            Heading::East => 35.0,
            Heading::West => -35.0,
        };
        self.decor(format!("{}.sign", sign.station), place, foot, mesh);
        if let Some(node) = self.nodes.last_mut() {
            node.transform.rotation *= Quat::from_rotation_y(turn.to_radians());
        }
        // Only the post is solid.
        self.add(
            format!("{}.post", sign.station),
            place,
            foot + Vec3::Y * (0.5 * MIDDLE),
            Mesh::default(),
            solid(ColliderSpec::Cylinder {
                height: MIDDLE,
                radius: 0.05,
            }),
        );
    }
}

/// Letters of square dots in the plane that looks along `+Z`, centred on a point.
pub fn text(mesh: &mut Mesh, paint: Paint, text: &str, center: Vec3, wanted: f32, width: f32) {
    let letters = text.chars().count() as f32;
    // A long line is set smaller, so that it stays on the board.
    let dot = wanted.min(width / (6.0 * letters - 1.0));
    let left = center.x - 0.5 * dot * (6.0 * letters - 1.0);
    for (i, letter) in text.chars().enumerate() {
        for (row, bits) in font::rows(letter).into_iter().enumerate() {
            let y = center.y + dot * (3.5 - row as f32);
            // Neighbouring dots of a row are one rectangle.
            let mut column = 0;
            while column < 5 {
                let run = (column..5)
                    .take_while(|c| bits & (0b10000 >> c) != 0)
                    .count();
                if run > 0 {
                    let x = left + dot * (6 * i + column) as f32;
                    let right = x + dot * run as f32;
                    mesh.polygon(
                        paint,
                        &[
                            Vec3::new(x, y - dot, center.z),
                            Vec3::new(right, y - dot, center.z),
                            Vec3::new(right, y, center.z),
                            Vec3::new(x, y, center.z),
                        ],
                    );
                }
                column += run.max(1);
            }
        }
    }
}
