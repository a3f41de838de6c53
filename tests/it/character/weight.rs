//! The weight of a character on what it stands on.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn the_weight_of_a_character_rests_on_what_it_stands_on() {
    // A beam on a hinge: the side with the character goes down; without weight it stays level.
    let mut found = Findings::new();
    for hz in RATES {
        for weighs in [true, false] {
            let mut sim = Sim::new(hz);
            let post = sim.block(Vec3::new(0.0, 0.5, 0.0), Vec3::new(0.1, 1.0, 0.1));
            let board = sim.dynamic(
                Collider::cuboid(4.0, 0.05, 0.5),
                Transform::from_xyz(0.0, 1.5, 0.0),
                40.0,
            );
            let hinge = RevoluteJointBuilder::new(Vec3::Z)
                .local_anchor1(Vec3::Y)
                .local_anchor2(Vec3::ZERO);
            insert(
                &mut sim,
                board,
                ImpulseJoint::new(post, TypedJoint::RevoluteJoint(hinge.build())),
            );
            let rider = runner_with(
                &mut sim,
                Character {
                    weighs_on_ground: weighs,
                    ..default()
                },
                Vec3::new(2.0, 1.55, 0.0),
            );
            sim.seconds(0.5);
            let tilt = (sim.get::<Transform>(board).rotation * Vec3::X).y;
            let case = format!("{hz} Hz weighs {weighs}");
            if weighs {
                // 70 kg at 2 m on a beam of 213 kg m²: 2.8 rad/s² when both move as one, 0.35 rad in half
                // a second; a free fall of the rider's side is 0.61 rad.
                found.at_most(format!("{case}: tilt"), tilt, -0.28);
                found.at_least(format!("{case}: tilt"), tilt, -0.55);
            } else {
                found.near(format!("{case}: tilt"), tilt, 0.0, 0.03);
            }
            found.holds(format!("{case}: finite"), finite(&sim, rider));
        }
    }
}

/// A plate of 100 kg that hangs at rest on a spring of 7 kN/m.
fn scale(hz: f64) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    let base = sim.block(Vec3::NEG_Y * 10.0, Vec3::ONE);
    let plate = sim.dynamic(Collider::cuboid(1.0, 0.1, 1.0), Transform::IDENTITY, 100.0);
    insert(&mut sim, plate, LockedAxes::ROTATION_LOCKED);
    let spring = PrismaticJointBuilder::new(Vec3::Y)
        .local_anchor1(Vec3::Y * 10.0)
        .local_anchor2(Vec3::ZERO)
        .motor_model(MotorModel::ForceBased)
        .motor_position(0.0, 7000.0, 1500.0);
    insert(
        &mut sim,
        plate,
        ImpulseJoint::new(base, TypedJoint::PrismaticJoint(spring.build())),
    );
    sim.seconds(4.0);
    (sim, plate)
}

#[test]
fn a_scale_under_a_standing_character_shows_its_weight() {
    // The same spring under a dead load of the same weight is the measure.
    let mut found = Findings::new();
    for hz in RATES {
        let (mut sim, plate) = scale(hz);
        let free = sim.position(plate).y;
        insert(
            &mut sim,
            plate,
            ExternalForce {
                force: Vec3::NEG_Y * 80.0 * G,
                torque: Vec3::ZERO,
            },
        );
        sim.seconds(6.0);
        let dead_load = free - sim.position(plate).y;
        let (mut sim, plate) = scale(hz);
        let character = Character {
            mass: 80.0,
            ..default()
        };
        let stander = runner_with(&mut sim, character, Vec3::Y * (free + 0.11));
        sim.seconds(6.0);
        let loaded = sim.position(plate).y;
        found.within(format!("{hz} Hz: sinks"), free - loaded, dead_load, 0.05);
        found.within(
            format!("{hz} Hz: the spring itself"),
            dead_load,
            80.0 * G / 7000.0,
            0.3,
        );
        let gap = sim.position(stander).y - loaded - 0.1;
        found.near(format!("{hz} Hz: stands on it"), gap, 0.0, 0.01);
    }
}

#[test]
fn the_crate_under_a_character_is_not_pushed_by_its_own_rider() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = sim.floor(0.0);
        insert(&mut sim, floor, Friction::coefficient(0.0));
        let raft = sim.dynamic(
            Collider::cuboid(1.0, 0.25, 1.0),
            Transform::from_xyz(0.0, 0.25, 0.0),
            20.0,
        );
        let rider = runner(&mut sim, Vec3::new(0.3, 0.5, 0.2));
        sim.seconds(3.0);
        found.at_most(
            format!("{hz} Hz: raft"),
            sim.position(raft).with_y(0.0).length(),
            0.01,
        );
        found.near(format!("{hz} Hz: rider"), sim.position(rider).y, 0.5, 0.01);
    }
}
