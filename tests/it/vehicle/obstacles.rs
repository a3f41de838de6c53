//! What lies on the road: a wall of bricks, a pothole, rubble, a loose step, a kerb, a long hill.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Patch, Sim};

use super::support::*;

/// How high the speed with which wheels are pushed out of the ground throws a car, metres: v² / 2 g with
/// 3 m/s.
const THROWN: f32 = 9.0 / (2.0 * G);

#[test]
fn a_car_breaks_through_a_wall_of_three_rows_and_no_brick_under_it_gains_energy() {
    // A little faster or slower, and other bricks end up under other wheels.
    for speed in [14.0, 14.5, 15.0, 15.5, 16.0] {
        through_a_wall(speed);
    }
}

fn through_a_wall(speed: f32) {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let mut bricks = Vec::new();
        for row in 0..3 {
            let shift = if row % 2 == 0 { 0.0 } else { 0.3 };
            for i in 0..8 {
                let at = Vec3::new(-2.1 + 0.6 * i as f32 + shift, 0.2 + 0.4 * row as f32, -14.0);
                bricks.push(sim.dynamic(
                    Collider::cuboid(0.295, 0.2, 0.2),
                    Transform::from_translation(at),
                    15.0,
                ));
            }
        }
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * speed);
        // Without what turns: never more than there is.
        let energy = |sim: &Sim| {
            let of = |entity: Entity, mass: f32| {
                let v = sim.get::<Velocity>(entity).linear.length_squared();
                mass * (0.5 * v + G * sim.position(entity).y)
            };
            of(car.body, MASS) + bricks.iter().map(|b| of(*b, 15.0)).sum::<f32>()
        };
        let spins = 2.0 * (speed / RADIUS) * (speed / RADIUS);
        let start = energy(&sim) + spins;
        let (mut highest, mut finite) = (f32::MIN, true);
        let (mut fastest, mut most) = (0.0f32, f32::MIN);
        for _ in 0..(4.0 * hz) as usize {
            sim.ticks(1);
            highest = highest.max(car.pose(&sim).translation.y);
            fastest = fastest.max(car.velocity(&sim).linear.length());
            most = most.max(energy(&sim));
            finite &= car.finite(&sim);
        }
        let case = format!("{hz} Hz {speed} m/s");
        let pose = car.pose(&sim);
        found.at_most(format!("{case}: through"), pose.translation.z, -20.0);
        // As over a ramp of the wall's height.
        found.at_most(format!("{case}: highest"), highest, HEIGHT + 1.2 + THROWN);
        found.at_most(format!("{case}: not sped up"), fastest, speed + 0.2);
        found.holds(format!("{case}: finite"), finite);
        found.at_most(format!("{case}: energy"), most, start * 1.005);
        let upright = (pose.rotation * Vec3::Y).y;
        found.at_least(format!("{case}: upright"), upright, 0.99);
    }
}

#[test]
fn a_wheel_follows_a_pothole_no_faster_than_its_mass_lets_it() {
    // Half a metre at 15 m/s lasts 33 ms. A hub of 25 kg under at most k x / m = 147 + 9.81 m/s² falls by
    // 8.6 cm in it, one without mass the whole 15 cm.
    let mut found = Findings::new();
    for hz in RATES {
        let run = |unsprung: f32| {
            let mut sim = Sim::new(hz);
            sim.block(Vec3::new(0.0, -0.5, 60.0), Vec3::new(20.0, 1.0, 140.0));
            sim.block(Vec3::new(0.0, -0.5, -60.5), Vec3::new(20.0, 1.0, 100.0));
            sim.block(Vec3::new(0.0, -0.65, 0.0), Vec3::new(20.0, 1.0, 400.0));
            let plan = Plan::reference().suspension(|s| s.unsprung_mass = unsprung);
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 0.0));
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 15.0);
            let (mut deepest, mut lowest) = (f32::MAX, f32::MAX);
            for _ in 0..hz as usize {
                sim.ticks(1);
                if car.pose(&sim).translation.z < -5.0 {
                    deepest = deepest.min(car.wheel(&sim, 0).compression);
                    lowest = lowest.min(car.pose(&sim).translation.y);
                }
            }
            let pose = car.pose(&sim);
            (SAG - deepest, HEIGHT - lowest, pose.rotation * Vec3::Y)
        };
        let (fell, dipped, up) = run(25.0);
        found.at_most(format!("{hz} Hz: the hub falls"), fell, 0.095);
        found.at_most(format!("{hz} Hz: the car dips"), dipped, 0.02);
        found.at_least(format!("{hz} Hz: upright"), up.y, 0.999);
        let (fell, ..) = run(0.0);
        found.at_least(format!("{hz} Hz: without mass"), fell, SAG - 1.0e-3);
    }
}

