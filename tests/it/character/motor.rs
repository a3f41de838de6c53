//! The movement layer against its closed forms: accelerations, jumps, grace times, modes of motion.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A character with this motor on a large floor, settled.
fn on_floor(hz: f64, motor: CharacterMotor) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    let who = sim.spawn((Character::default(), motor, Transform::IDENTITY));
    sim.seconds(0.5);
    (sim, who)
}

/// A character with this motor high above nothing.
fn in_air(hz: f64, motor: CharacterMotor) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    let at = Transform::from_xyz(0.0, 100.0, 0.0);
    let who = sim.spawn((Character::default(), motor, at));
    (sim, who)
}

#[test]
fn ground_acceleration_and_friction_are_those_asked_for() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            acceleration: 10.0,
            friction: 8.0,
            ..default()
        };
        let (mut sim, who) = on_floor(hz, motor);
        sim.walk(who, Vec3::X);
        sim.seconds(0.3);
        found.within(
            format!("{hz} Hz: speed after 0.3 s"),
            sim.state(who).velocity.x,
            3.0,
            0.01,
        );
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: full speed"),
            sim.state(who).velocity.x,
            5.0,
            0.001,
        );
        sim.walk(who, Vec3::ZERO);
        let start = sim.position(who).x;
        sim.seconds(0.5);
        found.near(
            format!("{hz} Hz: speed after braking 0.5 s"),
            sim.state(who).velocity.x,
            1.0,
            0.03,
        );
        sim.seconds(1.0);
        // v² / 2a, up to the speed of one tick.
        let way = sim.position(who).x - start;
        found.near(
            format!("{hz} Hz: way to a stop"),
            way,
            25.0 / 16.0,
            2.6 / hz as f32,
        );
        found.at_most(
            format!("{hz} Hz: stands"),
            sim.state(who).velocity.length(),
            1e-4,
        );
    }
}

#[test]
fn half_a_wish_is_half_the_speed_and_more_than_one_is_one() {
    let mut found = Findings::new();
    for hz in RATES {
        for (wish, speed) in [(0.5, 2.5), (1.0, 5.0), (7.0, 5.0)] {
            let (mut sim, who) = on_floor(hz, prompt());
            sim.walk(who, Vec3::new(0.6, 0.0, 0.8) * wish + Vec3::Y * 0.3);
            let start = sim.position(who);
            sim.seconds(1.0);
            let moved = sim.position(who) - start;
            let case = format!("{hz} Hz wish {wish}");
            found.at_most(format!("{case}: risen"), moved.y, 1e-3);
            // The part along up does not count on foot, nor for the length that is cut to one.
            found.within(format!("{case}: way"), moved.length(), speed, 0.001);
        }
    }
}

#[test]
fn sprinting_and_crouching_change_the_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for (sprint, stance, speed) in [
            (false, Stance::Stand, 5.0),
            (true, Stance::Stand, 8.0),
            (false, Stance::Crouch, 2.5),
        ] {
            let (mut sim, who) = on_floor(hz, prompt());
            sim.intent(who, |intent| {
                intent.movement = Vec3::X;
                intent.sprint = sprint;
                intent.stance = stance;
            });
            sim.seconds(0.5);
            let start = sim.position(who).x;
            sim.seconds(1.0);
            found.within(
                format!("{hz} Hz sprint {sprint} {stance:?}"),
                sim.position(who).x - start,
                speed,
                0.001,
            );
        }
    }
}

#[test]
fn a_jump_reaches_its_height_and_takes_its_time_at_every_rate() {
    let mut found = Findings::new();
    for hz in RATES {
        for height in [0.3, 1.2, 3.0] {
            let (mut sim, who) = on_floor(
                hz,
                CharacterMotor {
                    jump_height: height,
                    ..prompt()
                },
            );
            record(&mut sim);
            sim.intent(who, |intent| intent.jump = true);
            let mut high: f32 = 0.0;
            let mut air = 0;
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                high = high.max(sim.position(who).y);
                air += usize::from(!sim.state(who).on_ground());
            }
            let case = format!("{hz} Hz height {height}");
            // The top may lie between two ticks.
            let between = G / (8.0 * (hz * hz) as f32);
            found.near(
                format!("{case}: top"),
                high,
                height - between * 0.5,
                between * 0.5 + 0.002,
            );
            let time = 2.0 * ops::sqrt(2.0 * height / G);
            found.near(
                format!("{case}: time"),
                air as f32 / hz as f32,
                time,
                2.0 / hz as f32,
            );
            let log = take_events(&mut sim);
            found.holds(
                format!("{case}: one jump"),
                log.left.len() == 1 && log.left[0].jumped,
            );
            found.holds(format!("{case}: one landing"), log.landed.len() == 1);
            // Held all the time, it jumps once.
            found.near(format!("{case}: foot"), sim.position(who).y, 0.0, 0.001);
        }
    }
}

