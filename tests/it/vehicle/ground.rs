//! What the wheels stand on: it is pushed back, and carries them along.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A body of no friction with other bodies.
fn icy() -> Friction {
    Friction {
        coefficient: 0.0,
        combine_rule: CoefficientCombineRule::Min,
    }
}

#[test]
fn a_car_that_drives_off_pushes_the_slab_under_it_the_other_way() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = sim.floor(0.0);
        insert(&mut sim, floor, icy());
        let slab = sim.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(5.0, 0.25, 10.0),
            ColliderMassProperties::Mass(3000.0),
            icy(),
            Velocity::default(),
            Transform::from_xyz(0.0, 0.25, 0.0),
        ));
        let plan = Plan::reference().direct(1000.0, |_| true);
        let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, 0.5 + HEIGHT, 3.0));
        sim.seconds(3.0);
        let momentum = |sim: &Sim| {
            let slab = sim.get::<Velocity>(slab).linear;
            car.velocity(sim).linear * MASS + slab * 3000.0
        };
        let before = momentum(&sim);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        sim.seconds(1.0);
        // 4 kN for a second; the wheels' spin takes its part.
        let given = car.velocity(&sim).linear.length() * MASS;
        found.at_least(format!("{hz} Hz: driven"), given, 3000.0);
        let change = momentum(&sim) - before;
        let level = Vec2::new(change.x, change.z).length();
        found.at_most(
            format!("{hz} Hz: momentum out of nothing"),
            level,
            0.005 * given,
        );
    }
}

#[test]
fn a_light_plate_on_the_floor_carries_its_wheel() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let plate = sim.dynamic(
            Collider::cuboid(0.25, 0.025, 0.25),
            Transform::from_xyz(-HALF_TRACK, 0.026, -HALF_BASE),
            5.0,
        );
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.05, 0.0));
        let mut lowest = f32::MAX;
        let mut highest = f32::MIN;
        sim.seconds(3.0);
        let (mut rocks, mut swings) = (0.0f32, 0.0f32);
        for tick in 0..(5.0 * hz) as usize {
            sim.ticks(1);
            let y = car.pose(&sim).translation.y;
            lowest = lowest.min(y);
            highest = highest.max(y);
            if tick >= (3.0 * hz) as usize {
                let load: f32 = car.loads(&sim).iter().sum();
                rocks = rocks.max((load / (MASS * G) - 1.0).abs());
                swings = swings.max(car.wheel(&sim, 0).force.x.abs());
            }
        }
        found.at_least(format!("{hz} Hz: lowest"), lowest, HEIGHT - 0.02);
        found.at_most(format!("{hz} Hz: highest"), highest, HEIGHT + 0.05);
        let contact = car.wheel(&sim, 0).contact.map(|c| c.entity);
        found.holds(format!("{hz} Hz: on the plate"), contact == Some(plate));
        found.at_most(format!("{hz} Hz: loads off the weight"), rocks, 0.001);
        // Nobody drives or brakes.
        found.at_most(format!("{hz} Hz: swings to and fro with"), swings, 100.0);
    }
}

#[test]
fn light_rubble_does_not_throw_the_car_or_swallow_its_wheel() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        for i in 0..40 {
            let (x, z) = ((i % 8) as f32 * 0.27 - 0.95, -3.0 - (i / 8) as f32 * 0.5);
            sim.dynamic(
                Collider::cuboid(0.08, 0.025, 0.08),
                Transform::from_xyz(x, 0.026, z),
                5.0,
            );
        }
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 4.0);
        let (mut lowest, mut highest) = (f32::MAX, f32::MIN);
        for _ in 0..(3.0 * hz) as usize {
            sim.ticks(1);
            let y = car.pose(&sim).translation.y;
            lowest = lowest.min(y);
            highest = highest.max(y);
        }
        found.at_least(format!("{hz} Hz: lowest"), lowest, HEIGHT - 0.02);
        found.at_most(format!("{hz} Hz: highest"), highest, HEIGHT + 0.08);
    }
}

