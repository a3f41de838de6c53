//! The hill of voxels, the pool and the planet.

use std::collections::BTreeMap;

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{ColliderSpec, NodeExtras, PlanetSpec},
    layout::{APPROACH, planet, pool, voxels},
};

use super::{Level, boxed, ground, signs::Sign, solid};
use crate::{
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

pub fn build(level: &mut Level) {
    hill(level);
    basin(level);
    globe(level);
}

fn hill(level: &mut Level) {
    let r = voxels::RADIUS;
    let c = voxels::CUBE;
    let mut columns = Vec::new();
    let mut mesh = Mesh::default();
    let paint = |level: i32| {
        if level >= voxels::HEIGHT {
            Paint::White
        } else {
            Paint::Leaf
        }
    };
    for x in -r..r {
        for z in -r..r {
            let height = voxels::column(x, z);
            if height == 0 {
                continue;
            }
            columns.push([x, z, height]);
            let at = |i: i32, k: i32, y: i32| Vec3::new(i as f32, y as f32, k as f32) * c;
            let shade = |y: i32, odd: i32| (150 + 10 * y - 14 * (odd & 1)).clamp(0, 255) as u8;
            mesh.tint(shade(height, x + z)).polygon(
                paint(height),
                &[
                    at(x, z + 1, height),
                    at(x + 1, z + 1, height),
                    at(x + 1, z, height),
                    at(x, z, height),
                ],
            );
            for (dx, dz, a, b) in [
                (0, 1, (0, 1), (1, 1)),
                (1, 0, (1, 1), (1, 0)),
                (0, -1, (1, 0), (0, 0)),
                (-1, 0, (0, 0), (0, 1)),
            ] {
                for y in voxels::column(x + dx, z + dz)..height {
                    let low = [at(x + a.0, z + a.1, y), at(x + b.0, z + b.1, y)];
                    let high = [at(x + b.0, z + b.1, y + 1), at(x + a.0, z + a.1, y + 1)];
                    mesh.tint(shade(y, x + z))
                        .polygon(Paint::Leaf, &[low[0], low[1], high[0], high[1]]);
                }
            }
        }
    }
    level.add(
        "voxels.hill",
        &voxels::PLACE,
        voxels::CENTER,
        mesh,
        solid(ColliderSpec::Voxels { size: c, columns }),
    );
    level.station(
        &voxels::PLACE,
        &Sign {
            station: "voxels",
            kind: "HILL OF",
            title: "VOXELS",
            paint: Paint::Leaf,
        },
    );
}

fn basin(level: &mut Level) {
    let (w, d) = (0.5 * pool::WIDTH, -pool::DEPTH);
    let z = [
        -APPROACH,
        -APPROACH - pool::RAMP,
        -APPROACH - pool::RAMP - pool::BOTTOM,
        -APPROACH - pool::LENGTH,
    ];
    let at = Vec3::new;
    let mut mesh = Mesh::default();
    let floor = |mesh: &mut Mesh, (z0, y0): (f32, f32), (z1, y1): (f32, f32)| {
        mesh.polygon(
            Paint::White,
            &[at(-w, y0, z0), at(w, y0, z0), at(w, y1, z1), at(-w, y1, z1)],
        );
    };
    mesh.tint(225);
    floor(&mut mesh, (z[0], 0.0), (z[1], d));
    floor(&mut mesh, (z[1], d), (z[2], d));
    floor(&mut mesh, (z[2], d), (z[3], 0.0));
    mesh.tint(200)
        .polygon(
            Paint::White,
            &[
                at(-w, 0.0, z[0]),
                at(-w, d, z[1]),
                at(-w, d, z[2]),
                at(-w, 0.0, z[3]),
            ],
        )
        .polygon(
            Paint::White,
            &[
                at(w, 0.0, z[3]),
                at(w, d, z[2]),
                at(w, d, z[1]),
                at(w, 0.0, z[0]),
            ],
        );
    level.solid_mesh("pool.basin", &pool::PLACE, Vec3::ZERO, mesh);

    let size = Vec3::new(pool::WIDTH, pool::DEPTH - pool::WATER, pool::LENGTH);
    let mut water = Mesh::default();
    let y = 0.5 * size.y;
    // The surface ends where it meets the ramps.
    let end = 0.5 * size.z - pool::RAMP * pool::WATER / pool::DEPTH;
    water.polygon(
        Paint::Water,
        &[
            at(-w, y, end),
            at(w, y, end),
            at(w, y, -end),
            at(-w, y, -end),
        ],
    );
    level.add(
        "pool.water",
        &pool::PLACE,
        Vec3::new(0.0, -pool::WATER - y, -APPROACH - 0.5 * pool::LENGTH),
        water,
        NodeExtras {
            water: Some([0.0; 3]),
            ..solid(boxed(size))
        },
    );
    level.station(
        &pool::PLACE,
        &Sign {
            station: "pool",
            kind: "SWIM THE",
            title: "POOL",
            paint: Paint::Water,
        },
    );
}

/// A ball of triangles of one size: an icosahedron, each triangle cut in four a few times.
fn sphere(cuts: usize) -> (Vec<Vec3>, Vec<[usize; 3]>) {
    let g = (1.0 + 5.0f32.sqrt()) / 2.0;
    let mut points: Vec<Vec3> = [
        (-1.0, g, 0.0),
        (1.0, g, 0.0),
        (-1.0, -g, 0.0),
        (1.0, -g, 0.0),
        (0.0, -1.0, g),
        (0.0, 1.0, g),
        (0.0, -1.0, -g),
        (0.0, 1.0, -g),
        (g, 0.0, -1.0),
        (g, 0.0, 1.0),
        (-g, 0.0, -1.0),
        (-g, 0.0, 1.0),
    ]
    .map(|(x, y, z)| Vec3::new(x, y, z).normalize())
    .to_vec();
    let mut faces: Vec<[usize; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..cuts {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::with_capacity(faces.len() * 4);
        for [a, b, c] in faces {
            let mut middle = |i: usize, k: usize| {
                *middles.entry((i.min(k), i.max(k))).or_insert_with(|| {
                    points.push((points[i] + points[k]).normalize());
                    points.len() - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (points, faces)
}

fn globe(level: &mut Level) {
    let place = &planet::PLACE;
    let (points, faces) = sphere(4);
    let mut mesh = Mesh::default();
    for [a, b, c] in faces {
        let corners = [a, b, c].map(|i| (points[i] * planet::RADIUS, points[i]));
        let m = (points[a] + points[b] + points[c]) / 3.0;
        // Land and sea from a few waves over the ball.
        let wave = |x: f32| sin_cos(f64::from(x).to_degrees()).0;
        let land = wave(3.1 * m.x + 0.7)
            + wave(3.7 * m.y + 2.0)
            + wave(3.3 * m.z + 4.1)
            + 0.6 * wave(7.0 * m.x - 5.0 * m.z);
        let (paint, tint) = match land {
            l if l > 1.1 => (Paint::Sand, 255),
            l if l > 0.1 => (Paint::Leaf, 255),
            l if l > -0.05 => (Paint::Sand, 240),
            l if l > -0.8 => (Paint::Teal, 255),
            _ => (Paint::Teal, 215),
        };
        mesh.tint(tint).smooth(paint, corners);
    }
    level.add(
        "planet.globe",
        place,
        planet::CENTER,
        mesh,
        NodeExtras {
            planet: Some(PlanetSpec {
                gravity: planet::GRAVITY,
                reach: planet::REACH,
            }),
            ..solid(ColliderSpec::Ball {
                radius: planet::RADIUS,
            })
        },
    );
    // Trees off the great circle that the walker takes (its plane is x = 0).
    for (i, direction) in [
        Vec3::new(0.5, 0.8, 0.2),
        Vec3::new(-0.6, 0.7, -0.3),
        Vec3::new(0.8, 0.3, -0.5),
        Vec3::new(-0.7, -0.2, 0.6),
        Vec3::new(-0.9, 0.3, 0.3),
        Vec3::new(0.7, -0.5, 0.5),
        Vec3::new(0.6, 0.1, 0.8),
        Vec3::new(-0.6, -0.6, -0.5),
    ]
    .into_iter()
    .enumerate()
    {
        let up = direction.normalize();
        let upright = Quat::from_rotation_arc(Vec3::Y, up);
        let foot = planet::CENTER + up * (planet::RADIUS - 0.02);
        for (name, height, mesh, extras) in [
            ("tree", 0.0, ground::tree(0.45), NodeExtras::default()),
            (
                "trunk",
                0.5,
                Mesh::default(),
                solid(ColliderSpec::Cylinder {
                    height: 1.0,
                    radius: 0.1,
                }),
            ),
        ] {
            level.add(
                format!("planet.{name}.{i}"),
                place,
                foot + up * height,
                mesh,
                extras,
            );
            if let Some(node) = level.nodes.last_mut() {
                node.transform.rotation *= upright;
            }
        }
    }
    level.start("planet", place, Vec3::ZERO);
    // Its sign stands on the plaza below.
    level.sign(
        place,
        Vec3::new(-2.0, -place.origin.y, 6.0),
        &Sign {
            station: "planet",
            kind: "A SMALL",
            title: "PLANET",
            paint: Paint::Leaf,
        },
    );
}
