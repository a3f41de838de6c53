//! Standing, crouching, and any height: the foot stays, room is tested, refusals have a reason.

use bevy::prelude::*;
use bevy_embody::{character::StanceRefusal, prelude::*};
use bevy_rapier3d::prelude::*;
use embody_scenes::{Make, Sim};

use super::support::*;

fn set_stance(sim: &mut Sim, character: Entity, stance: Stance) {
    sim.intent(character, |intent| intent.stance = stance);
}

/// A ceiling 10 m square with its underside at this height.
fn ceiling(sim: &mut Sim, make: Make, under: f32) -> Entity {
    match make {
        Make::Boxes => sim.block(Vec3::new(0.0, under + 0.5, 0.0), Vec3::new(10.0, 1.0, 10.0)),
        Make::Mesh => {
            // Faces down.
            let mesh = embody_scenes::Patch::new(
                Vec3::new(-5.0, 0.0, -5.0),
                Vec3::X * 10.0,
                Vec3::Z * 10.0,
                20,
                20,
            );
            sim.fixed(mesh.collider(), Transform::from_xyz(0.0, under, 0.0))
        }
    }
}

#[test]
fn crouching_and_standing_up_keep_the_foot_where_it_is() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::new(1.0, 0.0, 2.0));
        sim.seconds(0.5);
        let start = sim.position(who);
        for (stance, height) in [
            (Stance::Crouch, 1.0),
            (Stance::Stand, 1.8),
            (Stance::Height(1.33), 1.33),
            (Stance::Height(0.1), 0.6),
            (Stance::Height(9.0), 1.8),
            (Stance::Stand, 1.8),
        ] {
            set_stance(&mut sim, who, stance);
            sim.seconds(0.5);
            let case = format!("{hz} Hz {stance:?}");
            found.near(
                format!("{case}: height"),
                sim.state(who).height,
                height,
                1e-4,
            );
            found.at_most(
                format!("{case}: foot moved"),
                sim.position(who).distance(start),
                1e-4,
            );
            found.holds(format!("{case}: on ground"), sim.state(who).on_ground());
        }
        let told = take_events(&mut sim).stance;
        found.holds(
            format!(
                "{hz} Hz: heights told {:?}",
                told.iter().map(|s| (s.from, s.to)).collect::<Vec<_>>()
            ),
            told.first().is_some_and(|s| {
                s.entity == who && s.stance == Stance::Crouch && (s.from - 1.8).abs() < 1e-4
            }) && told
                .iter()
                .any(|s| s.stance == Stance::Stand && (s.to - 1.8).abs() < 1e-4),
        );
    }
}

#[test]
fn standing_up_under_something_is_refused_with_the_reason() {
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let roof = ceiling(&mut sim, make, 1.3);
            let who = runner(&mut sim, Vec3::new(-7.0, 0.0, 0.0));
            set_stance(&mut sim, who, Stance::Crouch);
            sim.seconds(0.2);
            sim.walk(who, Vec3::X);
            sim.seconds(2.0);
            sim.walk(who, Vec3::ZERO);
            set_stance(&mut sim, who, Stance::Stand);
            sim.seconds(0.5);
            let case = format!("{hz} Hz {make:?}");
            let state = sim.state(who);
            found.near(format!("{case}: foot"), sim.position(who).y, 0.0, 0.001);
            found.at_most(format!("{case}: height"), state.height, 1.3);
            found.holds(
                format!("{case}: still not standing"),
                state.stance != Stance::Stand,
            );
            match sim.get::<CharacterContacts>(who).stance_refused {
                Some(StanceRefusal::Blocked { by, room }) => {
                    found.holds(format!("{case}: by the roof"), by == roof);
                    found.near(format!("{case}: room"), room, 1.3, 0.025);
                }
                other => found.holds(format!("{case}: refusal is {other:?}"), false),
            }
            // A height that fits is granted.
            set_stance(&mut sim, who, Stance::Height(1.2));
            sim.seconds(0.3);
            found.near(
                format!("{case}: a height that fits"),
                sim.state(who).height,
                1.2,
                1e-3,
            );
            // Out from under the roof the wish that was refused comes true.
            set_stance(&mut sim, who, Stance::Stand);
            sim.walk(who, Vec3::X);
            sim.seconds(4.0);
            found.near(
                format!("{case}: height outside"),
                sim.state(who).height,
                1.8,
                1e-3,
            );
            found.holds(format!("{case}: came out"), sim.position(who).x > 5.0);
        }
    }
}

