//! Stairs of every size, make and heading; what must not be climbed; kerbs and ledges.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Patch, Sim, StairCeiling, Stairs};

use super::support::*;

/// Height of the default capsule, metres.
const TALL: f32 = 1.8;

fn flight(rise: f32, tread: f32, make: Make, ceiling: Option<StairCeiling>) -> Stairs {
    Stairs {
        steps: 15,
        rise,
        tread,
        width: 14.0,
        landing: 6.0,
        make,
        ceiling,
    }
}

/// Walks the flight and returns the time from one metre before it to one metre behind it, seconds.
fn pass(found: &mut Findings, case: &str, hz: f64, stairs: &Stairs, up: bool, degrees: f32) -> f32 {
    let mut sim = Sim::new(hz);
    // Turned, so that no axis of the world is special.
    let base = Transform::from_rotation(Quat::from_rotation_y(0.3));
    sim.stairs(stairs, base);
    let (low, high) = (-1.0, stairs.last_riser() + 1.0);
    let side = (high - low) * ops::tan(degrees.to_radians());
    let (foot, way) = if up {
        (Vec3::new(low - 0.5, 0.0, -0.5 * side), heading(degrees))
    } else {
        (
            Vec3::new(high + 0.5, stairs.height(), -0.5 * side),
            heading(180.0 - degrees),
        )
    };
    let walker = runner(&mut sim, base.transform_point(foot));
    sim.seconds(0.2);
    sim.walk(walker, base.rotation * way);
    let ideal = (high - low) / (SPEED * ops::cos(degrees.to_radians()));
    let local = |sim: &Sim| base.rotation.inverse() * sim.position(walker);
    let progress = |x: f32| if up { x - low } else { high - x };
    let mut last = progress(local(&sim).x);
    let (mut begin, mut end) = (None, None);
    let (mut airborne, mut backwards): (usize, f32) = (0, 0.0);
    let limit = ((ideal * 2.0 + 1.0) * hz as f32) as usize;
    for tick in 1..=limit {
        sim.ticks(1);
        let now = progress(local(&sim).x);
        airborne += usize::from(!sim.state(walker).on_ground());
        backwards = backwards.max(last - now);
        let crossing = |line: f32| {
            (last < line && now >= line)
                .then(|| (tick as f32 - (now - line) / (now - last)) / hz as f32)
        };
        begin = begin.or(crossing(0.0));
        end = end.or(crossing(high - low));
        last = now;
        if end.is_some() {
            break;
        }
    }
    found.at_most(format!("{case}: ticks in the air"), airborne as f32, 0.0);
    found.at_most(format!("{case}: backwards in a tick"), backwards, 1e-5);
    let time = match (begin, end) {
        (Some(begin), Some(end)) => end - begin,
        _ => f32::INFINITY,
    };
    found.at_most(format!("{case}: time over ideal"), time / ideal, 1.5);
    let wanted = if up { stairs.height() } else { 0.0 };
    found.near(
        format!("{case}: height reached"),
        local(&sim).y,
        wanted,
        0.002,
    );
    let (deep, _) = depth(&mut sim, walker);
    found.at_most(format!("{case}: depth"), deep, 0.001);
    time
}

fn pass_at_every_rate(found: &mut Findings, stairs: &Stairs, name: &str) {
    for up in [true, false] {
        for degrees in [0.0, 30.0] {
            let case = format!(
                "{name} {}/{} {:?} {} {degrees}°",
                stairs.rise,
                stairs.tread,
                stairs.make,
                if up { "up" } else { "down" },
            );
            let times =
                RATES.map(|hz| pass(found, &format!("{case} {hz} Hz"), hz, stairs, up, degrees));
            let (least, most) = times
                .iter()
                .fold((f32::MAX, f32::MIN), |(a, b), t| (a.min(*t), b.max(*t)));
            found.at_most(
                format!("{case}: slowest over fastest of rates {times:?}"),
                most / least,
                1.05,
            );
        }
    }
}

fn sizes(make: Make, ceiling: Option<StairCeiling>, name: &str) {
    let mut found = Findings::new();
    for rise in [0.2, 0.3] {
        for tread in [0.25, 0.3, 0.4] {
            pass_at_every_rate(&mut found, &flight(rise, tread, make, ceiling), name);
        }
    }
}

