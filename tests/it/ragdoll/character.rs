//! Characters that fall, lie, and get up.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

fn person(sim: &mut Sim, at: Vec3, config: CharacterRagdoll) -> Entity {
    let ragdoll = Ragdoll::new(
        RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75),
        75.0,
    );
    let character = Character {
        mass: 75.0,
        ..default()
    };
    let intent = RagdollIntent {
        mode: RagdollMode::HitBoxes,
        ..default()
    };
    let at = Transform::from_translation(at);
    let entity = sim.spawn((character, ragdoll, intent, config, at));
    sim.ticks(5);
    entity
}

fn told(sim: &mut Sim, tell: impl FnOnce(&mut Commands)) {
    tell(&mut sim.app.world_mut().commands());
    sim.app.world_mut().flush();
}

#[derive(Resource, Default)]
struct Hits(Vec<Hit>);

fn phase(sim: &Sim, entity: Entity) -> BodyPhase {
    sim.get::<CharacterRagdollState>(entity).phase
}

#[test]
fn a_character_that_the_game_switched_off_stays_so() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let entity = person(&mut sim, Vec3::ZERO, CharacterRagdoll::default());
    insert(&mut sim, entity, RigidBodyDisabled);
    sim.walk(entity, Vec3::X);
    sim.seconds(0.5);
    let mut findings = Findings::new();
    let off = sim.app.world().get::<RigidBodyDisabled>(entity).is_some();
    findings.holds("still off", off);
    findings.at_most("walks, m", sim.position(entity).x, 1.0e-3);
}

#[test]
fn its_own_hit_boxes_are_nothing_to_a_character() {
    let walk = |boxes: bool| {
        let mut sim = Sim::new(60.0);
        sim.floor(0.0);
        let entity = if boxes {
            person(&mut sim, Vec3::ZERO, CharacterRagdoll::default())
        } else {
            let character = Character {
                mass: 75.0,
                ..default()
            };
            let entity = sim.character(character, Vec3::ZERO);
            sim.ticks(5);
            entity
        };
        sim.walk(entity, Vec3::X);
        let mut seen = Vec::new();
        for _ in 0..90 {
            sim.ticks(1);
            seen.push(sim.position(entity));
        }
        seen
    };
    let mut findings = Findings::new();
    findings.same("ways", &walk(false), &walk(true));
}

#[test]
fn a_runner_who_falls_takes_the_velocity_along_and_the_capsule_lies_with_the_pelvis() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let entity = person(&mut sim, Vec3::ZERO, CharacterRagdoll::default());
        sim.intent(entity, |i| i.sprint = true);
        sim.walk(entity, Vec3::NEG_Z);
        sim.seconds(1.0);
        let velocity = sim.state(entity).world_velocity();
        findings.at_least(format!("{hz} Hz: it runs, m/s"), velocity.length(), 3.0);
        told(&mut sim, |c| c.become_ragdoll(entity));
        sim.ticks(1);
        let (momentum, mass) = momentum(&sim, entity);
        let kept = momentum.with_y(0.0).distance(velocity * mass) / (velocity.length() * mass);
        findings.at_most(format!("{hz} Hz: momentum lost"), kept, 0.05);
        findings.holds("down", phase(&sim, entity) == BodyPhase::Down);
        sim.seconds(3.0);
        let pelvis = sim.position(bone(&sim, entity, "pelvis"));
        let beside = (sim.position(entity) - pelvis).with_y(0.0).length();
        findings.at_most(format!("{hz} Hz: beside the pelvis, m"), beside, 0.02);
        findings.near(
            format!("{hz} Hz: on the floor, m"),
            sim.position(entity).y,
            0.0,
            0.02,
        );
        // And up again, to walk on from there.
        let lies = sim.position(entity);
        told(&mut sim, |c| c.recover(entity));
        sim.walk(entity, Vec3::ZERO);
        sim.seconds(1.0);
        findings.holds(
            format!("{hz} Hz: upright"),
            phase(&sim, entity) == BodyPhase::Upright,
        );
        findings.holds(format!("{hz} Hz: stands"), sim.state(entity).on_ground());
        let moved = sim.position(entity).distance(lies);
        findings.at_most(format!("{hz} Hz: it stands where it lay, m"), moved, 0.05);
        let head = sim.position(bone(&sim, entity, "head"));
        findings.near(format!("{hz} Hz: head, m"), head.y, 0.875 * 1.75, 0.05);
        sim.walk(entity, Vec3::NEG_Z);
        sim.seconds(1.0);
        let way = lies.z - sim.position(entity).z;
        findings.at_least(format!("{hz} Hz: it walks on, m"), way, 1.5);
    }
}

