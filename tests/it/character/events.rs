//! Events and contacts: what is told, once, with the right numbers.

use bevy::{math::ops, prelude::*};
use bevy_embody::{
    character::{StepAttempt, StepResult},
    prelude::*,
};
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn a_landing_tells_the_ground_the_speed_and_the_time_in_the_air() {
    let mut found = Findings::new();
    for hz in RATES {
        for height in [0.5, 2.0, 8.0] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            let floor = sim.floor(0.0);
            let who = sim.character(Character::default(), Vec3::Y * height);
            sim.seconds(3.0);
            let log = take_events(&mut sim);
            let case = format!("{hz} Hz from {height} m");
            found.near(
                format!("{case}: landings"),
                log.landed.len() as f32,
                1.0,
                0.0,
            );
            if let Some(landed) = log.landed.first() {
                found.holds(format!("{case}: entity"), landed.entity == who);
                found.holds(format!("{case}: ground"), landed.ground == floor);
                found.near(
                    format!("{case}: speed"),
                    landed.speed,
                    ops::sqrt(2.0 * G * height),
                    G * 1.5 / hz as f32,
                );
                found.near(
                    format!("{case}: time"),
                    landed.air_time,
                    ops::sqrt(2.0 * height / G),
                    2.0 / hz as f32,
                );
            }
        }
    }
}

#[test]
fn leaving_the_ground_tells_whether_it_was_a_jump() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        let block = sim.block(Vec3::new(-10.0, -0.5, 0.0), Vec3::new(20.0, 1.0, 10.0));
        let floor = sim.floor(-3.0);
        let who = runner(&mut sim, Vec3::new(-1.0, 0.0, 0.0));
        sim.seconds(0.3);
        sim.intent(who, |intent| intent.jump = true);
        sim.seconds(0.3);
        sim.intent(who, |intent| intent.jump = false);
        sim.seconds(1.0);
        sim.walk(who, Vec3::X);
        sim.seconds(1.5);
        let log = take_events(&mut sim);
        let case = format!("{hz} Hz {:?}", log.left);
        found.near(
            format!("{case}: times left"),
            log.left.len() as f32,
            2.0,
            0.0,
        );
        if let [jump, fall] = log.left[..] {
            found.holds(
                format!("{case}: a jump"),
                jump.jumped && jump.ground == Some(block),
            );
            found.holds(
                format!("{case}: a fall"),
                !fall.jumped && fall.ground == Some(block),
            );
        }
        let grounds: Vec<Entity> = log.landed.iter().map(|landed| landed.ground).collect();
        found.holds(
            format!("{case}: landed {grounds:?}"),
            grounds.ends_with(&[block, floor]),
        );
    }
}

#[test]
fn losing_the_platform_tells_that_the_ground_was_left() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        let block = sim.block(Vec3::NEG_Y * 0.5, Vec3::ONE);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        sim.app.world_mut().despawn(block);
        sim.ticks(2);
        let log = take_events(&mut sim);
        found.holds(
            format!("{hz} Hz {:?}", log.left),
            log.left.len() == 1 && log.left[0].entity == who && !log.left[0].jumped,
        );
    }
}

#[test]
fn a_hit_tells_point_normal_and_speed_once_when_it_begins() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        let wall = sim.block(Vec3::new(3.5, 2.0, 0.0), Vec3::new(1.0, 4.0, 10.0));
        let who = runner(&mut sim, Vec3::new(0.0, 0.0, 0.4));
        sim.seconds(0.3);
        take_events(&mut sim);
        sim.walk(who, heading(-30.0));
        sim.seconds(1.0);
        let hits: Vec<Hit> = take_events(&mut sim)
            .hit
            .into_iter()
            .filter(|hit| hit.other == wall)
            .collect();
        let case = format!("{hz} Hz");
        found.near(
            format!("{case}: hits while it glides on"),
            hits.len() as f32,
            1.0,
            0.0,
        );
        if let Some(hit) = hits.first() {
            found.holds(format!("{case}: entity"), hit.entity == who);
            found.near(format!("{case}: point x"), hit.point.x, 3.0, 0.01);
            found.at_most(
                format!("{case}: normal"),
                hit.normal.distance(Vec3::NEG_X),
                1e-3,
            );
            found.within(
                format!("{case}: closing speed"),
                hit.speed,
                SPEED * ops::cos(30f32.to_radians()),
                0.01,
            );
        }
        // Away and again.
        sim.walk(who, Vec3::NEG_X);
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(0.5);
        let again = take_events(&mut sim)
            .hit
            .iter()
            .filter(|hit| hit.other == wall)
            .count();
        found.near(format!("{case}: second time"), again as f32, 1.0, 0.0);
    }
}

