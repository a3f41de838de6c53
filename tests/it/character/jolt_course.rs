//! Obstacles on which other controllers are known to fail: bumps, pits, troughs, low walls, wedges.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Patch, Sim};

use super::support::*;

/// Walks along `+X` for `seconds`; the way covered, the slowest tick (m/s) and the ticks off the ground.
fn stroll(sim: &mut Sim, who: Entity, seconds: f64, hz: f64) -> (f32, f32, usize) {
    sim.seconds(0.3);
    sim.walk(who, Vec3::X);
    let start = sim.position(who);
    let (mut slowest, mut off) = (f32::MAX, 0);
    for _ in 0..(seconds * hz).round() as usize {
        let before = sim.position(who);
        sim.ticks(1);
        slowest = slowest.min((sim.position(who).x - before.x) * hz as f32);
        off += usize::from(!sim.state(who).on_ground());
    }
    (sim.position(who).x - start.x, slowest, off)
}

#[test]
fn small_bumps_are_walked_over_at_full_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for (width, height, every) in [(0.05, 0.01, 0.5), (0.3, 0.1, 2.0)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            for i in 1..20 {
                sim.block(
                    Vec3::new(i as f32 * every, height * 0.5, 0.0),
                    Vec3::new(width, height, 4.0),
                );
            }
            let who = runner(&mut sim, Vec3::ZERO);
            let (way, slowest, off) = stroll(&mut sim, who, 1.6, hz);
            let case = format!("{hz} Hz bumps {width} x {height}");
            found.at_least(format!("{case}: way"), way, 8.0 * 0.93);
            found.at_most(format!("{case}: way"), way, 8.0 * 1.001);
            found.at_least(format!("{case}: slowest tick"), slowest, SPEED * 0.4);
            found.at_most(format!("{case}: ticks off the ground"), off as f32, 0.0);
        }
    }
}

#[test]
fn pits_narrower_than_the_body_are_walked_over() {
    let mut found = Findings::new();
    for hz in RATES {
        for gap in [0.02, 0.1, 0.3] {
            let mut sim = Sim::new(hz);
            for i in -2..22 {
                let width = 1.0 - gap;
                sim.block(Vec3::new(i as f32, -0.5, 0.0), Vec3::new(width, 1.0, 4.0));
            }
            let who = runner(&mut sim, Vec3::ZERO);
            let (way, slowest, off) = stroll(&mut sim, who, 3.0, hz);
            let case = format!("{hz} Hz gap {gap}");
            found.at_least(format!("{case}: way"), way, 15.0 * 0.95);
            found.at_least(format!("{case}: slowest tick"), slowest, SPEED * 0.7);
            found.at_most(format!("{case}: ticks off the ground"), off as f32, 0.0);
            // It does not sink in deeper than its round bottom: 0.3 - sqrt(0.3² - (gap / 2)²).
            let sink = 0.3 - ops::sqrt(0.09 - gap * gap * 0.25);
            found.at_least(format!("{case}: foot"), sim.position(who).y, -sink - 0.002);
        }
    }
}

#[test]
fn a_trough_of_many_facets_is_run_along_and_across() {
    let mut found = Findings::new();
    for hz in RATES {
        for degrees in [0.0, 25.0, 90.0] {
            let mut sim = Sim::new(hz);
            // A half pipe along X, radius 3, of 128 facets.
            let mut mesh = Patch::default();
            let point = |i: i32| {
                let angle = core::f32::consts::PI * (i as f32 / 128.0 - 0.5);
                Vec3::new(-5.0, 3.0 - 3.0 * ops::cos(angle), 3.0 * ops::sin(angle))
            };
            for i in 0..128 {
                mesh.add(point(i), point(i + 1) - point(i), Vec3::X * 40.0, 1, 4);
            }
            sim.fixed(mesh.collider(), Transform::IDENTITY);
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.5);
            sim.walk(who, heading(degrees));
            let (mut fastest, mut always): (f32, bool) = (0.0, true);
            for _ in 0..(3.0 * hz) as usize {
                let before = sim.position(who);
                sim.ticks(1);
                fastest = fastest.max(sim.position(who).distance(before) * hz as f32);
                always &= finite(&sim, who);
                let ball = sim.position(who) + Vec3::Y * 0.3 - Vec3::Y * 3.0;
                let out = ball.with_x(0.0).length() + 0.3;
                found.at_most(
                    format!("{hz} Hz {degrees}°: distance from the axis"),
                    out,
                    3.002,
                );
            }
            found.holds(format!("{hz} Hz {degrees}°: finite"), always);
            found.at_most(format!("{hz} Hz {degrees}°: fastest"), fastest, SPEED * 1.2);
            if degrees == 0.0 {
                found.within(format!("{hz} Hz: along"), sim.position(who).x, 15.0, 0.001);
            }
        }
    }
}

