//! Things that move: lifts, turntables, the conveyor, the seesaw and crates.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{ColliderSpec, Hinge, Motion, NodeExtras},
    layout::{
        self, APPROACH, CRATE_FRICTION, LIFT_SIZE, LIFT_THICK, LIFT_TOP, LIFT_WAIT, Lift,
        TABLE_TOP, Turntable, conveyor, seesaw,
    },
};

use super::{Level, boxed, dynamic, kinematic, signs::Sign, solid};
use crate::{mesh::Mesh, paint::Paint};

pub fn build(level: &mut Level) {
    for lift in layout::lifts() {
        build_lift(level, &lift);
    }
    for table in layout::turntables() {
        build_table(level, &table);
    }
    belt(level);
    board(level);
    for item in layout::crates() {
        build_crate(level, &item);
    }
}

fn build_lift(level: &mut Level, lift: &Lift) {
    let size = Vec3::new(LIFT_SIZE, LIFT_THICK, LIFT_SIZE);
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Amber, Vec3::ZERO, size);
    let edge = 0.5 * LIFT_SIZE - 0.06;
    for (x, z, sx, sz) in [
        (edge, 0.0, 0.12, LIFT_SIZE),
        (-edge, 0.0, 0.12, LIFT_SIZE),
        (0.0, edge, LIFT_SIZE, 0.12),
        (0.0, -edge, LIFT_SIZE, 0.12),
    ] {
        // Painted lines, a hair above the platform.
        let y = 0.5 * LIFT_THICK + 0.002;
        let (x0, x1, z0, z1) = (x - 0.5 * sx, x + 0.5 * sx, z - 0.5 * sz, z + 0.5 * sz);
        mesh.polygon(
            Paint::Ink,
            &[
                Vec3::new(x0, y, z1),
                Vec3::new(x1, y, z1),
                Vec3::new(x1, y, z0),
                Vec3::new(x0, y, z0),
            ],
        );
    }
    let center = LIFT_TOP - Vec3::Y * (0.5 * LIFT_THICK);
    level.add(
        lift.node.clone(),
        &lift.place,
        center,
        mesh,
        kinematic(
            boxed(size),
            Motion::Shuttle {
                travel: lift.place.direction(lift.travel).to_array(),
                speed: lift.speed,
                wait_near: LIFT_WAIT,
                wait_far: 0.0,
                ramp: 0.0,
            },
        ),
    );
    // A tower to step off to at the far end.
    let far = LIFT_TOP + lift.travel;
    let depth = 1.8;
    level.standing(
        format!("{}.tower", lift.name),
        &lift.place,
        Vec3::new(0.0, 0.0, far.z - 0.5 * LIFT_SIZE - 0.05 - 0.5 * depth),
        Vec3::new(LIFT_SIZE, far.y, depth),
        Paint::Stone,
    );
    let (kind, title) = if lift.travel.z == 0.0 {
        ("LIFT", format!("{} M/S", lift.speed))
    } else {
        ("PLATFORM", "DIAGONAL".to_owned())
    };
    level.station(
        &lift.place,
        &Sign {
            station: &lift.name,
            kind,
            title: &title,
            paint: Paint::Amber,
        },
    );
}

fn build_table(level: &mut Level, table: &Turntable) {
    let mut mesh = Mesh::default();
    let pieces = 12;
    let low = Vec3::Y * (-0.5 * TABLE_TOP);
    mesh.tint(215)
        .round(Paint::Amber, low, [table.radius; 2], TABLE_TOP - 0.002, 48);
    for i in 0..pieces {
        let angle = 360.0 / pieces as f32;
        mesh.tint(if i == 0 {
            120
        } else if i % 2 == 0 {
            255
        } else {
            215
        })
        .sector(
            [Paint::Amber; 2],
            Vec3::ZERO,
            [0.3, table.radius],
            [angle * i as f32, angle * (i + 1) as f32],
            [0.5 * TABLE_TOP - 0.01, 0.5 * TABLE_TOP],
            4,
        );
    }
    level.add(
        table.node.clone(),
        &table.place,
        Vec3::Y * (0.5 * TABLE_TOP),
        mesh,
        kinematic(
            ColliderSpec::Cylinder {
                height: TABLE_TOP,
                radius: table.radius,
            },
            Motion::Turn {
                axis: [0.0, 1.0, 0.0],
                rate: table.rate,
            },
        ),
    );
    level.start(&table.name, &table.place, table.start());
    level.sign(
        &table.place,
        Vec3::new(-table.radius - 0.5, 0.0, table.radius),
        &Sign {
            station: &table.name,
            kind: "TURNTABLE",
            title: &format!("{} REV/S", table.rate),
            paint: Paint::Amber,
        },
    );
}