#[test]
fn a_bad_height_is_refused_and_changes_nothing() {
    let mut found = Findings::new();
    for bad in [f32::NAN, f32::INFINITY, -1.0, 0.0] {
        let mut sim = Sim::new(60.0);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        set_stance(&mut sim, who, Stance::Crouch);
        sim.seconds(0.5);
        set_stance(&mut sim, who, Stance::Height(bad));
        sim.ticks(1);
        let refused = sim.get::<CharacterContacts>(who).stance_refused;
        found.holds(
            format!("{bad}: refused as {refused:?}"),
            matches!(refused, Some(StanceRefusal::BadHeight(_))),
        );
        sim.seconds(0.5);
        found.near(format!("{bad}: height"), sim.state(who).height, 1.0, 1e-4);
        found.holds(format!("{bad}: finite"), finite(&sim, who));
    }
}

#[test]
fn a_ceiling_that_comes_down_and_goes_up_again_never_traps() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        // From 2.5 m down to 1.2 m and up again, 0.5 m/s.
        let roof = sim.mover(Collider::cuboid(2.0, 0.5, 2.0), |t| {
            let down = (t * 0.5).min(1.3) - ((t - 4.0).max(0.0) * 0.5).min(1.3);
            Transform::from_xyz(0.0, (3.0 - down) as f32, 0.0)
        });
        let who = runner(&mut sim, Vec3::ZERO);
        set_stance(&mut sim, who, Stance::Crouch);
        sim.seconds(3.0);
        set_stance(&mut sim, who, Stance::Stand);
        let mut deepest = f32::MIN;
        for _ in 0..(5.0 * hz) as usize {
            sim.ticks(1);
            let under = sim.position(roof).y - 0.5;
            deepest = deepest.max(sim.position(who).y + sim.state(who).height - under);
        }
        found.at_most(format!("{hz} Hz: deepest in the roof"), deepest, 0.01);
        found.near(format!("{hz} Hz: foot"), sim.position(who).y, 0.0, 0.001);
        found.near(
            format!("{hz} Hz: stands in the end"),
            sim.state(who).height,
            1.8,
            1e-3,
        );
        found.holds(
            format!("{hz} Hz: not crushed"),
            take_events(&mut sim).crushed.is_empty(),
        );
    }
}

#[test]
fn crouching_on_a_lift_under_a_fixed_ceiling_keeps_off_both() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        // The lift rises until 1.1 m are left.
        let lift = sim.mover(Collider::cuboid(2.0, 0.25, 2.0), |t| {
            Transform::from_xyz(0.0, (-0.25 + (t * 0.8).min(1.4)) as f32, 0.0)
        });
        let roof = ceiling(&mut sim, Make::Boxes, 2.5);
        let who = runner(&mut sim, Vec3::ZERO);
        set_stance(&mut sim, who, Stance::Crouch);
        sim.seconds(1.0);
        // Wants to stand just when it no longer can for long.
        set_stance(&mut sim, who, Stance::Stand);
        sim.seconds(0.02);
        set_stance(&mut sim, who, Stance::Crouch);
        sim.seconds(2.0);
        found.near(
            format!("{hz} Hz: on the lift"),
            sim.position(who).y - sim.position(lift).y - 0.25,
            0.0,
            0.01,
        );
        found.at_most(
            format!("{hz} Hz: depth in the roof"),
            depth_in(&sim, who, roof),
            0.001,
        );
    }
}

#[test]
fn the_same_room_that_was_left_by_crouching_is_enough_to_stand_in() {
    // A ceiling a hair above the head: crouching and standing must not be a one-way street.
    let mut found = Findings::new();
    for hz in RATES {
        for make in Make::ALL {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            ceiling(&mut sim, make, 1.83);
            let who = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.2);
            for round in 0..5 {
                set_stance(&mut sim, who, Stance::Crouch);
                sim.seconds(0.3);
                set_stance(&mut sim, who, Stance::Stand);
                sim.seconds(0.3);
                found.near(
                    format!("{hz} Hz {make:?} round {round}"),
                    sim.state(who).height,
                    1.8,
                    1e-3,
                );
            }
        }
    }
}

