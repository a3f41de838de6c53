//! Corners, pillars, the crawl tunnel and the ladder.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{ColliderSpec, NodeExtras},
    layout::{self, APPROACH, CORNER_APEX, CORNER_WALL, Corner, crawl, ladder, pillars},
};

use super::{Level, boxed, signs::Sign, solid};
use crate::{
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

/// Thickness of the walls of a corner.
const WALL: f32 = 0.25;

pub fn build(level: &mut Level) {
    for corner in layout::corners() {
        if corner.mesh {
            mesh_corner(level, &corner);
        } else {
            box_corner(level, &corner);
        }
        level.station(
            &corner.place,
            &Sign {
                station: &corner.name,
                kind: "CORNER",
                title: &format!("{:.0}°", corner.degrees),
                paint: Paint::Indigo,
            },
        );
    }
    wood(level);
    tunnel(level);
    tower(level);
}

/// Two boxes whose inner faces meet at the apex.
fn box_corner(level: &mut Level, corner: &Corner) {
    for side in [1.0f32, -1.0] {
        // The wall runs from the apex back towards the walker, half the angle off the middle.
        let half = 0.5 * f64::from(corner.degrees);
        let (sin, cos) = sin_cos(half);
        let along = Vec3::new(side * sin, 0.0, cos);
        let outward = Vec3::new(side * cos, 0.0, -sin);
        // Longer than its inner face by its thickness, so that no gap is left behind the apex.
        let length = CORNER_WALL.x + WALL;
        let middle = CORNER_APEX
            + along * (0.5 * (CORNER_WALL.x - WALL))
            + outward * (0.5 * WALL)
            + Vec3::Y * (0.5 * CORNER_WALL.y);
        let size = Vec3::new(WALL, CORNER_WALL.y, length);
        let mut mesh = Mesh::default();
        mesh.cuboid(Paint::Indigo, Vec3::ZERO, size);
        level.add(
            format!(
                "{}.wall_{}",
                corner.name,
                if side > 0.0 { "right" } else { "left" }
            ),
            &corner.place,
            middle,
            mesh,
            solid(boxed(size)),
        );
        if let Some(node) = level.nodes.last_mut() {
            let turn = Quat::from_rotation_y(side * (half.to_radians() as f32));
            node.transform.rotation *= turn;
        }
    }
}

/// One closed mesh: the two inner faces and a back that follows them.
fn mesh_corner(level: &mut Level, corner: &Corner) {
    let (sin, cos) = sin_cos(0.5 * f64::from(corner.degrees));
    let top = CORNER_WALL.y;
    let end = |side: f32, y: f32| Vec3::new(side * sin * CORNER_WALL.x, y, cos * CORNER_WALL.x);
    // The back is parallel to the faces, one thickness behind.
    let back = |y: f32| Vec3::new(0.0, y, -WALL / sin);
    let behind = |side: f32, y: f32| end(side, y) + Vec3::new(side * cos, 0.0, -sin) * WALL;
    let apex = |y: f32| Vec3::Y * y;
    let mut mesh = Mesh::default();
    let paint = Paint::Indigo;
    mesh.polygon(paint, &[apex(0.0), end(1.0, 0.0), end(1.0, top), apex(top)])
        .polygon(
            paint,
            &[end(-1.0, 0.0), apex(0.0), apex(top), end(-1.0, top)],
        )
        .polygon(
            paint,
            &[
                end(1.0, 0.0),
                behind(1.0, 0.0),
                behind(1.0, top),
                end(1.0, top),
            ],
        )
        .polygon(
            paint,
            &[
                behind(-1.0, 0.0),
                end(-1.0, 0.0),
                end(-1.0, top),
                behind(-1.0, top),
            ],
        )
        .polygon(
            paint,
            &[behind(1.0, 0.0), back(0.0), back(top), behind(1.0, top)],
        )
        .polygon(
            paint,
            &[back(0.0), behind(-1.0, 0.0), behind(-1.0, top), back(top)],
        )
        .polygon(
            paint,
            &[apex(top), end(1.0, top), behind(1.0, top), back(top)],
        )
        .polygon(
            paint,
            &[end(-1.0, top), apex(top), back(top), behind(-1.0, top)],
        );
    level.solid_mesh(
        format!("{}.walls", corner.name),
        &corner.place,
        CORNER_APEX,
        mesh,
    );
}

fn wood(level: &mut Level) {
    for (i, foot) in pillars::all().into_iter().enumerate() {
        let (radius, height) = (pillars::RADIUS, pillars::HEIGHT);
        let mut mesh = Mesh::default();
        let middle = Vec3::Y * (0.5 * height);
        mesh.tint(if i % 2 == 0 { 255 } else { 225 }).round(
            Paint::Sand,
            -middle,
            [radius; 2],
            height,
            28,
        );
        level.add(
            format!("pillars.{i}"),
            &pillars::PLACE,
            foot + middle,
            mesh,
            solid(ColliderSpec::Cylinder { height, radius }),
        );
    }
    level.station(
        &pillars::PLACE,
        &Sign {
            station: "pillars",
            kind: "STONE WOOD",
            title: "PILLARS",
            paint: Paint::Sand,
        },
    );
}

fn tunnel(level: &mut Level) {
    let (inner, wall, height) = (crawl::WIDTH, crawl::WALL, crawl::HEIGHT);
    let middle = -APPROACH - 0.5 * crawl::LENGTH;
    for side in [-1.0f32, 1.0] {
        level.standing(
            format!("crawl.wall_{}", if side > 0.0 { "right" } else { "left" }),
            &crawl::PLACE,
            Vec3::new(side * 0.5 * (inner + wall), 0.0, middle),
            Vec3::new(wall, height, crawl::LENGTH),
            Paint::Slate,
        );
    }
    level.block(
        "crawl.roof",
        &crawl::PLACE,
        Vec3::new(0.0, height + 0.5, middle),
        Vec3::new(inner + 2.0 * wall, 1.0, crawl::LENGTH),
        Paint::Slate,
    );
    level.station(
        &crawl::PLACE,
        &Sign {
            station: "crawl",
            kind: "TUNNEL",
            title: "1.1 M HIGH",
            paint: Paint::Rose,
        },
    );
}

fn tower(level: &mut Level) {
    let tower = ladder::TOWER;
    level.standing(
        "ladder.tower",
        &ladder::PLACE,
        Vec3::new(0.0, 0.0, -APPROACH - 0.5 * tower),
        Vec3::new(tower, ladder::LEDGE, tower),
        Paint::Stone,
    );
    let mut rungs = Mesh::default();
    let h = 0.5 * ladder::WIDTH;
    for x in [-h, h] {
        rungs.cuboid(
            Paint::Wood,
            Vec3::new(x, 0.5 * ladder::LEDGE, 0.04),
            Vec3::new(0.07, ladder::LEDGE, 0.07),
        );
    }
    let count = 13;
    for i in 0..count {
        let y = ladder::LEDGE * (i as f32 + 0.5) / count as f32;
        rungs.cuboid(
            Paint::Wood,
            Vec3::new(0.0, y, 0.05),
            Vec3::new(ladder::WIDTH, 0.05, 0.05),
        );
    }
    level.decor(
        "ladder.rungs",
        &ladder::PLACE,
        Vec3::new(0.0, 0.0, -APPROACH),
        rungs,
    );
    let height = ladder::LEDGE + ladder::ABOVE;
    level.add(
        "ladder.space",
        &ladder::PLACE,
        Vec3::new(0.0, 0.5 * height, -APPROACH + 0.5 * ladder::REACH),
        Mesh::default(),
        NodeExtras {
            ladder: true,
            ..solid(boxed(Vec3::new(ladder::WIDTH, height, ladder::REACH)))
        },
    );
    level.station(
        &ladder::PLACE,
        &Sign {
            station: "ladder",
            kind: "TO THE LEDGE",
            title: "LADDER",
            paint: Paint::Rose,
        },
    );
}
