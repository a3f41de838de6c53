//! States and helpers whose values are no numbers.

use bevy::{ecs::component::Mutable, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Spoils a state in every field that may not be a number.
fn spoil(state: &mut VehicleState, bad: f32) {
    state.engine_speed = bad;
    state.shifting = bad;
    state.gear_age = bad;
    state.steer_angle = bad;
    state.clutch_torque = bad;
    state.traction_cut = bad;
    state.hill_hold = bad;
    state.gear = 100;
    for w in &mut state.wheels {
        w.spin = bad;
        w.angle = bad;
        w.compression = bad;
        w.compression_rate = bad;
        w.bristle = Vec2::splat(bad);
        w.slip = bad;
        w.expected = Vec2::splat(bad);
        w.ground_force = Vec3::splat(bad);
        w.ground_speed = Vec3::splat(bad);
        w.abs = bad;
        w.air_time = bad;
    }
}

#[test]
fn a_state_of_no_numbers_heals() {
    let mut found = Findings::new();
    for hz in [30.0, 240.0] {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1.0e38] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let mut plan = Plan::reference().wheel(|i, w| w.driven = i >= 2);
            plan.vehicle.drivetrain = Some(Drivetrain::default());
            let car = plan.park(&mut sim, Quat::IDENTITY);
            insert(
                &mut sim,
                car.body,
                (
                    AntiLockBrakes::default(),
                    TractionControl::default(),
                    HillHold::default(),
                ),
            );
            sim.seconds(2.0);
            edit::<VehicleState>(&mut sim, car.body, |s| spoil(s, bad));
            let mut finite = true;
            for _ in 0..(4.0 * hz) as usize {
                sim.ticks(1);
                finite &= car.finite(&sim);
            }
            let case = format!("{hz} Hz {bad}");
            found.holds(format!("{case}: finite"), finite);
            car.ask(&mut sim, |i| i.throttle = 0.5);
            sim.seconds(4.0);
            let at = car.pose(&sim).translation.y;
            found.near(format!("{case}: stands"), at, HEIGHT, 0.05);
            let speed = car.telemetry(&sim).speed;
            found.at_least(format!("{case}: drives"), speed, 2.0);
            car.ask(&mut sim, |i| {
                i.throttle = 0.0;
                i.brake = 1.0;
            });
            sim.seconds(6.0);
            let rest = car.velocity(&sim).linear.length();
            found.at_most(format!("{case}: stops"), rest, 0.01);
        }
    }
}

/// Inserts, ticks, removes again.
fn with<C: Component<Mutability = Mutable>>(sim: &mut Sim, car: &Car, component: C) {
    insert(sim, car.body, component);
    sim.seconds(0.5);
    sim.app.world_mut().entity_mut(car.body).remove::<C>();
}

#[test]
fn helpers_of_no_numbers_neither_crash_nor_take_the_brakes() {
    let mut found = Findings::new();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 0.0] {
        let mut sim = Sim::new(60.0);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference()
            .direct(500.0, |_| true)
            .park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        let begin = |sim: &mut Sim| {
            car.roll(sim, Vec3::NEG_Z * 20.0);
            car.ask(sim, |i| {
                i.brake = 1.0;
                i.steer = 0.2;
            });
        };
        let lost = |sim: &Sim| 20.0 - car.velocity(sim).linear.length();
        for which in 0..5 {
            begin(&mut sim);
            match which {
                0 => with(
                    &mut sim,
                    &car,
                    AntiLockBrakes {
                        slip: bad,
                        least_speed: bad,
                    },
                ),
                1 => with(&mut sim, &car, TractionControl { slip: bad }),
                2 => with(
                    &mut sim,
                    &car,
                    StabilityControl {
                        tolerance: bad,
                        strength: bad,
                    },
                ),
                3 => with(&mut sim, &car, HillHold { time: bad }),
                _ => with(
                    &mut sim,
                    &car,
                    LeanControl {
                        frequency: bad,
                        damping: bad,
                        max_lean: bad,
                    },
                ),
            }
            let case = format!("{bad} helper {which}");
            found.holds(format!("{case}: finite"), car.finite(&sim));
            found.at_least(format!("{case}: brakes"), lost(&sim), 3.0);
        }
    }
}