#[test]
fn crouching_in_the_air_keeps_the_foot_on_its_path() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let pair = [Vec3::ZERO, Vec3::X * 5.0].map(|foot| runner(&mut sim, foot));
        sim.seconds(0.2);
        set_stance(&mut sim, pair[0], Stance::Crouch);
        sim.seconds(0.3);
        let apart = sim.position(pair[0]).y - sim.position(pair[1]).y;
        found.near(format!("{hz} Hz"), apart, 0.0, 1e-4);
    }
}

#[test]
fn a_crouched_character_walks_under_what_it_would_bump_into_standing() {
    let mut found = Findings::new();
    for hz in RATES {
        for (stance, passes) in [(Stance::Stand, false), (Stance::Crouch, true)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            sim.block(Vec3::new(2.0, 2.0, 0.0), Vec3::new(1.0, 1.6, 10.0));
            let who = runner(&mut sim, Vec3::ZERO);
            set_stance(&mut sim, who, stance);
            sim.seconds(0.3);
            sim.walk(who, Vec3::X);
            sim.seconds(2.0);
            let x = sim.position(who).x;
            let speed_kept = passes == (x > 3.0);
            found.holds(format!("{hz} Hz {stance:?} reached {x}"), speed_kept);
        }
    }
}

#[test]
fn every_shape_crouches() {
    let mut found = Findings::new();
    let points = [-0.3, 0.3]
        .into_iter()
        .flat_map(|x| [-0.2, 0.2].map(|z| (x, z)))
        .flat_map(|(x, z)| [0.0, 1.7].map(|y| Vec3::new(x, y, z)))
        .collect();
    for shape in [
        CharacterShape::default(),
        CharacterShape::Cylinder {
            radius: 0.3,
            height: 1.7,
        },
        CharacterShape::Box {
            size: Vec3::new(0.6, 1.7, 0.4),
        },
        CharacterShape::ConvexHull { points },
    ] {
        for hz in RATES {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            sim.block(Vec3::new(2.0, 1.7, 0.0), Vec3::new(1.0, 1.0, 10.0));
            let name = format!("{hz} Hz {shape:?}");
            let who = runner_with(
                &mut sim,
                Character {
                    shape: shape.clone(),
                    ..default()
                },
                Vec3::ZERO,
            );
            set_stance(&mut sim, who, Stance::Crouch);
            sim.seconds(0.3);
            found.near(
                format!("{name}: crouched"),
                sim.state(who).height,
                1.0,
                1e-3,
            );
            found.near(format!("{name}: foot"), sim.position(who).y, 0.0, 0.001);
            sim.walk(who, Vec3::X);
            sim.seconds(2.0);
            found.at_least(format!("{name}: under the beam"), sim.position(who).x, 3.0);
            set_stance(&mut sim, who, Stance::Stand);
            sim.seconds(0.3);
            found.near(
                format!("{name}: stands"),
                sim.state(who).height,
                shape.height(),
                1e-3,
            );
        }
    }
}

#[test]
fn the_speed_goes_with_the_height_whichever_way_it_was_reached() {
    let mut found = Findings::new();
    for hz in RATES {
        for before in [Stance::Stand, Stance::Crouch] {
            for (stance, sprint, speed) in [
                (Stance::Stand, false, 5.0),
                (Stance::Stand, true, 8.0),
                (Stance::Height(1.8), false, 5.0),
                (Stance::Height(1.8), true, 8.0),
                (Stance::Height(1.4), false, 3.75),
                (Stance::Height(1.4), true, 5.25),
                (Stance::Crouch, false, 2.5),
                (Stance::Crouch, true, 2.5),
                (Stance::Height(0.7), false, 2.5),
            ] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let who = runner(&mut sim, Vec3::ZERO);
                set_stance(&mut sim, who, before);
                sim.seconds(0.2);
                set_stance(&mut sim, who, stance);
                sim.intent(who, |intent| intent.sprint = sprint);
                sim.seconds(0.2);
                sim.walk(who, Vec3::X);
                sim.seconds(1.0);
                found.within(
                    format!("{hz} Hz {before:?} {stance:?} sprint {sprint}"),
                    sim.position(who).x,
                    speed,
                    0.001,
                );
            }
        }
    }
}