#[test]
fn a_belt_takes_a_braked_car_along_and_a_turntable_turns_it() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = plane(&mut sim, Quat::IDENTITY);
        insert(
            &mut sim,
            floor,
            RoadVelocity {
                linear: Vec3::new(0.0, 0.0, 10.0),
                ..default()
            },
        );
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(4.0);
        let v = car.velocity(&sim).linear;
        found.near(format!("{hz} Hz belt: along"), v.z, 10.0, 0.01);
        for wheel in car.all(&sim) {
            found.within(
                format!("{hz} Hz belt: load"),
                wheel.load,
                MASS * G / 4.0,
                0.01,
            );
        }

        let mut sim = Sim::new(hz);
        let mover = sim.moving(|t| {
            Transform::from_xyz(0.0, -0.5, 0.0).with_rotation(Quat::from_rotation_y(t as f32))
        });
        sim.spawn((
            RigidBody::KinematicPositionBased,
            Collider::cuboid(20.0, 0.5, 20.0),
            Transform::from_xyz(0.0, -0.5, 0.0),
            mover,
        ));
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(3.0, HEIGHT, 0.0));
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(2.0);
        let radius = |sim: &Sim| {
            let at = car.pose(sim).translation;
            Vec2::new(at.x, at.z).length()
        };
        let before = radius(&sim);
        sim.seconds(6.0);
        found.near(
            format!("{hz} Hz turntable: radius"),
            radius(&sim),
            before,
            0.03,
        );
        let spin = car.velocity(&sim).angular.y;
        found.near(format!("{hz} Hz turntable: turns"), spin, 1.0, 0.01);
        let sum: f32 = car.loads(&sim).iter().sum();
        found.within(format!("{hz} Hz turntable: loads"), sum, MASS * G, 0.01);
    }
}

#[test]
fn a_scene_that_moves_as_a_whole_is_the_same_scene() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |speed: f32| {
            let mut sim = Sim::new(hz);
            sim.spawn((
                RigidBody::KinematicVelocityBased,
                Collider::cuboid(2000.0, 0.5, 2000.0),
                Velocity {
                    linear: Vec3::X * speed,
                    angular: Vec3::ZERO,
                },
                Transform::from_xyz(0.0, -0.5, 0.0),
            ));
            let plan = Plan::reference().direct(800.0, |i| i >= 2);
            let car = plan.park(&mut sim, Quat::IDENTITY);
            car.push(&mut sim, Vec3::X * speed);
            sim.seconds(1.0);
            let start = car.pose(&sim).translation;
            car.ask(&mut sim, |i| {
                i.throttle = 1.0;
                i.steer = 0.2;
            });
            sim.seconds(4.0);
            let way = car.pose(&sim).translation - start;
            way - Vec3::X * speed * 4.0
        };
        let (still, moving) = (run(0.0), run(50.0));
        let off = (moving - still).length();
        found.at_least(format!("{hz} Hz: drives"), still.length(), 5.0);
        found.at_most(format!("{hz} Hz: off"), off, 1.0e-3 * still.length());
    }
}

#[test]
fn a_car_on_a_seesaw_tips_it() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(-3.0);
        let anchor = sim.block(Vec3::new(0.0, -2.0, 0.0), Vec3::new(1.0, 1.0, 1.0));
        let hinge = RevoluteJointBuilder::new(Vec3::X)
            .local_anchor1(Vec3::new(0.0, 1.0, 0.0))
            .local_anchor2(Vec3::ZERO);
        let board = sim.dynamic(
            Collider::cuboid(2.0, 0.1, 6.0),
            Transform::from_xyz(0.0, -1.0, 0.0),
            400.0,
        );
        insert(&mut sim, board, ImpulseJoint::new(anchor, hinge));
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, -0.9 + HEIGHT, -2.0));
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(4.0);
        // The board's end lies on the floor, two metres below, and the car still stands on it.
        let tilt = sim.get::<Transform>(board).rotation * Vec3::Z;
        found.at_least(format!("{hz} Hz: tipped"), tilt.y, 0.1);
        let grounded = car.telemetry(&sim).grounded;
        found.at_least(format!("{hz} Hz: on it"), grounded as f32, 3.0);
    }
}

