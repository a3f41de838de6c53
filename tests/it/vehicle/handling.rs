//! The bicycle model in full: how yaw builds up after a step of the steering, and how much more
//! steering a faster drive on the same circle takes.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::{cornering::bicycle, support::*};

/// Yaw rate (rad/s, to the right) of the linear bicycle model at these times after a step of the
/// steering, integrated far below any error that matters here.
fn exact_step(a: f64, speed: f64, angle: f64, ticks: usize, dt: f64) -> Vec<f64> {
    let (m, i, c, b) = (f64::from(MASS), 2400.0, 80.0e3, 2.8 - a);
    let rate = |slide: f64, yaw: f64| {
        let front = c * (angle - slide - a * yaw / speed);
        let rear = c * (-slide + b * yaw / speed);
        (
            (front + rear) / (m * speed) - yaw,
            (a * front - b * rear) / i,
        )
    };
    let (mut slide, mut yaw) = (0.0, 0.0);
    let parts = 200;
    let h = dt / f64::from(parts);
    (0..ticks)
        .map(|_| {
            for _ in 0..parts {
                // Heun's method.
                let (s1, y1) = rate(slide, yaw);
                let (s2, y2) = rate(slide + h * s1, yaw + h * y1);
                slide += 0.5 * h * (s1 + s2);
                yaw += 0.5 * h * (y1 + y2);
            }
            yaw
        })
        .collect()
}

#[test]
fn yaw_builds_up_after_a_step_of_the_steering_as_in_the_bicycle_model() {
    // 20 m/s, a = 1.2 m: ω = 6.94 rad/s, ζ = 0.864.
    let mut found = Findings::new();
    for hz in RATES {
        for (a, angle) in [(1.2f32, 0.03f32), (1.4, 0.02)] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let mut plan = bicycle(a);
            plan.vehicle.steering.max_angle = angle;
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 20.0);
            sim.seconds(0.5);
            let speed = car.velocity(&sim).linear.length();
            car.ask(&mut sim, |i| i.steer = 1.0);
            let ticks = hz as usize;
            let exact = exact_step(
                f64::from(a),
                f64::from(speed),
                f64::from(angle),
                ticks,
                1.0 / hz,
            );
            let steady = exact[ticks - 1] as f32;
            let mut worst = 0.0f32;
            for wanted in &exact {
                sim.ticks(1);
                let yaw = -car.velocity(&sim).angular.y;
                worst = worst.max((yaw - *wanted as f32).abs() / steady);
            }
            found.at_most(format!("{hz} Hz a {a}: off"), worst, 0.05);
        }
    }
}

#[test]
fn a_constant_radius_takes_more_steering_by_the_understeer_gradient() {
    // δ = L / R + K a_y, K = m / L (b / C_f − a / C_r) = 0.00268 for a = 1.2 m.
    let mut found = Findings::new();
    for hz in RATES {
        for a in [1.2f32, 1.3, 1.4] {
            let mut points = Vec::new();
            for speed in [8.0f32, 11.0, 14.0, 17.0] {
                let mut sim = Sim::new(hz);
                plane(&mut sim, Quat::IDENTITY);
                let mut plan = bicycle(a).direct(1500.0, |_| true);
                plan.vehicle.steering.max_angle = 0.3;
                let car = plan.park(&mut sim, Quat::IDENTITY);
                sim.seconds(1.0);
                car.roll(&mut sim, Vec3::NEG_Z * speed);
                // A driver who keeps the speed and the circle of 50 m.
                let mut angle = 2.8 / 50.0;
                let dt = sim.dt();
                let mut state = (0.0, 0.0);
                for _ in 0..(6.0 * hz) as usize {
                    let v = car.velocity(&sim);
                    let (now, yaw) = (v.linear.length(), -v.angular.y);
                    angle += 3.0 * (1.0 / 50.0 - yaw / now) * dt * 2.8;
                    car.ask(&mut sim, |i| {
                        i.steer = angle / 0.3;
                        i.throttle = (speed - now).clamp(0.0, 0.5);
                    });
                    sim.ticks(1);
                    state = (now * yaw, car.telemetry(&sim).steer_angle);
                }
                points.push(state);
            }
            let slope = slope_of(&points);
            let b = 2.8 - a;
            let k = MASS / 2.8 * (b - a) / 80.0e3;
            found.near(format!("{hz} Hz a {a}: K"), slope, k, 0.05 * 0.002_68);
        }
    }
}

/// Slope of the straight line of least squares.
fn slope_of(points: &[(f32, f32)]) -> f32 {
    let n = points.len() as f32;
    let mean = |f: fn(&(f32, f32)) -> f32| points.iter().map(f).sum::<f32>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let up: f32 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let down: f32 = points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum();
    up / down
}

#[test]
fn the_inner_wheels_lift_where_the_centre_of_mass_is_over_the_outer_ones() {
    // a_y = g t / 2 h.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference()
            .direct(4000.0, |_| true)
            .tire(|t| t.friction = Vec2::splat(3.0))
            .suspension(|s| s.spring = SpringRate::RideFrequency(6.0));
        plan.vehicle.steering.max_angle = 0.06;
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 20.0);
        car.ask(&mut sim, |i| i.steer = 1.0);
        sim.seconds(1.0);
        // By now the car spins, and a tick of 1/30 s brings 8 % more acceleration. Load moves across in
        // proportion to that: the line through the last two ticks with load meets 0 where the wheels lift.
        let (mut before, mut last) = ((f32::NAN, 0.0), (f32::NAN, 0.0));
        for _ in 0..(20.0 * hz) as usize {
            car.ask(&mut sim, |i| i.throttle = 0.5);
            sim.ticks(1);
            let load = car.loads(&sim);
            let inner = load[1] + load[3];
            if inner <= 0.0 {
                break;
            }
            (before, last) = (last, (inner, car.telemetry(&sim).acceleration.x));
        }
        let lifted = last.1 + (last.1 - before.1) * last.0 / (before.0 - last.0);
        let height = car.pose(&sim).translation.y;
        let wanted = G * HALF_TRACK / height;
        found.within(format!("{hz} Hz: lifts"), lifted, wanted, 0.04);
    }
}

#[test]
fn the_rear_wheels_lift_where_the_brakes_would_tip_the_car() {
    // a = g b / h.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference()
            .tire(|t| t.friction = Vec2::splat(4.0))
            .suspension(|s| s.spring = SpringRate::RideFrequency(6.0));
        plan.vehicle.brakes = Brakes {
            torque: 20_000.0,
            balance: 1.0,
            hand_torque: 0.0,
        };
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 70.0);
        sim.seconds(0.5);
        let mut lifted = 0.0;
        let mut pose = car.pose(&sim);
        for tick in 0..(5.0 * hz) as usize {
            let time = tick as f32 / hz as f32;
            car.ask(&mut sim, |i| i.brake = 0.2 + 0.1 * time);
            // Contacts are those of the start of a tick.
            pose = car.pose(&sim);
            sim.ticks(1);
            let load = car.loads(&sim);
            if load[2] + load[3] < 1.0 {
                lifted = car.telemetry(&sim).acceleration.z;
                break;
            }
        }
        // The front contact seen from the centre of mass.
        let front = car.wheel(&sim, 0).contact.map_or(Vec3::NAN, |c| c.point);
        let arm = front - pose.translation;
        let wanted = G * -arm.z / -arm.y;
        found.within(format!("{hz} Hz: lifts"), lifted, wanted, 0.04);
    }
}