#[test]
fn a_free_fall_follows_the_parabola() {
    let mut found = Findings::new();
    for hz in RATES {
        for scale in [1.0, 0.25, 2.0] {
            let motor = CharacterMotor {
                gravity_scale: scale,
                ..default()
            };
            let (mut sim, who) = in_air(hz, motor);
            sim.ticks(2);
            let (start, speed) = (sim.position(who).y, sim.state(who).velocity.y);
            sim.seconds(1.0);
            let case = format!("{hz} Hz scale {scale}");
            let wanted = start + speed - 0.5 * G * scale;
            found.near(
                format!("{case}: height"),
                sim.position(who).y,
                wanted,
                0.002,
            );
            found.near(
                format!("{case}: speed"),
                sim.state(who).velocity.y,
                speed - G * scale,
                0.002,
            );
        }
    }
}

#[test]
fn negative_gravity_takes_a_character_off_the_ground_at_once() {
    let mut found = Findings::new();
    for hz in RATES {
        for scale in [-1.0, -0.1] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(1.0);
            found.holds(format!("{hz} Hz: stands"), sim.state(who).on_ground());
            edit::<CharacterMotor>(&mut sim, who, |motor| motor.gravity_scale = scale);
            sim.seconds(1.0);
            found.within(
                format!("{hz} Hz, {scale}: falls upwards"),
                sim.position(who).y,
                -0.5 * G * scale,
                0.002,
            );
            edit::<CharacterMotor>(&mut sim, who, |motor| motor.gravity_scale = 1.0);
            sim.seconds(3.0);
            found.holds(format!("{hz} Hz: stands again"), sim.state(who).on_ground());
        }
    }
}

#[test]
fn gravity_can_be_set_in_place_of_the_worlds() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            gravity: Some(3.0),
            ..default()
        };
        let (mut sim, who) = in_air(hz, motor);
        sim.seconds(2.0);
        found.within(format!("{hz} Hz"), -sim.state(who).velocity.y, 6.0, 0.02);
    }
}

#[test]
fn the_fall_is_limited_to_its_greatest_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            max_fall_speed: 12.0,
            ..default()
        };
        let (mut sim, who) = in_air(hz, motor);
        sim.seconds(2.0);
        let start = sim.position(who).y;
        sim.seconds(1.0);
        found.within(format!("{hz} Hz"), start - sim.position(who).y, 12.0, 0.001);
    }
}

#[test]
fn steering_in_the_air_accelerates_as_asked_and_momentum_is_kept() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            air_acceleration: 6.0,
            ..prompt()
        };
        let (mut sim, who) = in_air(hz, motor);
        sim.ticks(2);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        found.within(
            format!("{hz} Hz: steered"),
            sim.state(who).velocity.x,
            3.0,
            0.01,
        );
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: at full speed"),
            sim.state(who).velocity.x,
            5.0,
            0.001,
        );
        // Nothing asked: nothing but air stops it.
        sim.walk(who, Vec3::ZERO);
        set_velocity(&mut sim, who, Vec3::X * 15.0);
        edit::<CharacterMotor>(&mut sim, who, |motor| motor.air_acceleration = 0.0);
        sim.seconds(0.5);
        found.within(
            format!("{hz} Hz: momentum"),
            sim.state(who).velocity.x,
            15.0,
            0.001,
        );
    }
}

