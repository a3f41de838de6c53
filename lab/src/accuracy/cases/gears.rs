//! Engine, gears, differentials. Rapier's controller has none of them.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::reference::{Car, HEIGHT, MASS, Plan, plane};

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
        "vehicle A16",
        "open differential on ice and asphalt: torque right by left",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, _| {
                ratio(wheels[3].drive_torque, wheels[2].drive_torque)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "open differential: force on ice, of µ N",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, _| {
                ratio(wheels[2].force.x, 0.1 * wheels[2].load)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "open differential: input speed by the mean of its wheels",
        "",
        1.0,
        0.001,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, shaft| {
                ratio(shaft, 0.5 * (wheels[2].spin + wheels[3].spin))
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "torque bias 3: torque right by left",
        "",
        3.0,
        0.01,
        |s| {
            of_split(s, BIAS, 600.0, |wheels, _| {
                ratio(wheels[3].drive_torque, wheels[2].drive_torque)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "locked differential: speed right by left",
        "",
        1.0,
        0.001,
        |s| {
            of_split(s, Differential::Locked, 3000.0, |wheels, _| {
                ratio(wheels[3].spin, wheels[2].spin)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "locked differential: both forces, of µ N of both",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Locked, 3000.0, |wheels, _| {
                let limit = 0.1 * wheels[2].load + wheels[3].load;
                ratio(wheels[2].force.x + wheels[3].force.x, limit)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "torque of the front axle of a centre differential of 0.3 to 0.7",
        "",
        0.3,
        0.01,
        |s| front_share(s, 0.3),
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

const BIAS: Differential = Differential::LimitedSlip {
    bias: 3.0,
    preload: 0.0,
};
/// Radius of the wheels, metres.
const RADIUS: f32 = 0.34;
/// Gear and final drive.
const RATIO: f32 = 2.66 * 3.42;

fn ratio(a: f32, b: f32) -> f64 {
    f64::from(a) / f64::from(b)
}

/// 448 N·m at every speed, gear 2.66, final drive 3.42, efficiency 0.7, wheels of 0.34 m; an engine of
/// this inertia (kg·m²).
fn corvette(inertia: f32) -> Plan {
    let mut plan = Plan::reference().wheel(|i, wheel| {
        wheel.driven = i >= 2;
        wheel.radius = RADIUS;
        wheel.attachment.y += 0.04;
        wheel.tire.friction = Vec2::splat(3.0);
    });
    plan.vehicle.drivetrain = Some(Drivetrain {
        source: PowerSource::Engine(Engine {
            torque: vec![TorquePoint {
                rpm: 1000.0,
                torque: 448.0,
            }],
            idle: 700.0,
            redline: 6000.0,
            inertia,
            friction: 0.0,
            viscosity: 0.0,
            stall: None,
        }),
        clutch: Clutch {
            torque: 2000.0,
            automatic: false,
        },
        gearbox: Gearbox {
            forward: vec![2.66, 1.78],
            reverse: 2.9,
            shift_time: 0.3,
            shifting: Shifting::Manual,
        },
        final_drive: 3.42,
        efficiency: 0.7,
        ..default()
    });
    plan
}

/// A plan's car on a plane.
fn parked(mut s: Stage, plan: &Plan) -> Option<(Stage, Car)> {
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 500.0));
    s.sim.seconds(1.0);
    let car = s.own()?;
    Some((s, car))
}

/// Rolls at this speed in first gear, its engine turning along.
fn set_rolling(s: &mut Stage, car: &Car, speed: f32) {
    s.push(Vec3::NEG_Z * speed);
    let world = s.sim.app.world_mut();
    if let Some(mut state) = world.get_mut::<VehicleState>(car.body) {
        state.engine_speed = speed / RADIUS * RATIO;
        for wheel in &mut state.wheels {
            wheel.spin = speed / RADIUS;
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
    ratio(torque, RADIUS)
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

/// A car with this differential between its rear wheels, ice to the left and asphalt to the right,
/// after a second of such a torque; `read` is given its wheels and the speed of the input shaft.
fn of_split(
    mut s: Stage,
    differential: Differential,
    torque: f32,
    read: fn(&[WheelState], f32) -> f64,
) -> f64 {
    for (x, friction) in [(-50.0, 0.1), (50.0, 1.0)] {
        let size = Vec3::new(100.0, 1.0, 400.0);
        let slab = s.sim.block(Vec3::new(x, -0.5, 0.0), size);
        let mut slab = s.sim.app.world_mut().entity_mut(slab);
        slab.insert(SurfaceFriction::new(friction));
    }
    let mut plan = Plan::reference().wheel(|i, wheel| wheel.driven = i >= 2);
    plan.vehicle.drivetrain = Some(Drivetrain {
        source: PowerSource::Motor(ElectricMotor {
            torque,
            power: 1.0e9,
            redline: 1.0e6,
            inertia: 1.0e-3,
            recuperation: 0.0,
        }),
        gearbox: Gearbox {
            forward: vec![1.0],
            ..default()
        },
        final_drive: 1.0,
        efficiency: 1.0,
        axles: vec![axle(1, 1.0, differential)],
        ..default()
    });
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 100.0));
    s.sim.seconds(1.0);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(1.0);
    let Some(car) = s.own() else { return f64::NAN };
    read(&car.all(&s.sim), car.state(&s.sim).engine_speed)
}

fn axle(axle: u8, share: f32, differential: Differential) -> DrivenAxle {
    DrivenAxle {
        axle,
        share,
        differential,
    }
}

fn front_share(s: Stage, front: f32) -> f64 {
    let mut plan = corvette(0.1).wheel(|_, wheel| wheel.driven = true);
    if let Some(drivetrain) = &mut plan.vehicle.drivetrain {
        let open = Differential::Open;
        drivetrain.axles = vec![axle(0, front, open), axle(1, 1.0 - front, open)];
    }
    let Some((mut s, car)) = parked(s, &plan) else {
        return f64::NAN;
    };
    set_rolling(&mut s, &car, 8.0);
    s.ask(0.5, 0.0, 0.0);
    s.sim.seconds(0.5);
    let wheels = car.all(&s.sim);
    let of = |wheels: &[WheelState]| wheels.iter().map(|w| w.drive_torque).sum::<f32>();
    ratio(of(&wheels[..2]), of(&wheels))
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
