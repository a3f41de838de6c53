//! Four cars.

use bevy::prelude::*;

use super::{
    Frame,
    shapes::{Pane, Shell, cabin, pair},
};
use crate::{mesh::Mesh, paint::Paint};

/// The lines of a car, in parts of its length (0 the front, 1 the back) and of its height.
struct Lines<'a> {
    paint: Paint,
    /// Bonnet, waist and boot.
    waist: &'a [(f32, f32)],
    /// Foot of the windscreen, front and back of the roof, foot of the rear window.
    roof: [f32; 4],
    /// Height of the roof at its front and at its back.
    crown: [f32; 2],
    taper: f32,
    /// Width of the roof as a part of the car's.
    narrow: f32,
}

fn car(mesh: &mut Mesh, frame: &Frame, lines: &Lines) -> (f32, f32) {
    let (low, high) = (frame.low(), frame.high());
    let length = frame.hull.z;
    let front = frame.middle.z - 0.5 * length;
    let z = |part: f32| front + part * length;
    let y = |part: f32| low + part * (high - low);
    let top: Vec<(f32, f32)> = lines.waist.iter().map(|&(a, b)| (z(a), y(b))).collect();
    let axles = frame.axles();
    let shell = Shell {
        paint: lines.paint,
        half_width: 0.5 * frame.hull.x,
        sill: low,
        top: &top,
        axles: &axles,
        arch: 1.17 * frame.radius(),
        hub: frame.radius(),
        taper: lines.taper,
    };
    shell.build(mesh);
    let [a, b, c, d] = lines.roof.map(z);
    let [h0, h1] = lines.crown.map(y);
    let foot = |z: f32| shell.top_at(z) - 0.01;
    let middle = b + 0.5 * (c - b);
    let pane = |z: f32, high: f32, side: bool, top: bool| Pane {
        z,
        low: foot(z),
        high: high.max(foot(z) + 0.02),
        glass: (side, top),
    };
    let along = |t: f32| h0 + (h1 - h0) * (t - b) / (c - b);
    let panes = [
        pane(a, 0.0, true, true),
        pane(b, h0, false, false),
        pane(b + 0.07, along(b + 0.07), true, false),
        pane(middle - 0.04, along(middle - 0.04), false, false),
        pane(middle + 0.04, along(middle + 0.04), true, false),
        pane(c - 0.07, along(c - 0.07), false, false),
        pane(c, h1, true, true),
        pane(d, 0.0, true, true),
    ];
    let half = 0.5 * frame.hull.x;
    cabin(mesh, lines.paint, [half - 0.1, half * lines.narrow], &panes);

    // Mirrors, sills, lamps, plates, door handles.
    pair(
        mesh,
        lines.paint,
        Vec3::new(half + 0.04, foot(a + 0.3) + 0.08, a + 0.42),
        Vec3::new(0.16, 0.11, 0.09),
    );
    let (fz, bz) = (front, front + length);
    let nose = shell.top_at(fz);
    let tail = shell.top_at(bz);
    let width = shell.half_at(fz);
    pair(
        mesh,
        Paint::Lamp,
        Vec3::new(width - 0.26, nose - 0.14, fz - 0.005),
        Vec3::new(0.3, 0.11, 0.03),
    );
    let width = shell.half_at(bz);
    pair(
        mesh,
        Paint::Tail,
        Vec3::new(width - 0.24, tail - 0.14, bz + 0.005),
        Vec3::new(0.32, 0.12, 0.03),
    );
    for (z, sign) in [(fz, -1.0), (bz, 1.0)] {
        mesh.cuboid(
            Paint::Ink,
            Vec3::new(0.0, low + 0.1, z + 0.01 * sign),
            Vec3::new(2.0 * width - 0.3, 0.16, 0.05),
        )
        .cuboid(
            Paint::White,
            Vec3::new(0.0, low + 0.24, z + 0.02 * sign),
            Vec3::new(0.46, 0.11, 0.03),
        );
    }
    for z in [middle + 0.18, c + 0.02] {
        pair(
            mesh,
            Paint::Ink,
            Vec3::new(half - 0.005, foot(middle) - 0.16, z),
            Vec3::new(0.02, 0.025, 0.16),
        );
    }
    (fz, bz)
}

fn grille(mesh: &mut Mesh, z: f32, y: f32, size: Vec2) {
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, y, z),
        Vec3::new(size.x, size.y, 0.04),
    );
    for i in 0..3 {
        let y = y + size.y * (i as f32 - 1.0) * 0.28;
        mesh.cuboid(
            Paint::Metal,
            Vec3::new(0.0, y, z - 0.01),
            Vec3::new(size.x - 0.06, 0.02, 0.04),
        );
    }
}

