//! The plaza: floor, border, trees.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::ColliderSpec,
    layout::{Heading, PLAZA, PLAZA_HALF, Place, pool},
};

use super::{Level, signs::Sign, solid};
use crate::{mesh::Mesh, paint::Paint};

/// Edge of a tile of the floor.
const TILE: f32 = 2.0;
const WORLD: Place = Place::new(0.0, 0.0, Heading::North);

pub fn build(level: &mut Level) {
    floor(level);
    border(level);
    trees(level);
    level.station(
        &PLAZA,
        &Sign {
            station: "plaza",
            kind: "BEVY EMBODY",
            title: "COURSE",
            paint: Paint::Teal,
        },
    );
}

/// The floor is four slabs about the pool.
fn floor(level: &mut Level) {
    let (w, l) = (PLAZA_HALF.x, PLAZA_HALF.y);
    let a = pool::PLACE.point(Vec3::new(-0.5 * pool::WIDTH, 0.0, -3.0));
    let b = pool::PLACE.point(Vec3::new(0.5 * pool::WIDTH, 0.0, -3.0 - pool::LENGTH));
    let (low, high) = (a.min(b), a.max(b));
    for (name, min, max) in [
        ("floor.south", Vec2::new(-w, high.z), Vec2::new(w, l)),
        ("floor.north", Vec2::new(-w, -l), Vec2::new(w, low.z)),
        ("floor.west", Vec2::new(-w, low.z), Vec2::new(low.x, high.z)),
        ("floor.east", Vec2::new(high.x, low.z), Vec2::new(w, high.z)),
    ] {
        slab(level, name, min, max);
    }
}

fn slab(level: &mut Level, name: &str, min: Vec2, max: Vec2) {
    let size = Vec3::new(max.x - min.x, 1.0, max.y - min.y);
    let middle = Vec3::new(0.5 * (min.x + max.x), -0.5, 0.5 * (min.y + max.y));
    let mut mesh = Mesh::default();
    let h = size * 0.5;
    let corners = [(-h.x, h.z), (h.x, h.z), (h.x, -h.z), (-h.x, -h.z)];
    for i in 0..4 {
        let ((ax, az), (bx, bz)) = (corners[i], corners[(i + 1) % 4]);
        mesh.polygon(
            Paint::Stone,
            &[
                Vec3::new(ax, -h.y, az),
                Vec3::new(bx, -h.y, bz),
                Vec3::new(bx, h.y, bz),
                Vec3::new(ax, h.y, az),
            ],
        );
    }
    // Tiles lie on one grid over the whole plaza, cut where the slab ends.
    let lines = |from: f32, to: f32| {
        let mut lines = vec![from];
        let mut next = ((from / TILE).floor() + 1.0) * TILE;
        while next < to {
            lines.push(next);
            next += TILE;
        }
        lines.push(to);
        lines
    };
    let (xs, zs) = (lines(min.x, max.x), lines(min.y, max.y));
    for x in xs.windows(2) {
        for z in zs.windows(2) {
            let tile = |a: f32, b: f32| (0.5 * (a + b) / TILE).floor() as i32;
            let (i, k) = (tile(x[0], x[1]), tile(z[0], z[1]));
            let avenue = (-2..2).contains(&i);
            mesh.tint(match ((i + k).rem_euclid(2) == 0, avenue) {
                (true, true) => 255,
                (false, true) => 215,
                (true, false) => 195,
                (false, false) => 158,
            });
            let at = |x: f32, z: f32| Vec3::new(x - middle.x, 0.5, z - middle.z);
            mesh.polygon(
                Paint::Plaza,
                &[
                    at(x[0], z[1]),
                    at(x[1], z[1]),
                    at(x[1], z[0]),
                    at(x[0], z[0]),
                ],
            );
        }
    }
    level.add(name, &WORLD, middle, mesh, solid(super::boxed(size)));
}

fn border(level: &mut Level) {
    let (w, l) = (PLAZA_HALF.x, PLAZA_HALF.y);
    let (height, thick) = (0.55, 0.5);
    let along = Vec3::new(thick, height, 2.0 * l);
    let across = Vec3::new(2.0 * (w - thick), height, thick);
    for (name, foot, size) in [
        ("border.west", Vec3::new(-w + 0.5 * thick, 0.0, 0.0), along),
        ("border.east", Vec3::new(w - 0.5 * thick, 0.0, 0.0), along),
        ("border.south", Vec3::new(0.0, 0.0, l - 0.5 * thick), across),
        (
            "border.north",
            Vec3::new(0.0, 0.0, -l + 0.5 * thick),
            across,
        ),
    ] {
        level.standing(name, &WORLD, foot, size, Paint::Stone);
    }
}

/// A tree of two cones.
pub fn tree(size: f32) -> Mesh {
    let mut mesh = Mesh::default();
    mesh.round(
        Paint::Wood,
        Vec3::ZERO,
        [0.16 * size, 0.12 * size],
        1.1 * size,
        8,
    )
    .tint(225)
    .round(
        Paint::Leaf,
        Vec3::Y * (0.8 * size),
        [0.95 * size, 0.25 * size],
        1.5 * size,
        9,
    )
    .tint(255)
    .round(
        Paint::Leaf,
        Vec3::Y * (1.7 * size),
        [0.75 * size, 0.0],
        1.7 * size,
        9,
    );
    mesh
}

fn trees(level: &mut Level) {
    let (w, l) = (PLAZA_HALF.x - 1.8, PLAZA_HALF.y - 1.8);
    let mut spots = Vec::new();
    for i in 0..12 {
        let z = l - 1.0 - 7.4 * i as f32;
        spots.push(Vec3::new(-w, 0.0, z));
        spots.push(Vec3::new(w, 0.0, z - 2.0));
    }
    for (i, spot) in spots.into_iter().enumerate() {
        // Sizes differ in a way that looks random and is not.
        let size = 0.85 + 0.11 * ((i * 7) % 5) as f32;
        level.decor(format!("tree.{i}"), &WORLD, spot, tree(size));
        level.add(
            format!("tree.{i}.trunk"),
            &WORLD,
            spot + Vec3::Y * size,
            Mesh::default(),
            solid(ColliderSpec::Cylinder {
                height: 2.0 * size,
                radius: 0.16 * size,
            }),
        );
    }
}
