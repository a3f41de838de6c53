//! Springs and stops in motion: frequency, overshoot, drops, platforms.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Heave of the car after a start 5 cm too low: overshoot in parts, and time of its peak.
fn swing(hz: f64, ratio: f32) -> (f32, f32) {
    let mut sim = Sim::new(hz);
    sim.floor(0.0);
    let plan = Plan::reference().suspension(|s| {
        s.damping = Damper::Ratio {
            bump: ratio,
            rebound: ratio,
        };
        s.stop_stiffness = 0.0;
    });
    let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT - 0.05, 0.0));
    let mut heights = vec![-0.05];
    for _ in 0..hz as usize {
        sim.ticks(1);
        heights.push(car.pose(&sim).translation.y - HEIGHT);
    }
    let (peak, _) = heights
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(b.1))
        .expect("there are heights");
    // Between ticks, on the parabola through three.
    let (a, b, c) = (heights[peak - 1], heights[peak], heights[peak + 1]);
    let shift = 0.5 * (a - c) / (a - 2.0 * b + c);
    let top = b - 0.25 * (a - c) * shift;
    (top / 0.05, (peak as f32 + shift) / hz as f32)
}

#[test]
fn a_quarter_car_swings_with_its_frequency_and_overshoot_at_every_rate() {
    let mut found = Findings::new();
    let mut by_rate = Vec::new();
    for hz in RATES {
        let (overshoot, time) = swing(hz, 0.5);
        found.near(format!("{hz} Hz: overshoot"), overshoot, 0.163, 0.02);
        found.within(format!("{hz} Hz: peak time"), time, 0.385, 0.03);
        by_rate.push(overshoot);
        let (overshoot, time) = swing(hz, 0.2);
        let w = (1.0f32 - 0.04).sqrt();
        let exact = ops::exp(-core::f32::consts::PI * 0.2 / w);
        found.near(format!("{hz} Hz: overshoot at 0.2"), overshoot, exact, 0.02);
        found.within(
            format!("{hz} Hz: peak time at 0.2"),
            time,
            0.5 / (1.5 * w),
            0.03,
        );
    }
    let spread = by_rate
        .iter()
        .fold(0.0f32, |m, o| m.max((o - by_rate[0]).abs()));
    found.at_most("spread between the rates", spread, 0.03);
}

#[test]
fn a_dropped_car_never_touches_down_with_its_hull_and_stands_again_in_three_seconds() {
    let mut found = Findings::new();
    for hz in RATES {
        for height in [0.5, 1.0, 2.0, 10.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let car = Plan::reference().spawn(
                &mut sim,
                Transform::from_xyz(0.0, HEIGHT + SAG + height, 0.0),
            );
            let mut lowest = f32::MAX;
            let mut landed = false;
            let mut rebound = f32::MIN;
            let fall = f64::from((2.0 * height / G).sqrt());
            for tick in 0..((fall + 3.0) * hz) as usize {
                sim.ticks(1);
                let y = car.pose(&sim).translation.y;
                // The hull's underside is 0.1 m below the origin.
                lowest = lowest.min(y - 0.1);
                landed |= car.loads(&sim).iter().any(|l| *l > 0.0);
                if landed && tick as f64 / hz > fall + 0.3 {
                    rebound = rebound.max(y - HEIGHT);
                }
            }
            let case = format!("{hz} Hz {height} m");
            found.at_least(format!("{case}: hull above the ground"), lowest, -0.02);
            found.at_most(format!("{case}: rebound"), rebound, height);
            let y = car.pose(&sim).translation.y;
            found.near(format!("{case}: height in the end"), y, HEIGHT, 0.01);
        }
    }
}

#[test]
fn a_car_that_falls_at_a_hundred_metres_per_second_does_not_pass_through_the_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [30.0, 100.0] {
            for turn in [0.0, core::f32::consts::PI, 1.0] {
                let mut sim = Sim::new(hz);
                sim.floor(0.0);
                let at =
                    Transform::from_xyz(0.0, 20.0, 0.0).with_rotation(Quat::from_rotation_z(turn));
                let car = Plan::reference().spawn(&mut sim, at);
                car.push(&mut sim, Vec3::NEG_Y * speed);
                let mut lowest = f32::MAX;
                let mut finite = true;
                for _ in 0..(3.0 * hz) as usize {
                    sim.ticks(1);
                    lowest = lowest.min(car.pose(&sim).translation.y);
                    finite &= car.finite(&sim);
                }
                let case = format!("{hz} Hz {speed} m/s turned {turn}");
                found.at_least(format!("{case}: lowest"), lowest, 0.0);
                found.holds(format!("{case}: finite"), finite);
            }
        }
    }
}

#[test]
fn sag_on_a_lift_is_that_on_the_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        for speed in [2.0f32, -2.0] {
            let mut sim = Sim::new(hz);
            let mover = sim.moving(move |t| Transform::from_xyz(0.0, -0.5 + speed * t as f32, 0.0));
            sim.spawn((
                RigidBody::KinematicPositionBased,
                Collider::cuboid(10.0, 0.5, 10.0),
                Transform::from_xyz(0.0, -0.5, 0.0),
                mover,
            ));
            let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
            sim.seconds(5.0);
            for (i, wheel) in car.all(&sim).iter().enumerate() {
                let case = format!("{hz} Hz {speed} m/s wheel {i}");
                found.within(case, wheel.compression, SAG, 0.005);
            }
        }
    }
}

#[test]
fn an_undamped_drop_compresses_the_springs_as_far_as_its_energy_says() {
    // (m g + √((m g)² + 2 k m g H)) / k with k = 133 240 N/m: 0.46, 0.59 and 0.78 m.
    let mut found = Findings::new();
    for hz in RATES {
        for (height, wanted) in [(0.5f32, 0.46f32), (1.0, 0.59), (2.0, 0.78)] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let travel = 1.2;
            let plan = Plan::reference()
                .suspension(|s| {
                    s.travel = travel;
                    s.stop_stiffness = 0.0;
                    s.damping = Damper::Ratio {
                        bump: 0.0,
                        rebound: 0.0,
                    };
                })
                .wheel(|_, w| w.attachment.y = 0.0);
            // The hub hangs the travel below the origin, a radius above the ground.
            let touch = travel + RADIUS;
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, touch + height, 0.0));
            let mut lowest = f32::MAX;
            for _ in 0..(1.5 * hz) as usize {
                sim.ticks(1);
                lowest = lowest.min(car.pose(&sim).translation.y);
            }
            found.within(format!("{hz} Hz {height} m"), touch - lowest, wanted, 0.03);
        }
    }
}
