//! Drive: traction at the wheel, launches, gears, differentials.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::{Sim, drivelines::*};

use super::support::*;

/// Lets the car roll with its engine turning as fast as its wheels make it.
fn in_gear(sim: &mut Sim, car: &Car, speed: f32, ratio: f32) {
    car.push(sim, Vec3::NEG_Z * speed);
    edit::<VehicleState>(sim, car.body, |state| {
        state.engine_speed = speed / CORVETTE_RADIUS * ratio;
        for wheel in &mut state.wheels {
            wheel.spin = speed / CORVETTE_RADIUS;
        }
    });
}

#[test]
fn traction_is_torque_times_gears_times_efficiency_over_radius() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        // Next to no inertia: all of the torque goes to the wheels.
        let car = corvette(1.0e-4).spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 150.0));
        sim.seconds(1.0);
        in_gear(&mut sim, &car, 20.0 / 3.6, CORVETTE_RATIO);
        sim.ticks(2);
        let rpm = car.telemetry(&sim).rpm;
        found.within(format!("{hz} Hz: rpm"), rpm, 1419.0, 0.001);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(0.5);
        let torque: f32 = car.all(&sim).iter().map(|w| w.drive_torque).sum();
        found.within(format!("{hz} Hz: traction"), torque / 0.34, 8391.0, 0.001);
    }
}

#[test]
fn a_car_accelerates_as_its_effective_mass_says() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = corvette(0.2).spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 150.0));
        sim.seconds(1.0);
        let ratio = CORVETTE_RATIO;
        in_gear(&mut sim, &car, 5.0, ratio);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(0.7);
        let before = car.velocity(&sim).linear.length();
        sim.seconds(0.7);
        let after = car.velocity(&sim).linear.length();
        // What the flywheel takes is lost before the gearbox, so it counts with its efficiency.
        let mass = MASS + (4.0 + 0.2 * ratio * ratio * 0.7) / (0.34 * 0.34);
        let wanted = 448.0 * ratio * 0.7 / 0.34 / mass;
        found.within(format!("{hz} Hz"), (after - before) / 0.7, wanted, 0.01);
    }
}

#[test]
fn engine_speed_and_car_speed_are_tied_by_the_gears() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = corvette(0.2).spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 190.0));
        sim.seconds(1.0);
        in_gear(&mut sim, &car, 10.0, CORVETTE_RATIO);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        let mut highest = 0.0f32;
        for _ in 0..(6.0 * hz) as usize {
            sim.ticks(1);
            highest = highest.max(car.telemetry(&sim).rpm);
        }
        // At the limiter: 6000 rpm in first are 20.72 m/s at 0.3 m, 23.48 at 0.34.
        found.near(format!("{hz} Hz: rpm"), highest, 6000.0, 200.0);
        let spin = car.wheel(&sim, 2).spin * 0.5 + car.wheel(&sim, 3).spin * 0.5;
        let rpm = spin * CORVETTE_RATIO * 60.0 / core::f32::consts::TAU;
        found.within(
            format!("{hz} Hz: tied"),
            car.telemetry(&sim).rpm,
            rpm,
            0.001,
        );
        found.near(
            format!("{hz} Hz: speed"),
            car.telemetry(&sim).speed,
            23.48,
            0.8,
        );
    }
}

#[test]
fn an_engine_in_neutral_stays_between_idle_and_redline() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let mut plan = Plan::reference().wheel(|_, w| w.driven = true);
        plan.vehicle.drivetrain = Some(Drivetrain::default());
        let car = plan.park(&mut sim, Quat::IDENTITY);
        car.ask(&mut sim, |i| i.gear = Gear::Neutral);
        sim.seconds(2.0);
        found.near(
            format!("{hz} Hz: idle"),
            car.telemetry(&sim).rpm,
            850.0,
            40.0,
        );
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(2.0);
        for _ in 0..hz as usize {
            sim.ticks(1);
            found.near(
                format!("{hz} Hz: limited"),
                car.telemetry(&sim).rpm,
                6500.0,
                200.0,
            );
        }
    }
}

#[test]
fn launches_of_each_drive_layout_take_as_long_as_their_grip_says() {
    // To 100 km/h on flat friction 1: all 2.83 s, rear 4.55 s, front 6.78 s.
    let mut found = Findings::new();
    // A little more force than the tyres hold: what spins the wheels up pitches the car.
    for (name, driven, force, wanted) in [
        ("all", [0, 1, 2, 3].as_slice(), 6000.0, 27.78 / 9.81),
        ("rear", &[2, 3], 5000.0, 27.78 / 6.10),
        ("front", &[0, 1], 3400.0, 27.78 / 4.10),
    ] {
        let mut times = Vec::new();
        for hz in RATES {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let plan = Plan::reference().direct(force, |i| driven.contains(&i));
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.ask(&mut sim, |i| i.throttle = 1.0);
            let speed = |sim: &Sim| car.velocity(sim).linear.length();
            let (mut ticks, mut before, mut now) = (0.0, 0.0, 0.0);
            while now < 100.0 / 3.6 && ticks < 20.0 * hz as f32 {
                // Spinning rear wheels do not hold the tail: the driver keeps the course.
                let (nose, yaw) = (forward(&car.pose(&sim)), car.velocity(&sim).angular.y);
                car.ask(&mut sim, |i| i.steer = 3.0 * -nose.x + 0.5 * yaw);
                sim.ticks(1);
                ticks += 1.0;
                (before, now) = (now, speed(&sim));
            }
            // Between the last two ticks.
            let time = (ticks - (now - 100.0 / 3.6) / (now - before)) / hz as f32;
            times.push(time);
            found.within(format!("{hz} Hz {name}"), time, wanted, 0.05);
        }
        let (first, last) = (times[0], times[3]);
        found.within(format!("{name}: 30 against 240 Hz"), first, last, 0.02);
    }
}

