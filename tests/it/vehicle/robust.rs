//! Extremes: stiffness, damping, mass, friction, time step, bad numbers.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Kinetic and potential energy of the body, joules.
fn energy(sim: &Sim, car: &Car, plan: &Plan) -> f32 {
    let v = car.velocity(sim);
    let pose = car.pose(sim);
    let spin = pose.rotation.inverse() * v.angular;
    let inertia = plan.mass.inertia;
    0.5 * plan.mass.mass * v.linear.length_squared()
        + 0.5 * (spin * spin).dot(inertia)
        + plan.mass.mass * G * pose.translation.y
}

#[test]
fn no_stiffness_or_damping_makes_a_dropped_car_gain_energy() {
    let mut found = Findings::new();
    for hz in RATES {
        for stiffness in [1.0e3, 1.0e5, 1.0e6, 1.0e7, 1.0e8] {
            for damping in [0.0, 1.0e3, 1.0e5, 1.0e7] {
                let plan = Plan::reference().suspension(|s| {
                    s.spring = SpringRate::Stiffness(stiffness);
                    s.damping = Damper::Coefficient {
                        bump: damping,
                        rebound: damping,
                    };
                });
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let at = Transform::from_xyz(0.0, HEIGHT + 0.4, 0.0)
                    .with_rotation(Quat::from_rotation_z(0.1));
                let car = plan.spawn(&mut sim, at);
                sim.ticks(1);
                let start = energy(&sim, &car, &plan);
                let mut most = f32::MIN;
                let mut finite = true;
                for _ in 0..(4.0 * hz) as usize {
                    sim.ticks(1);
                    most = most.max(energy(&sim, &car, &plan));
                    finite &= car.finite(&sim);
                }
                let case = format!("{hz} Hz {stiffness:e} N/m {damping:e} N·s/m");
                found.holds(format!("{case}: finite"), finite);
                found.at_most(format!("{case}: energy"), most, start * 1.01);
            }
        }
    }
}

#[test]
fn random_vehicles_stay_finite_and_gain_no_energy_without_input() {
    let mut found = Findings::new();
    for seed in 0..60 {
        let mut dice = Dice::new(seed * 7919 + 1);
        for _ in 0..10 {
            dice.roll();
        }
        let hz = f64::from(dice.scale(20.0, 500.0));
        let mass = dice.scale(20.0, 40_000.0);
        let count = 2 + (dice.roll() * 14.9) as usize;
        let size = dice.between(0.5, 4.0);
        let mut plan = Plan::reference();
        plan.mass = VehicleMass::of_box(mass, Vec3::new(size, 0.5 * size, 2.0 * size), Vec3::ZERO);
        let stiffness = mass * dice.scale(10.0, 2000.0) / count as f32;
        let ratio = dice.between(0.0, 5.0);
        let friction = dice.between(0.0, 5.0);
        let model = match seed % 3 {
            0 => TireModel::Brush {
                stiffness: dice.scale(1.0e3, 1.0e6),
            },
            1 => TireModel::Linear {
                stiffness: dice.scale(1.0e3, 1.0e6),
            },
            _ => TireModel::Magic {
                b: dice.between(4.0, 20.0),
                c: dice.between(1.0, 2.0),
                e: dice.between(-2.0, 1.0),
            },
        };
        let sample = plan.wheels[0].clone();
        plan.wheels = (0..count)
            .map(|i| {
                let mut wheel = sample.clone();
                wheel.attachment = Vec3::new(
                    if i % 2 == 0 { -0.5 } else { 0.5 } * size,
                    0.0,
                    dice.between(-1.0, 1.0) * size,
                );
                wheel.axle = (i / 2) as u8;
                wheel.suspension.spring = SpringRate::Stiffness(stiffness);
                wheel.suspension.damping = Damper::Ratio {
                    bump: ratio,
                    rebound: ratio,
                };
                wheel.tire.friction = Vec2::splat(friction);
                wheel.tire.along = model.clone();
                wheel.tire.across = model.clone();
                wheel
            })
            .collect();
        plan.vehicle.anti_roll = vec![dice.between(0.0, 2.0) * stiffness; 8];
        plan.hull = Collider::cuboid(0.5 * size, 0.1, size);
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let at = Transform::from_xyz(0.0, 1.2, 0.0)
            .with_rotation(Quat::from_rotation_z(dice.between(-0.4, 0.4)));
        let car = plan.spawn(&mut sim, at);
        sim.ticks(2);
        let heading = Quat::from_rotation_y(dice.between(-3.0, 3.0)) * Vec3::NEG_Z;
        car.push(&mut sim, heading * dice.between(0.0, 30.0));
        sim.ticks(1);
        let start = energy(&sim, &car, &plan);
        let mut most = f32::MIN;
        let mut finite = true;
        let case = format!("seed {seed}: {hz:.0} Hz {mass:.0} kg {count} wheels µ {friction:.1}");
        for _ in 0..(3.0 * hz) as usize {
            sim.ticks(1);
            most = most.max(energy(&sim, &car, &plan));
            finite &= car.finite(&sim);
        }
        found.holds(format!("{case}: finite"), finite);
        found.at_most(format!("{case}: energy"), most, start * 1.02 + 1.0);
    }
}

