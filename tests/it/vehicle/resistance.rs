//! Air and rolling resistance: terminal speeds, coasting down, down-force.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Rolling resistance of 0.012 and `½ ρ CdA = 0.404`.
fn resisting() -> Plan {
    let mut plan = Plan::reference().tire(|t| t.rolling_resistance = 0.012);
    plan.vehicle.aero = Some(Aero {
        drag_area: 0.404 / (0.5 * 1.225),
        ..default()
    });
    plan
}

/// Speed after this time, from two sides of what is wanted.
fn settled(hz: f64, plan: &Plan, from: f32, seconds: f64) -> f32 {
    let mut sim = Sim::new(hz);
    // Long enough for a minute at 70 m/s.
    sim.fixed(
        bevy_rapier3d::prelude::Collider::cuboid(50.0, 0.5, 20_000.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
    );
    let car = plan.park(&mut sim, Quat::IDENTITY);
    sim.seconds(1.0);
    car.roll(&mut sim, Vec3::NEG_Z * from);
    car.ask(&mut sim, |i| i.throttle = 1.0);
    sim.seconds(seconds);
    car.telemetry(&sim).speed
}

#[test]
fn a_constant_force_leads_to_the_terminal_speed() {
    // √((2000 − 176.6) / 0.404) = 67.16 m/s.
    let mut found = Findings::new();
    for hz in RATES {
        let plan = resisting().direct(500.0, |_| true);
        for from in [63.0, 71.0] {
            let speed = settled(hz, &plan, from, 60.0);
            found.within(format!("{hz} Hz from {from}"), speed, 67.16, 0.01);
        }
    }
}

#[test]
fn a_constant_power_leads_to_the_terminal_speed() {
    // 176.6 v + 0.404 v³ = 100 kW at 60.46 m/s.
    let mut found = Findings::new();
    for hz in RATES {
        let mut plan = resisting().wheel(|_, w| w.driven = true);
        plan.vehicle.drivetrain = Some(Drivetrain {
            source: PowerSource::Motor(ElectricMotor {
                torque: 3000.0,
                power: 100.0e3,
                redline: 1.0e5,
                inertia: 0.01,
                recuperation: 0.0,
            }),
            gearbox: Gearbox {
                forward: vec![1.0],
                ..default()
            },
            final_drive: 4.0,
            efficiency: 1.0,
            ..default()
        });
        for from in [57.0, 64.0] {
            let speed = settled(hz, &plan, from, 50.0);
            found.within(format!("{hz} Hz from {from}"), speed, 60.46, 0.01);
        }
    }
}

#[test]
fn a_coasting_car_slows_down_as_the_formula_says() {
    // v = √(A/B) tan(atan(v₀ √(B/A)) − t √(AB) / m): 26.75 m/s after 10 s, rest after 175.9 s and 2137 m.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.fixed(
            bevy_rapier3d::prelude::Collider::cuboid(50.0, 0.5, 5000.0),
            Transform::from_xyz(0.0, -0.5, 0.0),
        );
        let car = resisting().park(&mut sim, Quat::IDENTITY);
        sim.seconds(2.0);
        car.roll(&mut sim, Vec3::NEG_Z * 30.0);
        let start = car.pose(&sim).translation.z;
        sim.seconds(10.0);
        found.within(
            format!("{hz} Hz: after 10 s"),
            car.telemetry(&sim).speed,
            26.75,
            0.01,
        );
        let mut time = 10.0;
        while car.telemetry(&sim).speed > 0.01 && time < 200.0 {
            sim.ticks(1);
            time += 1.0 / hz as f32;
        }
        found.within(format!("{hz} Hz: time"), time, 175.9, 0.02);
        let way = start - car.pose(&sim).translation.z;
        found.within(format!("{hz} Hz: way"), way, 2137.0, 0.02);
        sim.seconds(2.0);
        let rest = car.velocity(&sim).linear.length();
        found.at_most(format!("{hz} Hz: at rest"), rest, 1.0e-3);
    }
}

#[test]
fn down_force_adds_to_the_loads_with_the_square_of_the_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference();
        plan.vehicle.aero = Some(Aero {
            drag_area: 0.0,
            downforce_area: Vec2::new(0.5, 1.0),
            air_control: Vec3::ZERO,
        });
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 50.0);
        sim.seconds(4.0);
        let v = car.telemetry(&sim).speed;
        let load = car.loads(&sim);
        let unit = 0.5 * 1.225 * v * v;
        found.within(
            format!("{hz} Hz: sum"),
            load.iter().sum(),
            MASS * G + 1.5 * unit,
            0.005,
        );
        let rear = load[2] + load[3];
        found.within(format!("{hz} Hz: rear"), rear, MASS * G / 2.0 + unit, 0.01);
    }
}
