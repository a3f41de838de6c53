//! Kart and motorcycle, with who drives them.

use bevy::prelude::*;

use super::{
    Frame,
    shapes::{Section, bar, driver, lathe, loft, pair},
};
use crate::{mesh::Mesh, paint::Paint};

pub fn kart(mesh: &mut Mesh, frame: &Frame) {
    let axles = frame.axles();
    let (front, rear) = (axles[0], axles[axles.len() - 1]);
    let r = frame.radius();
    let y = r - 0.03;
    // Frame tubes and floor.
    for side in [-1.0, 1.0] {
        let at = |x: f32, z: f32| Vec3::new(side * x, y, z);
        for (a, b) in [
            (at(0.22, front - 0.22), at(0.32, front + 0.25)),
            (at(0.32, front + 0.25), at(0.32, rear + 0.12)),
        ] {
            bar(mesh, Paint::Slate, a, b, 0.045);
        }
        bar(mesh, Paint::Slate, at(0.1, front), at(0.46, front), 0.05);
        // Side pods.
        let point = Vec2::new;
        let section = |z: f32, w: f32, h: f32| Section {
            z,
            half: vec![
                point(w, y - 0.04),
                point(w, y + h - 0.04),
                point(w - 0.05, y + h),
            ],
        };
        let mut pod = Mesh::default();
        loft(
            &mut pod,
            &[
                section(-0.3, 0.07, 0.08),
                section(-0.22, 0.11, 0.14),
                section(0.24, 0.11, 0.16),
                section(0.3, 0.08, 0.1),
            ],
            |_, _| Paint::Red,
        );
        for (paint, part) in pod.parts {
            for t in part.indices.chunks_exact(3) {
                mesh.triangle(
                    paint,
                    [0, 1, 2].map(|k| part.positions[t[k] as usize] + Vec3::X * (side * 0.47)),
                );
            }
        }
    }
    bar(
        mesh,
        Paint::Metal,
        Vec3::new(-0.5, r, rear),
        Vec3::new(0.5, r, rear),
        0.04,
    );
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, y, 0.5 * (front + rear) - 0.12),
        Vec3::new(0.6, 0.02, rear - front - 0.2),
    );
    // Nose, bumper, seat, engine, wheel.
    let point = Vec2::new;
    let nose = |z: f32, w: f32, low: f32, high: f32| Section {
        z,
        half: vec![point(w, low), point(w, high - 0.03), point(w - 0.04, high)],
    };
    loft(
        mesh,
        &[
            nose(front - 0.34, 0.3, y - 0.05, y + 0.07),
            nose(front - 0.28, 0.38, y - 0.06, y + 0.12),
            nose(front - 0.1, 0.36, y - 0.04, y + 0.14),
        ],
        |_, _| Paint::Red,
    );
    loft(
        mesh,
        &[
            nose(front - 0.14, 0.16, y + 0.08, y + 0.14),
            nose(front + 0.06, 0.13, y + 0.1, y + 0.38),
            nose(front + 0.1, 0.12, y + 0.12, y + 0.36),
        ],
        |_, _| Paint::White,
    );
    mesh.cuboid(
        Paint::Ink,
        Vec3::new(0.0, y + 0.06, 0.2),
        Vec3::new(0.4, 0.1, 0.4),
    );
    bar(
        mesh,
        Paint::Ink,
        Vec3::new(0.0, y + 0.06, 0.38),
        Vec3::new(0.0, y + 0.5, 0.48),
        0.1,
    );
    pair(
        mesh,
        Paint::Ink,
        Vec3::new(0.19, y + 0.2, 0.26),
        Vec3::new(0.04, 0.24, 0.34),
    );
    mesh.cuboid(
        Paint::Metal,
        Vec3::new(0.36, y + 0.14, 0.34),
        Vec3::new(0.22, 0.26, 0.3),
    );
    bar(
        mesh,
        Paint::Slate,
        Vec3::new(0.0, y + 0.1, front + 0.3),
        Vec3::new(0.0, y + 0.38, -0.1),
        0.03,
    );
    lathe(
        mesh,
        Paint::Ink,
        Vec3::new(0.0, y + 0.4, -0.12),
        &[(-0.14, 0.02), (0.14, 0.02)],
        8,
    );
    bar(
        mesh,
        Paint::Slate,
        Vec3::new(-0.5, y + 0.03, rear + 0.26),
        Vec3::new(0.5, y + 0.03, rear + 0.26),
        0.07,
    );
    driver(
        mesh,
        Vec3::new(0.0, y + 0.12, 0.22),
        Paint::Blue,
        -0.1,
        Vec3::new(0.0, y + 0.4, -0.1),
    );
}