pub fn hatchback(mesh: &mut Mesh, frame: &Frame) {
    let (front, _) = car(
        mesh,
        frame,
        &Lines {
            paint: Paint::Red,
            waist: &[
                (0.0, 0.4),
                (0.03, 0.47),
                (0.22, 0.54),
                (0.3, 0.57),
                (0.75, 0.6),
                (0.97, 0.62),
                (1.0, 0.58),
            ],
            roof: [0.24, 0.42, 0.84, 0.985],
            crown: [0.98, 0.97],
            taper: 0.14,
            narrow: 0.74,
        },
    );
    grille(mesh, front - 0.005, frame.low() + 0.38, Vec2::new(0.6, 0.1));
}

pub fn sports(mesh: &mut Mesh, frame: &Frame) {
    let (front, back) = car(
        mesh,
        frame,
        &Lines {
            paint: Paint::Yellow,
            waist: &[
                (0.0, 0.34),
                (0.04, 0.42),
                (0.2, 0.56),
                (0.36, 0.58),
                (0.6, 0.6),
                (0.8, 0.66),
                (0.97, 0.66),
                (1.0, 0.6),
            ],
            roof: [0.34, 0.5, 0.64, 0.9],
            crown: [0.99, 0.985],
            taper: 0.12,
            narrow: 0.7,
        },
    );
    let (low, high) = (frame.low(), frame.high());
    let w = frame.hull.x;
    // Wing, splitter, intakes, stripe.
    let top = low + 0.66 * (high - low);
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(0.32 * w, top + 0.09, back - 0.22),
        Vec3::new(0.05, 0.2, 0.14),
    );
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, top + 0.2, back - 0.2),
        Vec3::new(0.86 * w, 0.035, 0.3),
    )
    .cuboid(
        Paint::Ink,
        Vec3::new(0.0, low + 0.015, front + 0.1),
        Vec3::new(0.84 * w, 0.03, 0.34),
    );
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(0.3 * w, low + 0.18, front - 0.005),
        Vec3::new(0.34, 0.14, 0.04),
    );
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(0.5 * w, low + 0.4, 0.62),
        Vec3::new(0.03, 0.2, 0.3),
    );
}

pub fn suv(mesh: &mut Mesh, frame: &Frame) {
    let (front, back) = car(
        mesh,
        frame,
        &Lines {
            paint: Paint::Blue,
            waist: &[
                (0.0, 0.46),
                (0.02, 0.53),
                (0.2, 0.58),
                (0.28, 0.6),
                (0.8, 0.62),
                (0.98, 0.62),
                (1.0, 0.58),
            ],
            roof: [0.25, 0.37, 0.9, 0.985],
            crown: [0.97, 0.96],
            taper: 0.08,
            narrow: 0.8,
        },
    );
    let (low, high) = (frame.low(), frame.high());
    grille(mesh, front - 0.005, low + 0.58, Vec2::new(0.95, 0.22));
    let half = 0.5 * frame.hull.x;
    // Roof rails, spare wheel, sill guards.
    pair(
        mesh,
        Paint::Slate,
        Vec3::new(half * 0.72, high + 0.02, 0.3),
        Vec3::new(0.06, 0.06, 2.1),
    );
    pair(
        mesh,
        Paint::Slate,
        Vec3::new(half - 0.02, low + 0.06, 0.0),
        Vec3::new(0.1, 0.12, 1.8),
    );
    mesh.cuboid(
        Paint::Rubber,
        Vec3::new(0.0, low + 0.75, back + 0.08),
        Vec3::new(0.62, 0.62, 0.2),
    )
    .cuboid(
        Paint::Silver,
        Vec3::new(0.0, low + 0.75, back + 0.19),
        Vec3::new(0.34, 0.34, 0.02),
    );
}

pub fn electric(mesh: &mut Mesh, frame: &Frame) {
    let (front, back) = car(
        mesh,
        frame,
        &Lines {
            paint: Paint::White,
            waist: &[
                (0.0, 0.36),
                (0.04, 0.45),
                (0.18, 0.55),
                (0.3, 0.58),
                (0.7, 0.62),
                (0.96, 0.66),
                (1.0, 0.6),
            ],
            roof: [0.2, 0.44, 0.68, 0.96],
            crown: [0.98, 0.96],
            taper: 0.16,
            narrow: 0.72,
        },
    );
    let low = frame.low();
    let w = frame.hull.x;
    // A line of light at either end and a stripe along the sill.
    mesh.cuboid(
        Paint::Teal,
        Vec3::new(0.0, low + 0.42, front - 0.006),
        Vec3::new(0.5 * w, 0.03, 0.03),
    )
    .cuboid(
        Paint::Tail,
        Vec3::new(0.0, low + 0.62, back + 0.006),
        Vec3::new(0.5 * w, 0.04, 0.03),
    );
    pair(
        mesh,
        Paint::Teal,
        Vec3::new(0.5 * w - 0.03, low + 0.06, 0.0),
        Vec3::new(0.07, 0.05, 1.7),
    );
}
