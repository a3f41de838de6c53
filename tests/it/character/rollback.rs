//! Saved states restored by a character that has changed since, and respawns.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A tunnel of this free height over a floor, from x = 2 on.
fn tunnel(sim: &mut Sim, free: f32) {
    sim.floor(0.0);
    sim.block(Vec3::new(7.0, free + 1.0, 0.0), Vec3::new(10.0, 2.0, 10.0));
}

#[test]
fn a_crouched_state_restored_by_one_who_stands_crouches_again() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        tunnel(&mut sim, 1.2);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.intent(who, |intent| intent.stance = Stance::Crouch);
        sim.walk(who, Vec3::X);
        sim.seconds(1.6);
        sim.walk(who, Vec3::ZERO);
        sim.seconds(0.2);
        let saved = save(&sim, who);
        found.at_least(format!("{hz} Hz: in the tunnel"), sim.position(who).x, 3.0);
        sim.walk(who, Vec3::NEG_X);
        sim.seconds(2.0);
        sim.intent(who, |intent| {
            intent.stance = Stance::Stand;
            intent.movement = Vec3::ZERO;
        });
        sim.seconds(0.5);
        found.near(format!("{hz} Hz: stands"), sim.state(who).height, 1.8, 0.0);
        insert(&mut sim, who, saved.clone());
        let mut off = 0.0f32;
        for _ in 0..20 {
            sim.ticks(1);
            let contacts = sim.get::<CharacterContacts>(who).contacts;
            let deep = contacts.iter().map(|c| -c.distance).fold(0.0, f32::max);
            found.at_most(format!("{hz} Hz: deep in what it touches"), deep, 0.01);
            off = off.max(sim.position(who).distance(saved.0.translation));
        }
        found.at_most(format!("{hz} Hz: pushed about"), off, 0.0001);
        found.holds(
            format!("{hz} Hz: not inside anything"),
            !sim.state(who).overlapping,
        );
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: crawls on"),
            sim.position(who).x - saved.0.translation.x,
            2.5,
            0.01,
        );
    }
}

#[test]
fn a_standing_state_restored_by_one_who_crouches_does_not_fit_under_what_is_low() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        tunnel(&mut sim, 1.2);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.3);
        let saved = save(&sim, who);
        sim.intent(who, |intent| intent.stance = Stance::Crouch);
        sim.seconds(0.3);
        insert(&mut sim, who, saved);
        sim.walk(who, Vec3::X);
        sim.seconds(1.5);
        found.near(
            format!("{hz} Hz: stopped by the lintel"),
            sim.position(who).x,
            1.7,
            0.01,
        );
        // The physics world has the same outline: a ball on the head stays there.
        let ball = sim.dynamic(
            Collider::ball(0.2),
            Transform::from_translation(sim.position(who).with_y(2.1)),
            1.0,
        );
        sim.ticks(5);
        found.at_least(format!("{hz} Hz: collider"), sim.position(ball).y, 1.9);
    }
}

#[test]
fn a_state_set_back_to_its_default_stands_at_once_at_full_height() {
    let mut found = Findings::new();
    for hz in RATES {
        for stance in [Stance::Stand, Stance::Crouch] {
            let mut sim = Sim::new(hz);
            record(&mut sim);
            tunnel(&mut sim, 2.5);
            let who = runner(&mut sim, Vec3::new(4.0, 0.0, 0.0));
            sim.intent(who, |intent| intent.stance = stance);
            sim.seconds(0.5);
            take_events(&mut sim);
            sim.intent(who, |intent| intent.stance = Stance::Stand);
            insert(
                &mut sim,
                who,
                (
                    CharacterState::default(),
                    Transform::from_xyz(5.0, 0.0, 1.0),
                ),
            );
            sim.ticks(2);
            let case = format!("{hz} Hz {stance:?}");
            found.near(format!("{case}: height"), sim.state(who).height, 1.8, 0.0);
            found.holds(
                format!("{case}: not refused"),
                sim.get::<CharacterContacts>(who).stance_refused.is_none(),
            );
            let log = take_events(&mut sim);
            found.holds(
                format!("{case}: no events {log:?}"),
                log.stance.is_empty() && log.landed.is_empty(),
            );
            found.holds(format!("{case}: stands"), sim.state(who).on_ground());
            sim.walk(who, Vec3::X);
            sim.seconds(0.5);
            found.within(
                format!("{case}: walks"),
                sim.position(who).x - 5.0,
                2.5,
                0.001,
            );
        }
    }
}