#[test]
fn stairs_of_boxes_are_walked_up_and_down_alike_at_every_rate() {
    sizes(Make::Boxes, None, "open");
}

#[test]
fn stairs_of_one_mesh_are_walked_up_and_down_alike_at_every_rate() {
    sizes(Make::Mesh, None, "open");
}

#[test]
fn stairs_under_a_ceiling_just_above_the_head_are_walked_alike() {
    // A quarter of a metre is left above the head on the step that is climbed to.
    let ceiling = StairCeiling {
        free: TALL + 0.25,
        lead: 0.62,
    };
    for make in Make::ALL {
        sizes(make, Some(ceiling), "ceiling");
    }
}

#[test]
fn low_stairs_under_a_ceiling_lower_than_the_step_height_are_walked_alike() {
    // A quarter of a metre is left before a step of 0.2 m is climbed, a twentieth behind it:
    // less than the 0.4 m that could be climbed.
    let ceiling = StairCeiling {
        free: TALL + 0.05,
        lead: 0.62,
    };
    let mut found = Findings::new();
    for make in Make::ALL {
        for tread in [0.25, 0.3, 0.4] {
            pass_at_every_rate(
                &mut found,
                &flight(0.2, tread, make, Some(ceiling)),
                "tight",
            );
        }
    }
}

#[test]
fn stairs_are_climbed_while_hugging_a_side_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            let stairs = flight(0.25, 0.3, make, None);
            sim.stairs(&stairs, Transform::IDENTITY);
            // A wall at z = 0 that faces +Z.
            sim.wall(make, Vec3::new(-6.0, -1.0, 0.0), Vec3::X, 20.0, 10.0);
            let walker = runner(&mut sim, Vec3::new(-1.0, 0.0, 0.32));
            sim.seconds(0.2);
            sim.walk(walker, heading(-20.0));
            let ideal = (stairs.last_riser() + 2.0) / (SPEED * ops::cos(20f32.to_radians()));
            let mut airborne = 0;
            for _ in 0..(ideal * 1.5 * hz as f32) as usize {
                sim.ticks(1);
                airborne += usize::from(!sim.state(walker).on_ground());
            }
            let case = format!("{hz} Hz {make:?}");
            found.at_least(
                format!("{case}: reached"),
                sim.position(walker).x,
                stairs.last_riser() + 1.0,
            );
            found.at_most(format!("{case}: ticks in the air"), airborne as f32, 0.0);
        }
    }
}

#[test]
fn stairs_on_tilted_ground_are_climbed() {
    let mut found = Findings::new();
    for hz in RATES {
        for (axis, degrees) in [(Vec3::X, 10.0), (Vec3::Z, 8.0), (Vec3::Z, -8.0)] {
            let mut sim = Sim::new(hz);
            let stairs = flight(0.15, 0.4, Make::Boxes, None);
            let base =
                Transform::from_rotation(Quat::from_axis_angle(axis, f32::to_radians(degrees)));
            sim.stairs(&stairs, base);
            let walker = runner(&mut sim, base.transform_point(Vec3::new(-1.0, 0.05, 0.0)));
            sim.seconds(0.3);
            sim.walk(walker, Vec3::X);
            let ideal = (stairs.last_riser() + 2.0) / SPEED;
            sim.seconds(f64::from(ideal) * 1.5);
            let reached = base.rotation.inverse() * sim.position(walker);
            let case = format!("{hz} Hz tilted {degrees}° about {axis}");
            found.at_least(
                format!("{case}: reached"),
                reached.x,
                stairs.last_riser() + 0.5,
            );
        }
    }
}