#[test]
fn who_lies_under_a_low_ceiling_waits_until_there_is_room() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let entity = person(&mut sim, Vec3::ZERO, CharacterRagdoll::default());
    told(&mut sim, |c| c.become_ragdoll(entity));
    sim.seconds(3.0);
    let ceiling = sim.block(Vec3::new(0.0, 1.5, 0.0), Vec3::new(8.0, 0.2, 8.0));
    sim.ticks(2);
    told(&mut sim, |c| c.recover(entity));
    sim.seconds(1.0);
    let mut findings = Findings::new();
    findings.holds("it waits", phase(&sim, entity) == BodyPhase::Waiting);
    findings.holds(
        "still limp",
        sim.get::<RagdollState>(entity).mode == RagdollMode::Limp,
    );
    sim.app.world_mut().despawn(ceiling);
    sim.seconds(1.0);
    findings.holds("it stands", phase(&sim, entity) == BodyPhase::Upright);
}

#[test]
fn a_fast_crate_throws_it_down_and_a_slow_one_or_a_wall_does_not() {
    let mut findings = Findings::new();
    // 20 kg against 75: 15.8 kg reduced. 50 N·s are 3.2 m/s.
    let config = CharacterRagdoll {
        fall_impulse: Some(50.0),
        get_up_after: Some(0.5),
        ..default()
    };
    for hz in RATES {
        for (speed, falls) in [(2.0, false), (6.0, true)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let entity = person(&mut sim, Vec3::ZERO, config);
            let crate_ = sim.dynamic(
                Collider::cuboid(0.3, 0.3, 0.3),
                Transform::from_xyz(0.0, 1.0, 0.75),
                20.0,
            );
            insert(&mut sim, crate_, Velocity::linear(Vec3::NEG_Z * speed));
            sim.app.init_resource::<Hits>();
            sim.app
                .add_observer(|hit: On<Hit>, mut hits: ResMut<Hits>| hits.0.push(*hit));
            let mut down = false;
            for _ in 0..(hz * 0.5) as usize {
                sim.ticks(1);
                down |= phase(&sim, entity) == BodyPhase::Down;
            }
            let hits = &sim.app.world().resource::<Hits>().0;
            let what = format!("{hz} Hz, {speed} m/s: falls {falls}, {hits:?}");
            findings.holds(what, down == falls);
            if falls {
                let (momentum, mass) = momentum(&sim, entity);
                let thrown = -momentum.z / mass;
                findings.at_least(format!("{hz} Hz: thrown along, m/s"), thrown, 0.3);
                sim.seconds(6.0);
                let up = phase(&sim, entity) == BodyPhase::Upright;
                findings.holds(format!("{hz} Hz: it gets up by itself"), up);
            }
        }
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        sim.block(Vec3::new(0.0, 1.0, -3.0), Vec3::new(4.0, 2.0, 0.2));
        let entity = person(&mut sim, Vec3::ZERO, config);
        sim.intent(entity, |i| i.sprint = true);
        sim.walk(entity, Vec3::NEG_Z);
        sim.seconds(2.0);
        let stands = phase(&sim, entity) == BodyPhase::Upright;
        findings.holds(format!("{hz} Hz: a wall that it runs into"), stands);
    }
}

