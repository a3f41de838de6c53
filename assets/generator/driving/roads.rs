//! Straight lanes: drag strip, ice, kerbs, washboard, rubble.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{ColliderSpec, NodeExtras},
    layout::driving::{KERB, LANE, drag, ice, kerbs, rubble, washboard},
};

use super::{LINES, road, station};
use crate::{
    level::{Level, boxed, dynamic, signs, solid},
    mesh::Mesh,
    paint::Paint,
};

pub fn build(level: &mut Level) {
    strip(level);
    slippery(level);
    for kerb in kerbs() {
        build_kerb(level, kerb.height, &kerb.place);
    }
    waves(level);
    stones(level);
}

fn strip(level: &mut Level) {
    let place = &drag::PLACE;
    road(level, "drag", place, [-8.0, drag::END], 5.0);
    station(level, place, "drag", "DRAG STRIP", Paint::Indigo, 6.0);
    let mut marks = Mesh::default();
    let lines = (drag::LENGTH / drag::MARK) as usize;
    for i in 1..=lines {
        let z = -drag::MARK * i as f32;
        let broad = if i == lines { 0.6 } else { 0.12 };
        marks.patch(
            Paint::White,
            Vec2::new(-4.6, z - broad),
            Vec2::new(4.6, z + broad),
            LINES,
        );
        // A board beside the road tells the distance.
        let foot = Vec3::new(5.8, 0.0, z);
        marks
            .cuboid(Paint::Slate, foot + Vec3::Y * 0.6, Vec3::new(0.1, 1.2, 0.1))
            .cuboid(Paint::Ink, foot + Vec3::Y * 1.5, Vec3::new(1.7, 0.8, 0.1));
        signs::text(
            &mut marks,
            Paint::White,
            &format!("{} M", drag::MARK * i as f32),
            foot + Vec3::new(0.0, 1.5, 0.06),
            0.07,
            1.5,
        );
    }
    level.decor("drag.marks", place, Vec3::ZERO, marks);
    super::arch(
        level,
        &place.moved(Vec3::NEG_Z * drag::LENGTH),
        "drag.finish",
        "FINISH",
        Paint::Indigo,
        0.0,
    );
}

/// A thin plate of another surface on the road.
fn surface(level: &mut Level, name: &str, [from, to]: [f32; 2], friction: f32, paint: Paint) {
    let size = Vec3::new(2.0 * LANE, 0.2, to - from);
    let top = LINES + 0.008;
    let mut mesh = Mesh::default();
    mesh.cuboid(paint, Vec3::ZERO, size);
    level.add(
        name,
        &ice::PLACE,
        Vec3::new(0.0, top - 0.5 * size.y, -0.5 * (from + to)),
        mesh,
        NodeExtras {
            road: Some(friction),
            ..solid(boxed(size))
        },
    );
}

fn slippery(level: &mut Level) {
    let place = &ice::PLACE;
    road(level, "ice", place, [-8.0, ice::ICE[1] + 20.0], LANE);
    station(level, place, "ice", "WET AND ICE", Paint::Water, 6.0);
    surface(level, "ice.wet", ice::WET, ice::WET_FRICTION, Paint::Wet);
    surface(level, "ice.ice", ice::ICE, ice::ICE_FRICTION, Paint::Ice);
}

fn build_kerb(level: &mut Level, height: f32, place: &embody_scenes::course::layout::Place) {
    let centimetres = height * 100.0;
    let name = format!("kerb_{centimetres:02.0}");
    let [ahead, length] = KERB;
    road(level, &name, place, [-8.0, ahead + length + 14.0], LANE);
    station(
        level,
        place,
        &name,
        &format!("KERB {centimetres:.0} CM"),
        Paint::Teal,
        6.0,
    );
    let size = Vec3::new(2.0 * LANE, height, length);
    let mut mesh = Mesh::default();
    let half = 0.5 * size;
    mesh.cuboid(Paint::Plaza, Vec3::ZERO, size);
    // The stones of the edge.
    for z in [-half.z + 0.15, half.z - 0.15] {
        for i in 0..6 {
            let x = -half.x + size.x * i as f32 / 6.0;
            let paint = if i % 2 == 0 {
                Paint::White
            } else {
                Paint::Coral
            };
            mesh.patch(
                paint,
                Vec2::new(x, z - 0.15),
                Vec2::new(x + size.x / 6.0, z + 0.15),
                half.y + 0.004,
            );
        }
    }
    level.add(
        format!("{name}.plate"),
        place,
        Vec3::new(0.0, half.y, -ahead - half.z),
        mesh,
        solid(boxed(size)),
    );
}

fn waves(level: &mut Level) {
    let place = &washboard::PLACE;
    let [first, length] = washboard::WAVES;
    road(
        level,
        "washboard",
        place,
        [-8.0, first + length + 14.0],
        LANE,
    );
    station(level, place, "washboard", "WASHBOARD", Paint::Sand, 6.0);
    let step = washboard::WAVE / 10.0;
    let rows = (length / step).round() as usize;
    let points: Vec<(Vec3, Vec3)> = (0..=rows)
        .flat_map(|i| {
            let at = step * i as f32;
            let slope = (washboard::height(at + 0.01) - washboard::height(at - 0.01)) / 0.02;
            // Ahead is `-Z`, so what rises ahead leans back.
            let normal = Vec3::new(0.0, 1.0, slope).normalize();
            let y = washboard::height(at) + LINES;
            [LANE, -LANE].map(|x| (Vec3::new(x, y, -at), normal))
        })
        .collect();
    let mut mesh = Mesh::default();
    mesh.grid(Paint::Sand, 2, &points);
    level.solid_mesh("washboard.waves", place, Vec3::NEG_Z * first, mesh);
}

fn stones(level: &mut Level) {
    let place = &rubble::PLACE;
    let [first, length] = rubble::FIELD;
    road(level, "rubble", place, [-8.0, first + length + 16.0], LANE);
    station(level, place, "rubble", "RUBBLE", Paint::Stone, 6.0);
    for i in 0..rubble::STONES {
        let (at, size) = rubble::stone(i);
        let mut mesh = Mesh::default();
        // A block without two of its corners, turned by its number.
        let h = 0.5 * size;
        let (w, l) = (
            h * (1.1 + 0.1 * (i % 3) as f32),
            h * (1.3 - 0.1 * (i % 4) as f32),
        );
        let outline = [
            Vec2::new(-w, 0.5 * l),
            Vec2::new(-0.4 * w, l),
            Vec2::new(w, 0.7 * l),
            Vec2::new(0.8 * w, -l),
            Vec2::new(-0.7 * w, -0.8 * l),
        ];
        let ring = |part: f32, y: f32| -> Vec<Vec3> {
            outline
                .iter()
                .map(|p| Vec3::new(p.x * part, y, p.y * part))
                .collect()
        };
        mesh.tint(255 - 20 * (i % 4) as u8);
        mesh.tube(
            Paint::Stone,
            &[ring(0.85, -h), ring(1.0, 0.1 * h), ring(0.7, h)],
        );
        let mass = 2400.0 * 0.7 * (2.0 * w) * (2.0 * l) * size;
        level.add(
            format!("rubble.{i}"),
            place,
            at,
            mesh,
            NodeExtras {
                friction: Some(0.6),
                ..dynamic(ColliderSpec::Convex, mass)
            },
        );
        if let Some(node) = level.nodes.last_mut() {
            let (sin, cos) = crate::mesh::sin_cos(0.5 * f64::from((i as u32 * 67) % 360));
            node.transform.rotation = Quat::from_xyzw(0.0, sin, 0.0, cos);
        }
    }
}
