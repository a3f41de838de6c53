//! Level floors of every kind: distance covered, height, no lost tick, near and far from the origin.

use bevy::{math::DVec3, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::{FloorKind, Sim};

use super::support::*;

/// Walks for `seconds` along each heading (degrees) at once, each on its own lane.
struct Walk {
    origin: Vec3,
    seconds: f64,
    headings: [f32; 2],
    /// Allowed error of the whole distance, part.
    distance: f32,
    /// Least part of its share that each tick must cover.
    tick: f32,
    /// Allowed range of the height, metres.
    height: f32,
}

fn walk(found: &mut Findings, kind: FloorKind, hz: f64, character: &Character, walk: &Walk) {
    let mut sim = Sim::new(hz);
    sim.floor_of(
        kind,
        walk.origin - Vec3::new(3.0, 0.0, 4.0),
        Vec2::new(58.0, 20.0),
    );
    let lanes = [-2.7, 1.3];
    let runners = lanes.map(|z| {
        runner_with(
            &mut sim,
            character.clone(),
            walk.origin + Vec3::new(0.2, 0.0, z),
        )
    });
    sim.seconds(0.5);
    let start = runners.map(|runner| exact_position(&sim, runner));
    for (runner, degrees) in runners.into_iter().zip(walk.headings) {
        sim.walk(runner, heading(degrees));
    }
    let ticks = (walk.seconds * hz).round() as usize;
    let share = f64::from(SPEED) / hz;
    let mut last = start;
    let mut least = [f64::INFINITY; 2];
    let mut low = start.map(|p| p.y);
    let mut high = low;
    let mut off_ground = 0;
    for _ in 0..ticks {
        sim.ticks(1);
        for i in 0..2 {
            let now = exact_position(&sim, runners[i]);
            let along = (now - last[i]).dot(heading(walk.headings[i]).as_dvec3());
            least[i] = least[i].min(along / share);
            low[i] = low[i].min(now.y);
            high[i] = high[i].max(now.y);
            off_ground += usize::from(!sim.state(runners[i]).on_ground());
            last[i] = now;
        }
    }
    let wanted = share * ticks as f64;
    for i in 0..2 {
        let case = format!("{kind:?} {hz} Hz heading {}°", walk.headings[i]);
        let travel: DVec3 = last[i] - start[i];
        let along = travel.dot(heading(walk.headings[i]).as_dvec3());
        let side = travel.dot(heading(walk.headings[i] + 90.0).as_dvec3());
        found.within(
            format!("{case}: distance"),
            along as f32,
            wanted as f32,
            walk.distance,
        );
        found.near(
            format!("{case}: sideways"),
            side as f32,
            0.0,
            wanted as f32 * walk.distance,
        );
        found.at_least(
            format!("{case}: worst tick's part"),
            least[i] as f32,
            walk.tick,
        );
        found.at_most(
            format!("{case}: height range"),
            (high[i] - low[i]) as f32,
            walk.height,
        );
        found.near(
            format!("{case}: height above the floor"),
            (last[i].y - f64::from(walk.origin.y)) as f32,
            0.0,
            1e-3,
        );
    }
    found.at_most(
        format!("{kind:?} {hz} Hz: ticks off the ground"),
        off_ground as f32,
        0.0,
    );
}

const NEAR: Walk = Walk {
    origin: Vec3::ZERO,
    seconds: 10.0,
    headings: [0.0, 13.0],
    distance: 0.001,
    tick: 0.99,
    height: 0.0005,
};

fn ten_seconds(kind: FloorKind) {
    let mut found = Findings::new();
    for hz in RATES {
        walk(&mut found, kind, hz, &Character::default(), &NEAR);
    }
}

#[test]
fn ten_seconds_on_one_box_cover_fifty_metres() {
    ten_seconds(FloorKind::Box);
}

#[test]
fn ten_seconds_on_half_metre_triangles_cover_fifty_metres() {
    ten_seconds(FloorKind::Triangles);
}

#[test]
fn ten_seconds_on_metre_tiles_cover_fifty_metres() {
    ten_seconds(FloorKind::Tiles);
}

#[test]
fn ten_seconds_on_voxels_cover_fifty_metres() {
    ten_seconds(FloorKind::Voxels);
}

#[test]
fn ten_seconds_on_a_height_field_cover_fifty_metres() {
    ten_seconds(FloorKind::HeightField);
}

#[test]
fn ten_kilometres_from_the_origin_ten_seconds_still_cover_fifty_metres() {
    let mut found = Findings::new();
    let far = Walk {
        origin: Vec3::new(10_000.0, 0.0, -10_000.0),
        distance: 0.01,
        tick: 0.9,
        ..NEAR
    };
    for kind in FloorKind::ALL {
        for hz in RATES {
            walk(&mut found, kind, hz, &Character::default(), &far);
        }
    }
}

#[test]
fn every_shape_walks_every_floor_without_a_catch() {
    let mut found = Findings::new();
    let hull = (0..8)
        .flat_map(|i| {
            let out = heading(45.0 * i as f32) * 0.3;
            [out + Vec3::Y * 0.2, out + Vec3::Y * 1.6]
        })
        .chain([Vec3::ZERO, Vec3::Y * 1.8])
        .collect();
    for shape in [
        CharacterShape::Cylinder {
            radius: 0.3,
            height: 1.8,
        },
        CharacterShape::Box {
            size: Vec3::new(0.5, 1.8, 0.4),
        },
        CharacterShape::ConvexHull { points: hull },
    ] {
        let character = Character { shape, ..default() };
        for kind in FloorKind::ALL {
            let short = Walk {
                seconds: 4.0,
                ..NEAR
            };
            walk(&mut found, kind, 60.0, &character, &short);
        }
    }
}

#[test]
fn a_millimetre_between_tiles_neither_stops_nor_lifts_off() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        for i in -2..32 {
            let top = if i % 2 == 0 { 0.0 } else { 0.001 };
            sim.block(
                Vec3::new(i as f32 + 0.5, top - 0.5, 0.0),
                Vec3::new(1.0, 1.0, 4.0),
            );
        }
        let runner = runner(&mut sim, Vec3::new(0.5, 0.0, 0.0));
        sim.seconds(0.5);
        let start = sim.position(runner).x;
        sim.walk(runner, Vec3::X);
        let mut off_ground = 0;
        for _ in 0..(5.0 * hz) as usize {
            sim.ticks(1);
            off_ground += usize::from(!sim.state(runner).on_ground());
        }
        found.within(
            format!("{hz} Hz: distance"),
            sim.position(runner).x - start,
            25.0,
            0.002,
        );
        found.at_most(
            format!("{hz} Hz: ticks off the ground"),
            off_ground as f32,
            0.0,
        );
    }
}

