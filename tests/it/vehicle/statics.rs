//! At rest on the level: sag, loads, stillness.

use bevy::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn a_standing_car_sags_by_g_over_omega_squared() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // From a hand's breadth above, so that it has to settle.
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.1, 0.0));
        sim.seconds(5.0);
        for (i, wheel) in car.all(&sim).iter().enumerate() {
            found.within(
                format!("{hz} Hz wheel {i}: sag"),
                wheel.compression,
                SAG,
                0.005,
            );
            found.within(
                format!("{hz} Hz wheel {i}: load"),
                wheel.load,
                MASS * G / 4.0,
                0.005,
            );
        }
        let y = car.pose(&sim).translation.y;
        found.near(format!("{hz} Hz: height"), y, HEIGHT, 0.005 * SAG);
    }
}

#[test]
fn the_weight_rests_on_the_axles_by_the_lever_of_the_centre_of_mass() {
    let mut found = Findings::new();
    for hz in RATES {
        for (ahead, aside) in [(0.3, 0.0), (-0.4, 0.0), (0.0, 0.2), (0.2, -0.1)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = Plan::reference();
            plan.mass.center = Vec3::new(aside, 0.0, -ahead);
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 0.0));
            sim.seconds(6.0);
            let load = car.loads(&sim);
            let case = format!("{hz} Hz centre {ahead} ahead {aside} right");
            let weight = MASS * G;
            let front = weight * (HALF_BASE + ahead) / (2.0 * HALF_BASE);
            found.within(format!("{case}: front"), load[0] + load[1], front, 0.005);
            let right = weight * (HALF_TRACK + aside) / (2.0 * HALF_TRACK);
            found.within(format!("{case}: right"), load[1] + load[3], right, 0.005);
            found.within(format!("{case}: sum"), load.iter().sum(), weight, 0.001);
        }
    }
}

#[test]
fn a_standing_car_stays_where_it_is_for_a_minute() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(3.0);
        let start = car.pose(&sim);
        sim.seconds(60.0);
        let end = car.pose(&sim);
        let velocity = car.velocity(&sim);
        found.at_most(format!("{hz} Hz: speed"), velocity.linear.length(), 1.0e-4);
        let drift = (end.translation - start.translation).length();
        found.at_most(format!("{hz} Hz: drift"), drift, 1.0e-4);
        let turned = start.rotation.angle_between(end.rotation);
        found.at_most(format!("{hz} Hz: turned"), turned, 1.0e-4);
        for wheel in car.all(&sim) {
            found.at_most(format!("{hz} Hz: spin"), wheel.spin.abs(), 1.0e-4);
        }
    }
}
