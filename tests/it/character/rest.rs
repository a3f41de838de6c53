//! Characters that have nothing to do: what they still tell, and that they are left alone.

use bevy::{
    diagnostic::{Diagnostic, DiagnosticsPlugin, DiagnosticsStore},
    prelude::*,
};
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

fn measured(hz: f64) -> Sim {
    let mut sim = Sim::new(hz);
    sim.app.init_resource::<CharacterDiagnostics>();
    sim
}

fn idle(sim: &Sim) -> u32 {
    sim.app.world().resource::<CharacterDiagnostics>().idle
}

#[test]
fn who_stops_at_a_wall_tells_no_step_and_no_blocking_any_more() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = measured(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(1.5, 1.0, 0.0), Vec3::new(1.0, 2.0, 4.0));
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.2);
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        let leaning = sim.get::<CharacterContacts>(who);
        found.holds(
            format!("{hz} Hz: leans"),
            leaning.step.is_some() && leaning.contacts.iter().any(|contact| contact.blocked),
        );
        sim.walk(who, Vec3::ZERO);
        sim.ticks(5);
        found.holds(format!("{hz} Hz: rests"), idle(&sim) == 1);
        let resting = sim.get::<CharacterContacts>(who);
        found.holds(format!("{hz} Hz: no step"), resting.step.is_none());
        found.holds(
            format!("{hz} Hz: nothing blocks"),
            !resting.contacts.iter().any(|contact| contact.blocked),
        );
        found.holds(
            format!("{hz} Hz: still touches"),
            resting.contacts.len() == leaning.contacts.len(),
        );
        found.holds(format!("{hz} Hz: no query"), resting.queries == 0);
        found.at_most(format!("{hz} Hz: snapped"), resting.snapped, 0.0);
        // And nothing is written while it goes on resting.
        let changed = |sim: &Sim| {
            sim.app
                .world()
                .entity(who)
                .get_ref::<CharacterContacts>()
                .expect("a character has contacts")
                .last_changed()
        };
        let before = changed(&sim);
        sim.ticks(10);
        found.holds(format!("{hz} Hz: left alone"), changed(&sim) == before);
    }
}

#[test]
fn a_turn_rate_or_an_up_of_its_own_lets_a_character_rest() {
    let mut found = Findings::new();
    for hz in RATES {
        for turn_rate in [None, Some(5.0)] {
            for up in [
                None,
                Some(UpDirection::World(Vec3::Y)),
                Some(UpDirection::AgainstGravity),
                Some(UpDirection::AwayFrom(Vec3::new(3.0, -50.0, 4.0))),
                Some(UpDirection::Ground),
            ] {
                let mut sim = measured(hz);
                sim.floor(0.0);
                let who = runner(&mut sim, Vec3::ZERO);
                edit::<CharacterMotor>(&mut sim, who, |motor| motor.turn_rate = turn_rate);
                if let Some(direction) = up {
                    insert(
                        &mut sim,
                        who,
                        CharacterUp {
                            direction,
                            turn_rate: 6.0,
                        },
                    );
                }
                let facing = Vec3::new(1.0, 0.0, 0.3).normalize();
                sim.intent(who, |intent| intent.facing = Some(facing));
                sim.seconds(2.0);
                let case = format!("{hz} Hz {turn_rate:?} {up:?}");
                let state = sim.state(who);
                found.holds(format!("{case}: rests {state:?}"), idle(&sim) == 1);
                if turn_rate.is_some() && !matches!(up, Some(UpDirection::AwayFrom(_))) {
                    let ahead = sim.get::<Transform>(who).rotation * Vec3::NEG_Z;
                    found.at_least(format!("{case}: faces"), ahead.dot(facing), 0.99999);
                    // Something else asked wakes it up.
                    sim.intent(who, |intent| intent.facing = Some(-facing));
                    sim.seconds(2.0);
                    let ahead = sim.get::<Transform>(who).rotation * Vec3::NEG_Z;
                    found.at_least(format!("{case}: faces about"), ahead.dot(-facing), 0.99999);
                }
            }
        }
    }
}

#[test]
fn the_diagnostics_publish_time_queries_and_counts_of_each_tick() {
    let mut sim = Sim::with(
        60.0,
        (
            EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>(),
            DiagnosticsPlugin,
            EmbodyDiagnosticsPlugin,
        ),
    );
    sim.floor(0.0);
    let walker = runner(&mut sim, Vec3::ZERO);
    runner(&mut sim, Vec3::X * 20.0);
    sim.seconds(0.5);
    sim.walk(walker, Vec3::Z);
    sim.seconds(0.5);
    let measured = *sim.app.world().resource::<CharacterDiagnostics>();
    assert_eq!((measured.characters, measured.idle), (2, 1));
    assert!(measured.queries > 0, "a walker asks for distances");
    assert!(!measured.tick_time.is_zero(), "and that takes time");
    let store = sim.app.world().resource::<DiagnosticsStore>();
    for (path, wanted) in [
        (&CharacterDiagnostics::CHARACTERS, Some(2.0)),
        (&CharacterDiagnostics::IDLE, Some(1.0)),
        (
            &CharacterDiagnostics::QUERIES,
            Some(f64::from(measured.queries)),
        ),
        (
            &CharacterDiagnostics::TICK_TIME,
            Some(measured.tick_time.as_secs_f64() * 1000.0),
        ),
    ] {
        let published = store.get(path).and_then(Diagnostic::value);
        assert_eq!(published, wanted, "{path}");
    }
}