#[test]
fn a_hit_on_a_body_tells_the_impulse_it_received() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        let floor = sim.floor(0.0);
        insert(&mut sim, floor, Friction::coefficient(0.0));
        let crate_ = sim.dynamic(
            Collider::cuboid(0.5, 0.5, 0.5),
            Transform::from_xyz(2.0, 0.5, 0.0),
            200.0,
        );
        insert(
            &mut sim,
            crate_,
            (Friction::coefficient(0.0), LockedAxes::ROTATION_LOCKED),
        );
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        sim.walk(who, Vec3::X);
        let mut sum = 0.0;
        for _ in 0..hz as usize {
            sim.ticks(1);
            sum += sim
                .get::<CharacterContacts>(who)
                .contacts
                .iter()
                .filter(|contact| contact.entity == crate_)
                .map(|contact| contact.impulse.x)
                .sum::<f32>();
        }
        // What was told is what the crate has.
        let momentum = sim.get::<Velocity>(crate_).linear.x * 200.0;
        let case = format!("{hz} Hz");
        found.within(format!("{case}: sum of impulses"), sum, momentum, 0.02);
        found.at_least(format!("{case}: momentum"), momentum, 100.0);
        let hit = take_events(&mut sim)
            .hit
            .into_iter()
            .find(|hit| hit.other == crate_);
        found.holds(
            format!("{case}: hit {hit:?}"),
            hit.is_some_and(|hit| hit.impulse.x > 0.0),
        );
    }
}

#[test]
fn contacts_list_floor_and_walls_with_their_planes() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = sim.floor(0.0);
        let wall = sim.block(Vec3::new(0.8, 2.0, 0.0), Vec3::new(1.0, 4.0, 10.0));
        let side = sim.block(Vec3::new(0.0, 2.0, 0.8), Vec3::new(10.0, 4.0, 1.0));
        let who = runner(&mut sim, Vec3::new(-0.05, 0.0, -0.05));
        sim.walk(who, heading(45.0));
        sim.seconds(0.5);
        let contacts = sim.get::<CharacterContacts>(who);
        let case = format!("{hz} Hz");
        for (name, entity, normal) in [
            ("floor", floor, Vec3::Y),
            ("wall", wall, Vec3::NEG_X),
            ("side", side, Vec3::NEG_Z),
        ] {
            match contacts
                .contacts
                .iter()
                .find(|contact| contact.entity == entity)
            {
                Some(contact) => {
                    found.at_most(
                        format!("{case}: normal of {name}"),
                        contact.normal.distance(normal),
                        1e-3,
                    );
                    found.near(
                        format!("{case}: distance of {name}"),
                        contact.distance,
                        0.0,
                        0.025,
                    );
                    let on = contact.point.dot(normal) - if name == "floor" { 0.0 } else { -0.3 };
                    found.near(format!("{case}: point on {name}"), on, 0.0, 0.01);
                }
                None => found.holds(format!("{case}: {name} is listed"), false),
            }
        }
        let blocked = |entity| {
            contacts
                .contacts
                .iter()
                .any(|c| c.entity == entity && c.blocked)
        };
        found.holds(
            format!("{case}: walls block"),
            blocked(wall) && blocked(side),
        );
        found.at_least(
            format!("{case}: queries counted"),
            contacts.queries as f32,
            1.0,
        );
        // No contact in the air.
        sim.place(who, Vec3::new(-3.0, 20.0, -3.0));
        sim.ticks(2);
        let count = sim.get::<CharacterContacts>(who).contacts.len();
        found.at_most(format!("{case}: contacts in the air"), count as f32, 0.0);
    }
}

#[test]
fn ground_state_tells_entity_normal_point_velocity_and_material() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let angle = 20f32.to_radians();
        let ramp = sim.ramp(embody_scenes::Make::Boxes, Vec3::ZERO, angle, 30.0, 10.0);
        insert(
            &mut sim,
            ramp,
            (Friction::coefficient(0.83), Restitution::coefficient(0.21)),
        );
        let who = runner(&mut sim, foot_on_slope(Vec3::ZERO, angle, 0.3));
        sim.seconds(0.5);
        let ground = sim.state(who).ground;
        let (_, normal) = slope_axes(angle);
        let case = format!("{hz} Hz");
        found.holds(
            format!("{case}: state"),
            ground.state == GroundState::OnGround,
        );
        found.holds(format!("{case}: entity"), ground.entity == Some(ramp));
        found.at_most(
            format!("{case}: normal off"),
            ground.normal.distance(normal),
            1e-3,
        );
        found.at_most(format!("{case}: point off"), ground.point.length(), 0.01);
        found.at_most(format!("{case}: velocity"), ground.velocity.length(), 1e-3);
        found.near(
            format!("{case}: friction"),
            ground.material.friction,
            0.83,
            1e-6,
        );
        found.near(
            format!("{case}: restitution"),
            ground.material.restitution,
            0.21,
            1e-6,
        );
        found.near(format!("{case}: grip"), ground.material.grip, 1.0, 1e-6);
        sim.place(who, Vec3::Y * 30.0);
        sim.ticks(2);
        let air = sim.state(who).ground;
        found.holds(
            format!("{case}: in the air"),
            air.state == GroundState::InAir && air.entity.is_none(),
        );
    }
}

