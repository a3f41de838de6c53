//! Truck, forklift, tracked vehicle.

use bevy::prelude::*;

use super::{
    Frame,
    shapes::{Section, bar, driver, loft, pair},
};
use crate::{
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

pub fn truck(mesh: &mut Mesh, frame: &Frame) {
    let half = 0.5 * frame.hull.x;
    let front = frame.middle.z - 0.5 * frame.hull.z;
    let back = front + frame.hull.z;
    let (low, high) = (frame.low(), frame.high());
    let hub = frame.radius();
    // Frame rails and axles.
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(0.45, low + 0.16, 0.4),
        Vec3::new(0.16, 0.3, frame.hull.z - 1.0),
    );
    for z in frame.axles() {
        mesh.cuboid(
            Paint::Slate,
            Vec3::new(0.0, hub, z),
            Vec3::new(1.7, 0.16, 0.2),
        );
    }
    // Cab.
    let depth = 2.1;
    let waist = low + 1.15;
    let top = high - 0.1;
    let point = Vec2::new;
    let sections: Vec<Section> = [
        (front, 0.06, 0.0, top - 0.5),
        (front + 0.12, 0.0, 0.0, top - 0.06),
        (front + 0.6, 0.0, 0.0, top),
        (front + 0.72, 0.0, 0.0, top),
        (front + 1.5, 0.0, 0.0, top),
        (front + depth, 0.0, 0.0, top),
    ]
    .into_iter()
    .map(|(z, tight, _, high)| Section {
        z,
        half: vec![
            point(half - 0.06 - tight, low + 0.3),
            point(half - tight, low + 0.5),
            point(half - tight, waist),
            point(half - 0.06 - tight, high - 0.28),
            point(half - 0.16 - tight, high),
        ],
    })
    .collect();
    loft(mesh, &sections, |piece, strip| {
        if strip == 2 && (piece == 1 || piece == 3) {
            Paint::Glass
        } else {
            Paint::Coral
        }
    });
    // Windscreen, grille, lamps, bumper, step.
    mesh.cuboid(
        Paint::Glass,
        Vec3::new(0.0, waist + 0.42, front + 0.03),
        Vec3::new(2.0 * half - 0.4, 0.72, 0.1),
    )
    .cuboid(
        Paint::Ink,
        Vec3::new(0.0, low + 0.78, front - 0.01),
        Vec3::new(1.5, 0.5, 0.06),
    )
    .cuboid(
        Paint::Slate,
        Vec3::new(0.0, low + 0.2, front + 0.1),
        Vec3::new(2.0 * half - 0.05, 0.36, 0.3),
    );
    for i in 0..3 {
        mesh.cuboid(
            Paint::Metal,
            Vec3::new(0.0, low + 0.64 + 0.14 * i as f32, front - 0.04),
            Vec3::new(1.4, 0.04, 0.03),
        );
    }
    pair(
        mesh,
        Paint::Lamp,
        Vec3::new(half - 0.24, low + 0.24, front - 0.06),
        Vec3::new(0.32, 0.14, 0.04),
    );
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(half + 0.12, waist + 0.4, front + 0.2),
        Vec3::new(0.12, 0.5, 0.2),
    );
    pair(
        mesh,
        Paint::Amber,
        Vec3::new(0.7, top + 0.03, front + 0.4),
        Vec3::new(0.22, 0.08, 0.12),
    );
    // Box body.
    let from = front + depth + 0.15;
    let body = Vec3::new(2.0 * half, high - low - 0.35, back - from);
    let middle = Vec3::new(0.0, high - 0.5 * body.y, 0.5 * (from + back));
    mesh.cuboid(Paint::White, middle, body);
    for i in 0..7 {
        let z = from + body.z * (i as f32 + 0.5) / 7.0;
        pair(
            mesh,
            Paint::Stone,
            Vec3::new(half + 0.005, middle.y, z),
            Vec3::new(0.03, body.y - 0.1, 0.06),
        );
    }
    pair(
        mesh,
        Paint::Coral,
        Vec3::new(half + 0.004, middle.y + 0.25, middle.z),
        Vec3::new(0.02, 0.3, body.z - 0.2),
    );
    mesh.cuboid(
        Paint::Slate,
        Vec3::new(0.0, middle.y, back + 0.005),
        Vec3::new(0.05, body.y - 0.2, 0.03),
    )
    .cuboid(
        Paint::Slate,
        Vec3::new(0.0, low + 0.1, back - 0.06),
        Vec3::new(2.0 * half - 0.1, 0.16, 0.1),
    );
    pair(
        mesh,
        Paint::Tail,
        Vec3::new(half - 0.3, low + 0.26, back + 0.01),
        Vec3::new(0.36, 0.12, 0.05),
    );
    // Tank and guards between the axles.
    pair(
        mesh,
        Paint::Metal,
        Vec3::new(half - 0.38, low + 0.05, -0.8),
        Vec3::new(0.55, 0.5, 1.3),
    );
    for z in frame.axles().into_iter().skip(1) {
        pair(
            mesh,
            Paint::Ink,
            Vec3::new(half - 0.25, 2.0 * hub + 0.12, z),
            Vec3::new(0.42, 0.05, 1.1),
        );
    }
}