#[test]
fn a_low_wall_gives_no_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for height in [0.1, 0.29, 0.45, 0.6] {
            for step in [
                None,
                Some(StepConfig {
                    height: 0.05,
                    ..default()
                }),
            ] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                sim.block(
                    Vec3::new(20.0, height * 0.5, -0.5),
                    Vec3::new(60.0, height, 1.0),
                );
                let who = runner_with(
                    &mut sim,
                    Character { step, ..default() },
                    Vec3::new(0.0, 0.0, 0.5),
                );
                sim.seconds(0.3);
                sim.walk(who, heading(-12.0));
                let mut fastest: f32 = 0.0;
                for _ in 0..(2.0 * hz) as usize {
                    let before = sim.position(who);
                    sim.ticks(1);
                    let level = (sim.position(who) - before).with_y(0.0).length() * hz as f32;
                    fastest = fastest.max(level);
                }
                let case = format!("{hz} Hz wall {height} step {step:?}");
                found.at_most(format!("{case}: fastest"), fastest, SPEED * 1.001);
                found.at_least(
                    format!("{case}: way"),
                    sim.position(who).x,
                    2.0 * SPEED * 0.9,
                );
            }
        }
    }
}

#[test]
fn an_obstacle_higher_than_the_step_is_climbed_from_no_direction() {
    let mut found = Findings::new();
    for hz in RATES {
        for step in [0.45, 0.0] {
            for turn in [0.0, 0.3, 0.785, 1.2] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                sim.fixed(
                    Collider::cuboid(2.0, 0.4, 2.0),
                    Transform::from_xyz(4.0, 0.4, 0.3).with_rotation(Quat::from_rotation_y(turn)),
                );
                let character = Character {
                    step: Some(StepConfig {
                        height: step,
                        ..default()
                    }),
                    ..Character::capsule(0.45, 1.8)
                };
                let who = runner_with(&mut sim, character, Vec3::ZERO);
                sim.seconds(0.3);
                sim.walk(who, Vec3::X);
                let mut high = f32::MIN;
                for _ in 0..(3.0 * hz) as usize {
                    sim.ticks(1);
                    high = high.max(sim.position(who).y);
                }
                found.at_most(
                    format!("{hz} Hz step {step} turned {turn}: highest"),
                    high,
                    0.01,
                );
            }
        }
    }
}

#[test]
fn a_gap_too_narrow_to_enter_holds_without_jitter() {
    let mut found = Findings::new();
    for hz in RATES {
        for side in [0.0, 0.01, -0.02] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            for z in [-1.25, 1.25] {
                sim.block(Vec3::new(3.0, 1.0, z), Vec3::new(2.0, 2.0, 2.0));
            }
            let who = runner(&mut sim, Vec3::new(1.0, 0.0, side));
            sim.seconds(0.3);
            sim.walk(who, Vec3::X);
            sim.seconds(1.0);
            let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
            for _ in 0..200 {
                sim.ticks(1);
                let now = sim.position(who);
                (low, high) = (low.min(now), high.max(now));
            }
            let case = format!("{hz} Hz from {side}");
            found.at_most(
                format!("{case}: jitter"),
                (high - low).max_element(),
                0.0001,
            );
            found.at_most(
                format!("{case}: middle"),
                high.z.abs().max(low.z.abs()),
                0.01,
            );
        }
    }
}

#[test]
fn a_gap_just_wide_enough_is_passed() {
    let mut found = Findings::new();
    for hz in RATES {
        // The body is 0.6 m wide; 0.66 m leave room for any sensible skin.
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        for z in [-1.33, 1.33] {
            sim.block(Vec3::new(3.0, 1.0, z), Vec3::new(2.0, 2.0, 2.0));
        }
        let who = runner(&mut sim, Vec3::new(0.0, 0.0, 0.1));
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(2.0);
        found.at_least(format!("{hz} Hz"), sim.position(who).x, 4.5);
    }
}

#[test]
fn a_jump_beside_a_box_edge_goes_straight_up() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(1.3, 0.35, 0.0), Vec3::new(2.0, 0.7, 4.0));
        let who = runner(&mut sim, Vec3::new(-0.005, 0.0, 0.0));
        edit::<CharacterMotor>(&mut sim, who, |motor| motor.air_acceleration = 0.0);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        sim.walk(who, Vec3::ZERO);
        sim.seconds(0.2);
        let start = sim.position(who).x;
        sim.intent(who, |intent| intent.jump = true);
        let (mut off, mut high): (f32, f32) = (0.0, 0.0);
        for _ in 0..(0.55 * hz) as usize {
            sim.ticks(1);
            off = off.max((sim.position(who).x - start).abs());
            off = off.max(sim.state(who).velocity.with_y(0.0).length());
            high = high.max(sim.position(who).y);
        }
        found.at_most(format!("{hz} Hz: sideways"), off, 0.002);
        found.near(format!("{hz} Hz: height"), high, 1.2, 0.015);
    }
}