#[test]
fn a_fall_ends_exactly_on_the_floor_and_stays_there() {
    let mut found = Findings::new();
    for hz in RATES {
        for kind in FloorKind::ALL {
            let mut sim = Sim::new(hz);
            sim.floor_of(kind, Vec3::new(-4.0, 0.0, -4.0), Vec2::splat(8.0));
            // On an edge of everything, and in the middle of a cell.
            let fallers = [Vec3::new(0.0, 2.0, 0.0), Vec3::new(2.21, 3.0, 1.37)]
                .map(|foot| sim.character(Character::default(), foot));
            sim.seconds(2.0);
            let landed = fallers.map(|faller| sim.position(faller));
            sim.seconds(5.0);
            for (faller, landed) in fallers.into_iter().zip(landed) {
                let foot = sim.position(faller);
                let case = format!("{kind:?} {hz} Hz");
                found.near(format!("{case}: foot height"), foot.y, 0.0, 1e-3);
                found.at_most(format!("{case}: drift"), foot.distance(landed), 1e-5);
                found.holds(format!("{case}: on ground"), sim.state(faller).on_ground());
            }
        }
    }
}

#[test]
fn strong_gravity_at_a_low_rate_does_not_shake_a_walker() {
    // Radius 0.35, height 2.9, gravity 30, 9 m/s at 30 Hz: known to jitter by 54 mm elsewhere.
    let mut sim = Sim::new(30.0);
    sim.block(Vec3::NEG_Y, Vec3::new(30.0, 2.0, 30.0));
    let walker = sim.spawn((
        Character::capsule(0.35, 2.9),
        CharacterMotor {
            walk_speed: 9.0,
            gravity: Some(30.0),
            ..prompt()
        },
        Transform::from_xyz(-13.0, 0.0, 0.0),
    ));
    sim.seconds(0.5);
    sim.walk(walker, Vec3::X);
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    let start = sim.position(walker).x;
    for _ in 0..75 {
        sim.ticks(1);
        let y = sim.position(walker).y;
        (low, high) = (low.min(y), high.max(y));
    }
    let mut found = Findings::new();
    found.at_most("height range", high - low, 0.0005);
    found.within("distance", sim.position(walker).x - start, 22.5, 0.001);
}

#[test]
fn two_flush_height_fields_have_no_seam() {
    use bevy_rapier3d::prelude::Collider;
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        for x in [0.0, 16.0] {
            sim.fixed(
                Collider::heightfield(vec![0.0; 17 * 17], 17, 17, Vec3::new(16.0, 1.0, 16.0)),
                Transform::from_xyz(x, 0.0, 0.0),
            );
        }
        let walker = runner(&mut sim, Vec3::new(2.0, 0.0, 0.0));
        sim.seconds(0.5);
        sim.walk(walker, Vec3::X);
        let mut low = f32::MAX;
        for _ in 0..(3.0 * hz) as usize {
            sim.ticks(1);
            low = low.min(sim.position(walker).y);
        }
        found.at_least(format!("{hz} Hz: lowest"), low, -0.0005);
        found.within(
            format!("{hz} Hz: reached"),
            sim.position(walker).x - 2.0,
            15.0,
            0.001,
        );
    }
}

#[test]
fn a_character_below_a_parent_walks_in_the_axes_of_the_world() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let parent =
            sim.spawn(Transform::from_xyz(5.0, 1.0, 3.0).with_rotation(Quat::from_rotation_y(1.0)));
        let who = sim.spawn((
            Character::default(),
            prompt(),
            Transform::from_xyz(0.0, -1.0, 0.0),
            ChildOf(parent),
        ));
        let at = |sim: &Sim| sim.get::<GlobalTransform>(who).translation();
        sim.seconds(0.3);
        found.at_most(
            format!("{hz} Hz: begins"),
            at(&sim).distance(Vec3::new(5.0, 0.0, 3.0)),
            0.001,
        );
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: walks"),
            at(&sim).distance(Vec3::new(10.0, 0.0, 3.0)),
            0.005,
        );
        sim.walk(who, Vec3::ZERO);
        sim.ticks(2);
        let start = at(&sim);
        sim.seconds(2.0);
        found.at_most(format!("{hz} Hz: rests"), at(&sim).distance(start), 0.0001);
    }
}