/// Walks off a ledge at x = 0 and presses jump this long after the foot left it; how high it rose above the
/// place of the press.
fn late_jump(hz: f64, late: f64) -> f32 {
    let mut sim = Sim::new(hz);
    sim.block(Vec3::new(-10.0, -0.5, 0.0), Vec3::new(20.0, 1.0, 10.0));
    let motor = CharacterMotor {
        coyote_time: 0.2,
        ..prompt()
    };
    let who = sim.spawn((
        Character {
            ground_snap: 0.1,
            ..Character::cylinder(0.3, 1.8)
        },
        motor,
        Transform::from_xyz(-1.0, 0.0, 0.0),
    ));
    sim.seconds(0.2);
    sim.walk(who, Vec3::X);
    while sim.state(who).on_ground() && sim.position(who).x < 5.0 {
        sim.ticks(1);
    }
    sim.seconds(late);
    let from = sim.position(who).y;
    sim.intent(who, |intent| intent.jump = true);
    let mut high = f32::MIN;
    for _ in 0..(hz * 0.6) as usize {
        sim.ticks(1);
        high = high.max(sim.position(who).y - from);
    }
    high
}

#[test]
fn a_jump_just_after_an_edge_still_counts_and_later_not() {
    let mut found = Findings::new();
    for hz in RATES {
        for late in [0.0, 0.1, 0.13] {
            found.near(
                format!("{hz} Hz {late} s late"),
                late_jump(hz, late),
                1.2,
                0.005,
            );
        }
        for late in [0.25, 0.4] {
            found.at_most(format!("{hz} Hz {late} s late"), late_jump(hz, late), 0.0);
        }
    }
}

#[test]
fn the_grace_after_an_edge_gives_no_second_jump() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            coyote_time: 0.5,
            ..prompt()
        };
        let (mut sim, who) = on_floor(hz, motor);
        record(&mut sim);
        for i in 0..8 {
            sim.intent(who, |intent| intent.jump = i % 2 == 0);
            sim.seconds(0.067);
        }
        let jumps = take_events(&mut sim).left.len();
        found.near(format!("{hz} Hz: jumps"), jumps as f32, 1.0, 0.0);
    }
}

#[test]
fn a_press_just_before_landing_is_remembered_and_an_early_one_is_not() {
    let mut found = Findings::new();
    for hz in RATES {
        for (early, jumps) in [(0.05, true), (0.15, true), (0.3, false)] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            sim.floor(0.0);
            let motor = CharacterMotor {
                jump_buffer: 0.2,
                ..prompt()
            };
            // Falls 2 m in 0.639 s.
            let who = sim.spawn((
                Character::default(),
                motor,
                Transform::from_xyz(0.0, 2.0, 0.0),
            ));
            sim.seconds(0.639 - early);
            sim.intent(who, |intent| intent.jump = true);
            sim.ticks(1);
            sim.intent(who, |intent| intent.jump = false);
            sim.seconds(early + 0.3);
            let log = take_events(&mut sim);
            let jumped = log.left.iter().any(|left| left.jumped);
            found.holds(
                format!("{hz} Hz {early} s early: jumped {jumped}"),
                jumped == jumps,
            );
        }
    }
}

#[test]
fn ice_keeps_the_velocity_and_half_grip_gives_half_the_acceleration() {
    let mut found = Findings::new();
    for hz in RATES {
        for (grip, wanted) in [(0.0, 4.0), (0.5, 2.0), (1.0, 0.0)] {
            let mut sim = Sim::new(hz);
            let floor = sim.floor(0.0);
            insert(&mut sim, floor, SurfaceGrip(grip));
            let motor = CharacterMotor {
                acceleration: 8.0,
                friction: 8.0,
                ..default()
            };
            let who = sim.spawn((Character::default(), motor, Transform::IDENTITY));
            sim.seconds(0.5);
            set_velocity(&mut sim, who, Vec3::X * 4.0);
            sim.seconds(0.5);
            let case = format!("{hz} Hz grip {grip}");
            found.near(
                format!("{case}: after 0.5 s"),
                sim.state(who).velocity.x,
                wanted,
                0.05,
            );
            found.near(
                format!("{case}: told"),
                sim.state(who).ground.material.grip,
                grip,
                1e-6,
            );
        }
    }
}