pub fn forklift(mesh: &mut Mesh, frame: &Frame) {
    let half = 0.5 * frame.hull.x;
    let front = frame.middle.z - 0.5 * frame.hull.z;
    let back = front + frame.hull.z;
    let (low, high) = (frame.low(), frame.high());
    let point = Vec2::new;
    // Body with its counterweight.
    let section = |z: f32, w: f32, y0: f32, y1: f32| Section {
        z,
        half: vec![
            point(w - 0.04, y0),
            point(w, y0 + 0.06),
            point(w, y1 - 0.1),
            point(w - 0.08, y1),
        ],
    };
    loft(
        mesh,
        &[
            section(front + 0.3, half - 0.22, low + 0.05, low + 0.42),
            section(front + 0.85, half - 0.2, low, low + 0.46),
            section(front + 0.86, half - 0.2, low, low + 0.62),
            section(front + 1.2, half - 0.16, low, low + 0.7),
            section(back - 0.42, half - 0.03, low + 0.05, low + 0.78),
            section(back - 0.08, half - 0.03, low + 0.12, low + 0.74),
            section(back, half - 0.12, low + 0.2, low + 0.6),
        ],
        |piece, _| if piece > 3 { Paint::Ink } else { Paint::Yellow },
    );
    // Cage over the driver.
    let roof = high + 0.05;
    for (z0, z1) in [(front + 0.42, front + 0.62), (back - 0.5, back - 0.62)] {
        for x in [-half + 0.12, half - 0.12] {
            bar(
                mesh,
                Paint::Ink,
                Vec3::new(x, low + 0.4, z0),
                Vec3::new(x, roof, z1),
                0.07,
            );
        }
    }
    for i in 0..6 {
        let z = front + 0.62 + (back - 0.62 - front - 0.62) * i as f32 / 5.0;
        mesh.cuboid(
            Paint::Ink,
            Vec3::new(0.0, roof, z),
            Vec3::new(2.0 * half - 0.18, 0.05, 0.05),
        );
    }
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(half - 0.12, roof, 0.0),
        Vec3::new(0.07, 0.07, back - front - 1.2),
    );
    // Mast, carriage and forks.
    let mast = front + 0.06;
    pair(
        mesh,
        Paint::Slate,
        Vec3::new(0.33, low + 0.95, mast),
        Vec3::new(0.1, 2.0, 0.14),
    );
    for y in [low + 0.15, low + 1.0, low + 1.9] {
        mesh.cuboid(
            Paint::Slate,
            Vec3::new(0.0, y, mast),
            Vec3::new(0.7, 0.09, 0.09),
        );
    }
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, low + 0.32, mast - 0.12),
        Vec3::new(0.95, 0.42, 0.06),
    );
    pair(
        mesh,
        Paint::Metal,
        Vec3::new(0.28, low + 0.02, mast - 0.6),
        Vec3::new(0.12, 0.05, 0.95),
    );
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, low + 0.78, 0.32),
        Vec3::new(0.5, 0.5, 0.12),
    );
    driver(
        mesh,
        Vec3::new(0.0, low + 0.68, 0.14),
        Paint::Coral,
        0.02,
        Vec3::new(0.0, low + 0.92, -0.3),
    );
}

