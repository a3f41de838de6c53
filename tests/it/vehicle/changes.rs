//! A vehicle that is taken apart, switched over or put elsewhere while it drives.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// The hull of the reference car lies on the ground with its origin this high, metres.
const ON_ITS_HULL: f32 = 0.1;

/// A standing car, awake or asleep, with a second one beside it.
fn standing(hz: f64, asleep: bool) -> (Sim, Car) {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    Plan::reference().spawn(&mut sim, Transform::from_xyz(20.0, HEIGHT, 0.0));
    let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
    if asleep {
        insert(&mut sim, car.body, Sleeping::default());
    }
    sim.seconds(if asleep { 12.0 } else { 2.0 });
    assert_eq!(car.telemetry(&sim).asleep, asleep);
    (sim, car)
}

#[test]
fn what_has_no_wheels_any_more_falls_on_its_hull() {
    type Take = fn(&mut Sim, &Car);
    let ways: [(&str, Take); 4] = [
        ("all wheels despawned", |sim, car| {
            for wheel in &car.wheels {
                sim.app.world_mut().despawn(*wheel);
            }
        }),
        ("no vehicle any more", |sim, car| {
            sim.app.world_mut().entity_mut(car.body).remove::<Vehicle>();
        }),
        ("a wheel without its config", |sim, car| {
            sim.app
                .world_mut()
                .entity_mut(car.wheels[1])
                .remove::<Wheel>();
        }),
        ("a config out of range", |sim, car| {
            edit::<Vehicle>(sim, car.body, |v| v.brakes.torque = f32::NAN);
        }),
    ];
    let mut found = Findings::new();
    for hz in [30.0, 240.0] {
        for asleep in [false, true] {
            for (name, take) in ways {
                let (mut sim, car) = standing(hz, asleep);
                take(&mut sim, &car);
                sim.seconds(3.0);
                let y = car.pose(&sim).translation.y;
                let case = format!("{hz} Hz {name}, asleep {asleep}");
                found.near(case, y, ON_ITS_HULL, 0.02);
            }
        }
    }
}

#[test]
fn a_wheel_lost_in_flight_leaves_the_others_as_they_were() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, 50.0, 0.0));
        sim.ticks(2);
        edit::<VehicleState>(&mut sim, car.body, |state| {
            for (i, wheel) in state.wheels.iter_mut().enumerate() {
                wheel.spin = 10.0 * (i as f32 + 1.0);
            }
        });
        sim.ticks(1);
        sim.app.world_mut().despawn(car.wheels[1]);
        sim.ticks(2);
        for i in [0, 2, 3] {
            let spin = car.wheel(&sim, i).spin;
            let case = format!("{hz} Hz wheel {i}: spin");
            found.near(case, spin, 10.0 * (i as f32 + 1.0), 1.0e-3);
        }
    }
}

#[test]
fn a_wheel_that_is_tied_to_another_car_goes_on_there() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let giver = Plan::reference().park(&mut sim, Quat::IDENTITY);
        let taker = Plan::reference().spawn(&mut sim, Transform::from_xyz(20.0, HEIGHT, 0.0));
        sim.seconds(2.0);
        insert(&mut sim, giver.wheels[0], WheelOf(taker.body));
        sim.seconds(4.0);
        let both: f32 = taker.loads(&sim).iter().sum::<f32>() + giver.wheel(&sim, 0).load;
        found.within(format!("{hz} Hz: taker"), both, MASS * G, 0.001);
        let tied = giver.wheel(&sim, 0).load;
        found.at_least(format!("{hz} Hz: carries"), tied, 1000.0);
        found.holds(format!("{hz} Hz: giver"), giver.finite(&sim));
        let tip = (giver.pose(&sim).rotation * Vec3::Y).y;
        found.at_most(format!("{hz} Hz: giver leans"), tip, 0.999);
    }
}

#[test]
fn a_car_that_was_switched_to_fixed_or_kinematic_goes_on_when_it_is_dynamic_again() {
    let mut found = Findings::new();
    for hz in RATES {
        for kind in [RigidBody::Fixed, RigidBody::KinematicPositionBased] {
            let rotation = uphill(15.0);
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let car = Plan::reference().park(&mut sim, rotation);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(4.0);
            let stood = car.pose(&sim).translation;
            insert(&mut sim, car.body, kind);
            sim.seconds(1.0);
            let held = (car.pose(&sim).translation - stood).length();
            let case = format!("{hz} Hz {kind:?}");
            found.at_most(format!("{case}: held"), held, 1.0e-4);
            insert(&mut sim, car.body, RigidBody::Dynamic);
            let mut farthest = 0.0f32;
            for _ in 0..(2.0 * hz) as usize {
                sim.ticks(1);
                farthest = farthest.max((car.pose(&sim).translation - stood).length());
            }
            found.at_most(format!("{case}: moved"), farthest, 0.01);
            let sum: f32 = car.loads(&sim).iter().sum();
            found.within(format!("{case}: load"), sum, MASS * G * cos(15.0), 0.005);
        }
    }
}

