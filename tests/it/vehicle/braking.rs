//! Stopping: distance, heading, the friction circle.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Distance and heading (degrees) of a full stop from this speed.
fn stop(hz: f64, plan: &Plan, speed: f32, abs: bool) -> (f32, f32) {
    let mut sim = Sim::new(hz);
    plane(&mut sim, Quat::IDENTITY);
    let car = plan.park(&mut sim, Quat::IDENTITY);
    if abs {
        insert(&mut sim, car.body, AntiLockBrakes::default());
    }
    sim.seconds(1.0);
    car.roll(&mut sim, Vec3::NEG_Z * speed);
    let start = car.pose(&sim).translation;
    car.ask(&mut sim, |i| i.brake = 1.0);
    sim.seconds(f64::from(speed / 4.0) + 2.0);
    let end = car.pose(&sim);
    let nose = forward(&end);
    let heading = ops::atan2(nose.x, -nose.z).to_degrees();
    let upright = (end.rotation * Vec3::Y).y;
    assert!(upright > 0.99, "{hz} Hz: lies on its side");
    ((end.translation - start).length(), heading)
}

#[test]
fn locked_wheels_stop_within_the_distance_of_friction() {
    let mut found = Findings::new();
    for (speed, wanted) in [(100.0 / 3.6, 39.33), (20.0, 20.39)] {
        let mut all = Vec::new();
        for hz in RATES {
            let (distance, heading) = stop(hz, &Plan::reference(), speed, false);
            found.within(
                format!("{hz} Hz {speed} m/s: distance"),
                distance,
                wanted,
                0.03,
            );
            found.near(format!("{hz} Hz {speed} m/s: heading"), heading, 0.0, 1.0);
            all.push(distance);
        }
        found.within(
            format!("{speed} m/s: 30 against 240 Hz"),
            all[0],
            all[3],
            0.02,
        );
    }
}

#[test]
fn any_brake_torque_stops_within_friction_and_on_the_wheels() {
    let mut found = Findings::new();
    for hz in RATES {
        for torque in [1.0e5, 1.0e7, 1.0e9] {
            let mut plan = Plan::reference();
            plan.vehicle.brakes.torque = torque;
            let (distance, _) = stop(hz, &plan, 20.0, false);
            found.within(format!("{hz} Hz {torque} N·m"), distance, 20.39, 0.03);
        }
    }
}

#[test]
fn anti_lock_brakes_stop_shorter_than_locked_wheels_on_a_falling_curve() {
    let mut found = Findings::new();
    for hz in RATES {
        let plan = Plan::reference().tire(|t| {
            let magic = TireModel::Magic {
                b: 10.0,
                c: 1.9,
                e: 0.6,
            };
            t.along = magic.clone();
            t.across = magic;
        });
        let (locked, _) = stop(hz, &plan, 27.78, false);
        let (held, _) = stop(hz, &plan, 27.78, true);
        found.at_most(format!("{hz} Hz: with anti-lock"), held, locked * 0.97);
        // Nor shorter than the peak allows.
        found.at_least(format!("{hz} Hz: with anti-lock"), held, 39.33 * 0.98);
    }
}

#[test]
fn no_tyre_leaves_its_friction_circle() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 25.0);
        car.ask(&mut sim, |i| {
            i.brake = 0.25;
            i.steer = 0.6;
        });
        let mut worst = 0.0f32;
        for _ in 0..(3.0 * hz) as usize {
            sim.ticks(1);
            for wheel in car.all(&sim) {
                if wheel.load > 1.0 {
                    worst = worst.max(wheel.force.length() / wheel.load);
                }
            }
        }
        found.at_most(format!("{hz} Hz: force over load"), worst, 1.001);
        found.at_least(format!("{hz} Hz: used"), worst, 0.99);
    }
}

#[test]
fn locked_wheels_do_not_steer_and_slide_against_their_motion() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.ask(&mut sim, |i| {
            i.brake = 1.0;
            i.steer = 1.0;
        });
        sim.seconds(1.0);
        car.push(&mut sim, Vec3::NEG_Z * 25.0);
        // The carcasses turn from how they stood to how they slide.
        sim.seconds(0.1);
        for _ in 0..hz as usize {
            sim.ticks(1);
            for wheel in car.all(&sim) {
                let Some(contact) = wheel.contact else {
                    continue;
                };
                if wheel.load < 100.0 {
                    continue;
                }
                let across = contact.forward.cross(contact.normal);
                let force = contact.forward * wheel.force.x + across * wheel.force.y;
                let (pose, velocity) = (car.pose(&sim), car.velocity(&sim));
                let arm = contact.point - pose.translation;
                let slide = velocity.linear + velocity.angular.cross(arm);
                let slide = slide.with_y(0.0);
                if slide.length() < 2.0 {
                    continue;
                }
                let angle = force.angle_between(-slide).to_degrees();
                found.at_most(format!("{hz} Hz: against the slide"), angle, 1.0);
            }
        }
        let at = car.pose(&sim).translation;
        // With rolling wheels it would be tens of metres.
        found.at_most(format!("{hz} Hz: aside"), at.x.abs(), 0.02);
    }
}