#[test]
fn ramps_of_every_angle_let_nothing_through() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let mut walkers = Vec::new();
        for i in 0..18 {
            let z = i as f32 * 6.0;
            let tilt = Quat::from_rotation_z((10.0 * i as f32).to_radians());
            sim.fixed(
                Collider::cuboid(2.5, 0.05, 1.5),
                Transform::from_xyz(4.0, 1.0, z).with_rotation(tilt),
            );
            let who = runner(&mut sim, Vec3::Z * z);
            walkers.push((i, who));
        }
        sim.seconds(0.3);
        let mut deepest = [f32::MIN; 18];
        for way in [Vec3::X, Vec3::NEG_X, heading(20.0), heading(160.0)] {
            for &(_, who) in &walkers {
                sim.walk(who, way);
            }
            for tick in 0..(1.5 * hz) as usize {
                sim.ticks(1);
                if tick % 4 == 0 {
                    for &(i, who) in &walkers {
                        deepest[i] = deepest[i].max(depth(&mut sim, who).0);
                    }
                }
            }
        }
        for (i, deep) in deepest.into_iter().enumerate() {
            found.at_most(format!("{hz} Hz ramp of {}°: deepest", i * 10), deep, 0.001);
        }
    }
}

#[test]
fn a_steep_wedge_with_an_overhang_lets_go_again() {
    let mut found = Findings::new();
    for hz in RATES {
        for lean in [70.0, 100.0, 120.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            // Two walls that close in ahead; each leans by this from level.
            for side in [-1.0f32, 1.0] {
                let turn = Quat::from_rotation_y(side * 0.35)
                    * Quat::from_rotation_x(
                        side * (f32::to_radians(lean) - core::f32::consts::FRAC_PI_2),
                    );
                sim.fixed(
                    Collider::cuboid(3.0, 2.5, 0.1),
                    Transform::from_xyz(3.0, 1.0, side * 1.2).with_rotation(turn),
                );
            }
            let who = runner(&mut sim, Vec3::NEG_X);
            sim.seconds(0.3);
            sim.walk(who, Vec3::X);
            sim.seconds(2.0);
            let case = format!("{hz} Hz lean {lean}°");
            let held = sim.position(who);
            let (deep, _) = depth(&mut sim, who);
            found.at_most(format!("{case}: depth"), deep, 0.001);
            found.holds(format!("{case}: finite"), finite(&sim, who));
            sim.walk(who, Vec3::NEG_X);
            sim.seconds(1.0);
            found.at_most(
                format!("{case}: came back"),
                sim.position(who).x,
                held.x - 2.0,
            );
        }
    }
}

#[test]
fn ten_thousand_steps_on_two_kilometres_of_floor_lose_nothing() {
    let mut sim = Sim::new(60.0);
    sim.block(Vec3::NEG_Y, Vec3::new(2200.0, 2.0, 2200.0));
    let ball = sim.spawn((
        Character::capsule(0.5, 1.0),
        CustomMotor,
        Transform::from_xyz(0.0, 0.0, 0.0),
    ));
    sim.ticks(5);
    let start = sim.position(ball);
    let mut off = 0;
    for _ in 0..10_000 {
        set_velocity(&mut sim, ball, Vec3::new(6.0, -6.0, 6.0));
        sim.ticks(1);
        off += usize::from(!sim.state(ball).on_ground());
    }
    let moved = sim.position(ball) - start;
    let mut found = Findings::new();
    found.at_least("x", moved.x, 999.0);
    found.at_least("z", moved.z, 999.0);
    found.at_most("x", moved.x, 1000.5);
    found.at_most("ticks off the ground", off as f32, 0.0);
}

#[test]
fn ten_minutes_on_a_slope_just_below_the_limit_do_not_drift() {
    let mut sim = Sim::new(30.0);
    let angle = 49f32.to_radians();
    sim.ramp(Make::Boxes, Vec3::ZERO, angle, 20.0, 10.0);
    sim.ramp(Make::Mesh, Vec3::Z * 20.0, angle, 20.0, 10.0);
    let pair =
        [Vec3::ZERO, Vec3::Z * 20.0].map(|at| runner(&mut sim, foot_on_slope(at, angle, 0.3)));
    sim.seconds(1.0);
    let start = pair.map(|who| sim.position(who));
    sim.seconds(600.0);
    let mut found = Findings::new();
    for (who, start) in pair.into_iter().zip(start) {
        found.at_most("drift", sim.position(who).distance(start), 0.001);
    }
}