#[test]
fn flying_is_free_in_all_directions_and_without_gravity() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let motor = CharacterMotor {
            fly_acceleration: f32::INFINITY,
            ..prompt()
        };
        let who = sim.spawn((
            Character::default(),
            motor,
            Transform::from_xyz(0.0, 10.0, 0.0),
        ));
        edit::<CharacterState>(&mut sim, who, |state| state.mode = MovementMode::Fly);
        sim.seconds(2.0);
        found.at_most(
            format!("{hz} Hz: hovers"),
            sim.position(who).distance(Vec3::Y * 10.0),
            0.001,
        );
        let way = Vec3::new(0.5, 0.7, -0.3).normalize();
        sim.walk(who, way);
        sim.seconds(1.0);
        let moved = sim.position(who) - Vec3::Y * 10.0;
        found.at_most(format!("{hz} Hz: flies"), moved.distance(way * 8.0), 0.01);
        // A wall in the way is slid along.
        let foot = sim.position(who);
        sim.block(
            foot + Vec3::new(1.5, 0.0, 0.0),
            Vec3::new(1.0, 100.0, 100.0),
        );
        sim.walk(who, Vec3::new(0.6, 0.8, 0.0));
        sim.seconds(0.5);
        let start = sim.position(who).y;
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: up the wall"),
            sim.position(who).y - start,
            6.4,
            0.005,
        );
        // Back on foot it falls.
        edit::<CharacterState>(&mut sim, who, |state| state.mode = MovementMode::Walk);
        sim.walk(who, Vec3::ZERO);
        sim.seconds(1.0);
        found.at_most(format!("{hz} Hz: falls"), sim.state(who).velocity.y, -1.0);
    }
}

#[test]
fn a_custom_motor_leaves_the_velocity_to_the_game() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let who = raw(&mut sim, Vec3::Y * 10.0);
        sim.walk(who, Vec3::X);
        sim.intent(who, |intent| intent.jump = true);
        set_velocity(&mut sim, who, Vec3::new(1.0, 0.5, -2.0));
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: off"),
            sim.position(who).distance(Vec3::new(1.0, 10.5, -2.0)),
            0.002,
        );
        found.holds(
            format!("{hz} Hz: velocity untouched"),
            sim.state(who).velocity == Vec3::new(1.0, 0.5, -2.0),
        );
    }
}

#[test]
fn a_walker_turns_to_where_it_walks_or_is_told_to_face() {
    let mut found = Findings::new();
    for hz in RATES {
        let motor = CharacterMotor {
            turn_rate: Some(3.0),
            ..prompt()
        };
        let (mut sim, who) = on_floor(hz, motor);
        let facing = |sim: &Sim| sim.get::<Transform>(who).forward().as_vec3();
        let start = facing(&sim);
        let aside = start.cross(Vec3::Y);
        sim.walk(who, aside);
        sim.seconds(0.25);
        let turned = ops::acos(facing(&sim).dot(start).clamp(-1.0, 1.0));
        found.near(
            format!("{hz} Hz: turned in a quarter second"),
            turned,
            0.75,
            3.1 / hz as f32,
        );
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: faces its way"),
            facing(&sim).distance(aside),
            0.01,
        );
        sim.intent(who, |intent| intent.facing = Some(start));
        sim.seconds(1.5);
        found.at_most(
            format!("{hz} Hz: faces as told"),
            facing(&sim).distance(start),
            0.01,
        );
        let upright = sim.get::<Transform>(who).rotation * Vec3::Y;
        found.at_most(format!("{hz} Hz: upright"), upright.distance(Vec3::Y), 1e-3);
    }
}

#[test]
fn the_same_walk_covers_the_same_way_at_every_rate() {
    // A course with turns, a jump and a stop: the ends may differ by a fraction of a tick's way.
    let mut found = Findings::new();
    let ends = [30.0, 60.0, 120.0, 144.0, 240.0, 360.0].map(|hz| {
        let (mut sim, who) = on_floor(hz, prompt());
        for (degrees, time) in [(0.0, 1.0), (70.0, 0.5), (200.0, 1.5), (10.0, 1.0 / 3.0)] {
            sim.walk(who, heading(degrees));
            sim.seconds(time);
        }
        (hz, sim.position(who))
    });
    for (hz, end) in ends {
        found.at_most(
            format!("{hz} Hz: away from the end at 240 Hz"),
            end.distance(ends[4].1),
            0.003,
        );
    }
}
