//! A character that stops being one, for good or for a while.

use bevy::prelude::*;
use bevy_embody::{CharacterDiagnostics, prelude::*};
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn who_is_no_character_any_more_leaves_nothing_of_one_behind() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.app.init_resource::<CharacterDiagnostics>();
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::new(-3.0, 0.0, 0.0));
        let neighbour = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(0.2);
        let velocity = sim.state(who).velocity;
        sim.app.world_mut().entity_mut(who).remove::<Character>();
        sim.ticks(3);
        let entity = sim.app.world().entity(who);
        found.holds(
            format!("{hz} Hz: outputs gone"),
            !entity.contains::<CharacterContacts>(),
        );
        found.holds(
            format!("{hz} Hz: its collider gone"),
            !entity.contains::<Collider>(),
        );
        found.holds(
            format!("{hz} Hz: the state stays for the game"),
            sim.state(who).velocity == velocity,
        );
        let measured = *sim.app.world().resource::<CharacterDiagnostics>();
        found.holds(
            format!("{hz} Hz: the neighbour rests"),
            (measured.characters, measured.idle) == (1, 1),
        );
        // Nothing is in the way where it stands.
        let x = sim.position(who).x;
        sim.walk(neighbour, Vec3::NEG_X);
        sim.seconds(1.0);
        found.at_most(
            format!("{hz} Hz: nothing in the way"),
            sim.position(neighbour).x,
            x - 1.0,
        );
        // Once more a character, it works as before.
        sim.walk(who, Vec3::ZERO);
        insert(&mut sim, who, Character::default());
        sim.seconds(0.3);
        found.holds(format!("{hz} Hz: a collider again"), {
            sim.app.world().entity(who).contains::<Collider>()
        });
        let start = sim.position(who).z;
        sim.walk(who, Vec3::Z);
        sim.seconds(1.0);
        found.within(
            format!("{hz} Hz: walks again"),
            sim.position(who).z - start,
            5.0,
            0.001,
        );
    }
}

#[test]
fn a_collider_and_a_body_of_the_games_own_stay_when_the_character_goes() {
    let mut found = Findings::new();
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let who = sim.spawn((
        Character::default(),
        Collider::ball(0.3),
        Transform::from_xyz(0.0, 0.0, 0.0),
    ));
    sim.seconds(0.2);
    sim.app
        .world_mut()
        .entity_mut(who)
        .remove::<Character>()
        .insert((RigidBody::Dynamic, Transform::from_xyz(0.0, 3.0, 0.0)));
    sim.seconds(2.0);
    found.holds(
        "its own collider",
        sim.app.world().entity(who).contains::<Collider>(),
    );
    found.near("it falls and lies", sim.position(who).y, 0.3, 0.02);
}

#[test]
fn a_disabled_character_stays_where_it_is_and_goes_on_from_there() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::Y * 5.0);
        sim.seconds(0.2);
        let (place, velocity) = (sim.position(who), sim.state(who).velocity);
        insert(&mut sim, who, RigidBodyDisabled);
        sim.seconds(3.0);
        let state = sim.state(who);
        found.at_most(
            format!("{hz} Hz: stays"),
            sim.position(who).distance(place),
            0.0,
        );
        found.holds(
            format!("{hz} Hz: state stands still"),
            state.velocity == velocity && !state.on_ground(),
        );
        found.holds(
            format!("{hz} Hz: no events"),
            take_events(&mut sim) == EventLog::default(),
        );
        sim.app
            .world_mut()
            .entity_mut(who)
            .remove::<RigidBodyDisabled>();
        sim.ticks(2);
        found.near(
            format!("{hz} Hz: goes on from there"),
            sim.position(who).y,
            place.y + velocity.y * 2.0 / hz as f32,
            0.05,
        );
        sim.seconds(2.0);
        found.near(format!("{hz} Hz: lands"), sim.position(who).y, 0.0, 0.001);
    }
}

#[test]
fn a_disabled_character_is_nobodys_obstacle() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let seated = runner(&mut sim, Vec3::new(2.0, 0.0, 0.0));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.2);
        insert(&mut sim, seated, RigidBodyDisabled);
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        found.within(format!("{hz} Hz"), sim.position(who).x, 5.0, 0.001);
    }
}