/// One save: crouched at a crate's side, in a pool, or on a ladder.
fn scene(hz: f64) -> (Sim, Entity, Entity) {
    let mut sim = Sim::new(hz);
    sim.block(Vec3::new(-10.0, -0.5, 0.0), Vec3::new(40.0, 1.0, 40.0));
    let crate_ = sim.dynamic(
        Collider::cuboid(0.4, 0.4, 0.4),
        Transform::from_xyz(2.0, 0.4, 0.0),
        30.0,
    );
    sim.spawn((
        Collider::cuboid(2.0, 4.0, 4.0),
        Sensor,
        WaterVolume {
            flow: Vec3::X * 0.5,
        },
        Transform::from_xyz(-10.0, 0.0, 0.0),
    ));
    sim.spawn((
        Collider::cuboid(0.5, 2.9, 0.5),
        Sensor,
        Ladder,
        Transform::from_xyz(-20.0, 2.9, 0.0),
    ));
    let who = runner(&mut sim, Vec3::ZERO);
    (sim, who, crate_)
}

#[test]
fn a_save_restored_gives_the_same_ticks_again_across_stances_bodies_water_and_ladders() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, foot, way, stance) in [
            (
                "stance and crate",
                Vec3::new(0.0, 0.0, 0.1),
                Vec3::X,
                Stance::Crouch,
            ),
            (
                "water",
                Vec3::new(-11.0, 0.0, 0.0),
                Vec3::new(0.8, 0.2, 0.0),
                Stance::Stand,
            ),
            (
                "ladder",
                Vec3::new(-20.0, 0.5, 0.3),
                Vec3::new(0.0, 0.5, -0.5),
                Stance::Stand,
            ),
        ] {
            let (mut sim, who, crate_) = scene(hz);
            sim.place(who, foot);
            sim.seconds(0.3);
            sim.walk(who, way);
            sim.intent(who, |intent| intent.stance = stance);
            sim.seconds(0.3);
            let saved = save(&sim, who);
            let body = (sim.get::<Transform>(crate_), sim.get::<Velocity>(crate_));
            let physics = Physics::save(&mut sim);
            let run = |sim: &mut Sim| -> Vec<_> {
                (0..60)
                    .map(|tick| {
                        sim.intent(who, |intent| {
                            intent.jump = tick == 40;
                            // Up, half way down, and up again within the stretch.
                            intent.stance = match tick / 15 {
                                0 => stance,
                                2 => Stance::Height(1.3),
                                _ => Stance::Stand,
                            };
                        });
                        sim.ticks(1);
                        (
                            sim.get::<Transform>(who),
                            sim.state(who),
                            sim.get::<Transform>(crate_),
                        )
                    })
                    .collect()
            };
            let first = run(&mut sim);
            for round in 0..2 {
                // Left at a height that is not the saved one.
                sim.intent(who, |intent| intent.stance = Stance::Height(0.8));
                sim.ticks(2);
                insert(&mut sim, who, saved.clone());
                insert(&mut sim, crate_, body);
                physics.restore(&mut sim);
                let again = run(&mut sim);
                found.same(format!("{hz} Hz {name} round {round}"), &first, &again);
            }
        }
    }
}

#[test]
fn a_state_before_its_first_tick_is_equal_to_itself_and_survives_json() {
    let fresh = CharacterState::default();
    assert_eq!(fresh, fresh.clone());
    let text = serde_json::to_string(&fresh).expect("a state is plain data");
    let back: CharacterState = serde_json::from_str(&text).expect("what was written");
    assert_eq!(back, fresh);

    // And one in the middle of things.
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let who = runner(&mut sim, Vec3::Y);
    sim.seconds(0.2);
    let state = sim.state(who);
    let text = serde_json::to_string(&state).expect("a state is plain data");
    let back: CharacterState = serde_json::from_str(&text).expect("what was written");
    assert_eq!(back, state);
}

#[test]
fn what_a_character_holds_of_other_entities_is_mapped_to_a_copy_of_the_world() {
    use bevy::ecs::entity::{EntityHashMap, MapEntities};
    let mut world = World::new();
    let [a, b, c, d] = core::array::from_fn(|_| world.spawn_empty().id());
    let mut map = EntityHashMap::from_iter([(a, c), (b, d)]);
    let mut up = CharacterUp {
        direction: UpDirection::Of(a, Vec3::Y),
        turn_rate: 1.0,
    };
    MapEntities::map_entities(&mut up, &mut map);
    assert_eq!(up.direction, UpDirection::Of(c, Vec3::Y));
    let mut ignores = CharacterIgnores(vec![b, a]);
    MapEntities::map_entities(&mut ignores, &mut map);
    assert_eq!(ignores.0, [d, c]);
    let mut state = CharacterState {
        water: Some(a),
        ladder: Some(b),
        ..default()
    };
    MapEntities::map_entities(&mut state, &mut map);
    assert_eq!((state.water, state.ladder), (Some(c), Some(d)));
}
