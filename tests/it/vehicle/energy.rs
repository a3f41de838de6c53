//! No more energy in the car than its engine gave.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::{Patch, Sim};

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

#[test]
fn a_car_that_coasts_up_a_loop_arrives_with_the_speed_that_its_energy_leaves() {
    // Into a loop of 20 m at 34 m/s, by hard springs that keep the centre of mass where it is.
    let mut found = Findings::new();
    let (radius, speed, run_up) = (20.0f32, 34.0f32, 30.0f32);
    let point = |degrees: f32| {
        let up = radius * (1.0 - cos(degrees));
        Vec3::new(-5.0, up, -run_up - radius * sin(degrees))
    };
    // The body about the middle of the loop, its own pitch, and the wheels by what they roll.
    let arm = radius - HEIGHT;
    let wheels = 4.0 / (RADIUS * RADIUS);
    let inertia = MASS * arm * arm + 2400.0 + wheels * radius * radius;
    let left = (MASS + wheels) * speed * speed - 4.0 * MASS * G * arm;
    let wanted = ops::sqrt(left / inertia) * arm;
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let start = Vec3::new(-5.0, 0.0, 10.0);
        let mut band = Patch::new(start, Vec3::X * 10.0, Vec3::NEG_Z * (run_up + 10.0), 1, 1);
        for degree in 0..220u8 {
            let (from, to) = (point(degree.into()), point(f32::from(degree) + 1.0));
            band.add(from, Vec3::X * 10.0, to - from, 1, 1);
        }
        sim.fixed(band.collider(), Transform::default());
        let sag = SAG * (1.5 / 5.0) * (1.5 / 5.0);
        let plan = Plan::reference().wheel(|_, wheel| {
            wheel.suspension.spring = SpringRate::RideFrequency(5.0);
            wheel.attachment.y += SAG - sag;
        });
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * speed);
        let (mut top, mut there) = (0.0, 0.0);
        for _ in 0..(4.0 * hz) as usize {
            sim.ticks(1);
            let y = car.pose(&sim).translation.y;
            if y > top {
                (top, there) = (y, car.velocity(&sim).linear.length());
            }
        }
        found.near(format!("{hz} Hz: height"), top, 2.0 * radius - HEIGHT, 0.2);
        found.within(format!("{hz} Hz: speed at the top"), there, wanted, 0.02);
    }
}
