//! On a slope: holding, sliding, rolling off.

use bevy::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// How far a braked car moves in this time after it has settled, metres; sleeping is off.
fn creep(hz: f64, rotation: Quat, friction: f32, seconds: f64) -> f32 {
    let mut sim = Sim::new(hz);
    plane(&mut sim, rotation);
    let plan = Plan::reference().tire(|t| t.friction = Vec2::splat(friction));
    let car = plan.park(&mut sim, rotation);
    car.ask(&mut sim, |i| i.brake = 1.0);
    // The body comes to rest on its springs.
    sim.seconds(6.0);
    let start = car.pose(&sim).translation;
    sim.seconds(seconds);
    (car.pose(&sim).translation - start).length()
}

#[test]
fn a_braked_car_on_twenty_degrees_stays_within_a_millimetre_for_a_minute() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, rotation) in [
            ("nose up", uphill(20.0)),
            ("nose down", uphill(-20.0)),
            ("side-on", side_on(20.0)),
        ] {
            // The mirror image of nose up but for the steered axle.
            if name == "nose down" && hz != 60.0 {
                continue;
            }
            let moved = creep(hz, rotation, 1.0, 60.0);
            found.at_most(format!("{hz} Hz {name}"), moved, 0.001);
        }
    }
}

#[test]
fn a_car_holds_on_thirty_degrees_with_a_friction_of_six_tenths() {
    // tan 30° = 0.577.
    let mut found = Findings::new();
    for hz in RATES {
        for (name, rotation) in [("nose up", uphill(30.0)), ("side-on", side_on(30.0))] {
            let moved = creep(hz, rotation, 0.6, 60.0);
            found.at_most(format!("{hz} Hz {name}"), moved, 0.001);
        }
    }
}

#[test]
fn beyond_the_angle_of_friction_a_braked_car_slides_with_what_friction_leaves() {
    // g (sin 32° − 0.6 cos 32°) = 0.207 m/s².
    let mut found = Findings::new();
    for hz in RATES {
        for (name, rotation) in [("nose up", uphill(32.0)), ("side-on", side_on(32.0))] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let plan = Plan::reference().tire(|t| t.friction = Vec2::splat(0.6));
            let car = plan.park(&mut sim, rotation);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(4.0);
            let before = car.velocity(&sim).linear.length();
            sim.seconds(4.0);
            let after = car.velocity(&sim).linear.length();
            let wanted = G * (sin(32.0) - 0.6 * cos(32.0));
            found.within(
                format!("{hz} Hz {name}"),
                (after - before) / 4.0,
                wanted,
                0.05,
            );
        }
    }
}

#[test]
fn the_loads_on_a_slope_sum_to_the_normal_part_of_the_weight() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, rotation, angle) in [
            ("10 up", uphill(10.0), 10.0),
            ("20 up", uphill(20.0), 20.0),
            ("20 across", side_on(20.0), 20.0),
        ] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let car = Plan::reference().park(&mut sim, rotation);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(8.0);
            let sum: f32 = car.loads(&sim).iter().sum();
            found.within(format!("{hz} Hz {name}"), sum, MASS * G * cos(angle), 0.001);
        }
    }
}

#[test]
fn a_released_car_moves_on_the_next_tick_and_rolls_with_its_effective_mass() {
    let mut found = Findings::new();
    for hz in RATES {
        let rotation = uphill(10.0);
        let mut sim = Sim::new(hz);
        plane(&mut sim, rotation);
        let plan = Plan::reference().tire(|t| t.rolling_resistance = 0.012);
        let car = plan.park(&mut sim, rotation);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(6.0);
        let start = car.pose(&sim).translation;
        car.ask(&mut sim, |i| i.brake = 0.0);
        sim.ticks(1);
        let moved = (car.pose(&sim).translation - start).length();
        found.at_least(format!("{hz} Hz: moved at once"), moved, 1.0e-6);
        sim.seconds(2.0);
        let before = car.velocity(&sim).linear.length();
        sim.seconds(2.0);
        let after = car.velocity(&sim).linear.length();
        // Four wheels of 1 kg·m² at 0.3 m add 44 kg.
        let mass = MASS + 4.0 / (RADIUS * RADIUS);
        let wanted = G * (sin(10.0) - 0.012 * cos(10.0)) * MASS / mass;
        found.within(
            format!("{hz} Hz: acceleration"),
            (after - before) / 2.0,
            wanted,
            0.02,
        );
    }
}

#[test]
fn a_handbrake_holds_by_the_load_of_its_axle_alone() {
    // Facing uphill the rear axle carries N_r = m g (cos θ / 2 + h / L sin θ); it holds if µ N_r > m g sin θ.
    let mut found = Findings::new();
    for hz in RATES {
        for (angle, friction, holds) in [(15.0, 0.6, true), (15.0, 0.4, false)] {
            let rotation = uphill(angle);
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let plan = Plan::reference()
                .tire(|t| t.friction = Vec2::splat(friction))
                .wheel(|i, w| w.handbrake = i >= 2);
            let car = plan.park(&mut sim, rotation);
            car.ask(&mut sim, |i| i.handbrake = 1.0);
            sim.seconds(6.0);
            let start = car.pose(&sim).translation;
            sim.seconds(10.0);
            let moved = (car.pose(&sim).translation - start).length();
            let case = format!("{hz} Hz {angle}° µ {friction}");
            if holds {
                found.at_most(format!("{case}: moved"), moved, 0.001);
            } else {
                found.at_least(format!("{case}: moved"), moved, 0.5);
            }
        }
    }
}
