//! Weight transfer under acceleration along and across.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn acceleration_moves_load_from_the_front_axle_to_the_rear_by_height_over_wheelbase() {
    // m a h / L, and what spins the wheels up: a hundredth more.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let effective = MASS + 4.0 / (RADIUS * RADIUS);
        // Stiff: a body that pitches moves its centre of mass as well.
        let plan = Plan::reference()
            .direct(effective * 5.0 / 4.0, |_| true)
            .suspension(|s| s.spring = SpringRate::RideFrequency(3.0));
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(2.0);
        let before = car.velocity(&sim).linear.z;
        sim.seconds(1.0);
        let load = car.loads(&sim);
        let moved = (load[2] + load[3] - load[0] - load[1]) / 2.0;
        let height = car.pose(&sim).translation.y;
        let wanted = MASS * 5.0 * height / (2.0 * HALF_BASE);
        found.within(format!("{hz} Hz: transfer"), moved, wanted, 0.03);
        let a = before - car.velocity(&sim).linear.z;
        found.within(format!("{hz} Hz: acceleration"), a, 5.0, 0.01);
    }
}

#[test]
fn cornering_moves_load_to_the_outer_side_by_height_over_track() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // Stiff, so that the body does not lean out.
        let mut plan = Plan::reference().suspension(|s| {
            s.spring = SpringRate::RideFrequency(4.0);
        });
        plan.vehicle.steering.rate = 1.0;
        let car = plan.spawn(&mut sim, Transform::from_xyz(-30.0, HEIGHT, 100.0));
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 15.0);
        car.ask(&mut sim, |i| i.steer = 0.1);
        sim.seconds(3.0);
        let load = car.loads(&sim);
        let across = car.telemetry(&sim).acceleration.x;
        found.at_least(format!("{hz} Hz: turns"), across, 3.0);
        let moved = (load[0] + load[2] - load[1] - load[3]) / 2.0;
        let height = car.pose(&sim).translation.y;
        let wanted = MASS * across * height / (2.0 * HALF_TRACK);
        found.within(format!("{hz} Hz: transfer"), moved, wanted, 0.03);
    }
}

#[test]
fn an_anti_roll_bar_moves_load_to_its_axle_and_none_across_the_car() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut share = Vec::new();
        for bar in [0.0, 30_000.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = Plan::reference();
            plan.vehicle.anti_roll = vec![bar, 0.0];
            let car = plan.spawn(&mut sim, Transform::from_xyz(-30.0, HEIGHT, 100.0));
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 15.0);
            car.ask(&mut sim, |i| i.steer = 0.1);
            sim.seconds(3.0);
            let load = car.loads(&sim);
            let (front, rear) = (load[0] - load[1], load[2] - load[3]);
            share.push(front / (front + rear));
            found.within(
                format!("{hz} Hz {bar}: sum"),
                load.iter().sum(),
                MASS * G,
                0.01,
            );
        }
        // Springs of 33 kN/m alone share evenly; a bar of 30 kN/m between the wheels counts twice:
        // (33.3 + 60) / (33.3 + 60 + 33.3).
        found.near(format!("{hz} Hz: without"), share[0], 0.5, 0.02);
        found.near(format!("{hz} Hz: with"), share[1], 0.737, 0.03);
    }
}