/// Walks at a block with its near face at x = 1 for a second and returns where the foot ends.
fn try_block(
    hz: f64,
    character: Character,
    height: f32,
    depth: f32,
    degrees: f32,
) -> (Vec3, Vec<Stepped>) {
    let mut sim = Sim::new(hz);
    record(&mut sim);
    sim.floor(0.0);
    sim.block(
        Vec3::new(1.0 + depth * 0.5, height * 0.5, 0.0),
        Vec3::new(depth, height, 30.0),
    );
    // Behind it a wall, so that narrow ledges stay narrow.
    sim.block(
        Vec3::new(1.0 + depth + 0.5, 2.0, 0.0),
        Vec3::new(1.0, 4.0, 30.0),
    );
    let walker = runner_with(&mut sim, character, Vec3::ZERO);
    sim.seconds(0.2);
    sim.walk(walker, heading(degrees));
    sim.seconds(1.0);
    (sim.position(walker), take_events(&mut sim).stepped)
}

#[test]
fn a_step_up_to_the_step_height_is_climbed_and_none_above() {
    let mut found = Findings::new();
    for hz in RATES {
        for limit in [0.2, 0.4, 0.6] {
            for (part, climbs) in [(0.7, true), (0.97, true), (1.04, false), (1.5, false)] {
                let character = Character {
                    step: Some(StepConfig {
                        height: limit,
                        ..default()
                    }),
                    ..default()
                };
                let height = limit * part;
                let (foot, stepped) = try_block(hz, character, height, 3.0, 0.0);
                let case = format!("{hz} Hz limit {limit} block {height}");
                // Below the radius a round bottom could be pushed up an edge; it must not be.
                found.near(
                    case.clone(),
                    foot.y,
                    if climbs { height } else { 0.0 },
                    0.002,
                );
                found.holds(format!("{case}: event"), stepped.is_empty() != climbs);
                let risen: f32 = stepped.iter().map(|step| step.height).sum();
                if climbs {
                    found.near(format!("{case}: height told"), risen, height, 0.02);
                }
            }
        }
    }
}

#[test]
fn without_step_climbing_a_kerb_is_a_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        let none = Character {
            step: None,
            ..default()
        };
        let (foot, stepped) = try_block(hz, none, 0.25, 3.0, 0.0);
        found.near(format!("{hz} Hz: kerb"), foot.y, 0.0, 0.002);
        found.holds(format!("{hz} Hz: no step told"), stepped.is_empty());
    }
}

#[test]
fn a_ledge_narrower_than_the_minimum_width_is_not_climbed() {
    let mut found = Findings::new();
    for hz in RATES {
        for (depth, climbs) in [(0.05, false), (0.15, false), (0.75, true), (1.0, true)] {
            let character = Character {
                step: Some(StepConfig {
                    min_width: 0.2,
                    ..default()
                }),
                ..default()
            };
            let (foot, _) = try_block(hz, character, 0.3, depth, 0.0);
            let case = format!("{hz} Hz ledge {depth}");
            found.near(case, foot.y, if climbs { 0.3 } else { 0.0 }, 0.002);
        }
    }
}

#[test]
fn stairs_as_steep_as_a_wall_are_not_climbed() {
    // 0.3 m high and 0.05 m deep: each tread is too narrow to stand on.
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            let stairs = Stairs {
                steps: 10,
                rise: 0.3,
                tread: 0.05,
                width: 10.0,
                landing: 4.0,
                make,
                ceiling: None,
            };
            sim.stairs(&stairs, Transform::IDENTITY);
            let walker = runner(&mut sim, Vec3::new(-1.0, 0.0, 0.0));
            sim.seconds(0.2);
            sim.walk(walker, Vec3::X);
            let high = highest(&mut sim, walker, 2.0);
            found.at_most(format!("{hz} Hz {make:?}: highest"), high, 0.01);
        }
    }
}

#[test]
fn a_landing_too_steep_to_stand_on_is_not_climbed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // A riser of 0.2 m with a slope of 60° behind it.
        let (width, (up_slope, _)) = (Vec3::Z * 20.0, slope_axes(60f32.to_radians()));
        let mut mesh = Patch::new(Vec3::new(1.0, 0.0, -10.0), width, Vec3::Y * 0.2, 1, 1);
        mesh.add(Vec3::new(1.0, 0.2, -10.0), width, up_slope * 6.0, 1, 1);
        sim.fixed(mesh.collider(), Transform::IDENTITY);
        let walker = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.2);
        sim.walk(walker, Vec3::X);
        let high = highest(&mut sim, walker, 2.0);
        found.at_most(format!("{hz} Hz: highest"), high, 0.05);
    }
}

