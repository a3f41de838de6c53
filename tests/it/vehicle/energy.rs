//! No more energy in the car than its engine gave.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn a_launch_takes_no_more_energy_than_the_engine_gives() {
    let mut found = Findings::new();
    for hz in RATES {
        for differential in [Differential::Open, Differential::Locked] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let mut plan = Plan::reference().wheel(|i, w| w.driven = i >= 2);
            let engine = Engine::default();
            let inertia = engine.inertia;
            plan.vehicle.drivetrain = Some(Drivetrain {
                source: PowerSource::Engine(engine),
                axles: vec![DrivenAxle {
                    axle: 1,
                    share: 1.0,
                    differential,
                }],
                ..default()
            });
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(2.0);
            let stored = |sim: &Sim| {
                let state = car.state(sim);
                let wheels: f32 = state.wheels.iter().map(|w| 0.5 * w.spin * w.spin).sum();
                let engine = 0.5 * inertia * state.engine_speed * state.engine_speed;
                let v = car.velocity(sim).linear.length_squared();
                0.5 * MASS * v + wheels + engine
            };
            let start = stored(&sim);
            car.ask(&mut sim, |i| i.throttle = 1.0);
            let mut given = 0.0;
            let mut least = f32::MAX;
            let mut before = car.state(&sim).engine_speed;
            for _ in 0..(12.0 * hz) as usize {
                sim.ticks(1);
                let now = car.state(&sim).engine_speed;
                let torque = car.telemetry(&sim).engine_torque;
                given += torque * 0.5 * (before + now) / hz as f32;
                before = now;
                // What is kept must have been given; half a percent is the sum's own error.
                least = least.min(given * 1.005 + 50.0 - (stored(&sim) - start));
            }
            let case = format!("{hz} Hz {differential:?}");
            found.at_least(format!("{case}: left over"), least, 0.0);
            found.at_least(format!("{case}: given"), given, 3.0e5);
        }
    }
}
