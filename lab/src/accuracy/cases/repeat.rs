//! The same again: bit for bit, and at other tick rates.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::{parry::math::Pose, prelude::*};
use embody_scenes::reference::{Car, HEIGHT, Plan, plane};

use super::{Case, Stage, alone, case, nothing, slow};

/// The rate that others are held against, hertz.
const FINEST: f64 = 240.0;

pub const CASES: &[Case] = &[
    nothing(
        "vehicle A21",
        "numbers that differ between two runs",
        "",
        0.0,
        |s| {
            let again = s.again(s.hz());
            differences(&alone_on_plane(s), &alone_on_plane(again))
        },
    ),
    alone(nothing(
        "vehicle A21",
        "numbers that differ after a state is put back",
        "",
        0.0,
        put_back,
    )),
    alone(nothing(
        "vehicle A21",
        "numbers that differ with 15 others, some spawned before",
        "",
        0.0,
        |s| {
            let again = s.again(s.hz());
            differences(&among(s, 0, 0), &among(again, 7, 8))
        },
    )),
    slow(case(
        "vehicle A21",
        "time to 100 km/h, of that at 240 Hz",
        "",
        1.0,
        0.02,
        |s| of_finest(s, sprint),
    )),
    slow(case(
        "vehicle A21",
        "way to stop from 100 km/h, of that at 240 Hz",
        "",
        1.0,
        0.02,
        |s| of_finest(s, stop),
    )),
    slow(case(
        "vehicle A21",
        "time of a lap, of that at 240 Hz",
        "",
        1.0,
        0.03,
        |s| of_finest(s, lap),
    )),
];

fn of_finest(s: Stage, measure: fn(Stage) -> f64) -> f64 {
    let finest = measure(s.again(FINEST));
    measure(s) / finest
}

/// Rear-wheel drive by an engine with gears on our side; the same force at full throttle on the other.
fn plan(s: &Stage) -> Plan {
    let mut plan = Plan::reference().wheel(|i, wheel| wheel.driven = i >= 2);
    plan.vehicle.anti_roll = vec![15_000.0, 10_000.0];
    if s.is_ours() {
        plan.vehicle.drivetrain = Some(Drivetrain::default());
    }
    plan
}

/// Throttle, brake and angle of the front wheels in a tick of a drive of many manoeuvres.
fn script(tick: usize) -> (f32, f32, f32) {
    let throttle = if tick % 300 < 200 { 1.0 } else { 0.0 };
    let brake = if tick % 300 > 230 { 0.6 } else { 0.0 };
    (throttle, brake, ((tick / 40) % 5) as f32 * 0.1 - 0.2)
}

fn drive(s: &mut Stage, ticks: core::ops::Range<usize>) {
    for tick in ticks {
        let (throttle, brake, angle) = script(tick);
        s.ask(throttle, brake, angle);
        s.sim.ticks(1);
    }
}

/// Every number of a car's motion and state.
fn bits(s: &Stage) -> Vec<u32> {
    let (pose, velocity) = (s.pose(), s.velocity());
    let mut bits: Vec<u32> = [pose.translation, velocity.linear, velocity.angular]
        .iter()
        .flat_map(Vec3::to_array)
        .chain(pose.rotation.to_array())
        .map(f32::to_bits)
        .collect();
    if let Some(car) = s.own() {
        let state = car.state(&s.sim);
        bits.push(state.engine_speed.to_bits());
        for wheel in &state.wheels {
            let of = [
                wheel.spin,
                wheel.bristle.x,
                wheel.bristle.y,
                wheel.compression,
            ];
            bits.extend(of.map(f32::to_bits));
        }
    }
    bits
}

fn differences(a: &[u32], b: &[u32]) -> f64 {
    let differing = a.iter().zip(b).filter(|(a, b)| a != b).count();
    (differing + a.len().abs_diff(b.len())) as f64
}

fn alone_on_plane(mut s: Stage) -> Vec<u32> {
    let plan = plan(&s);
    s.park(&plan, 6000.0, Quat::IDENTITY);
    drive(&mut s, 0..400);
    bits(&s)
}

