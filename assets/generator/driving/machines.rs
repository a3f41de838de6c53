//! Things that move: bridge, seesaw, ferry, lift.

use bevy::prelude::*;
use embody_scenes::course::{
    extras::{Hinge, Motion, NodeExtras},
    layout::{
        Place,
        driving::{LANE, bridge, car_lift, car_seesaw, ferry},
    },
};

use super::{arch, road, station, wedge};
use crate::{
    level::{Level, boxed, dynamic, kinematic, solid},
    mesh::Mesh,
    paint::Paint,
};

pub fn build(level: &mut Level) {
    planks(level);
    board(level);
    deck(level);
    lift(level);
}

fn planks(level: &mut Level) {
    let place = &bridge::PLACE;
    let [ahead, ramp, bank] = bridge::RAMP;
    let (begin, end, high) = (bridge::BEGIN, bridge::END, bridge::HEIGHT);
    road(
        level,
        "bridge",
        place,
        [-8.0, end + ahead + ramp + bank + 6.0],
        LANE,
    );
    station(level, place, "bridge", "BRIDGE 5 T", Paint::Wood, 6.0);
    let half = 0.5 * bridge::PLANK.x + 0.2;
    wedge(
        level,
        "bridge.up".into(),
        place,
        [ahead, ahead + ramp],
        high,
        half,
        Paint::Plaza,
    );
    let far = end + bank;
    wedge(
        level,
        "bridge.down".into(),
        place,
        [far + ramp, far],
        high,
        half,
        Paint::Plaza,
    );
    let size = Vec3::new(2.0 * half, high, bank);
    level.standing(
        "bridge.near",
        place,
        Vec3::new(0.0, 0.0, -begin + 0.5 * bank),
        size,
        Paint::Stone,
    );

    let plank = bridge::PLANK;
    let top = high - 0.5 * plank.y;
    let pitch = plank.z;
    for i in 0..bridge::PLANKS {
        let z = -begin - pitch * (i as f32 + 0.5);
        let mut mesh = Mesh::default();
        mesh.tint(255 - 22 * (i % 3) as u8).cuboid(
            Paint::Wood,
            Vec3::ZERO,
            Vec3::new(plank.x, plank.y, plank.z - 0.05),
        );
        for x in [-0.5 * plank.x + 0.15, 0.5 * plank.x - 0.15] {
            mesh.tint(255).cuboid(
                Paint::Slate,
                Vec3::new(x, 0.01, 0.0),
                Vec3::new(0.08, plank.y + 0.03, plank.z - 0.04),
            );
        }
        let (on, on_anchor) = if i == 0 {
            // The bank's own middle is its origin.
            (
                "bridge.near".to_owned(),
                Vec3::new(0.0, top - 0.5 * high, -0.5 * bank),
            )
        } else {
            (
                format!("bridge.plank.{}", i - 1),
                Vec3::NEG_Z * (0.5 * pitch),
            )
        };
        level.add(
            format!("bridge.plank.{i}"),
            place,
            Vec3::new(0.0, top, z),
            mesh,
            NodeExtras {
                hinge: Some(Hinge {
                    on,
                    on_anchor: on_anchor.to_array(),
                    anchor: (Vec3::Z * (0.5 * pitch)).to_array(),
                    axis: [1.0, 0.0, 0.0],
                    limit: 0.5,
                }),
                ..dynamic(
                    boxed(Vec3::new(plank.x, plank.y, plank.z - 0.02)),
                    bridge::MASS,
                )
            },
        );
    }
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Stone, Vec3::ZERO, size);
    level.add(
        "bridge.far",
        place,
        Vec3::new(0.0, 0.5 * high, -end - 0.5 * bank),
        mesh,
        NodeExtras {
            hinge: Some(Hinge {
                on: format!("bridge.plank.{}", bridge::PLANKS - 1),
                on_anchor: (Vec3::NEG_Z * (0.5 * pitch)).to_array(),
                anchor: [0.0, top - 0.5 * high, 0.5 * bank],
                axis: [1.0, 0.0, 0.0],
                limit: 0.5,
            }),
            ..solid(boxed(size))
        },
    );
    let mut water = Mesh::default();
    water.patch(
        Paint::Water,
        Vec2::new(-5.5, -end + 0.1),
        Vec2::new(5.5, -begin - 0.1),
        0.12,
    );
    level.decor("bridge.water", place, Vec3::ZERO, water);
}

