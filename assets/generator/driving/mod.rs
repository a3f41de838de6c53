//! The proving ground, station by station. Measures are in `embody_scenes::course::layout::driving`.

mod ground;
mod machines;
mod roads;
mod slopes;

use bevy::prelude::*;
use embody_scenes::course::layout::{Place, driving::LANE};

use crate::{
    level::{Level, signs},
    mesh::Mesh,
    paint::Paint,
};

/// Height of painted things above the ground, metres: clear of it also from far away.
pub const PAINTED: f32 = 0.012;
/// Height of lines on painted things.
pub const LINES: f32 = 0.022;

/// Builds everything.
pub fn build(level: &mut Level) {
    ground::build(level);
    roads::build(level);
    slopes::build(level);
    machines::build(level);
}

/// A road ahead of a place from one distance to another, with white edges.
fn road(level: &mut Level, name: &str, place: &Place, [from, to]: [f32; 2], half: f32) {
    let mut mesh = Mesh::default();
    mesh.patch(
        Paint::Asphalt,
        Vec2::new(-half, -to),
        Vec2::new(half, -from),
        PAINTED,
    );
    for x in [-half + 0.3, half - 0.3] {
        let line = Vec2::new(0.07, 0.0);
        mesh.patch(
            Paint::White,
            Vec2::new(x, -to) - line,
            Vec2::new(x, -from) + line,
            LINES,
        );
    }
    level.decor(format!("{name}.road"), place, Vec3::ZERO, mesh);
}

/// The start of a station: its mark, a painted box and a gantry over the lane.
fn station(level: &mut Level, place: &Place, name: &str, title: &str, paint: Paint, gantry: f32) {
    level.start(name, place, Vec3::ZERO);
    let mut mesh = Mesh::default();
    let half = LANE - 0.8;
    for (x0, x1, z0, z1) in [
        (-half, half, -5.0, -4.7),
        (-half, -half + 0.3, -4.7, 4.0),
        (half - 0.3, half, -4.7, 4.0),
    ] {
        mesh.patch(paint, Vec2::new(x0, z0), Vec2::new(x1, z1), LINES + 0.006);
    }
    level.decor(format!("{name}.box"), place, Vec3::ZERO, mesh);
    arch(level, place, name, title, paint, gantry);
}

/// Two posts and a board over the lane, this far ahead.
fn arch(level: &mut Level, place: &Place, name: &str, title: &str, paint: Paint, ahead: f32) {
    let mut mesh = Mesh::default();
    let (post, height) = (LANE + 0.35, 6.4);
    for x in [-post, post] {
        mesh.round(
            Paint::Slate,
            Vec3::new(x, 0.0, -ahead),
            [0.12, 0.1],
            height,
            10,
        )
        .round(paint, Vec3::new(x, 0.0, -ahead), [0.32, 0.32], 0.3, 14);
    }
    let board = Vec3::new(2.0 * post + 0.5, 1.3, 0.16);
    let middle = Vec3::new(0.0, height - 0.55, -ahead);
    mesh.cuboid(Paint::Ink, middle, board).cuboid(
        paint,
        middle - Vec3::Y * (0.5 * board.y + 0.08),
        Vec3::new(board.x, 0.16, board.z),
    );
    signs::text(
        &mut mesh,
        Paint::White,
        title,
        middle + Vec3::Z * (0.5 * board.z + 0.01),
        0.13,
        0.92 * board.x,
    );
    level.decor(format!("{name}.gantry"), place, Vec3::ZERO, mesh);
    for (side, x) in [("left", -post), ("right", post)] {
        level.add(
            format!("{name}.post.{side}"),
            place,
            Vec3::new(x, 0.5 * height, -ahead),
            Mesh::default(),
            crate::level::solid(embody_scenes::course::extras::ColliderSpec::Cylinder {
                height,
                radius: 0.14,
            }),
        );
    }
}

/// A wedge across the lane: rises by `height` from `from` to `to` ahead.
fn wedge(
    level: &mut Level,
    name: String,
    place: &Place,
    [from, to]: [f32; 2],
    height: f32,
    half: f32,
    paint: Paint,
) {
    let mut mesh = Mesh::default();
    // Rising towards the far side, or falling when it is given the other way round.
    let (low, high) = (from, to);
    let (near, far) = (low.min(high), low.max(high));
    let at = |x: f32, distance: f32| {
        let part = (distance - low) / (high - low);
        Vec3::new(x, height * part, -distance)
    };
    let foot = |x: f32, distance: f32| Vec3::new(x, 0.0, -distance);
    mesh.quad(
        paint,
        [
            at(-half, near),
            at(half, near),
            at(half, far),
            at(-half, far),
        ],
    )
    .quad(
        Paint::Stone,
        [
            foot(half, near),
            foot(half, far),
            at(half, far),
            at(half, near),
        ],
    )
    .quad(
        Paint::Stone,
        [
            foot(-half, far),
            foot(-half, near),
            at(-half, near),
            at(-half, far),
        ],
    )
    .quad(
        Paint::Stone,
        [
            foot(half, high),
            foot(-half, high),
            at(-half, high),
            at(half, high),
        ],
    )
    .quad(
        Paint::Stone,
        [
            foot(-half, near),
            foot(-half, far),
            foot(half, far),
            foot(half, near),
        ],
    );
    if high < low {
        // Seen from the other side the end face goes round the other way.
        mesh.quad(
            Paint::Stone,
            [
                foot(-half, high),
                foot(half, high),
                at(half, high),
                at(-half, high),
            ],
        );
    }
    level.add(
        name,
        place,
        Vec3::ZERO,
        mesh,
        crate::level::solid(embody_scenes::course::extras::ColliderSpec::Convex),
    );
}