#[test]
fn a_tick_of_a_tenth_of_a_second_among_others_does_no_harm() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let plan = Plan::reference().direct(1500.0, |_| true);
        let car = plan.park(&mut sim, Quat::IDENTITY);
        car.ask(&mut sim, |i| {
            i.throttle = 1.0;
            i.steer = 0.1;
        });
        sim.seconds(2.0);
        for _ in 0..5 {
            sim.set_hz(10.0);
            sim.ticks(1);
            sim.set_hz(hz);
            sim.ticks(20);
        }
        found.holds(format!("{hz} Hz: finite"), car.finite(&sim));
        let upright = (car.pose(&sim).rotation * Vec3::Y).y;
        found.at_least(format!("{hz} Hz: upright"), upright, 0.98);
        found.at_most(
            format!("{hz} Hz: height"),
            car.pose(&sim).translation.y,
            HEIGHT + 0.1,
        );
    }
}

#[test]
fn an_upside_down_car_is_not_held_by_its_wheels() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let at = Transform::from_xyz(0.0, 1.5, 0.0)
            .with_rotation(Quat::from_rotation_z(core::f32::consts::PI));
        let car = Plan::reference().spawn(&mut sim, at);
        sim.seconds(3.0);
        for wheel in car.all(&sim) {
            found.near(format!("{hz} Hz: load"), wheel.load, 0.0, 0.0);
        }
        found.at_most(format!("{hz} Hz: lies"), car.pose(&sim).translation.y, 0.35);
        found.holds(format!("{hz} Hz: finite"), car.finite(&sim));
    }
}

#[test]
fn a_wheel_does_not_climb_a_wall_beside_it() {
    let mut found = Findings::new();
    for hz in RATES {
        for probe in [
            WheelProbe::Ray,
            WheelProbe::Cylinder,
            WheelProbe::Sphere { radius: 0.25 },
        ] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            for x in [-1.45, 1.45] {
                sim.block(Vec3::new(x, 1.0, 0.0), Vec3::new(1.0, 2.0, 20.0));
            }
            let plan = Plan::reference().wheel(|_, w| w.probe = probe);
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(4.0);
            let y = car.pose(&sim).translation.y;
            found.near(format!("{hz} Hz {probe:?}: height"), y, HEIGHT, 0.01);
            let v = car.velocity(&sim).linear.length();
            found.at_most(format!("{hz} Hz {probe:?}: rest"), v, 0.01);
        }
    }
}

#[test]
fn an_intent_that_is_no_number_is_taken_as_nothing_asked() {
    let mut found = Findings::new();
    for hz in RATES {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let car = Plan::reference()
                .direct(500.0, |_| true)
                .park(&mut sim, Quat::IDENTITY);
            car.ask(&mut sim, |i| {
                *i = VehicleIntent {
                    throttle: bad,
                    brake: bad,
                    handbrake: bad,
                    steer: bad,
                    clutch: bad,
                    air: Vec3::splat(bad),
                    ..default()
                };
            });
            sim.seconds(2.0);
            found.holds(format!("{hz} Hz {bad}: finite"), car.finite(&sim));
            car.ask(&mut sim, |i| *i = VehicleIntent::default());
            sim.seconds(1.0);
            car.ask(&mut sim, |i| i.throttle = 1.0);
            sim.seconds(1.0);
            let speed = car.telemetry(&sim).speed;
            found.at_least(format!("{hz} Hz {bad}: drives again"), speed, 0.5);
        }
    }
}

#[test]
fn a_config_out_of_range_leaves_a_body_without_wheels_until_it_is_mended() {
    type Spoil = fn(&mut Wheel, f32);
    let mut found = Findings::new();
    let fields: [(&str, Spoil, &[f32]); 6] = [
        ("radius", |w, v| w.radius = v, &[f32::NAN, 0.0, -1.0]),
        ("inertia", |w, v| w.inertia = v, &[f32::NAN, 0.0]),
        ("travel", |w, v| w.suspension.travel = v, &[f32::NAN, 0.0]),
        ("friction", |w, v| w.tire.friction.x = v, &[f32::NAN, -1.0]),
        ("load", |w, v| w.tire.nominal_load = v, &[f32::NAN, 0.0]),
        (
            "attachment",
            |w, v| w.attachment.x = v,
            &[f32::NAN, f32::INFINITY],
        ),
    ];
    for (name, spoil, values) in fields {
        for value in values {
            let mut sim = Sim::new(60.0);
            sim.floor(0.0);
            let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
            sim.seconds(0.5);
            edit::<Wheel>(&mut sim, car.wheels[1], |w| spoil(w, *value));
            sim.seconds(2.0);
            let case = format!("{name} {value}");
            found.holds(format!("{case}: finite"), car.finite(&sim));
            // It lies on its hull.
            found.at_most(format!("{case}: lies"), car.pose(&sim).translation.y, 0.15);
            let sound = Plan::reference().wheels[1].clone();
            edit::<Wheel>(&mut sim, car.wheels[1], |w| *w = sound);
            sim.seconds(4.0);
            let y = car.pose(&sim).translation.y;
            found.near(format!("{case}: stands again"), y, HEIGHT, 0.01);
        }
    }
}
