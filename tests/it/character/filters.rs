//! What a character may touch: groups, a predicate, a list, sensors, other bodies' disabled colliders.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Marks what a ghost passes.
#[derive(Component)]
struct Misty;

/// Runs at a wall at x = 2 for a second; `set_up` prepares character and wall. Where it ends.
fn run_at_wall(hz: f64, set_up: impl FnOnce(&mut Sim, Entity, Entity)) -> f32 {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    let wall = sim.block(Vec3::new(2.5, 2.0, 0.0), Vec3::new(1.0, 4.0, 10.0));
    let who = runner(&mut sim, Vec3::ZERO);
    set_up(&mut sim, who, wall);
    sim.seconds(0.3);
    sim.walk(who, Vec3::X);
    sim.seconds(1.0);
    assert!(
        sim.position(who).y.abs() < 0.01,
        "the floor holds at {hz} Hz: {}",
        sim.position(who)
    );
    sim.position(who).x
}

fn expect(found: &mut Findings, case: &str, x: f32, passes: bool) {
    if passes {
        found.near(format!("{case}: passes"), x, 5.0, 0.01);
    } else {
        found.near(format!("{case}: stops"), x, 1.7, 0.025);
    }
}

#[test]
fn collision_groups_decide_from_both_sides() {
    let mut found = Findings::new();
    let (one, two) = (Group::GROUP_1, Group::GROUP_2);
    for hz in RATES {
        for (who_groups, wall_groups, passes) in [
            ((one, Group::ALL), (one, Group::ALL), false),
            ((one, Group::ALL ^ two), (two, Group::ALL), true),
            ((one, Group::ALL), (two, Group::ALL ^ one), true),
            ((one, Group::ALL ^ two), (one, Group::ALL), false),
        ] {
            let x = run_at_wall(hz, |sim, who, wall| {
                insert(sim, who, CollisionGroups::new(who_groups.0, who_groups.1));
                insert(
                    sim,
                    wall,
                    CollisionGroups::new(wall_groups.0, wall_groups.1),
                );
            });
            let case = format!("{hz} Hz {who_groups:?} against {wall_groups:?}");
            expect(&mut found, &case, x, passes);
        }
    }
}

#[test]
fn a_list_of_ignored_entities_is_passed() {
    let mut found = Findings::new();
    for hz in RATES {
        let x = run_at_wall(hz, |sim, who, wall| {
            insert(sim, who, CharacterIgnores(vec![wall]));
        });
        expect(&mut found, &format!("{hz} Hz"), x, true);
    }
}

#[test]
fn a_predicate_decides_for_each_collider() {
    fn nothing_of_the_first(_: Entity, other: Entity) -> bool {
        other.index_u32().is_multiple_of(2)
    }
    let mut found = Findings::new();
    for hz in RATES {
        // Two walls in a row, of which the predicate lets one through: the one with an odd index.
        let mut sim = Sim::new(hz);
        let mut floor = sim.floor(0.0);
        while !floor.index_u32().is_multiple_of(2) {
            sim.app.world_mut().despawn(floor);
            floor = sim.floor(0.0);
            sim.spawn(Misty);
        }
        let mut walls = [None; 2];
        let mut spare = Vec::new();
        while walls.contains(&None) {
            let entity = sim.spawn(Misty);
            let odd = entity.index_u32() % 2 == 1;
            let slot = usize::from(!odd);
            if walls[slot].is_none() {
                let x = if odd { 2.5 } else { 4.5 };
                insert(
                    &mut sim,
                    entity,
                    (
                        RigidBody::Fixed,
                        Collider::cuboid(0.5, 2.0, 5.0),
                        Transform::from_xyz(x, 2.0, 0.0),
                    ),
                );
                walls[slot] = Some(entity);
            } else {
                spare.push(entity);
            }
        }
        let who = runner(&mut sim, Vec3::ZERO);
        insert(&mut sim, who, CharacterFilter::new(nothing_of_the_first));
        sim.seconds(0.3);
        sim.walk(who, Vec3::X);
        sim.seconds(1.5);
        found.near(
            format!("{hz} Hz: stops at the second"),
            sim.position(who).x,
            3.7,
            0.025,
        );
        found.near(format!("{hz} Hz: stands"), sim.position(who).y, 0.0, 0.002);
    }
}

#[test]
fn sensors_are_never_touched() {
    let mut found = Findings::new();
    for hz in RATES {
        let x = run_at_wall(hz, |sim, _, wall| insert(sim, wall, Sensor));
        expect(&mut found, &format!("{hz} Hz wall"), x, true);
        // Nor stood on, nor in the way of standing up.
        let mut sim = Sim::new(hz);
        sim.floor(-2.0);
        let cloud = sim.block(Vec3::NEG_Y * 0.5, Vec3::new(10.0, 1.0, 10.0));
        insert(&mut sim, cloud, Sensor);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.intent(who, |intent| intent.stance = Stance::Crouch);
        sim.seconds(1.5);
        sim.intent(who, |intent| intent.stance = Stance::Stand);
        sim.seconds(0.5);
        found.near(
            format!("{hz} Hz: falls through"),
            sim.position(who).y,
            -2.0,
            0.002,
        );
        found.near(
            format!("{hz} Hz: stands up in it"),
            sim.state(who).height,
            1.8,
            1e-3,
        );
    }
}

#[test]
fn a_disabled_collider_is_not_there() {
    let mut found = Findings::new();
    for hz in RATES {
        let x = run_at_wall(hz, |sim, _, wall| insert(sim, wall, ColliderDisabled));
        expect(&mut found, &format!("{hz} Hz"), x, true);
    }
}

#[test]
fn its_own_colliders_and_those_of_its_children_are_not_in_its_way() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        // A hit box and a shield, carried along.
        sim.spawn((
            Collider::ball(0.5),
            Transform::from_xyz(0.0, 1.6, 0.0),
            ChildOf(who),
        ));
        sim.spawn((
            Collider::cuboid(0.5, 0.5, 0.05),
            Transform::from_xyz(0.4, 1.0, 0.0),
            ChildOf(who),
        ));
        sim.seconds(0.5);
        found.at_most(format!("{hz} Hz: stands"), sim.position(who).length(), 1e-3);
        sim.walk(who, Vec3::X);
        sim.seconds(1.0);
        found.within(format!("{hz} Hz: walks"), sim.position(who).x, SPEED, 0.001);
    }
}

#[test]
fn a_change_of_filter_acts_on_the_next_tick() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = sim.floor(0.0);
        let who = runner(&mut sim, Vec3::ZERO);
        sim.seconds(0.5);
        insert(&mut sim, who, CharacterIgnores(vec![floor]));
        sim.seconds(0.5);
        found.at_most(format!("{hz} Hz: falls"), sim.position(who).y, -1.0);
    }
}

#[test]
fn a_predicate_can_go_by_data_of_its_own() {
    let mut found = Findings::new();
    for hz in RATES {
        for ours in [true, false] {
            let x = run_at_wall(hz, |sim, who, wall| {
                let doors: Vec<Entity> = if ours { vec![wall] } else { Vec::new() };
                let filter = CharacterFilter::new(move |_, other| !doors.contains(&other));
                assert_eq!(filter.touches(who, wall), !ours);
                insert(sim, who, filter);
            });
            expect(&mut found, &format!("{hz} Hz ours {ours}"), x, ours);
        }
    }
}