#[test]
fn sliding_crates_come_down_on_one_who_may_or_may_not_push_and_be_pushed() {
    let mut found = Findings::new();
    for hz in RATES {
        for pushed in [true, false] {
            for pushable in [true, false] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let ramp = sim.ramp(
                    Make::Boxes,
                    Vec3::new(4.0, 4.0, 0.0),
                    45f32.to_radians(),
                    11.0,
                    6.0,
                );
                insert(&mut sim, ramp, Friction::coefficient(0.0));
                let (up_slope, normal) = slope_axes(45f32.to_radians());
                let tilt = Quat::from_rotation_z(45f32.to_radians());
                let at = Vec3::new(4.0, 4.0, 0.0) + up_slope * 3.0 + normal * 0.26;
                let crate_ = sim.dynamic(
                    Collider::cuboid(0.25, 0.25, 0.25),
                    Transform::from_translation(at).with_rotation(tilt),
                    10.0,
                );
                if !pushable {
                    insert(&mut sim, crate_, NotPushable);
                }
                let character = Character {
                    pushed_by_bodies: pushed,
                    ..default()
                };
                let who = runner_with(
                    &mut sim,
                    character,
                    foot_on_slope(Vec3::new(3.0, 3.0, 0.0), 45f32.to_radians(), 0.3),
                );
                let start = sim.position(who);
                let (mut fastest, mut deepest): (f32, f32) = (0.0, f32::MIN);
                for _ in 0..(4.0 * hz) as usize {
                    let before = sim.position(who);
                    sim.ticks(1);
                    fastest = fastest.max(sim.position(who).distance(before) * hz as f32);
                    deepest = deepest.max(depth(&mut sim, who).0);
                }
                let case = format!("{hz} Hz pushed {pushed} pushable {pushable}");
                found.holds(format!("{case}: finite"), finite(&sim, who));
                // As fast as a fall from where the crate begins, and no faster.
                let most = ops::sqrt(2.0 * G * at.y);
                found.at_most(format!("{case}: fastest"), fastest, most);
                found.at_most(format!("{case}: deepest"), deepest, 0.001);
                if !pushed {
                    found.at_most(
                        format!("{case}: moved"),
                        sim.position(who).distance(start),
                        0.02,
                    );
                }
            }
        }
    }
}

#[test]
fn a_ball_that_rolls_in_and_a_stack_of_boxes_throw_nobody() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        for i in 0..3 {
            sim.dynamic(
                Collider::cuboid(0.5, 0.5, 0.5),
                Transform::from_xyz(2.5, 0.5 + i as f32, 0.0),
                10.0,
            );
        }
        let ball = sim.dynamic(
            Collider::ball(0.2),
            Transform::from_xyz(-2.0, 0.2, 0.0),
            10.0,
        );
        insert(
            &mut sim,
            ball,
            Velocity {
                linear: Vec3::X * 2.0,
                angular: Vec3::NEG_Z * 10.0,
            },
        );
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(1.5);
        found.at_most(
            format!("{hz} Hz: moved by the ball"),
            sim.position(who).length(),
            0.5,
        );
        sim.walk(who, Vec3::X);
        let mut fastest: f32 = 0.0;
        for _ in 0..(3.0 * hz) as usize {
            let before = sim.position(who);
            sim.ticks(1);
            fastest = fastest.max((sim.position(who) - before).length() * hz as f32);
        }
        found.at_most(format!("{hz} Hz: fastest"), fastest, SPEED * 1.5);
        found.holds(format!("{hz} Hz: finite"), finite(&sim, who));
        found.at_least(format!("{hz} Hz: pushed through"), sim.position(who).x, 3.0);
    }
}

#[test]
fn a_hundred_kilometres_from_the_origin_it_still_walks() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let origin = Vec3::new(100_000.0, 0.0, 0.0);
        sim.block(origin - Vec3::Y * 0.5, Vec3::new(100.0, 1.0, 100.0));
        let who = runner(&mut sim, origin);
        sim.seconds(0.5);
        let start = exact_position(&sim, who);
        sim.walk(who, heading(20.0));
        sim.seconds(5.0);
        let moved = exact_position(&sim, who) - start;
        found.within(format!("{hz} Hz"), moved.length() as f32, 25.0, 0.01);
        found.near(format!("{hz} Hz: height"), moved.y as f32, 0.0, 0.0005);
    }
}
