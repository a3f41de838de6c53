//! The meadow, the oval, the skid pad.

use bevy::prelude::*;
use embody_scenes::course::layout::{
    Heading, Place,
    driving::{GROUND, GROUND_EXTENT, oval, skid_pad},
};

use super::{LINES, PAINTED, arch};
use crate::{
    level::{Level, boxed, solid},
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

const MIDDLE: Place = Place::new(GROUND.x, GROUND.z, Heading::North);
/// Edge of a square of the meadow.
const SQUARE: f32 = 16.0;

pub fn build(level: &mut Level) {
    meadow(level);
    track(level);
    pad(level);
    trees(level);
}

fn meadow(level: &mut Level) {
    let [min, max] = GROUND_EXTENT;
    let size = Vec3::new(max.x - min.x, 2.0, max.y - min.y);
    let center = Vec3::new(0.5 * (min.x + max.x), -1.0, 0.5 * (min.y + max.y));
    let half = 0.5 * size;
    let mut mesh = Mesh::default();
    let count = (size / SQUARE).round();
    let edge = Vec2::new(size.x / count.x, size.z / count.z);
    for i in 0..count.x as usize {
        for k in 0..count.z as usize {
            mesh.tint(if (i + k) % 2 == 0 { 255 } else { 226 });
            let low = Vec2::new(-half.x, -half.z) + edge * Vec2::new(i as f32, k as f32);
            mesh.patch(Paint::Grass, low, low + edge, half.y);
        }
    }
    mesh.tint(255);
    let corner = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    for i in 0..4 {
        let ((ax, az), (bx, bz)) = (corner[i], corner[(i + 1) % 4]);
        let at = |x: f32, y: f32, z: f32| Vec3::new(x * half.x, y * half.y, z * half.z);
        mesh.polygon(
            Paint::Stone,
            &[
                at(ax, -1.0, az),
                at(bx, -1.0, bz),
                at(bx, 1.0, bz),
                at(ax, 1.0, az),
            ],
        );
    }
    level.add("meadow", &MIDDLE, center, mesh, solid(boxed(size)));
}

fn track(level: &mut Level) {
    let pieces = 2 * (oval::LENGTH / 3.2) as usize;
    let width = oval::WIDTH;
    let sections: Vec<oval::Section> = (0..=pieces)
        .map(|i| oval::section(oval::LENGTH * i as f32 / pieces as f32))
        .collect();
    let mut mesh = Mesh::default();
    for (paint, from, to) in [
        (Paint::White, 0.0, 0.3),
        (Paint::Asphalt, 0.3, 0.5 * width),
        (Paint::Asphalt, 0.5 * width, width - 0.3),
        (Paint::White, width - 0.3, width),
    ] {
        let points: Vec<(Vec3, Vec3)> = sections
            .iter()
            .flat_map(|s| [to, from].map(|across| (s.point(across), s.normal())))
            .collect();
        mesh.grid(paint, 2, &points);
    }
    for pair in sections.windows(2) {
        let foot = |s: &oval::Section| {
            let top = s.point(width);
            let out = s.ahead.cross(Vec3::Y);
            (top, (top + out * (0.9 * top.y)).with_y(-0.05))
        };
        let ((a, af), (b, bf)) = (foot(&pair[0]), foot(&pair[1]));
        if a.y.max(b.y) > 0.05 {
            mesh.quad(Paint::Leaf, [af, bf, b, a]);
        }
    }
    level.solid_mesh("oval.surface", &MIDDLE, Vec3::Y * PAINTED, mesh);

    let mut rail = Mesh::default();
    let rings: Vec<Vec<Vec3>> = sections
        .iter()
        .map(|s| {
            let up = s.normal();
            [(0.05, 0.25), (0.05, 0.75), (0.17, 0.75), (0.17, 0.25)]
                .map(|(out, high)| s.point(width + out) + up * high)
                .to_vec()
        })
        .collect();
    rail.tube(Paint::Metal, &rings);
    for s in sections.iter().step_by(3) {
        let base = s.point(width + 0.24);
        rail.cuboid(
            Paint::Slate,
            base + Vec3::Y * 0.35,
            Vec3::new(0.12, 0.9, 0.12),
        );
    }
    level.solid_mesh("oval.rail", &MIDDLE, Vec3::ZERO, rail);

    let mut marks = Mesh::default();
    // A dashed line between two lanes, and the start.
    for (i, pair) in sections.windows(2).enumerate() {
        if i % 4 < 2 {
            let at = |s: &oval::Section, across: f32| s.point(across) + s.normal() * 0.012;
            let (low, high) = (0.5 * width - 2.5, 0.5 * width - 2.35);
            let [a, b] = [&pair[0], &pair[1]];
            marks.quad(
                Paint::White,
                [at(a, low), at(a, high), at(b, high), at(b, low)],
            );
        }
    }
    for i in 0..24 {
        for row in 0..2 {
            let x = oval::INNER + 0.5 * i as f32;
            let z = -4.0 - 0.5 * row as f32;
            let paint = if (i + row) % 2 == 0 {
                Paint::White
            } else {
                Paint::Ink
            };
            marks.patch(paint, Vec2::new(x, z), Vec2::new(x + 0.5, z + 0.5), 0.014);
        }
    }
    level.decor("oval.marks", &MIDDLE, Vec3::Y * PAINTED, marks);
    level.start("oval", &oval::PLACE, Vec3::ZERO);
    arch(level, &oval::PLACE, "oval", "OVAL 30°", Paint::Coral, 10.0);
}

fn pad(level: &mut Level) {
    let place = &skid_pad::PLACE;
    let center = skid_pad::CENTER;
    let mut mesh = Mesh::default();
    let ring = |radius: f32, pieces: usize| -> Vec<Vec2> {
        (0..pieces)
            .map(|i| {
                let (sin, cos) = sin_cos(360.0 * i as f64 / pieces as f64);
                Vec2::new(center.x + radius * cos, center.z - radius * sin)
            })
            .collect()
    };
    let flat = |mesh: &mut Mesh, paint: Paint, inner: f32, outer: f32, y: f32| {
        let pieces = 72;
        let (a, b) = (ring(inner, pieces), ring(outer, pieces));
        for i in 0..pieces {
            let j = (i + 1) % pieces;
            let at = |p: Vec2| Vec3::new(p.x, y, p.y);
            mesh.quad(paint, [at(a[i]), at(b[i]), at(b[j]), at(a[j])]);
        }
    };
    flat(&mut mesh, Paint::Asphalt, 0.0, skid_pad::RADIUS, PAINTED);
    for radius in skid_pad::CIRCLES {
        flat(&mut mesh, Paint::White, radius - 0.12, radius + 0.12, LINES);
    }
    flat(&mut mesh, Paint::Amber, 0.0, 0.6, LINES);
    level.decor("skid_pad.disc", place, Vec3::ZERO, mesh);
    level.start("skid_pad", place, Vec3::ZERO);
    arch(level, place, "skid_pad", "SKID PAD", Paint::Amber, -7.0);
}

fn trees(level: &mut Level) {
    let [min, max] = GROUND_EXTENT;
    let mut spots = Vec::new();
    let spread = |i: usize, n: usize| ((i * n) % 29) as f32 / 29.0;
    for i in 0..15 {
        let z = min.y + 8.0 + (max.y - min.y - 16.0) * i as f32 / 14.0;
        spots.push(Vec2::new(max.x - 3.0 - 3.0 * spread(i, 11), z));
        spots.push(Vec2::new(
            min.x + 3.0 + 3.0 * spread(i, 7),
            z + 6.0 * spread(i, 5),
        ));
    }
    for i in 0..16 {
        let x = min.x + 10.0 + (max.x - min.x - 20.0) * i as f32 / 15.0;
        spots.push(Vec2::new(x, min.y + 3.0 + 4.0 * spread(i, 13)));
    }
    for (i, spot) in spots.into_iter().enumerate() {
        let size = 1.5 + 0.25 * ((i * 7) % 5) as f32;
        level.decor(
            format!("meadow.tree.{i}"),
            &MIDDLE,
            Vec3::new(spot.x, 0.0, spot.y),
            crate::level::ground::tree(size),
        );
        level.add(
            format!("meadow.trunk.{i}"),
            &MIDDLE,
            Vec3::new(spot.x, size, spot.y),
            Mesh::default(),
            solid(embody_scenes::course::extras::ColliderSpec::Cylinder {
                height: 2.0 * size,
                radius: 0.16 * size,
            }),
        );
    }
}
