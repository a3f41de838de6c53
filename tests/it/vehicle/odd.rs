//! Odd worlds and odd vehicles: few and many ticks per second, gravity aside or none, one wheel and
//! sixteen, far from the origin, on each other, between walls.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn sag_hold_and_stop_are_right_at_odd_tick_rates() {
    let mut found = Findings::new();
    for hz in [7.5, 10.0, 15.0, 20.0, 500.0, 1000.0] {
        let rotation = uphill(20.0);
        let mut sim = Sim::new(hz);
        plane(&mut sim, rotation);
        let car = Plan::reference().park(&mut sim, rotation);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(6.0);
        let start = car.pose(&sim).translation;
        sim.seconds(10.0);
        let moved = (car.pose(&sim).translation - start).length();
        found.at_most(format!("{hz} Hz: holds"), moved, 0.001);
        let sum: f32 = car.loads(&sim).iter().sum();
        found.within(format!("{hz} Hz: load"), sum, MASS * G * cos(20.0), 0.001);

        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference()
            .direct(1000.0, |_| true)
            .spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.1, 0.0));
        sim.seconds(4.0);
        for (i, wheel) in car.all(&sim).iter().enumerate() {
            let case = format!("{hz} Hz wheel {i}: sag");
            found.within(case, wheel.compression, SAG, 0.005);
        }
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(4.0);
        let mass = MASS + 4.0 / (RADIUS * RADIUS);
        let speed = car.velocity(&sim).linear.length();
        found.within(format!("{hz} Hz: speed"), speed, 16_000.0 / mass, 0.02);
        let from = car.pose(&sim).translation;
        car.ask(&mut sim, |i| {
            i.throttle = 0.0;
            i.brake = 1.0;
        });
        sim.seconds(4.0);
        let way = (car.pose(&sim).translation - from).length();
        let wanted = speed * speed / (2.0 * G);
        found.near(
            format!("{hz} Hz: stops"),
            way,
            wanted,
            0.03 * wanted + speed / hz as f32,
        );
        let rest = car.velocity(&sim).linear.length();
        found.at_most(format!("{hz} Hz: rests"), rest, 1.0e-3);
    }
}

#[test]
fn a_tick_rate_that_changes_leaves_a_parked_car_parked() {
    let rotation = uphill(15.0);
    let mut sim = Sim::new(60.0);
    plane(&mut sim, rotation);
    let car = Plan::reference().park(&mut sim, rotation);
    car.ask(&mut sim, |i| i.brake = 1.0);
    sim.seconds(6.0);
    let start = car.pose(&sim).translation;
    let mut found = Findings::new();
    for hz in [240.0, 15.0, 120.0, 30.0, 500.0, 60.0] {
        sim.set_hz(hz);
        let mut farthest = 0.0f32;
        for _ in 0..(2.0 * hz) as usize {
            sim.ticks(1);
            farthest = farthest.max((car.pose(&sim).translation - start).length());
        }
        found.at_most(format!("now {hz} Hz: moved"), farthest, 0.001);
    }
}

fn set_gravity(sim: &mut Sim, gravity: Vec3) {
    let world = sim.app.world_mut();
    let mut configs = world.query::<&mut RapierConfiguration>();
    for mut config in configs.iter_mut(world) {
        config.gravity = gravity;
    }
}

#[test]
fn down_is_where_gravity_points() {
    let mut found = Findings::new();
    for hz in RATES {
        for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
            let up = -axis;
            let rotation = Quat::from_rotation_arc(Vec3::Y, up);
            let mut sim = Sim::new(hz);
            set_gravity(&mut sim, axis * G);
            plane(&mut sim, rotation);
            let car = Plan::reference().park(&mut sim, rotation);
            sim.seconds(4.0);
            for (i, wheel) in car.all(&sim).iter().enumerate() {
                let case = format!("{hz} Hz {axis} wheel {i}: sag");
                found.within(case, wheel.compression, SAG, 0.005);
            }
            let off = car.pose(&sim).translation - up * HEIGHT;
            found.at_most(format!("{hz} Hz {axis}: stays"), off.length(), 0.002);
        }
    }
}

#[test]
fn without_gravity_a_car_floats_off_its_springs_and_stays_finite() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        set_gravity(&mut sim, Vec3::ZERO);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference()
            .direct(1000.0, |_| true)
            .park(&mut sim, Quat::IDENTITY);
        car.ask(&mut sim, |i| i.throttle = 0.2);
        sim.seconds(4.0);
        found.holds(format!("{hz} Hz: finite"), car.finite(&sim));
        let y = car.pose(&sim).translation.y;
        found.at_least(format!("{hz} Hz: off the ground"), y, HEIGHT + SAG);
        // No faster than the springs could make it: ½ k x² for each wheel.
        let most = SAG * (33_310.0 * 4.0 / MASS).sqrt();
        let v = car.velocity(&sim).linear.y;
        found.at_most(format!("{hz} Hz: upward"), v, most);
    }
}