pub fn motorcycle(mesh: &mut Mesh, frame: &Frame) {
    let axles = frame.axles();
    let (front, rear) = (axles[0], axles[axles.len() - 1]);
    let r = frame.radius();
    let point = Vec2::new;
    let section = |z: f32, w: f32, low: f32, high: f32| Section {
        z,
        half: vec![
            point(0.6 * w, low),
            point(w, low + 0.3 * (high - low)),
            point(w, high - 0.3 * (high - low)),
            point(0.5 * w, high),
        ],
    };
    // Engine, tank and tail.
    loft(
        mesh,
        &[
            section(front + 0.5, 0.1, 0.34, 0.62),
            section(front + 0.6, 0.17, 0.26, 0.68),
            section(0.2, 0.17, 0.28, 0.66),
            section(0.28, 0.12, 0.34, 0.6),
        ],
        |_, _| Paint::Slate,
    );
    loft(
        mesh,
        &[
            section(-0.42, 0.1, 0.72, 0.94),
            section(-0.32, 0.16, 0.66, 1.02),
            section(-0.08, 0.17, 0.66, 0.98),
            section(0.12, 0.12, 0.68, 0.82),
        ],
        |_, _| Paint::Red,
    );
    loft(
        mesh,
        &[
            section(0.1, 0.13, 0.7, 0.8),
            section(0.42, 0.14, 0.72, 0.83),
            section(0.72, 0.09, 0.82, 0.92),
            section(0.86, 0.05, 0.88, 0.93),
        ],
        |piece, _| if piece == 0 { Paint::Ink } else { Paint::Red },
    );
    // Fairing, screen, lamp.
    loft(
        mesh,
        &[
            section(-0.66, 0.07, 0.84, 0.96),
            section(-0.52, 0.17, 0.68, 1.06),
            section(-0.36, 0.2, 0.5, 1.08),
        ],
        |_, _| Paint::Red,
    );
    mesh.cuboid(
        Paint::Lamp,
        Vec3::new(0.0, 0.9, -0.665),
        Vec3::new(0.12, 0.09, 0.03),
    );
    bar(
        mesh,
        Paint::Glass,
        Vec3::new(0.0, 1.05, -0.5),
        Vec3::new(0.0, 1.2, -0.38),
        0.14,
    );
    // Fork, swing arm, exhaust, mudguard, handlebar.
    for side in [-1.0, 1.0] {
        let x = |x: f32| side * x;
        bar(
            mesh,
            Paint::Metal,
            Vec3::new(x(0.1), r, front),
            Vec3::new(x(0.1), 0.98, -0.44),
            0.05,
        );
        bar(
            mesh,
            Paint::Metal,
            Vec3::new(x(0.11), r, rear),
            Vec3::new(x(0.11), 0.42, 0.18),
            0.06,
        );
        bar(
            mesh,
            Paint::Ink,
            Vec3::new(x(0.12), 1.02, -0.42),
            Vec3::new(x(0.32), 1.0, -0.3),
            0.04,
        );
        bar(
            mesh,
            Paint::Metal,
            Vec3::new(x(0.15), 0.4, 0.2),
            Vec3::new(x(0.18), 0.6, 0.78),
            0.09,
        );
    }
    mesh.cuboid(
        Paint::Red,
        Vec3::new(0.0, 2.0 * r + 0.03, front + 0.03),
        Vec3::new(0.14, 0.03, 0.34),
    );
    mesh.cuboid(
        Paint::Tail,
        Vec3::new(0.0, 0.88, 0.865),
        Vec3::new(0.09, 0.05, 0.02),
    );
    driver(
        mesh,
        Vec3::new(0.0, 0.86, 0.22),
        Paint::Ink,
        0.3,
        Vec3::new(0.0, 1.03, -0.3),
    );
}
