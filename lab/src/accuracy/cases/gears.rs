//! Engine and gears. Rapier's controller has neither.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::{
    drivelines::{CORVETTE_RADIUS, CORVETTE_RATIO, corvette},
    reference::{Car, HEIGHT, MASS, Plan, plane},
};

use super::{Case, Stage, alone, case, nothing};

pub const CASES: &[Case] = &[
    alone(case(
        "vehicle A5",
        "traction in first gear: T i η / R",
        "N",
        8391.0,
        0.001,
        traction,
    )),
    alone(case(
        "vehicle A5",
        "engine speed at 20 km/h in first gear",
        "rpm",
        1419.0,
        0.001,
        |s| {
            geared(s, 1.0e-4, 20.0 / 3.6)
                .map_or(f64::NAN, |(s, car)| car.telemetry(&s.sim).rpm.into())
        },
    )),
    // (T i η / R) / (m + (Σ I + I_e i² η) / R²).
    alone(case(
        "vehicle A5",
        "acceleration with the inertia of wheels and engine",
        "m/s²",
        5.1325,
        0.01,
        effective_mass,
    )),
    alone(case(
        "vehicle A17",
        "speed at 6000 rpm in first gear, wheels of 0.34 m",
        "m/s",
        23.483,
        0.005,
        first_gear,
    )),
    alone(case(
        "vehicle A17",
        "time without traction in a shift of 0.3 s",
        "s",
        0.3,
        0.01,
        shift_time,
    )),
    alone(nothing(
        "vehicle A17",
        "shifts up while wheels spin on ice",
        "",
        0.0,
        upshifts_on_ice,
    )),
    alone(nothing(
        "vehicle A17",
        "engine at its limiter, off its redline",
        "rpm",
        200.0,
        limiter,
    )),
    alone(nothing(
        "vehicle A17",
        "engine at idle, off its idle speed",
        "rpm",
        40.0,
        idle,
    )),
    alone(nothing(
        "vehicle A17",
        "energy of a launch beyond what the engine gave, in parts of that",
        "",
        0.005,
        energy,
    )),
];

pub fn ratio(a: f32, b: f32) -> f64 {
    f64::from(a) / f64::from(b)
}

/// A plan's car on a plane.
pub fn parked(mut s: Stage, plan: &Plan) -> Option<(Stage, Car)> {
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 500.0));
    s.sim.seconds(1.0);
    let car = s.own()?;
    Some((s, car))
}

/// Rolls at this speed in first gear, its engine turning along.
pub fn set_rolling(s: &mut Stage, car: &Car, speed: f32) {
    s.push(Vec3::NEG_Z * speed);
    let world = s.sim.app.world_mut();
    if let Some(mut state) = world.get_mut::<VehicleState>(car.body) {
        state.engine_speed = speed / CORVETTE_RADIUS * CORVETTE_RATIO;
        for wheel in &mut state.wheels {
            wheel.spin = speed / CORVETTE_RADIUS;
        }
    }
    s.sim.ticks(2);
}

fn geared(s: Stage, inertia: f32, speed: f32) -> Option<(Stage, Car)> {
    let (mut s, car) = parked(s, &corvette(inertia))?;
    set_rolling(&mut s, &car, speed);
    Some((s, car))
}

fn traction(s: Stage) -> f64 {
    // Next to no inertia: all of the torque goes to the wheels.
    let Some((mut s, car)) = geared(s, 1.0e-4, 20.0 / 3.6) else {
        return f64::NAN;
    };
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(0.5);
    let torque: f32 = car.all(&s.sim).iter().map(|wheel| wheel.drive_torque).sum();
    ratio(torque, CORVETTE_RADIUS)
}

fn effective_mass(s: Stage) -> f64 {
    let Some((mut s, _)) = geared(s, 0.2, 5.0) else {
        return f64::NAN;
    };
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(0.7);
    let (v0, span) = (s.speed(), 0.7);
    s.sim.seconds(span);
    (s.speed() - v0) / span
}