#[test]
fn a_car_without_a_collider_drives_by_its_mass_alone() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let plan = Plan::reference().direct(800.0, |_| true);
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.app
            .world_mut()
            .entity_mut(car.body)
            .remove::<Collider>();
        sim.seconds(2.0);
        let y = car.pose(&sim).translation.y;
        found.near(format!("{hz} Hz: stands"), y, HEIGHT, 0.002);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(1.0);
        found.at_least(format!("{hz} Hz: drives"), car.telemetry(&sim).speed, 1.5);
    }
}

#[test]
fn a_car_without_any_mass_is_left_alone() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let body = sim.spawn((Vehicle::default(), Transform::from_xyz(0.0, 1.0, 0.0)));
    sim.spawn((Wheel::default(), WheelOf(body)));
    sim.seconds(1.0);
    assert!(sim.position(body).is_finite());
}

#[test]
fn cargo_above_a_wheel_is_no_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        for probe in [
            WheelProbe::Ray,
            WheelProbe::Rays { count: 3 },
            WheelProbe::Sphere { radius: 0.25 },
            WheelProbe::Cylinder,
        ] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let plan = Plan::reference().wheel(|_, w| w.probe = probe);
            let car = plan.park(&mut sim, Quat::IDENTITY);
            // On the hull, over the rear right wheel, whose top it is below.
            sim.dynamic(
                Collider::cuboid(0.2, 0.1, 0.2),
                Transform::from_xyz(0.75, HEIGHT + 0.41, 1.4),
                20.0,
            );
            let mut highest = f32::MIN;
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                highest = highest.max(car.pose(&sim).translation.y);
            }
            let case = format!("{hz} Hz {probe:?}");
            found.at_most(format!("{case}: thrown up"), highest, HEIGHT + 0.005);
            let sum: f32 = car.loads(&sim).iter().sum();
            found.within(format!("{case}: load"), sum, (MASS + 20.0) * G, 0.01);
        }
    }
}

#[test]
fn a_wheel_is_seen_where_it_is_wherever_it_hangs_in_the_hierarchy() {
    let mut found = Findings::new();
    for nested in [0, 1, 2, 3] {
        let mut sim = Sim::new(60.0);
        sim.floor(0.0);
        let turned =
            Transform::from_xyz(30.0, 0.0, -10.0).with_rotation(Quat::from_rotation_y(1.0));
        let level = sim.spawn(turned);
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(2.0, HEIGHT, 3.0));
        insert(&mut sim, car.body, ChildOf(level));
        let model = sim.spawn((
            Transform::from_xyz(0.0, 0.5, 0.0).with_scale(Vec3::splat(2.0)),
            ChildOf(car.body),
        ));
        let parent = match nested {
            0 => None,
            1 => Some(car.body),
            2 => Some(model),
            _ => Some(level),
        };
        if let Some(parent) = parent {
            for wheel in &car.wheels {
                insert(&mut sim, *wheel, ChildOf(parent));
            }
        }
        sim.seconds(3.0);
        for (i, wheel) in car.wheels.iter().enumerate() {
            let seen = sim.get::<GlobalTransform>(*wheel).translation();
            let touch = car.wheel(&sim, i).contact.map(|c| c.point);
            let wanted = touch.unwrap_or(Vec3::NAN) + Vec3::Y * RADIUS;
            let off = (seen - wanted).length();
            found.at_most(format!("nested {nested} wheel {i}"), off, 0.003);
        }
    }
}

#[test]
fn a_game_that_is_paused_goes_on_where_it_was() {
    let mut found = Findings::new();
    for hz in RATES {
        let rotation = uphill(10.0);
        let run = |pause: bool| {
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let car = Plan::reference()
                .direct(1000.0, |_| true)
                .park(&mut sim, rotation);
            car.ask(&mut sim, |i| {
                i.throttle = 1.0;
                i.steer = 0.2;
            });
            sim.seconds(2.0);
            if pause {
                sim.app.world_mut().resource_mut::<Time<Virtual>>().pause();
                sim.ticks(100);
                sim.app
                    .world_mut()
                    .resource_mut::<Time<Virtual>>()
                    .unpause();
            }
            sim.seconds(1.0);
            (car.pose(&sim), car.state(&sim))
        };
        let (through, paused) = (run(false), run(true));
        let off = (through.0.translation - paused.0.translation).length();
        // The clock may lose the tick in which it is stopped.
        let tick = 12.0 / hz as f32;
        found.at_most(format!("{hz} Hz: off"), off, tick);
        let finite = paused.1.wheels.iter().all(|w| w.spin.is_finite());
        found.holds(format!("{hz} Hz: finite"), finite);
    }
}