#[test]
fn a_refused_step_tells_why() {
    let mut found = Findings::new();
    type Build = fn(&mut Sim);
    let cases: [(&str, Build, fn(&StepResult) -> bool); 3] = [
        (
            "too high",
            |sim| {
                sim.block(Vec3::new(2.0, 0.3, 0.0), Vec3::new(2.0, 0.6, 10.0));
            },
            |result| matches!(result, StepResult::TooHigh | StepResult::NoLanding),
        ),
        (
            "no room",
            |sim| {
                sim.block(Vec3::new(2.0, 0.15, 0.0), Vec3::new(2.0, 0.3, 10.0));
                sim.block(Vec3::new(0.0, 2.4, 0.0), Vec3::new(20.0, 1.0, 10.0));
            },
            |result| matches!(result, StepResult::NoRoom),
        ),
        (
            "dynamic",
            |sim| {
                sim.dynamic(
                    Collider::cuboid(1.0, 0.15, 5.0),
                    Transform::from_xyz(2.0, 0.15, 0.0),
                    9000.0,
                );
            },
            |result| matches!(result, StepResult::Dynamic),
        ),
    ];
    for hz in RATES {
        for (name, build, right) in &cases {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            build(&mut sim);
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.3);
            sim.walk(who, Vec3::X);
            let mut seen: Vec<StepAttempt> = Vec::new();
            for _ in 0..hz as usize {
                sim.ticks(1);
                seen.extend(sim.get::<CharacterContacts>(who).step);
            }
            let case = format!("{hz} Hz {name}");
            match seen.last() {
                Some(attempt) => {
                    found.holds(
                        format!("{case}: {:?}", attempt.result),
                        right(&attempt.result),
                    );
                    found.near(format!("{case}: point"), attempt.point.x, 1.0, 0.03);
                    found.at_most(
                        format!("{case}: direction"),
                        attempt.direction.distance(Vec3::X),
                        0.01,
                    );
                }
                None => found.holds(format!("{case}: an attempt is told"), false),
            }
        }
    }
}

#[test]
fn walking_down_stairs_tells_how_far_it_was_pulled_down() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.block(Vec3::new(-10.0, -0.5, 0.0), Vec3::new(20.0, 1.0, 10.0));
        sim.floor(-0.25);
        let who = runner(&mut sim, Vec3::new(-1.0, 0.0, 0.0));
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        let mut snapped: f32 = 0.0;
        let mut off = 0;
        for _ in 0..hz as usize {
            sim.ticks(1);
            snapped = snapped.max(sim.get::<CharacterContacts>(who).snapped);
            off += usize::from(!sim.state(who).on_ground());
        }
        found.at_most(format!("{hz} Hz: ticks in the air"), off as f32, 0.0);
        found.at_least(format!("{hz} Hz: pulled down"), snapped, 0.01);
        found.at_most(format!("{hz} Hz: pulled down"), snapped, 0.4);
    }
}

#[test]
fn nothing_happens_to_one_who_stands_still() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        record(&mut sim);
        let before = sim.position(who);
        sim.seconds(3.0);
        let log = take_events(&mut sim);
        found.holds(format!("{hz} Hz: {log:?}"), log == EventLog::default());
        found.holds(
            format!("{hz} Hz: not moved by a bit"),
            sim.position(who) == before,
        );
    }
}

#[test]
fn who_is_spawned_on_the_ground_has_not_landed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        let log = take_events(&mut sim);
        found.holds(
            format!("{hz} Hz: {log:?}"),
            log == EventLog::default() && sim.state(who).on_ground(),
        );
        // A jump ends with a landing, as ever.
        sim.intent(who, |intent| intent.jump = true);
        sim.seconds(1.5);
        found.near(
            format!("{hz} Hz: landings"),
            take_events(&mut sim).landed.len() as f32,
            1.0,
            0.0,
        );
    }
}

#[test]
fn events_of_one_tick_come_in_the_order_of_the_entities() {
    let mut sim = Sim::new(60.0);
    record(&mut sim);
    sim.floor(0.0);
    let mut falling: Vec<Entity> = (0..6)
        .map(|i| runner(&mut sim, Vec3::new(3.0 * i as f32, 1.0, 0.0)))
        .collect();
    // Other tables for some of them.
    for i in [0, 2, 3] {
        insert(&mut sim, falling[i], CharacterUp::default());
    }
    insert(&mut sim, falling[1], Name::new("another"));
    sim.seconds(2.0);
    let landed: Vec<Entity> = take_events(&mut sim)
        .landed
        .iter()
        .map(|landed| landed.entity)
        .collect();
    falling.sort();
    assert_eq!(landed, falling);
}
