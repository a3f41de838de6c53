//! Hills, the jump, the loop.

use bevy::prelude::*;
use embody_scenes::course::layout::driving::{
    HILL_HALF_WIDTH, HILL_TOP, Hill, LANE, hills, jump, looping,
};

use super::{LINES, arch, road, station};
use crate::{
    level::Level,
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

pub fn build(level: &mut Level) {
    for hill in hills() {
        build_hill(level, &hill);
    }
    kicker(level);
    build_loop(level);
}

fn build_hill(level: &mut Level, hill: &Hill) {
    let name = format!("hill_{:.0}", hill.degrees);
    let up = hill.outline();
    let top = hill.top();
    let length = 2.0 * top.x + HILL_TOP;
    // Up, along the top, and down again.
    let mut line = up.clone();
    line.extend(up.iter().rev().map(|p| Vec2::new(length - p.x, p.y)));
    let w = HILL_HALF_WIDTH;
    let mut mesh = Mesh::default();
    let normals: Vec<Vec3> = (0..line.len())
        .map(|i| {
            let before = line[i.saturating_sub(1)];
            let after = line[(i + 1).min(line.len() - 1)];
            let way = after - before;
            Vec3::new(0.0, way.x, way.y).normalize()
        })
        .collect();
    for (paint, from, to) in [
        (Paint::White, -w, -w + 0.3),
        (Paint::Asphalt, -w + 0.3, w - 0.3),
        (Paint::White, w - 0.3, w),
    ] {
        let points: Vec<(Vec3, Vec3)> = line
            .iter()
            .zip(&normals)
            .flat_map(|(p, n)| [to, from].map(|x| (Vec3::new(x, p.y + LINES, -p.x), *n)))
            .collect();
        mesh.grid(paint, 2, &points);
    }
    for pair in line.windows(2) {
        let at = |x: f32, p: Vec2| Vec3::new(x, p.y + LINES, -p.x);
        let foot = |x: f32, p: Vec2| Vec3::new(x, -0.05, -p.x);
        let [a, b] = [pair[0], pair[1]];
        mesh.quad(Paint::Leaf, [foot(w, a), foot(w, b), at(w, b), at(w, a)]);
        mesh.quad(
            Paint::Leaf,
            [foot(-w, b), foot(-w, a), at(-w, a), at(-w, b)],
        );
    }
    level.solid_mesh(format!("{name}.ridge"), &hill.place, Vec3::ZERO, mesh);
    road(level, &name, &hill.place, [-16.0, 0.0], w);
    road(
        level,
        &format!("{name}.out"),
        &hill.place,
        [length, length + 14.0],
        w,
    );
    // Both stations begin in the middle of the slope, one along it and one across.
    let middle = hill.middle();
    let (sin, cos) = sin_cos(0.5 * f64::from(hill.degrees));
    let pitch = Quat::from_xyzw(sin, 0.0, 0.0, cos);
    let (sin, cos) = sin_cos(-45.0);
    let across = Quat::from_xyzw(0.0, sin, 0.0, cos);
    for (kind, turn) in [("hill", Quat::IDENTITY), ("side", across)] {
        level.start(
            &format!("{kind}_{:.0}", hill.degrees),
            &hill.place,
            Vec3::new(0.0, middle.y + LINES, -middle.x),
        );
        if let Some(node) = level.nodes.last_mut() {
            node.transform.rotation = pitch * turn;
        }
    }
    arch(
        level,
        &hill.place,
        &name,
        &format!("HILL {:.0}°", hill.degrees),
        Paint::Coral,
        -12.0,
    );
}

fn kicker(level: &mut Level) {
    let place = &jump::PLACE;
    let lip = jump::lip();
    let far = jump::RUN_UP + lip.x + jump::GAP;
    road(
        level,
        "jump",
        place,
        [-8.0, far + jump::landing() + 50.0],
        LANE,
    );
    station(level, place, "jump", "JUMP", Paint::Rose, 6.0);
    let pieces = 10;
    let line: Vec<Vec2> = (0..=pieces)
        .map(|i| {
            let (sin, cos) = sin_cos(f64::from(jump::ANGLE) * i as f64 / pieces as f64);
            Vec2::new(
                jump::RUN_UP + jump::RADIUS * sin,
                jump::RADIUS * (1.0 - cos),
            )
        })
        .collect();
    let mut mesh = Mesh::default();
    let w = LANE;
    for (i, pair) in line.windows(2).enumerate() {
        let at = |x: f32, p: Vec2| Vec3::new(x, p.y + LINES, -p.x);
        let foot = |x: f32, p: Vec2| Vec3::new(x, 0.0, -p.x);
        let [a, b] = [pair[0], pair[1]];
        mesh.tint(if i % 2 == 0 { 255 } else { 225 })
            .quad(Paint::Rose, [at(-w, a), at(w, a), at(w, b), at(-w, b)])
            .tint(255)
            .quad(Paint::Stone, [foot(w, a), foot(w, b), at(w, b), at(w, a)])
            .quad(
                Paint::Stone,
                [foot(-w, b), foot(-w, a), at(-w, a), at(-w, b)],
            );
        if i + 1 == pieces {
            mesh.quad(Paint::Stone, [foot(w, b), foot(-w, b), at(-w, b), at(w, b)]);
        }
    }
    level.solid_mesh("jump.kicker", place, Vec3::ZERO, mesh);
    super::wedge(
        level,
        "jump.landing".into(),
        place,
        [far + jump::landing(), far],
        lip.y,
        LANE + 1.0,
        Paint::Rose,
    );
}

fn build_loop(level: &mut Level) {
    let place = &looping::PLACE;
    road(level, "loop", place, [-8.0, looping::RUN_UP], LANE);
    station(level, place, "loop", "LOOP", Paint::Indigo, 6.0);
    let out = place.moved(Vec3::X * looping::SHIFT);
    road(
        level,
        "loop.out",
        &out,
        [looping::RUN_UP, looping::RUN_UP + 80.0],
        LANE,
    );
    let w = looping::HALF_WIDTH;
    let rings: Vec<Vec<Vec3>> = looping::line()
        .into_iter()
        .map(|(at, up)| {
            let under = at - up * 0.3;
            [(-w, at), (w, at), (w, under), (-w, under)]
                .map(|(x, p)| p + Vec3::X * x)
                .to_vec()
        })
        .collect();
    let mut mesh = Mesh::default();
    for (i, pair) in rings.windows(2).enumerate() {
        mesh.tint(if i % 8 < 4 { 255 } else { 215 });
        for k in 0..4 {
            let j = (k + 1) % 4;
            let paint = if k == 0 { Paint::Indigo } else { Paint::Stone };
            mesh.quad(paint, [pair[0][k], pair[0][j], pair[1][j], pair[1][k]]);
        }
    }
    level.solid_mesh("loop.band", place, Vec3::Y * LINES, mesh);
    // What holds it up.
    let mut legs = Mesh::default();
    let line = looping::line();
    for i in [54, 81, 135, 162] {
        let (at, up) = line[i];
        let under = at - up * 0.3;
        for x in [-w - 0.25, w + 0.25] {
            legs.round(
                Paint::Slate,
                Vec3::new(under.x + x, 0.0, under.z),
                [0.22, 0.16],
                under.y,
                8,
            );
        }
        legs.cuboid(
            Paint::Slate,
            under - up * 0.12,
            Vec3::new(2.0 * w + 0.7, 0.22, 0.22),
        );
    }
    level.decor("loop.legs", place, Vec3::ZERO, legs);
}
