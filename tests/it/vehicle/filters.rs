//! What wheels stand on and what they do not: filters, sensors, what is switched off, other worlds.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Height of the reference car three seconds after something was done to its floor.
fn height(hz: f64, change: impl FnOnce(&mut Sim, Entity, &Car)) -> f32 {
    let mut sim = Sim::new(hz);
    let floor = sim.floor(0.0);
    sim.floor(-3.0);
    let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
    sim.seconds(1.0);
    change(&mut sim, floor, &car);
    sim.seconds(3.0);
    car.pose(&sim).translation.y
}

#[test]
fn wheels_stand_on_what_is_solid_to_their_vehicle_and_switched_on() {
    let mut found = Findings::new();
    for hz in RATES {
        let y = height(hz, |_, _, _| {});
        found.near(format!("{hz} Hz floor"), y, HEIGHT, 0.002);
        let below = HEIGHT - 3.0;
        let y = height(hz, |sim, floor, _| insert(sim, floor, Sensor));
        found.near(format!("{hz} Hz sensor"), y, below, 0.01);
        let y = height(hz, |sim, floor, _| insert(sim, floor, ColliderDisabled));
        found.near(format!("{hz} Hz collider off"), y, below, 0.01);
        let y = height(hz, |sim, floor, _| insert(sim, floor, RigidBodyDisabled));
        found.near(format!("{hz} Hz body off"), y, below, 0.01);
        let y = height(hz, |sim, floor, car| {
            insert(
                sim,
                floor,
                CollisionGroups::new(Group::GROUP_2, Group::GROUP_2),
            );
            insert(
                sim,
                car.body,
                CollisionGroups::new(Group::GROUP_1, Group::GROUP_1),
            );
        });
        // The floor below is of all groups.
        found.near(format!("{hz} Hz group"), y, below, 0.01);
        let y = height(hz, |sim, floor, _| {
            sim.app.world_mut().despawn(floor);
        });
        found.near(format!("{hz} Hz despawned"), y, below, 0.01);
    }
}

#[test]
fn a_vehicle_that_is_switched_off_stays_and_goes_on_when_it_is_on_again() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = Plan::reference()
            .direct(800.0, |_| true)
            .park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        insert(&mut sim, car.body, RigidBodyDisabled);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(1.0);
        let at = car.pose(&sim).translation;
        found.near(format!("{hz} Hz: stays"), at.z, 0.0, 1.0e-3);
        sim.app
            .world_mut()
            .entity_mut(car.body)
            .remove::<RigidBodyDisabled>();
        sim.seconds(2.0);
        found.at_least(format!("{hz} Hz: drives"), car.telemetry(&sim).speed, 3.0);
        let y = car.pose(&sim).translation.y;
        found.near(format!("{hz} Hz: height"), y, HEIGHT, 0.05);
    }
}

#[test]
fn vehicles_of_two_worlds_do_not_meet() {
    let mut found = Findings::new();
    for hz in [30.0, 240.0] {
        let mut sim = Sim::new(hz);
        let other = sim.spawn(RapierContextSimulation::default());
        sim.ticks(1);
        let first = sim
            .app
            .world_mut()
            .query_filtered::<Entity, With<DefaultRapierContext>>()
            .single(sim.app.world())
            .expect("one world by default");
        sim.floor(0.0);
        let high = sim.floor(2.0);
        insert(&mut sim, high, RapierContextEntityLink(other));
        let here = Plan::reference().park(&mut sim, Quat::IDENTITY);
        insert(&mut sim, here.body, RapierContextEntityLink(first));
        let there = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, 2.0 + HEIGHT, 0.0));
        insert(&mut sim, there.body, RapierContextEntityLink(other));
        sim.seconds(3.0);
        let y = here.pose(&sim).translation.y;
        found.near(format!("{hz} Hz: here"), y, HEIGHT, 0.002);
        let y = there.pose(&sim).translation.y;
        found.near(format!("{hz} Hz: there"), y, 2.0 + HEIGHT, 0.002);
    }
}