fn board(level: &mut Level) {
    use car_seesaw as s;
    let place = &s::PLACE;
    let half = 0.5 * s::SIZE.z;
    let low = s::low_end();
    let near = -s::HINGE.z - half;
    let far = -s::HINGE.z + half;
    road(
        level,
        "car_seesaw",
        place,
        [-8.0, far + s::RAMP + 14.0],
        LANE,
    );
    station(level, place, "car_seesaw", "SEESAW", Paint::Rose, 6.0);
    let w = 0.5 * s::SIZE.x;
    wedge(
        level,
        "car_seesaw.up".into(),
        place,
        [near - s::RAMP, near - 0.05],
        low,
        w,
        Paint::Plaza,
    );
    wedge(
        level,
        "car_seesaw.down".into(),
        place,
        [far + s::RAMP, far + 0.05],
        low,
        w,
        Paint::Plaza,
    );
    let mut stand = Mesh::default();
    stand.tube(
        Paint::Slate,
        &[-w - 0.15, w + 0.15].map(|x| {
            [(-0.45, -s::HINGE.y), (0.0, -0.12), (0.45, -s::HINGE.y)]
                .map(|(z, y)| Vec3::new(x, y, z))
                .to_vec()
        }),
    );
    // The hinge is where the stand is, so it has no collider that the board could rub on.
    level.add(
        "car_seesaw.stand",
        place,
        s::HINGE,
        stand,
        NodeExtras {
            ..solid(boxed(Vec3::new(s::SIZE.x, 0.1, 0.1)))
        },
    );
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Rose, Vec3::ZERO, s::SIZE);
    for i in 0..6 {
        let z = -half + 0.6 + (s::SIZE.z - 1.2) * i as f32 / 5.0;
        mesh.patch(
            Paint::White,
            Vec2::new(-w + 0.1, z - 0.06),
            Vec2::new(w - 0.1, z + 0.06),
            0.5 * s::SIZE.y + 0.004,
        );
    }
    level.add(
        s::BOARD,
        place,
        s::HINGE,
        mesh,
        NodeExtras {
            hinge: Some(Hinge {
                on: "car_seesaw.stand".into(),
                on_anchor: [0.0; 3],
                anchor: [0.0; 3],
                axis: [1.0, 0.0, 0.0],
                limit: s::TILT,
            }),
            ..dynamic(boxed(s::SIZE), s::MASS)
        },
    );
    if let Some(node) = level.nodes.last_mut() {
        // The near end is down until something heavier comes.
        let (sin, cos) = crate::mesh::sin_cos(0.5 * f64::from(s::TILT).to_degrees());
        node.transform.rotation = Quat::from_xyzw(sin, 0.0, 0.0, cos);
    }
}