/// A lump of rubble: eight corners of a cube, each moved by chance.
fn lump(dice: &mut Dice, size: f32) -> Collider {
    let corners: Vec<Vec3> = (0..8)
        .map(|i| {
            let corner = Vec3::new(
                if i & 1 == 0 { -0.5 } else { 0.5 },
                if i & 2 == 0 { -0.3 } else { 0.3 },
                if i & 4 == 0 { -0.5 } else { 0.5 },
            );
            let by = Vec3::new(dice.roll(), dice.roll(), dice.roll()) - 0.5;
            (corner + by * 0.3) * size
        })
        .collect();
    Collider::convex_hull(&corners).expect("eight corners of a cube have a hull")
}

/// A drive over a heap of rubble.
struct Over {
    end: Transform,
    lowest: f32,
    highest: f32,
    /// Least cosine of the tilt.
    tilt: f32,
    finite: bool,
}

/// A car rolls at 6 m/s over a hundred lumps, the largest of this size, metres.
fn over_rubble(hz: f64, probe: WheelProbe, seed: u64, largest: f32) -> Over {
    let mut sim = Sim::new(hz);
    plane(&mut sim, Quat::IDENTITY);
    let mut dice = Dice::new(seed);
    for i in 0..100 {
        let size = dice.between(0.1, largest);
        let at = Vec3::new(
            (i % 10) as f32 * 0.4 - 1.8 + dice.between(-0.05, 0.05),
            0.15,
            -8.0 - (i / 10) as f32 * 0.6,
        );
        let turn = Quat::from_rotation_y(dice.between(0.0, 6.0));
        let mass = 2000.0 * size * size * size * 0.6;
        sim.dynamic(
            lump(&mut dice, size),
            Transform::from_translation(at).with_rotation(turn),
            mass,
        );
    }
    let plan = Plan::reference()
        .direct(800.0, |_| true)
        .wheel(|_, w| w.probe = probe);
    let car = plan.park(&mut sim, Quat::IDENTITY);
    sim.seconds(2.0);
    car.roll(&mut sim, Vec3::NEG_Z * 6.0);
    car.ask(&mut sim, |i| i.throttle = 0.3);
    let mut over = Over {
        end: Transform::IDENTITY,
        lowest: f32::MAX,
        highest: f32::MIN,
        tilt: 1.0,
        finite: true,
    };
    for _ in 0..(5.0 * hz) as usize {
        sim.ticks(1);
        let pose = car.pose(&sim);
        over.lowest = over.lowest.min(pose.translation.y);
        over.highest = over.highest.max(pose.translation.y);
        over.tilt = over.tilt.min((pose.rotation * Vec3::Y).y);
        over.finite &= car.finite(&sim);
        over.end = pose;
    }
    over
}

#[test]
fn a_hundred_lumps_of_rubble_neither_throw_nor_stop_a_car() {
    let mut found = Findings::new();
    for hz in RATES {
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            let over = over_rubble(hz, probe, 7, 0.3);
            let case = format!("{hz} Hz {probe:?}");
            found.at_most(format!("{case}: over"), over.end.translation.z, -16.0);
            found.at_least(format!("{case}: lowest"), over.lowest, HEIGHT - 0.1);
            // The largest lumps are 27 cm high.
            let highest = HEIGHT + 0.27 + THROWN;
            found.at_most(format!("{case}: highest"), over.highest, highest);
            // Half of the 55.5° at which it would tip over.
            found.at_least(format!("{case}: tilt"), over.tilt, cos(27.7));
            found.holds(format!("{case}: finite"), over.finite);
        }
    }
}

#[test]
fn no_heap_of_stones_half_as_high_as_a_wheel_throws_a_car() {
    let mut found = Findings::new();
    for hz in [30.0, 60.0, 120.0] {
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            for seed in 0..10 {
                let over = over_rubble(hz, probe, seed * 1000 + 7, 0.15);
                let case = format!("{hz} Hz {probe:?} heap {seed}");
                found.at_most(format!("{case}: over"), over.end.translation.z, -16.0);
                found.at_most(format!("{case}: highest"), over.highest, HEIGHT + 0.15);
                // One side on the highest stones, the other on the ground: 0.15 m of 1.6.
                found.at_least(format!("{case}: tilt"), over.tilt, cos(2.0 * 5.4));
            }
        }
    }
}

#[test]
fn no_heap_of_stones_as_high_as_a_hub_turns_a_car_over() {
    // Some of them spin under the wheels like balls out of a machine.
    let mut found = Findings::new();
    for hz in [30.0, 60.0, 120.0] {
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            for seed in 0..20 {
                let over = over_rubble(hz, probe, seed * 1000 + 7, 0.3);
                let case = format!("{hz} Hz {probe:?} heap {seed}");
                found.at_most(format!("{case}: over"), over.end.translation.z, -16.0);
                // A stone on another one.
                found.at_most(format!("{case}: highest"), over.highest, HEIGHT + 0.6);
                // It would tip over at 55.5°.
                found.at_least(format!("{case}: tilt"), over.tilt, cos(45.0));
            }
        }
    }
}