/// With others that drive the same far away, some of which were spawned before.
fn among(mut s: Stage, before: usize, after: usize) -> Vec<u32> {
    let plan = plan(&s);
    plane(&mut s.sim, Quat::IDENTITY);
    let place = |i: usize| Transform::from_xyz(500.0 + 10.0 * i as f32, HEIGHT, 0.0);
    let mut others: Vec<Car> = (0..before)
        .map(|i| plan.spawn(&mut s.sim, place(i)))
        .collect();
    // So that the car is as old in every run.
    s.sim.ticks(1);
    s.spawn(&plan, 6000.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    others.extend((0..after).map(|i| plan.spawn(&mut s.sim, place(20 + i))));
    for tick in 0..400 {
        let (throttle, brake, _) = script(tick + 77);
        for car in &others {
            car.ask(&mut s.sim, |intent| {
                intent.throttle = throttle;
                intent.brake = brake;
            });
        }
        drive(&mut s, tick..tick + 1);
    }
    bits(&s)
}

fn put_back(mut s: Stage) -> f64 {
    let plan = plan(&s);
    s.park(&plan, 0.0, Quat::IDENTITY);
    drive(&mut s, 0..200);
    let Some(car) = s.own() else { return f64::NAN };
    let kept = (s.pose(), s.velocity(), car.state(&s.sim));
    drive(&mut s, 200..500);
    let first = bits(&s);
    // Straight into the body: on the way through a matrix a rotation loses its last bits.
    let world = s.sim.app.world_mut();
    let Some(handle) = world.get::<RapierRigidBodyHandle>(car.body).map(|h| h.0) else {
        return f64::NAN;
    };
    for mut set in world.query::<&mut RapierRigidBodySet>().iter_mut(world) {
        if let Some(body) = set.bodies.get_mut(handle) {
            let pose = Pose::from_parts(kept.0.translation, kept.0.rotation);
            body.set_position(pose, true);
        }
    }
    s.equip((kept.1, kept.2));
    drive(&mut s, 200..500);
    differences(&first, &bits(&s))
}

fn sprint(mut s: Stage) -> f64 {
    let plan = plan(&s);
    s.park(&plan, 6000.0, Quat::IDENTITY);
    s.sim.seconds(2.0);
    s.ask(1.0, 0.0, 0.0);
    let (mut before, mut now, mut t) = (0.0, 0.0, 0.0);
    let (dt, wanted) = (f64::from(s.sim.dt()), 100.0 / 3.6);
    while now < wanted {
        s.sim.ticks(1);
        t += dt;
        (before, now) = (now, s.speed());
        if t > 60.0 {
            return f64::NAN;
        }
    }
    // Between the last two ticks.
    t - (now - wanted) / (now - before) * dt
}

fn stop(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(2.0);
    s.roll(Vec3::NEG_Z * (100.0 / 3.6));
    let from = s.pose().translation;
    s.ask(0.0, 1.0, 0.0);
    if s.time_until(20.0, |s| s.speed() < 0.01).is_infinite() {
        return f64::NAN;
    }
    s.pose().translation.distance(from).into()
}

/// Once round with all of the throttle at a fixed angle of the wheels.
fn lap(mut s: Stage) -> f64 {
    let force = 800.0;
    let plan = Plan::reference().direct(force / 2.0, |i| i >= 2);
    s.park(&plan, force, Quat::IDENTITY);
    s.sim.seconds(1.0);
    s.ask(1.0, 0.0, 0.1);
    let (mut turned, mut t) = (0.0, 0.0);
    let mut last = s.pose().rotation * Vec3::NEG_Z;
    while turned < core::f32::consts::TAU {
        s.sim.ticks(1);
        t += f64::from(s.sim.dt());
        let now = s.pose().rotation * Vec3::NEG_Z;
        // The arc cosine of nearly 1 has no digits: the sine of the small angle does.
        turned += last.cross(now).length();
        last = now;
        if t > 60.0 {
            return f64::NAN;
        }
    }
    t
}
