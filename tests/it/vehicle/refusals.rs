//! What cannot work is named in one warning, with its entity and field.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;
use crate::character::warnings;

/// Checks that the entity which this spoils is named once, with these words.
fn told(words: &[&str], spoil: impl FnOnce(&mut Sim, &Car) -> Entity) {
    let mut sim = Sim::new(60.0);
    warnings::unique_entities(&mut sim);
    sim.floor(0.0);
    let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
    let named = spoil(&mut sim, &car);
    sim.seconds(1.0);
    let told = warnings::about(named);
    assert_eq!(told.len(), 1, "{words:?}: {told:?}");
    for word in words {
        assert!(told[0].contains(word), "{word}: {told:?}");
    }
}

#[test]
fn a_bad_value_is_named_with_its_entity_and_field() {
    told(&["brakes.torque", "NaN"], |sim, car| {
        edit::<Vehicle>(sim, car.body, |v| v.brakes.torque = f32::NAN);
        car.body
    });
    told(&["Wheel::radius", "-1"], |sim, car| {
        edit::<Wheel>(sim, car.wheels[2], |w| w.radius = -1.0);
        car.wheels[2]
    });
    told(&["VehicleMass::mass", "0"], |sim, car| {
        edit::<VehicleMass>(sim, car.body, |m| m.mass = 0.0);
        car.body
    });
    told(&["speed_curve", "order"], |sim, car| {
        edit::<Vehicle>(sim, car.body, |v| {
            v.steering.speed_curve = [20.0, 10.0]
                .map(|speed| SteerPoint { speed, part: 1.0 })
                .to_vec();
        });
        car.body
    });
}

#[test]
fn a_bad_helper_or_surface_is_named() {
    told(&["AntiLockBrakes", "slip"], |sim, car| {
        insert(
            sim,
            car.body,
            AntiLockBrakes {
                slip: 0.0,
                ..default()
            },
        );
        car.body
    });
    told(&["LeanControl", "max_lean"], |sim, car| {
        insert(
            sim,
            car.body,
            LeanControl {
                max_lean: f32::NAN,
                ..default()
            },
        );
        car.body
    });
    told(&["SurfaceFriction", "-1"], |sim, _| {
        sim.spawn((
            RigidBody::Fixed,
            Collider::cuboid(1.0, 1.0, 1.0),
            Transform::from_xyz(50.0, 5.0, 0.0),
            SurfaceFriction::new(-1.0),
        ))
    });
    told(&["RoadVelocity", "NaN"], |sim, _| {
        sim.spawn(RoadVelocity {
            linear: Vec3::NAN,
            ..default()
        })
    });
}

#[test]
fn wheels_that_belong_to_nothing_are_named() {
    told(&["WheelOf"], |sim, _| sim.spawn(Wheel::default()));
    told(&["WheelOf", "Vehicle"], |sim, _| {
        let nothing = sim.spawn(Transform::default());
        sim.spawn((Wheel::default(), WheelOf(nothing)))
    });
    told(&["Wheel", "missing"], |sim, car| {
        sim.spawn(WheelOf(car.body))
    });
    told(&["at most 16"], |sim, car| {
        for _ in 0..13 {
            sim.spawn((Wheel::default(), WheelOf(car.body)));
        }
        car.body
    });
}

#[test]
fn a_body_that_wheels_cannot_carry_is_named() {
    told(&["mass", "VehicleMass"], |sim, _| {
        let body = sim.spawn((Vehicle::default(), Transform::from_xyz(30.0, 1.0, 0.0)));
        sim.spawn((Wheel::default(), WheelOf(body)));
        body
    });
    told(&["RigidBody", "Dynamic"], |sim, _| {
        let body = sim.spawn((
            Vehicle::default(),
            RigidBody::Fixed,
            Collider::cuboid(1.0, 0.2, 2.0),
            Transform::from_xyz(30.0, 1.0, 0.0),
        ));
        sim.spawn((Wheel::default(), WheelOf(body)));
        body
    });
}