fn first_gear(s: Stage) -> f64 {
    let Some((mut s, car)) = geared(s, 0.2, 20.0) else {
        return f64::NAN;
    };
    // Without torque, so that the tyres do not slip.
    s.sim.seconds(1.0);
    s.speed() * 6000.0 / f64::from(car.telemetry(&s.sim).rpm)
}

fn shift_time(s: Stage) -> f64 {
    let Some((mut s, car)) = geared(s, 0.2, 10.0) else {
        return f64::NAN;
    };
    s.ask(0.5, 0.0, 0.0);
    s.sim.seconds(0.5);
    car.ask(&mut s.sim, |intent| intent.gear = Gear::Number(2));
    let mut without = 0;
    for _ in 0..(1.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        let torque: f32 = car.all(&s.sim).iter().map(|w| w.drive_torque).sum();
        without += usize::from(torque.abs() < 1.0);
    }
    if car.telemetry(&s.sim).gear != 2 {
        return f64::NAN;
    }
    without as f64 * f64::from(s.sim.dt())
}

/// A front-driven car with the default engine and automatic.
fn automatic() -> Plan {
    let mut plan = Plan::reference().wheel(|i, wheel| wheel.driven = i < 2);
    plan.vehicle.drivetrain = Some(Drivetrain::default());
    plan
}

fn upshifts_on_ice(s: Stage) -> f64 {
    let plan = automatic().tire(|tire| tire.friction = Vec2::splat(0.05));
    let Some((mut s, car)) = parked(s, &plan) else {
        return f64::NAN;
    };
    s.ask(1.0, 0.0, 0.0);
    let mut highest = 1;
    for _ in 0..(4.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        highest = highest.max(car.telemetry(&s.sim).gear);
    }
    f64::from(highest - 1)
}

/// Greatest distance of the engine's speed from what it is held at in neutral, with this throttle.
fn held_speed(s: Stage, throttle: f32, rpm: f32) -> f64 {
    let Some((mut s, car)) = parked(s, &automatic()) else {
        return f64::NAN;
    };
    car.ask(&mut s.sim, |intent| {
        intent.gear = Gear::Neutral;
        intent.throttle = throttle;
    });
    s.sim.seconds(2.0);
    let mut off = 0.0f32;
    for _ in 0..(1.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        off = off.max((car.telemetry(&s.sim).rpm - rpm).abs());
    }
    off.into()
}

fn limiter(s: Stage) -> f64 {
    held_speed(s, 1.0, Engine::default().redline)
}

fn idle(s: Stage) -> f64 {
    held_speed(s, 0.0, Engine::default().idle)
}

fn energy(s: Stage) -> f64 {
    let Some((mut s, car)) = parked(s, &automatic()) else {
        return f64::NAN;
    };
    let inertia = Engine::default().inertia;
    let stored = |s: &Stage| {
        let state = car.state(&s.sim);
        let wheels: f32 = state.wheels.iter().map(|w| 0.5 * w.spin * w.spin).sum();
        let engine = 0.5 * inertia * state.engine_speed * state.engine_speed;
        f64::from(0.5 * MASS * s.velocity().linear.length_squared() + wheels + engine)
    };
    let start = stored(&s);
    s.ask(1.0, 0.0, 0.0);
    let (mut given, mut beyond) = (0.0, 0.0f64);
    let mut before = car.state(&s.sim).engine_speed;
    for _ in 0..(8.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        let now = car.state(&s.sim).engine_speed;
        let torque = car.telemetry(&s.sim).engine_torque;
        given += f64::from(torque * 0.5 * (before + now) * s.sim.dt());
        before = now;
        // Of the first little nothing can be told.
        if given > 1.0e4 {
            beyond = beyond.max((stored(&s) - start - given) / given);
        }
    }
    if given > 1.0e5 { beyond } else { f64::NAN }
}