pub fn tracked(mesh: &mut Mesh, frame: &Frame) {
    let half = 0.5 * frame.hull.x;
    let front = frame.middle.z - 0.5 * frame.hull.z;
    let back = front + frame.hull.z;
    let (low, high) = (frame.low(), frame.high());
    let r = frame.radius();
    let axles = frame.axles();
    let (first, last) = (axles[0], axles[axles.len() - 1]);
    let width = 0.46;
    let middle = 1.1;
    // A band round all wheels, drawn in as links.
    let mut line = Vec::new();
    let outer = r + 0.02;
    let lift = 0.32;
    let arc = |z: f32, y: f32, from: f64, to: f64, line: &mut Vec<Vec2>| {
        for i in 0..=6 {
            let (sin, cos) = sin_cos(from + (to - from) * f64::from(i) / 6.0);
            line.push(Vec2::new(z + outer * cos, y + outer * sin));
        }
    };
    // Over the raised wheels at both ends, then along the ground.
    arc(first - 0.42, r + lift, 250.0, 90.0, &mut line);
    arc(last + 0.42, r + lift, 90.0, -70.0, &mut line);
    arc(last, r, -60.0, -90.0, &mut line);
    arc(first, r, -90.0, -120.0, &mut line);
    for side in [-1.0, 1.0] {
        for i in 0..line.len() {
            let (a, b) = (line[i], line[(i + 1) % line.len()]);
            let steps = ((b - a).length() / 0.2).ceil().max(1.0) as usize;
            for k in 0..steps {
                let p = a.lerp(b, k as f32 / steps as f32);
                let q = a.lerp(b, (k + 1) as f32 / steps as f32);
                bar(
                    mesh,
                    if (i + k) % 2 == 0 {
                        Paint::Rubber
                    } else {
                        Paint::Ink
                    },
                    Vec3::new(
                        side * middle - 0.5 * width,
                        0.5 * (p.y + q.y),
                        0.5 * (p.x + q.x),
                    ),
                    Vec3::new(
                        side * middle + 0.5 * width,
                        0.5 * (p.y + q.y),
                        0.5 * (p.x + q.x),
                    ),
                    (q - p).length().max(0.06) * 0.8,
                );
            }
        }
        for z in [first - 0.42, last + 0.42] {
            super::shapes::lathe(
                mesh,
                Paint::Green,
                Vec3::new(side * middle, r + lift, z),
                &[(-0.18, 0.8 * r), (0.18, 0.8 * r)],
                12,
            );
        }
    }
    let point = Vec2::new;
    let deck = low + 0.62 * (high - low);
    let section = |z: f32, w: f32, y0: f32, y1: f32| Section {
        z,
        half: vec![
            point(w - 0.5, y0),
            point(w - 0.48, y1 - 0.42),
            point(w, y1 - 0.4),
            point(w - 0.06, y1),
        ],
    };
    loft(
        mesh,
        &[
            section(front, half, low + 0.42, low + 0.52),
            section(front + 0.9, half, low, deck - 0.1),
            section(front + 1.3, half, low, deck),
            section(back - 0.2, half, low, deck),
            section(back, half, low + 0.2, deck - 0.15),
        ],
        |_, _| Paint::Green,
    );
    // A cab in front, a flat bed with rails behind.
    let cab = |z: f32, w: f32, y1: f32| Section {
        z,
        half: vec![
            point(w, deck - 0.02),
            point(w, deck + 0.08),
            point(w - 0.1, y1 - 0.08),
            point(w - 0.2, y1),
        ],
    };
    loft(
        mesh,
        &[
            cab(front + 0.95, half - 0.35, deck + 0.2),
            cab(front + 1.3, half - 0.3, high + 0.3),
            cab(front + 1.42, half - 0.3, high + 0.32),
            cab(front + 2.15, half - 0.3, high + 0.32),
            cab(front + 2.3, half - 0.32, high + 0.28),
        ],
        |piece, strip| {
            if (strip == 1 && piece == 2) || (piece == 0 && strip > 0) {
                Paint::Glass
            } else {
                Paint::Green
            }
        },
    );
    for z in [front + 2.6, 0.5 * (front + 2.6 + back - 0.2), back - 0.2] {
        pair(
            mesh,
            Paint::Slate,
            Vec3::new(half - 0.12, deck + 0.25, z),
            Vec3::new(0.07, 0.5, 0.07),
        );
    }
    pair(
        mesh,
        Paint::Wood,
        Vec3::new(half - 0.12, deck + 0.36, 0.5 * (front + 2.6 + back - 0.2)),
        Vec3::new(0.05, 0.22, back - front - 2.8),
    );
    mesh.cuboid(
        Paint::Wood,
        Vec3::new(0.0, deck + 0.02, 0.5 * (front + 2.5 + back - 0.2)),
        Vec3::new(2.0 * half - 0.3, 0.05, back - front - 2.8),
    );
    pair(
        mesh,
        Paint::Lamp,
        Vec3::new(half - 0.3, deck - 0.22, front + 0.52),
        Vec3::new(0.2, 0.14, 0.1),
    );
    mesh.round(
        Paint::Ink,
        Vec3::new(half - 0.2, deck, front + 2.45),
        [0.07, 0.06],
        0.9,
        8,
    );
}