#[test]
fn the_friction_of_a_surface_is_that_of_its_component() {
    let mut found = Findings::new();
    for hz in RATES {
        for friction in [1.0, 0.5, 0.1] {
            let mut sim = Sim::new(hz);
            let floor = plane(&mut sim, Quat::IDENTITY);
            insert(&mut sim, floor, SurfaceFriction::new(friction));
            let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 20.0);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(0.5);
            let before = car.velocity(&sim).linear.length();
            sim.seconds(1.0);
            let lost = before - car.velocity(&sim).linear.length();
            found.within(format!("{hz} Hz {friction}"), lost, friction * G, 0.01);
        }
    }
}

#[test]
fn a_light_slab_on_ice_is_taken_along_without_a_shake() {
    let mut found = Findings::new();
    for hz in RATES {
        for mass in [20.0f32, 60.0, 400.0] {
            let mut sim = Sim::new(hz);
            let floor = plane(&mut sim, Quat::IDENTITY);
            insert(&mut sim, floor, icy());
            let slab = sim.spawn((
                RigidBody::Dynamic,
                Collider::cuboid(3.0, 0.1, 4.0),
                ColliderMassProperties::Mass(mass),
                icy(),
                Velocity::default(),
                Transform::from_xyz(0.0, 0.1, 0.0),
            ));
            let at = Transform::from_xyz(0.0, 0.2 + HEIGHT, 0.0);
            let car = Plan::reference().spawn(&mut sim, at);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(3.0);
            car.push(&mut sim, Vec3::NEG_Z * 2.0);
            // Within a second they go as one, by the momentum that the car had.
            sim.seconds(1.0);
            let wanted = -2.0 * MASS / (MASS + mass);
            let mut worst = 0.0f32;
            for _ in 0..hz as usize {
                sim.ticks(1);
                let v = sim.get::<Velocity>(slab).linear.z;
                worst = worst.max((v - wanted).abs());
            }
            let case = format!("{hz} Hz {mass} kg");
            found.at_most(format!("{case}: slab off"), worst, 0.02);
            let v = car.velocity(&sim).linear.z;
            found.near(format!("{case}: car"), v, wanted, 0.02);
        }
    }
}

#[test]
fn a_crate_in_the_air_is_knocked_away_by_no_more_than_it_was_hit_with() {
    // A wheel lands on a crate that falls freely below it.
    let mut found = Findings::new();
    for hz in RATES {
        for mass in [2.0f32, 15.0, 100.0] {
            let mut sim = Sim::new(hz);
            let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, 60.0, 0.0));
            car.push(&mut sim, Vec3::NEG_Y * 3.0);
            let below = 60.0 - HEIGHT - SAG - 0.4;
            let crate_ = sim.dynamic(
                Collider::cuboid(0.2, 0.2, 0.2),
                Transform::from_xyz(-HALF_TRACK, below, -HALF_BASE),
                mass,
            );
            let energy = |sim: &Sim| {
                let (a, b) = (car.velocity(sim), sim.get::<Velocity>(crate_));
                let (p, q) = (car.pose(sim).translation.y, sim.position(crate_).y);
                0.5 * MASS * a.linear.length_squared()
                    + 1200.0 * a.angular.with_z(0.0).length_squared()
                    + 300.0 * a.angular.z * a.angular.z
                    + 0.5 * mass * b.linear.length_squared()
                    + G * (MASS * p + mass * q)
            };
            let start = energy(&sim);
            let mut most = f32::MIN;
            let mut fastest = 0.0f32;
            let mut touched = false;
            for tick in 0..hz as usize {
                sim.ticks(1);
                touched |= car.telemetry(&sim).grounded > 0;
                most = most.max(energy(&sim));
                let fall = G * (tick + 1) as f32 / hz as f32;
                let v = sim.get::<Velocity>(crate_).linear.y;
                fastest = fastest.max(-v - fall);
            }
            let case = format!("{hz} Hz {mass} kg");
            found.holds(format!("{case}: touched"), touched);
            // A spring gives at most twice the speed of the hit.
            found.at_most(format!("{case}: crate"), fastest, 6.5);
            found.at_most(format!("{case}: energy"), most, start + 0.01 * 4.5 * MASS);
        }
    }
}