#[test]
fn a_step_never_adds_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in [0.0, 30.0, 60.0, 80.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            for i in 0..6 {
                let x = 1.0 + i as f32;
                sim.block(
                    Vec3::new(x + 10.0, 0.1 + 0.1 * i as f32, 0.0),
                    Vec3::new(20.0, 0.2 * (i + 1) as f32, 60.0),
                );
            }
            let walker = runner(&mut sim, Vec3::new(0.0, 0.0, -10.0));
            sim.seconds(0.2);
            sim.walk(walker, heading(degrees));
            let mut fastest: f32 = 0.0;
            for _ in 0..(3.0 * hz) as usize {
                let before = sim.position(walker);
                sim.ticks(1);
                let level = (sim.position(walker) - before).with_y(0.0).length();
                fastest = fastest.max(level * hz as f32);
            }
            found.at_most(
                format!("{hz} Hz {degrees}°: fastest"),
                fastest,
                SPEED * 1.001,
            );
        }
    }
}

#[test]
fn a_dynamic_body_is_stepped_onto_only_if_asked() {
    let mut found = Findings::new();
    for hz in RATES {
        for onto in [false, true] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let crate_ = sim.dynamic(
                Collider::cuboid(1.0, 0.125, 1.0),
                Transform::from_xyz(2.0, 0.125, 0.0),
                5000.0,
            );
            let character = Character {
                step: Some(StepConfig {
                    onto_dynamic: onto,
                    ..default()
                }),
                ..default()
            };
            let walker = runner_with(&mut sim, character, Vec3::ZERO);
            sim.seconds(0.3);
            sim.walk(walker, Vec3::X);
            let mut high = f32::MIN;
            for _ in 0..(0.5 * hz) as usize {
                sim.ticks(1);
                high = high.max(sim.position(walker).y);
            }
            let wanted = if onto { 0.25 } else { 0.0 };
            found.near(format!("{hz} Hz onto {onto}: highest"), high, wanted, 0.01);
            found.at_most(
                format!("{hz} Hz onto {onto}: crate moved"),
                (sim.position(crate_).x - 2.0).abs(),
                0.01,
            );
        }
    }
}

#[test]
fn no_step_is_taken_in_the_air() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.block(Vec3::new(6.0, 0.0, 0.0), Vec3::new(10.0, 1.0, 10.0));
        // Falls past the edge with its foot 0.3 m below it while pushing at it.
        let faller = runner(&mut sim, Vec3::new(0.68, 0.2, 0.0));
        sim.walk(faller, Vec3::X);
        let mut high = f32::MIN;
        for _ in 0..hz as usize {
            sim.ticks(1);
            high = high.max(sim.position(faller).y);
        }
        found.at_most(format!("{hz} Hz: highest"), high, 0.2);
        found.holds(
            format!("{hz} Hz: no step"),
            take_events(&mut sim).stepped.is_empty(),
        );
    }
}

#[test]
fn the_view_offset_makes_a_step_smooth_for_the_camera() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(11.0, 0.15, 0.0), Vec3::new(20.0, 0.3, 20.0));
        let walker = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.3);
        sim.walk(walker, Vec3::X);
        let eye = |sim: &Sim| sim.position(walker).y + sim.state(walker).view_offset.y;
        let (mut last, mut jump, mut least): (f32, f32, f32) = (eye(&sim), 0.0, 0.0);
        for _ in 0..hz as usize {
            sim.ticks(1);
            let now = eye(&sim);
            jump = jump.max(now - last);
            least = least.min(sim.state(walker).view_offset.y);
            last = now;
        }
        // With a time constant of 0.08 s a tick shows 1 - exp(-dt / 0.08) of what is left, at most.
        let part = 1.0 - ops::exp(-sim.dt() / 0.08);
        found.at_most(
            format!("{hz} Hz: largest rise of the view"),
            jump,
            0.3 * part + 0.03,
        );
        found.at_most(format!("{hz} Hz: offset at the step"), least, -0.05);
        found.near(format!("{hz} Hz: view in the end"), last, 0.3, 0.002);
    }
}