/// A car with one differential on ice to the left, asphalt to the right; forces of the driven wheels
/// and their loads after a second.
fn split(hz: f64, differential: Differential, torque: f32) -> (Vec<WheelState>, VehicleTelemetry) {
    let mut sim = Sim::new(hz);
    split_road(&mut sim);
    let plan = rear_motor(torque, differential);
    let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 100.0));
    sim.seconds(1.0);
    car.ask(&mut sim, |i| i.throttle = 1.0);
    sim.seconds(1.0);
    (car.all(&sim), car.telemetry(&sim))
}

#[test]
fn differentials_share_torque_as_their_kind_says() {
    let mut found = Findings::new();
    for hz in RATES {
        // Just enough to spin the wheel on ice: 0.1 · 3679 N · 0.3 m = 110 N·m there.
        let (wheels, _) = split(hz, Differential::Open, 400.0);
        let (left, right) = (&wheels[2], &wheels[3]);
        found.within(
            format!("{hz} Hz open: ice"),
            left.force.x,
            0.1 * left.load,
            0.01,
        );
        found.within(
            format!("{hz} Hz open: equal"),
            right.drive_torque,
            200.0,
            0.01,
        );
        found.within(
            format!("{hz} Hz open: equal"),
            left.drive_torque,
            200.0,
            0.01,
        );
        let bias = Differential::LimitedSlip {
            bias: 3.0,
            preload: 0.0,
        };
        let (wheels, _) = split(hz, bias, 600.0);
        let (left, right) = (&wheels[2], &wheels[3]);
        let ratio = right.drive_torque / left.drive_torque;
        found.within(format!("{hz} Hz bias 3: ratio"), ratio, 3.0, 0.01);
        let (wheels, _) = split(hz, Differential::Locked, 3000.0);
        let (left, right) = (&wheels[2], &wheels[3]);
        found.near(
            format!("{hz} Hz locked: speed"),
            left.spin,
            right.spin,
            1.0e-3,
        );
        let force = left.force.x + right.force.x;
        let wanted = 0.1 * left.load + right.load;
        found.within(
            format!("{hz} Hz locked: both at their limit"),
            force,
            wanted,
            0.01,
        );
    }
}

#[test]
fn an_unequal_split_between_the_axles_is_the_configured_one() {
    let mut found = Findings::new();
    for hz in RATES {
        for front in [0.3, 0.6] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = corvette(0.1).wheel(|_, w| w.driven = true);
            if let Some(drivetrain) = &mut plan.vehicle.drivetrain {
                let axle = |axle, share| DrivenAxle {
                    axle,
                    share,
                    differential: Differential::Open,
                };
                drivetrain.axles = vec![axle(0, front), axle(1, 1.0 - front)];
            }
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 150.0));
            sim.seconds(1.0);
            in_gear(&mut sim, &car, 8.0, CORVETTE_RATIO);
            car.ask(&mut sim, |i| i.throttle = 0.5);
            sim.seconds(0.5);
            let t: Vec<f32> = car.all(&sim).iter().map(|w| w.drive_torque).collect();
            let part = (t[0] + t[1]) / t.iter().sum::<f32>();
            found.within(format!("{hz} Hz {front}"), part, front, 0.01);
        }
    }
}

#[test]
fn an_open_differential_turns_its_input_with_the_mean_of_its_wheels() {
    let mut found = Findings::new();
    for hz in RATES {
        let (wheels, telemetry) = split(hz, Differential::Open, 400.0);
        let mean = (wheels[2].spin + wheels[3].spin) * 0.5;
        let rpm = mean * 60.0 / core::f32::consts::TAU;
        found.within(format!("{hz} Hz"), telemetry.rpm, rpm, 0.001);
        found.at_least(
            format!("{hz} Hz: spins"),
            wheels[2].spin,
            2.0 * wheels[3].spin,
        );
    }
}

#[test]
fn a_default_car_drives_off_shifts_up_and_reverses() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference().wheel(|i, w| w.driven = i < 2);
        plan.vehicle.drivetrain = Some(Drivetrain::default());
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(2.0);
        // In gear at idle it does not creep.
        found.at_most(
            format!("{hz} Hz: creep"),
            car.velocity(&sim).linear.length(),
            1.0e-3,
        );
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(15.0);
        let fast = car.telemetry(&sim);
        found.at_least(format!("{hz} Hz: gear"), f32::from(fast.gear), 3.0);
        found.at_least(format!("{hz} Hz: speed"), fast.speed, 25.0);
        car.ask(&mut sim, |i| {
            i.throttle = 0.0;
            i.brake = 1.0;
        });
        sim.seconds(8.0);
        found.at_most(
            format!("{hz} Hz: stands"),
            car.telemetry(&sim).speed.abs(),
            0.01,
        );
        car.ask(&mut sim, |i| {
            i.brake = 0.0;
            i.throttle = 0.5;
            i.gear = Gear::Reverse;
        });
        sim.seconds(4.0);
        found.at_most(format!("{hz} Hz: reverse"), car.telemetry(&sim).speed, -2.0);
    }
}
