//! Turning: Ackermann circles, the bicycle model, stability, relaxation.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn at_walking_pace_the_path_is_the_circle_of_the_steering() {
    let mut found = Findings::new();
    for hz in RATES {
        for radius in [5.0f32, 10.0, 20.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = Plan::reference();
            let angle = ops::atan(2.0 * HALF_BASE / radius);
            plan.vehicle.steering.max_angle = angle;
            let car = plan.park(&mut sim, Quat::IDENTITY);
            car.ask(&mut sim, |i| i.steer = 1.0);
            sim.seconds(1.5);
            car.roll(&mut sim, Vec3::NEG_Z);
            sim.seconds(1.0);
            let inner = car.wheel(&sim, 1).steer_angle;
            let outer = car.wheel(&sim, 0).steer_angle;
            let cot = 1.0 / ops::tan(outer) - 1.0 / ops::tan(inner);
            found.near(
                format!("{hz} Hz {radius} m: Ackermann"),
                cot,
                1.6 / 2.8,
                1.0e-3,
            );
            // The middle of the rear axle runs on the circle.
            let rear = |sim: &Sim| {
                let pose = car.pose(sim);
                pose.transform_point(Vec3::Z * HALF_BASE)
            };
            let (from, nose) = (rear(&sim), forward(&car.pose(&sim)));
            let mut way = 0.0;
            let mut last = from;
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                let now = rear(&sim);
                way += (now - last).length();
                last = now;
            }
            let turned = nose.angle_between(forward(&car.pose(&sim)));
            found.within(
                format!("{hz} Hz {radius} m: radius"),
                way / turned,
                radius,
                0.01,
            );
        }
    }
}

/// The reference car with constant cornering stiffness of 80 kN/rad per axle and its centre of mass
/// `a` metres behind the front axle; stiff in roll.
pub fn bicycle(a: f32) -> Plan {
    let mut plan = Plan::reference()
        .suspension(|s| s.spring = SpringRate::RideFrequency(4.0))
        .tire(|t| {
            t.across = TireModel::Linear { stiffness: 40.0e3 };
            t.friction = Vec2::splat(3.0);
            t.relaxation_length = Vec2::splat(0.05);
        });
    plan.mass.center = Vec3::new(0.0, -0.2, a - HALF_BASE);
    plan.vehicle.steering.ackermann = 0.0;
    plan.vehicle.steering.rate = 1.0e3;
    plan
}

/// Steady yaw rate, and the speed it is reached at.
fn turn(hz: f64, a: f32, angle: f32, speed: f32, seconds: f64) -> (f32, f32, f32) {
    let mut sim = Sim::new(hz);
    plane(&mut sim, Quat::IDENTITY);
    let mut plan = bicycle(a);
    plan.vehicle.steering.max_angle = angle;
    let car = plan.park(&mut sim, Quat::IDENTITY);
    sim.seconds(1.0);
    car.roll(&mut sim, Vec3::NEG_Z * speed);
    sim.seconds(0.5);
    car.ask(&mut sim, |i| i.steer = 1.0);
    sim.seconds(seconds);
    let velocity = car.velocity(&sim);
    let pose = car.pose(&sim);
    let slide = ops::atan2(
        velocity.linear.dot(pose.rotation * Vec3::X),
        velocity.linear.dot(forward(&pose)),
    );
    (-velocity.angular.y, velocity.linear.length(), slide)
}

#[test]
fn steady_cornering_is_that_of_the_bicycle_model() {
    // r = V δ / (L + K V²) with K = m / L (b / C_f − a / C_r).
    let mut found = Findings::new();
    for (a, seconds) in [(1.2f32, 2.0), (1.4, 2.0), (1.6, 3.0)] {
        for hz in RATES {
            let (rate, v, slide) = turn(hz, a, 0.03, 20.0, seconds);
            let b = 2.8 - a;
            let k = MASS / 2.8 * (b - a) / 80.0e3;
            let wanted = v * 0.03 / (2.8 + k * v * v);
            found.within(format!("{hz} Hz a {a}: yaw rate"), rate, wanted, 0.05);
            if a == 1.2 {
                let beta = rate * (b / v - MASS * a * v / (2.8 * 80.0e3));
                found.near(format!("{hz} Hz: slide"), slide, beta, 0.002);
            }
        }
    }
}

#[test]
fn an_oversteering_car_spins_above_its_critical_speed_and_not_below() {
    // V = √(L / −K) = 32.3 m/s for a = 1.6 m.
    let mut found = Findings::new();
    for hz in RATES {
        for (speed, spins) in [(28.0, false), (36.0, true)] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let car = bicycle(1.6).park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * speed);
            sim.seconds(0.2);
            edit::<bevy_rapier3d::prelude::Velocity>(&mut sim, car.body, |v| v.angular.y = 0.02);
            sim.seconds(1.0);
            let early = car.velocity(&sim).angular.y.abs();
            sim.seconds(2.0);
            let late = car.velocity(&sim).angular.y.abs();
            let case = format!("{hz} Hz {speed} m/s: yaw rate from {early} to {late}");
            found.holds(case, (late > early * 1.2) == spins);
        }
    }
}

#[test]
fn lateral_force_builds_up_over_the_relaxation_length_at_every_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        // The slower, the more ticks to the length.
        for speed in [0.5f32, 2.0] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            // So heavy that the tyres do not turn it.
            let mut plan = Plan::reference().tire(|t| {
                t.relaxation_length = Vec2::splat(0.5);
                t.friction = Vec2::splat(1.0e-4);
            });
            plan.mass.mass = 1.5e9;
            plan.mass.inertia = Vec3::splat(2.4e9);
            plan.vehicle.steering.rate = 1.0e6;
            plan.vehicle.steering.max_angle = 0.02;
            plan.vehicle.steering.ackermann = 0.0;
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * speed);
            sim.seconds(1.0);
            car.ask(&mut sim, |i| i.steer = 1.0);
            // Along the rolled distance, between the two ticks around the length.
            let (mut way, mut force) = (0.0, 0.0);
            let mut at_length = 0.0;
            while way < 0.5 {
                sim.ticks(1);
                let now = car.wheel(&sim, 0).force.y;
                let step = speed / hz as f32;
                if way + step >= 0.5 {
                    at_length = force + (now - force) * (0.5 - way) / step;
                }
                way += step;
                force = now;
            }
            sim.seconds(f64::from(4.0 / speed));
            let end = car.wheel(&sim, 0).force.y;
            found.within(
                format!("{hz} Hz {speed} m/s: steady"),
                end,
                80.0e3 * 0.02,
                0.02,
            );
            found.near(format!("{hz} Hz {speed} m/s"), at_length / end, 0.632, 0.03);
        }
    }
}