fn deck(level: &mut Level) {
    use ferry as f;
    let place = &f::PLACE;
    let half = 0.5 * f::DECK;
    let [dock, ramp] = f::DOCK;
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Amber, Vec3::ZERO, f::DECK);
    let line = half.x - 0.25;
    for x in [-line, line] {
        mesh.cuboid(
            Paint::Slate,
            Vec3::new(x + 0.2 * x.signum(), half.y + 0.3, 0.0),
            Vec3::new(0.12, 0.6, f::DECK.z),
        );
    }
    for z in [-half.z + 0.3, half.z - 0.3] {
        for i in 0..10 {
            let x = -line + 2.0 * line * i as f32 / 10.0;
            let paint = if i % 2 == 0 { Paint::Ink } else { Paint::White };
            mesh.patch(
                paint,
                Vec2::new(x, z - 0.2),
                Vec2::new(x + 0.2 * line, z + 0.2),
                half.y + 0.004,
            );
        }
    }
    level.add(
        f::NODE,
        place,
        Vec3::Y * (f::TOP - half.y),
        mesh,
        kinematic(
            boxed(f::DECK),
            Motion::Shuttle {
                travel: place.direction(Vec3::NEG_Z * f::TRAVEL).to_array(),
                speed: f::SPEED,
                wait_near: f::WAIT,
                wait_far: f::WAIT,
                ramp: f::RAMP,
            },
        ),
    );
    let near = half.z + f::GAP;
    let far = half.z + f::TRAVEL + f::GAP;
    let size = Vec3::new(f::DECK.x, f::TOP, dock);
    level.standing(
        "ferry.dock.near",
        place,
        Vec3::Z * (near + 0.5 * dock),
        size,
        Paint::Stone,
    );
    level.standing(
        "ferry.dock.far",
        place,
        Vec3::NEG_Z * (far + 0.5 * dock),
        size,
        Paint::Stone,
    );
    let back = near + dock;
    wedge(
        level,
        "ferry.up".into(),
        place,
        [-back - ramp, -back],
        f::TOP,
        half.x,
        Paint::Plaza,
    );
    let ahead = far + dock;
    wedge(
        level,
        "ferry.down".into(),
        place,
        [ahead + ramp, ahead],
        f::TOP,
        half.x,
        Paint::Plaza,
    );
    let mut water = Mesh::default();
    let (w, wall) = (6.5, 0.3);
    water.patch(Paint::Water, Vec2::new(-w, -far), Vec2::new(w, near), 0.42);
    level.decor("ferry.water", place, Vec3::ZERO, water);
    let middle = 0.5 * (near - far);
    for x in [-w, w] {
        level.standing(
            format!("ferry.wall.{}", if x < 0.0 { "west" } else { "east" }),
            place,
            Vec3::new(x, 0.0, middle),
            Vec3::new(wall, 0.6, near + far),
            Paint::Stone,
        );
    }
    for (name, z) in [("south", near), ("north", -far)] {
        for x in [-1.0f32, 1.0] {
            let width = w - half.x;
            level.standing(
                format!(
                    "ferry.wall.{name}.{}",
                    if x < 0.0 { "west" } else { "east" }
                ),
                place,
                Vec3::new(x * (half.x + 0.5 * width), 0.0, z),
                Vec3::new(width, 0.6, wall),
                Paint::Stone,
            );
        }
    }
    level.start("ferry", place, Vec3::Y * f::TOP);
    arch(
        level,
        place,
        "ferry",
        "FERRY",
        Paint::Water,
        -back - ramp - 2.0,
    );
}

fn lift(level: &mut Level) {
    use car_lift as l;
    let place: &Place = &l::PLACE;
    let half = 0.5 * l::SIZE;
    let [deck, ramp] = l::DECK;
    let mut mesh = Mesh::default();
    mesh.cuboid(Paint::Amber, Vec3::ZERO, l::SIZE);
    for x in [-half.x + 0.2, half.x - 0.2] {
        for i in 0..11 {
            let z = -half.z + i as f32;
            let paint = if i % 2 == 0 { Paint::Ink } else { Paint::White };
            mesh.patch(
                paint,
                Vec2::new(x - 0.15, z),
                Vec2::new(x + 0.15, z + 1.0),
                half.y + 0.004,
            );
        }
    }
    level.add(
        l::NODE,
        place,
        Vec3::Y * (l::TOP - half.y),
        mesh,
        kinematic(
            boxed(l::SIZE),
            Motion::Shuttle {
                travel: [0.0, l::TRAVEL, 0.0],
                speed: l::SPEED,
                wait_near: l::WAIT,
                wait_far: l::WAIT,
                ramp: l::RAMP,
            },
        ),
    );
    let gap = 0.04;
    let front = half.z + gap;
    let high = l::TOP + l::TRAVEL;
    wedge(
        level,
        "car_lift.up".into(),
        place,
        [-front - 2.5, -front],
        l::TOP,
        half.x,
        Paint::Plaza,
    );
    level.standing(
        "car_lift.deck",
        place,
        Vec3::NEG_Z * (front + 0.5 * deck),
        Vec3::new(l::SIZE.x, high, deck),
        Paint::Stone,
    );
    let edge = front + deck;
    wedge(
        level,
        "car_lift.down".into(),
        place,
        [edge + ramp, edge],
        high,
        half.x,
        Paint::Plaza,
    );
    let mut posts = Mesh::default();
    for x in [-half.x - 0.3, half.x + 0.3] {
        for z in [-half.z + 0.6, half.z - 0.6] {
            posts.cuboid(
                Paint::Slate,
                Vec3::new(x, 0.5 * (high + 1.5), z),
                Vec3::new(0.25, high + 1.5, 0.25),
            );
        }
    }
    level.decor("car_lift.posts", place, Vec3::ZERO, posts);
    level.start("car_lift", place, Vec3::Y * l::TOP);
    arch(
        level,
        place,
        "car_lift",
        "CAR LIFT",
        Paint::Amber,
        -front - 4.5,
    );
}
