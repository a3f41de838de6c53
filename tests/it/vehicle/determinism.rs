//! The same inputs give the same bits; a state put back goes on as it did.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::{parry::math::Pose, prelude::*};
use embody_scenes::Sim;

use super::support::*;

fn plan() -> Plan {
    let mut plan = Plan::reference().wheel(|i, w| w.driven = i >= 2);
    plan.vehicle.drivetrain = Some(Drivetrain::default());
    plan.vehicle.anti_roll = vec![15_000.0, 10_000.0];
    plan
}

/// A drive of many manoeuvres.
fn script(sim: &mut Sim, car: &Car, tick: usize) {
    car.ask(sim, |i| {
        i.throttle = if tick % 300 < 200 { 1.0 } else { 0.0 };
        i.brake = if tick % 300 > 230 { 0.6 } else { 0.0 };
        i.steer = ((tick / 40) % 5) as f32 * 0.3 - 0.6;
        i.handbrake = if tick % 300 > 280 { 1.0 } else { 0.0 };
    });
}

fn bits(sim: &Sim, car: &Car) -> Vec<u32> {
    let (pose, velocity, state) = (car.pose(sim), car.velocity(sim), car.state(sim));
    let mut bits: Vec<u32> = [pose.translation, velocity.linear, velocity.angular]
        .iter()
        .flat_map(Vec3::to_array)
        .chain(pose.rotation.to_array())
        .map(f32::to_bits)
        .collect();
    bits.push(state.engine_speed.to_bits());
    for w in &state.wheels {
        bits.extend([
            w.spin.to_bits(),
            w.bristle.x.to_bits(),
            w.compression.to_bits(),
        ]);
    }
    bits
}

#[test]
fn two_runs_are_equal_bit_for_bit() {
    let run = || {
        let mut sim = Sim::threaded(60.0);
        plane(&mut sim, Quat::IDENTITY);
        let car = plan().park(&mut sim, Quat::IDENTITY);
        for tick in 0..600 {
            script(&mut sim, &car, tick);
            sim.ticks(1);
        }
        bits(&sim, &car)
    };
    let first = run();
    assert_eq!(first, run());
    assert_eq!(first, run());
}

#[test]
fn other_cars_and_the_order_of_spawning_do_not_matter() {
    let run = |before: usize, after: usize| {
        let mut sim = Sim::threaded(60.0);
        plane(&mut sim, Quat::IDENTITY);
        let mut others = Vec::new();
        let mut other = |sim: &mut Sim, i: usize| {
            let at = Transform::from_xyz(500.0 + 10.0 * i as f32, HEIGHT, 0.0);
            others.push(plan().spawn(sim, at));
        };
        for i in 0..before {
            other(&mut sim, i);
        }
        let car = plan().park(&mut sim, Quat::IDENTITY);
        for i in 0..after {
            other(&mut sim, 20 + i);
        }
        for tick in 0..400 {
            script(&mut sim, &car, tick);
            for car in &others {
                script(&mut sim, car, tick + 77);
            }
            sim.ticks(1);
        }
        bits(&sim, &car)
    };
    let alone = run(0, 0);
    for (before, after) in [(1, 0), (0, 15), (7, 8)] {
        assert_eq!(alone, run(before, after), "{before} before, {after} after");
    }
}

#[test]
fn a_state_that_is_put_back_goes_on_as_it_did() {
    let mut sim = Sim::threaded(60.0);
    plane(&mut sim, Quat::IDENTITY);
    put_back(&mut sim, |_, _| {});
}

#[test]
fn a_state_with_every_helper_that_is_put_back_mid_drift_goes_on_as_it_did() {
    let mut sim = Sim::threaded(60.0);
    plane(&mut sim, Quat::IDENTITY);
    put_back(&mut sim, |sim, car| {
        insert(
            sim,
            car.body,
            (
                AntiLockBrakes::default(),
                TractionControl::default(),
                StabilityControl::default(),
                HillHold::default(),
                LeanControl::default(),
                ProbeInterval { ticks: 3 },
            ),
        );
    });
}

fn put_back(sim: &mut Sim, equip: impl FnOnce(&mut Sim, &Car)) {
    let car = plan().park(sim, Quat::IDENTITY);
    equip(sim, &car);
    for tick in 0..200 {
        script(sim, &car, tick);
        sim.ticks(1);
    }
    let kept = (car.pose(sim), car.velocity(sim), car.state(sim));
    let drive = |sim: &mut Sim, car: &Car| {
        for tick in 200..500 {
            script(sim, car, tick);
            sim.ticks(1);
        }
        bits(sim, car)
    };
    let first = drive(sim, &car);
    // Straight into the body: on the way through a matrix a rotation loses its last bits.
    let world = sim.app.world_mut();
    let handle = world
        .get::<RapierRigidBodyHandle>(car.body)
        .expect("a body")
        .0;
    let mut sets = world.query::<&mut RapierRigidBodySet>();
    let mut set = sets.single_mut(world).expect("one world");
    let body = set.bodies.get_mut(handle).expect("the body is there");
    let pose = Pose::from_parts(kept.0.translation, kept.0.rotation);
    body.set_position(pose, true);
    edit::<Velocity>(sim, car.body, |v| *v = kept.1);
    edit::<VehicleState>(sim, car.body, |s| *s = kept.2.clone());
    assert_eq!(first, drive(sim, &car));
}

#[test]
fn a_new_state_is_equal_to_itself() {
    // What is no number would be not.
    assert_eq!(VehicleState::default(), VehicleState::default());
}

#[test]
fn a_lap_takes_as_long_and_ends_where_it_does_at_every_tick_rate() {
    let mut found = Findings::new();
    let run = |hz: f64| {
        let mut sim = Sim::threaded(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference().direct(400.0, |i| i >= 2);
        plan.vehicle.steering.max_angle = 0.1;
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.ask(&mut sim, |i| {
            i.throttle = 1.0;
            i.steer = 1.0;
        });
        let mut turned = 0.0;
        let mut time = 0.0;
        let mut last = forward(&car.pose(&sim));
        while turned < core::f32::consts::TAU && time < 60.0 {
            sim.ticks(1);
            let now = forward(&car.pose(&sim));
            // The arc cosine of nearly 1 has no digits: the sine of the small angle does.
            turned += last.cross(now).length();
            last = now;
            time += 1.0 / hz as f32;
        }
        (time, car.telemetry(&sim).speed)
    };
    let best = run(240.0);
    for hz in [30.0, 60.0, 120.0] {
        let (time, speed) = run(hz);
        found.within(format!("{hz} Hz: time"), time, best.0, 0.03);
        found.within(format!("{hz} Hz: speed"), speed, best.1, 0.03);
    }
}