#[test]
fn one_wheel_to_sixteen_carry_the_weight() {
    let mut found = Findings::new();
    for hz in [30.0, 60.0, 240.0] {
        for count in 1..=16usize {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = Plan::reference();
            let sample = plan.wheels[0].clone();
            plan.wheels = (0..count)
                .map(|i| {
                    let mut wheel = sample.clone();
                    // One in the middle, two in line, then pairs of both sides.
                    let side = if i % 2 == 0 { -HALF_TRACK } else { HALF_TRACK };
                    let z = (i / 2) as f32 - 0.25 * (count as f32 - 2.0);
                    (wheel.attachment.x, wheel.attachment.z) = match count {
                        1 => (0.0, 0.0),
                        2 => (0.0, 2.8 * i as f32 - 1.4),
                        3 => [(0.0, -1.4), (-0.8, 0.7), (0.8, 0.7)][i],
                        _ => (side, z),
                    };
                    wheel.axle = (i / 2) as u8;
                    wheel
                })
                .collect();
            plan.vehicle.anti_roll = vec![10_000.0; 8];
            let car = plan.park(&mut sim, Quat::IDENTITY);
            if count < 3 {
                let locks = LockedAxes::ROTATION_LOCKED_X | LockedAxes::ROTATION_LOCKED_Z;
                insert(&mut sim, car.body, locks);
            }
            sim.seconds(5.0);
            let sum: f32 = car.loads(&sim).iter().sum();
            let case = format!("{hz} Hz {count} wheels");
            found.within(format!("{case}: load"), sum, MASS * G, 0.002);
            let y = car.pose(&sim).translation.y;
            // An odd one stands askew, as no linear sharing balances it exactly.
            found.near(format!("{case}: height"), y, HEIGHT, 0.03);
            let still = car.velocity(&sim).linear.length();
            found.at_most(format!("{case}: still"), still, 0.001);
        }
    }
}

#[test]
fn far_from_the_origin_a_car_stands_drives_and_holds() {
    let mut found = Findings::new();
    for hz in RATES {
        for far in [1000.0f32, 5000.0] {
            let mut sim = Sim::new(hz);
            let center = Vec3::new(far, 0.0, -far);
            sim.block(center - Vec3::Y * 0.5, Vec3::new(400.0, 1.0, 400.0));
            let plan = Plan::reference().direct(1000.0, |_| true);
            let car = plan.spawn(
                &mut sim,
                Transform::from_translation(center + Vec3::Y * HEIGHT),
            );
            sim.seconds(3.0);
            let case = format!("{hz} Hz {far} m");
            let sum: f32 = car.loads(&sim).iter().sum();
            found.within(format!("{case}: load"), sum, MASS * G, 0.002);
            let start = car.pose(&sim).translation;
            sim.seconds(10.0);
            let drift = (car.pose(&sim).translation - start).length();
            // Two steps of the last digit that places have there.
            found.at_most(format!("{case}: drift"), drift, 2.0 * far * f32::EPSILON);
            car.ask(&mut sim, |i| i.throttle = 1.0);
            sim.seconds(3.0);
            let mass = MASS + 4.0 / (RADIUS * RADIUS);
            let speed = car.velocity(&sim).linear.length();
            found.within(format!("{case}: speed"), speed, 12_000.0 / mass, 0.02);
        }
    }
}

#[test]
fn a_car_on_the_roof_of_another_rests_there() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let mut lower = Plan::reference();
        lower.hull = Collider::compound(vec![(
            Vec3::Y * 0.3,
            Quat::IDENTITY,
            Collider::cuboid(1.2, 0.3, 2.2),
        )]);
        let lower = lower.park(&mut sim, Quat::IDENTITY);
        lower.ask(&mut sim, |i| i.brake = 1.0);
        // Its springs give another 11 cm under a second car.
        let roof = HEIGHT + 0.6 - SAG;
        let upper = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, roof + HEIGHT, 0.0));
        upper.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(8.0);
        let case = format!("{hz} Hz");
        let sum: f32 = lower.loads(&sim).iter().sum();
        found.within(format!("{case}: below"), sum, 2.0 * MASS * G, 0.005);
        let sum: f32 = upper.loads(&sim).iter().sum();
        found.within(format!("{case}: above"), sum, MASS * G, 0.005);
        let still = upper.velocity(&sim).linear.length() + lower.velocity(&sim).linear.length();
        found.at_most(format!("{case}: still"), still, 0.005);
    }
}

#[test]
fn a_car_wedged_between_two_walls_gains_no_speed() {
    let mut found = Findings::new();
    for hz in RATES {
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            for tilt in [60.0f32, 75.0, 90.0] {
                let mut sim = Sim::new(hz);
                sim.floor(-5.0);
                for side in [-1.0f32, 1.0] {
                    // A V of two slabs whose faces meet at the origin.
                    let turn = Quat::from_rotation_z(side * tilt.to_radians());
                    let out = turn * Vec3::NEG_Y * 0.5;
                    let apart = if tilt > 80.0 { side * 1.05 } else { 0.0 };
                    sim.fixed(
                        Collider::cuboid(6.0, 0.5, 20.0),
                        Transform::from_translation(out + Vec3::X * apart).with_rotation(turn),
                    );
                }
                let plan = Plan::reference().wheel(|_, w| w.probe = probe);
                let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, 4.0, 0.0));
                let (mut fastest, mut finite) = (0.0f32, true);
                for _ in 0..(5.0 * hz) as usize {
                    sim.ticks(1);
                    fastest = fastest.max(car.velocity(&sim).linear.length());
                    finite &= car.finite(&sim);
                }
                let case = format!("{hz} Hz {probe:?} {tilt}°");
                found.holds(format!("{case}: finite"), finite);
                // What nine metres of fall give.
                found.at_most(format!("{case}: fastest"), fastest, 13.3);
            }
        }
    }
}