#[test]
fn who_is_spawned_with_no_intent_stands_and_who_gets_its_skin_late_too() {
    let mut findings = Findings::new();
    for late in [false, true] {
        let mut sim = Sim::new(60.0);
        ground(&mut sim);
        let ragdoll = Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies10, 1.75),
            75.0,
        );
        let entity = sim.spawn((
            Character::default(),
            CharacterRagdoll::default(),
            Transform::default(),
        ));
        if late {
            sim.ticks(10);
        }
        insert(&mut sim, entity, ragdoll);
        sim.seconds(1.0);
        let head = sim.position(bone(&sim, entity, "head")).y;
        findings.at_least(format!("late {late}: head, m"), head, 1.4);
        let mode = sim.get::<RagdollIntent>(entity).mode;
        findings.holds(format!("{mode:?}"), mode == RagdollMode::HitBoxes);
    }
}

#[test]
fn a_phase_that_was_written_back_is_taken_up_by_the_capsule() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    let entity = person(&mut sim, Vec3::ZERO, CharacterRagdoll::default());
    let saved = sim.get::<CharacterRagdollState>(entity);
    told(&mut sim, |c| c.become_ragdoll(entity));
    sim.ticks(20);
    let fallen = sim.get::<CharacterRagdollState>(entity);
    let off = |sim: &Sim| sim.app.world().get::<RigidBodyDisabled>(entity).is_some();
    findings.holds("down: the capsule is off", off(&sim));
    insert(&mut sim, entity, saved);
    sim.ticks(2);
    findings.holds("upright again: it is on", !off(&sim));
    insert(&mut sim, entity, fallen);
    sim.ticks(2);
    findings.holds("down again: it is off", off(&sim));
    // Without the component it is a character again.
    let mut world = sim.app.world_mut().entity_mut(entity);
    world.remove::<CharacterRagdoll>();
    sim.ticks(2);
    findings.holds("no longer one that falls: it is on", !off(&sim));
    let ignored = sim.get::<CharacterIgnores>(entity).0.len();
    findings.near("ignored bones", ignored as f32, 0.0, 0.0);
}

#[test]
fn an_impulse_of_nothing_throws_nobody_down_and_is_told_once() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    crate::character::warnings::unique_entities(&mut sim);
    let config = CharacterRagdoll {
        fall_impulse: Some(0.0),
        ..default()
    };
    let entity = person(&mut sim, Vec3::ZERO, config);
    sim.walk(entity, Vec3::NEG_Z);
    sim.seconds(1.0);
    findings.holds("it walks", phase(&sim, entity) == BodyPhase::Upright);
    let told = crate::character::warnings::about(entity);
    findings.holds(
        format!("{told:?}"),
        told.len() == 1 && told[0].contains("fall_impulse is 0"),
    );
}

#[test]
fn bad_settings_of_a_character_that_can_fall_are_told_once_though_written_every_tick() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    crate::character::warnings::unique_entities(&mut sim);
    let bad = CharacterRagdoll {
        fall_impulse: Some(-3.0),
        get_up_after: Some(f32::NAN),
        ..default()
    };
    let entity = person(&mut sim, Vec3::ZERO, bad);
    for _ in 0..20 {
        insert(&mut sim, entity, bad);
        sim.ticks(1);
    }
    let told = || crate::character::warnings::about(entity);
    findings.near("warnings", told().len() as f32, 2.0, 0.0);
    // Another bad value is news, and so is the same one after a good one.
    let other = CharacterRagdoll {
        fall_impulse: Some(f32::NAN),
        ..bad
    };
    let good = CharacterRagdoll {
        fall_impulse: None,
        ..bad
    };
    for config in [other, good, other] {
        insert(&mut sim, entity, config);
        sim.ticks(2);
    }
    findings.near("warnings", told().len() as f32, 4.0, 0.0);
}
