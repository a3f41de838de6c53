//! Ramps, funnels and wavy ground.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::ColliderSpec,
    layout::{self, APPROACH, Funnel, Place, terrain},
};

use super::{Level, signs::Sign, solid};
use crate::{
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

pub fn build(level: &mut Level) {
    ramps(level);
    for funnel in layout::funnels() {
        build_funnel(level, &funnel);
    }
    wavy(level);
}

fn ramps(level: &mut Level) {
    for (i, ramp) in layout::ramps().into_iter().enumerate() {
        let w = 0.5 * layout::RAMP_WIDTH;
        let (run, top) = (ramp.run, ramp.top);
        let at = Vec3::new;
        let mut mesh = Mesh::default();
        mesh.tint(if i % 2 == 0 { 255 } else { 215 })
            .polygon(
                Paint::Coral,
                &[
                    at(-w, 0.0, 0.0),
                    at(w, 0.0, 0.0),
                    at(w, top, -run),
                    at(-w, top, -run),
                ],
            )
            .triangle(
                Paint::Coral,
                [at(w, 0.0, 0.0), at(w, 0.0, -run), at(w, top, -run)],
            )
            .triangle(
                Paint::Coral,
                [at(-w, 0.0, -run), at(-w, 0.0, 0.0), at(-w, top, -run)],
            )
            .polygon(
                Paint::Coral,
                &[
                    at(-w, 0.0, -run),
                    at(-w, top, -run),
                    at(w, top, -run),
                    at(w, 0.0, -run),
                ],
            )
            .polygon(
                Paint::Coral,
                &[
                    at(-w, 0.0, 0.0),
                    at(-w, 0.0, -run),
                    at(w, 0.0, -run),
                    at(w, 0.0, 0.0),
                ],
            );
        // Every other ramp is a mesh, so that both kinds of collider are walked on.
        let collider = if i % 2 == 0 {
            ColliderSpec::Convex
        } else {
            ColliderSpec::Trimesh
        };
        level.add(
            format!("{}.slope", ramp.name),
            &ramp.place,
            at(0.0, 0.0, -APPROACH),
            mesh,
            solid(collider),
        );
        level.standing(
            format!("{}.landing", ramp.name),
            &ramp.place,
            at(0.0, 0.0, -APPROACH - run - 0.5 * layout::RAMP_LANDING),
            at(2.0 * w, top, layout::RAMP_LANDING),
            Paint::Stone,
        );
        level.station(
            &ramp.place,
            &Sign {
                station: &ramp.name,
                kind: "RAMP",
                title: &format!("{:.0}°", ramp.degrees),
                paint: Paint::Coral,
            },
        );
    }
}

fn build_funnel(level: &mut Level, funnel: &Funnel) {
    let depth = {
        let (sin, cos) = sin_cos(f64::from(layout::FUNNEL_DEGREES));
        layout::FUNNEL_RIM * sin / cos
    };
    let bottom = layout::FUNNEL_BOTTOM;
    let top = bottom + depth;
    let mut mesh = Mesh::default();
    if funnel.walls == 2 {
        trough(&mut mesh, bottom, top);
    } else {
        pit(&mut mesh, funnel.walls, bottom, top);
    }
    level.solid_mesh(
        format!("{}.pit", funnel.name),
        &funnel.place,
        Vec3::ZERO,
        mesh,
    );
    level.start(&funnel.name, &funnel.place, funnel.start());
    level.sign(
        &funnel.place,
        Vec3::new(-1.0, 0.0, 2.4),
        &Sign {
            station: &funnel.name,
            kind: "FUNNEL",
            title: &format!("{} WALLS", funnel.walls),
            paint: Paint::Indigo,
        },
    );
}

/// Two walls along the heading.
fn trough(mesh: &mut Mesh, bottom: f32, top: f32) {
    let (rim, outer, l) = (layout::FUNNEL_RIM, layout::FUNNEL_RIM + 0.2, 1.6);
    for side in [1.0, -1.0] {
        // Mirrored, the corners of a face go round the other way.
        let face = |points: [Vec3; 4]| {
            let mut points = points.map(|p| Vec3::new(p.x * side, p.y, p.z));
            if side < 0.0 {
                points.reverse();
            }
            points
        };
        let at = Vec3::new;
        mesh.polygon(
            Paint::Indigo,
            &face([
                at(0.0, bottom, l),
                at(rim, top, l),
                at(rim, top, -l),
                at(0.0, bottom, -l),
            ]),
        )
        .polygon(
            Paint::Stone,
            &face([
                at(rim, top, l),
                at(outer, top, l),
                at(outer, top, -l),
                at(rim, top, -l),
            ]),
        )
        .polygon(
            Paint::Stone,
            &face([
                at(outer, 0.0, l),
                at(outer, 0.0, -l),
                at(outer, top, -l),
                at(outer, top, l),
            ]),
        );
        for z in [l, -l] {
            let mut end = [
                at(0.0, 0.0, z),
                at(outer, 0.0, z),
                at(outer, top, z),
                at(rim, top, z),
                at(0.0, bottom, z),
            ]
            .map(|p| Vec3::new(p.x * side, p.y, p.z));
            if (z < 0.0) != (side < 0.0) {
                end.reverse();
            }
            // Not convex: a fan from the corner at the bottom of the pit covers it.
            for (a, b) in [(0, 1), (1, 2), (2, 3)] {
                mesh.triangle(Paint::Stone, [end[4], end[a], end[b]]);
            }
        }
    }
}

/// A pyramid upside down.
fn pit(mesh: &mut Mesh, walls: usize, bottom: f32, top: f32) {
    let corner = |i: usize, apothem: f32, y: f32| {
        let half = 180.0 / walls as f64;
        let radius = apothem / sin_cos(half).1;
        // One wall is square to the heading.
        let (sin, cos) = sin_cos(90.0 + half + 2.0 * half * (i % walls) as f64);
        Vec3::new(radius * cos, y, -radius * sin)
    };
    let rim = layout::FUNNEL_RIM;
    let outer = rim + 0.2;
    for i in 0..walls {
        let j = i + 1;
        mesh.tint(if i % 2 == 0 { 255 } else { 225 })
            .triangle(
                Paint::Indigo,
                [Vec3::Y * bottom, corner(i, rim, top), corner(j, rim, top)],
            )
            .tint(255)
            .polygon(
                Paint::Stone,
                &[
                    corner(i, outer, top),
                    corner(j, outer, top),
                    corner(j, rim, top),
                    corner(i, rim, top),
                ],
            )
            .polygon(
                Paint::Stone,
                &[
                    corner(i, outer, 0.0),
                    corner(j, outer, 0.0),
                    corner(j, outer, top),
                    corner(i, outer, top),
                ],
            );
    }
}

fn wavy(level: &mut Level) {
    let n = terrain::SQUARES;
    let spacing = 2.0 * terrain::HALF / n as f32;
    let mut points = Vec::new();
    for row in 0..=n {
        for column in 0..=n {
            let x = -terrain::HALF + spacing * column as f32;
            let z = -terrain::HALF + spacing * row as f32;
            let e = 0.05;
            let slope = |dx: f32, dz: f32| {
                (terrain::height(x + dx, z + dz) - terrain::height(x - dx, z - dz)) / (2.0 * e)
            };
            let normal = Vec3::new(-slope(e, 0.0), 1.0, -slope(0.0, e)).normalize();
            points.push((Vec3::new(x, terrain::height(x, z), z), normal));
        }
    }
    let mut mesh = Mesh::default();
    // Squares in two shades would need corners of their own; height shades the ground instead.
    mesh.grid(Paint::Leaf, n + 1, &points);
    if let Some(part) = mesh.parts.get_mut(&Paint::Leaf) {
        for (tint, point) in part.tints.iter_mut().zip(&part.positions) {
            let shade = (150.0 + 85.0 * point.y).clamp(120.0, 255.0);
            *tint = [shade as u8; 3];
        }
    }
    let place: Place = terrain::PLACE;
    level.solid_mesh("terrain.ground", &place, terrain::CENTER, mesh);
    level.station(
        &place,
        &Sign {
            station: "terrain",
            kind: "MESH",
            title: "TERRAIN",
            paint: Paint::Leaf,
        },
    );
}