fn belt(level: &mut Level) {
    let size = Vec3::new(conveyor::WIDTH, conveyor::TOP, conveyor::LENGTH);
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Slate, Vec3::ZERO, size);
    let y = 0.5 * size.y + 0.002;
    for i in 0..8 {
        let z = 0.5 * size.z - 1.0 - 1.4 * i as f32;
        let w = 0.5 * size.x - 0.25;
        // Chevrons that point the way the belt runs.
        for side in [1.0f32, -1.0] {
            let mut points = [
                Vec3::new(side * w, y, z + 0.35),
                Vec3::new(side * w, y, z),
                Vec3::new(0.0, y, z - 0.45),
                Vec3::new(0.0, y, z - 0.1),
            ];
            if side < 0.0 {
                points.reverse();
            }
            mesh.polygon(Paint::Amber, &points);
        }
    }
    level.add(
        "conveyor.belt",
        &conveyor::PLACE,
        Vec3::new(0.0, 0.5 * size.y, -APPROACH - 0.5 * size.z),
        mesh,
        NodeExtras {
            conveyor: Some([0.0, 0.0, -conveyor::SPEED]),
            ..solid(boxed(size))
        },
    );
    level.station(
        &conveyor::PLACE,
        &Sign {
            station: "conveyor",
            kind: "CONVEYOR",
            title: &format!("{} M/S", conveyor::SPEED),
            paint: Paint::Amber,
        },
    );
}

fn board(level: &mut Level) {
    let place = &seesaw::PLACE;
    let size = seesaw::SIZE;
    let mut stand = Mesh::default();
    let (w, h) = (0.5 * size.x - 0.15, seesaw::HINGE.y - 0.09);
    let at = Vec3::new;
    let foot = -seesaw::HINGE.y;
    stand
        .polygon(
            Paint::Slate,
            &[
                at(-w, foot, 0.35),
                at(w, foot, 0.35),
                at(w, foot + h, 0.0),
                at(-w, foot + h, 0.0),
            ],
        )
        .polygon(
            Paint::Slate,
            &[
                at(w, foot, -0.35),
                at(-w, foot, -0.35),
                at(-w, foot + h, 0.0),
                at(w, foot + h, 0.0),
            ],
        )
        .triangle(
            Paint::Slate,
            [at(w, foot, 0.35), at(w, foot, -0.35), at(w, foot + h, 0.0)],
        )
        .triangle(
            Paint::Slate,
            [
                at(-w, foot, -0.35),
                at(-w, foot, 0.35),
                at(-w, foot + h, 0.0),
            ],
        );
    level.add(
        "seesaw.stand",
        place,
        seesaw::HINGE,
        stand,
        solid(ColliderSpec::Convex),
    );
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Wood, Vec3::ZERO, size);
    level.add(
        seesaw::BOARD,
        place,
        seesaw::HINGE,
        mesh,
        NodeExtras {
            hinge: Some(Hinge {
                on: "seesaw.stand".into(),
                on_anchor: [0.0; 3],
                anchor: [0.0; 3],
                axis: [1.0, 0.0, 0.0],
                limit: seesaw::TILT,
            }),
            ..dynamic(boxed(size), seesaw::MASS)
        },
    );
    if let Some(node) = level.nodes.last_mut() {
        // The end towards the walker is down at first.
        node.transform.rotation *= Quat::from_rotation_x(seesaw::TILT);
    }
    let height = seesaw::low_end() + seesaw::DROP;
    for (end, side) in [("near", 1.0f32), ("far", -1.0)] {
        let inner = seesaw::HINGE.z + side * (0.5 * size.z + 0.03);
        for (i, (from, depth, high)) in [(0.0, 0.8, height), (0.8, 0.5, 0.5 * height)]
            .into_iter()
            .enumerate()
        {
            level.standing(
                format!("seesaw.{end}_{i}"),
                place,
                Vec3::new(0.0, 0.0, inner + side * (from + 0.5 * depth)),
                Vec3::new(size.x, high, depth),
                Paint::Stone,
            );
        }
    }
    level.station(
        place,
        &Sign {
            station: "seesaw",
            kind: "BOARD ON A HINGE",
            title: "SEESAW",
            paint: Paint::Amber,
        },
    );
}

fn build_crate(level: &mut Level, item: &layout::Crate) {
    let s = item.size;
    let mut mesh = Mesh::default();
    let paint = match item.mass {
        m if m < 5.0 => Paint::Sand,
        m if m < 500.0 => Paint::Wood,
        _ => Paint::Metal,
    };
    mesh.tint(215)
        .cuboid(paint, Vec3::ZERO, Vec3::splat(s * 0.98));
    // Battens along the edges, flush with the collider.
    let (edge, b) = (0.5 * s - 0.04 * s, 0.08 * s);
    mesh.tint(255);
    for a in [-edge, edge] {
        for c in [-edge, edge] {
            mesh.cuboid(paint, Vec3::new(0.0, a, c), Vec3::new(s, b, b))
                .cuboid(paint, Vec3::new(a, 0.0, c), Vec3::new(b, s, b))
                .cuboid(paint, Vec3::new(a, c, 0.0), Vec3::new(b, b, s));
        }
    }
    level.add(
        item.node.clone(),
        &item.place,
        item.center(),
        mesh,
        NodeExtras {
            friction: Some(CRATE_FRICTION),
            ..dynamic(boxed(Vec3::splat(s)), item.mass)
        },
    );
    level.station(
        &item.place,
        &Sign {
            station: &item.name,
            kind: "CRATE",
            title: &format!("{} KG", item.mass),
            paint: Paint::Wood,
        },
    );
}