#[test]
fn a_loose_step_of_five_centimetres_is_crossed() {
    let mut found = Findings::new();
    for hz in RATES {
        for mass in [20.0, 100.0, 1000.0] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let turned = Quat::from_rotation_y(54f32.to_radians());
            sim.dynamic(
                Collider::cuboid(5.0, 0.025, 1.0),
                Transform::from_xyz(0.0, 0.026, -12.0).with_rotation(turned),
                mass,
            );
            let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 8.0);
            let (mut lowest, mut highest) = (f32::MAX, f32::MIN);
            for _ in 0..(4.0 * hz) as usize {
                sim.ticks(1);
                let y = car.pose(&sim).translation.y;
                lowest = lowest.min(y);
                highest = highest.max(y);
            }
            let case = format!("{hz} Hz {mass} kg");
            let at = car.pose(&sim);
            found.at_most(format!("{case}: crossed"), at.translation.z, -18.0);
            found.at_least(format!("{case}: lowest"), lowest, HEIGHT - 0.05);
            found.at_most(format!("{case}: highest"), highest, HEIGHT + 0.1);
            found.at_least(format!("{case}: upright"), (at.rotation * Vec3::Y).y, 0.999);
        }
    }
}

#[test]
fn a_kerb_of_fifteen_centimetres_throws_neither_a_ray_nor_a_cylinder() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |probe| {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            sim.block(Vec3::new(0.0, 0.075, -30.0), Vec3::new(20.0, 0.15, 40.0));
            let plan = Plan::reference().wheel(|_, w| w.probe = probe);
            let car = plan.park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 6.0);
            let (mut up, mut finite) = (0.0f32, true);
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                up = up.max(car.velocity(&sim).linear.y);
                finite &= car.finite(&sim);
            }
            let over = car.pose(&sim).translation;
            (up, over, finite)
        };
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            let (up, at, finite) = run(probe);
            let case = format!("{hz} Hz {probe:?}");
            found.holds(format!("{case}: finite"), finite);
            found.at_most(format!("{case}: over"), at.z, -11.0);
            found.at_most(format!("{case}: thrown up"), up, 2.0);
            found.near(format!("{case}: stands"), at.y, HEIGHT + 0.15, 0.03);
        }
    }
}

#[test]
fn thirty_degrees_are_climbed_with_what_the_slope_leaves() {
    // Four wheels of 1 kg·m² at 0.3 m add 44 kg.
    let mut found = Findings::new();
    for hz in RATES {
        let rotation = uphill(30.0);
        let mut sim = Sim::new(hz);
        plane(&mut sim, rotation);
        let plan = Plan::reference().direct(2100.0, |_| true);
        let car = plan.park(&mut sim, rotation);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(4.0);
        let start = car.pose(&sim).translation;
        car.ask(&mut sim, |i| {
            i.brake = 0.0;
            i.throttle = 1.0;
        });
        sim.seconds(2.0);
        let before = car.velocity(&sim).linear.length();
        sim.seconds(2.0);
        let after = car.velocity(&sim).linear.length();
        let mass = MASS + 4.0 / (RADIUS * RADIUS);
        let wanted = (4.0 * 2100.0 - MASS * G * sin(30.0)) / mass;
        found.within(format!("{hz} Hz"), (after - before) / 2.0, wanted, 0.02);
        let climbed = (car.pose(&sim).translation - start).y;
        found.at_least(format!("{hz} Hz: climbed"), climbed, 2.5);
    }
}

#[test]
fn a_hilly_mesh_is_driven_without_leaving_it() {
    let mut found = Findings::new();
    for hz in RATES {
        for probe in [WheelProbe::Ray, WheelProbe::Cylinder] {
            let height = |x: f32, z: f32| 0.6 * ops::sin(0.2 * x) + 0.6 * ops::cos(0.15 * z);
            let mut sim = Sim::new(hz);
            let terrain = Patch::terrain(60, 2.0, height);
            sim.fixed(terrain.collider(), Transform::from_xyz(-60.0, 0.0, -100.0));
            let plan = Plan::reference()
                .direct(1000.0, |_| true)
                .wheel(|_, w| w.probe = probe);
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, 2.2, 0.0));
            sim.seconds(2.0);
            car.ask(&mut sim, |i| {
                i.throttle = 1.0;
                i.steer = 0.05;
            });
            let mut tilt = 1.0f32;
            let mut farthest = 0.0f32;
            for _ in 0..(6.0 * hz) as usize {
                sim.ticks(1);
                tilt = tilt.min((car.pose(&sim).rotation * Vec3::Y).y);
                for wheel in car.all(&sim) {
                    if let Some(contact) = wheel.contact {
                        // Triangles of 2 m lie below the crests they stand for.
                        let at = contact.point + Vec3::new(60.0, 0.0, 100.0);
                        let off = (contact.point.y - height(at.x, at.z)).abs();
                        farthest = farthest.max(off);
                    }
                }
            }
            let case = format!("{hz} Hz {probe:?}");
            found.at_least(format!("{case}: tilt"), tilt, 0.9);
            found.at_most(format!("{case}: contacts off the ground"), farthest, 0.1);
            found.at_least(
                format!("{case}: drives"),
                car.pose(&sim).translation.length(),
                10.0,
            );
        }
    }
}
