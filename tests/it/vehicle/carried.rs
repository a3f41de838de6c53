//! On ground that moves or changes: what the driver's helpers, the gearbox and the sleepers make of it.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A car that stands on a long deck which runs backward past the nose at this speed.
fn ferry(hz: f64, plan: &Plan, speed: f32) -> (Sim, Car) {
    let mut sim = Sim::new(hz);
    sim.spawn((
        RigidBody::KinematicVelocityBased,
        Collider::cuboid(50.0, 0.5, 4000.0),
        Velocity {
            linear: Vec3::Z * speed,
            angular: Vec3::ZERO,
        },
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    let car = plan.park(&mut sim, Quat::IDENTITY);
    car.push(&mut sim, Vec3::Z * speed);
    sim.seconds(1.0);
    (sim, car)
}

/// Way against the deck.
fn way(sim: &Sim, car: &Car, speed: f32, from: Vec3, seconds: f32) -> Vec3 {
    car.pose(sim).translation - from - Vec3::Z * speed * seconds
}

#[test]
fn helpers_and_gearbox_take_the_deck_of_a_ferry_for_the_ground() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |speed: f32, test: usize| {
            let mut plan = Plan::reference().wheel(|i, w| w.driven = i < 2);
            plan.vehicle.drivetrain = Some(Drivetrain::default());
            plan.vehicle.steering.speed_curve = vec![
                SteerPoint {
                    speed: 0.0,
                    part: 1.0,
                },
                SteerPoint {
                    speed: 20.0,
                    part: 0.1,
                },
            ];
            let (mut sim, car) = ferry(hz, &plan, speed);
            match test {
                0 => {
                    insert(&mut sim, car.body, AntiLockBrakes::default());
                    edit::<Velocity>(&mut sim, car.body, |v| v.linear.z -= 15.0);
                    edit::<VehicleState>(&mut sim, car.body, |s| {
                        for w in &mut s.wheels {
                            w.spin = 15.0 / RADIUS;
                        }
                    });
                    car.ask(&mut sim, |i| i.brake = 1.0);
                }
                1 => {
                    insert(&mut sim, car.body, TractionControl::default());
                    car.ask(&mut sim, |i| i.throttle = 1.0);
                }
                2 => car.ask(&mut sim, |i| {
                    i.throttle = 1.0;
                    i.gear = Gear::Reverse;
                }),
                3 => {
                    insert(&mut sim, car.body, StabilityControl::default());
                    car.ask(&mut sim, |i| {
                        i.throttle = 0.6;
                        i.steer = 0.5;
                    });
                }
                _ => {
                    insert(&mut sim, car.body, HillHold { time: 1.0 });
                    car.ask(&mut sim, |i| i.brake = 1.0);
                    sim.seconds(1.0);
                    car.ask(&mut sim, |i| i.brake = 0.0);
                    sim.seconds(0.5);
                    // Pushed within the time of the hold.
                    edit::<ExternalForce>(&mut sim, car.body, |f| f.force = Vec3::X * 3000.0);
                }
            }
            let start = car.pose(&sim).translation;
            sim.seconds(3.0);
            (way(&sim, &car, speed, start, 3.0), car.telemetry(&sim))
        };
        for (test, name) in ["anti-lock", "traction", "reverse", "stability"]
            .iter()
            .enumerate()
        {
            let (still, there) = run(0.0, test);
            for speed in [20.0, -20.0] {
                let (carried, here) = run(speed, test);
                let case = format!("{hz} Hz {name} at {speed} m/s");
                let off = (carried - still).length();
                found.at_most(format!("{case}: way"), off, 0.01 * still.length());
                found.near(format!("{case}: speed"), here.speed, there.speed, 0.05);
            }
        }
    }
}

#[test]
fn a_braked_car_keeps_its_place_on_a_ferry_that_gathers_way() {
    // It stays behind by what its tyres and springs give: m a / 4 k of the carcass, and the height of the
    // centre of mass times the lean m a h / (4 k b² - m g h) on springs b beside the middle. Half of what the
    // deck's speed changes by in a tick, times the tick, is the deck's own.
    let mut found = Findings::new();
    let (a, spring) = (2.0, 33_310.0);
    for hz in RATES {
        for (name, axis, carcass, b) in [
            ("ahead", Vec3::NEG_Z, 100.0e3 / 0.2, HALF_BASE),
            ("aside", Vec3::X, 80.0e3 / 0.4, HALF_TRACK),
        ] {
            let mut sim = Sim::new(hz);
            let deck = sim.spawn((
                RigidBody::KinematicVelocityBased,
                Collider::cuboid(50.0, 0.5, 50.0),
                Velocity::default(),
                Transform::from_xyz(0.0, -0.5, 0.0),
            ));
            let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(2.0);
            let tolerance = 4.0e-4 + 0.5 * a * sim.dt() * sim.dt();
            let place = |sim: &Sim| (sim.position(car.body) - sim.position(deck)).dot(axis);
            let start = place(&sim);
            for tick in 1..=(2.5 * hz) as usize {
                let speed = a * tick as f32 / hz as f32;
                edit::<Velocity>(&mut sim, deck, |v| v.linear = axis * speed);
                sim.ticks(1);
            }
            let lag = start - place(&sim);
            let stiffness = 4.0 * spring * b * b - MASS * G * HEIGHT;
            let lean = MASS * a * HEIGHT / stiffness;
            let wanted = MASS * a / (4.0 * carcass) + HEIGHT * lean;
            found.near(format!("{hz} Hz {name}: lags"), lag, wanted, tolerance);
            sim.seconds(4.0);
            let lag = start - place(&sim);
            found.near(format!("{hz} Hz {name}: back"), lag, 0.0, tolerance);
        }
    }
}

#[test]
fn a_belt_that_starts_takes_a_sleeping_car_along() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let floor = plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        insert(&mut sim, car.body, Sleeping::default());
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(10.0);
        found.holds(format!("{hz} Hz: sleeps"), car.telemetry(&sim).asleep);
        let belt = RoadVelocity {
            linear: Vec3::X * 2.0,
            ..default()
        };
        insert(&mut sim, floor, belt);
        sim.seconds(3.0);
        let speed = car.velocity(&sim).linear.x;
        found.near(format!("{hz} Hz: taken along"), speed, 2.0, 0.02);
    }
}

#[test]
fn a_sleeping_car_on_a_hill_slides_when_the_road_freezes() {
    let mut found = Findings::new();
    for hz in RATES {
        let rotation = uphill(15.0);
        let mut sim = Sim::new(hz);
        let road = plane(&mut sim, rotation);
        let car = Plan::reference().park(&mut sim, rotation);
        insert(&mut sim, car.body, Sleeping::default());
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(10.0);
        found.holds(format!("{hz} Hz: sleeps"), car.telemetry(&sim).asleep);
        insert(&mut sim, road, SurfaceFriction::new(0.05));
        sim.seconds(2.0);
        let speed = car.velocity(&sim).linear.length();
        found.at_least(format!("{hz} Hz: slides"), speed, 2.0);
        insert(&mut sim, road, SurfaceFriction::default());
        sim.seconds(2.0);
        let speed = car.velocity(&sim).linear.length();
        found.at_most(format!("{hz} Hz: stops"), speed, 0.01);
    }
}

#[test]
fn surfaces_of_no_numbers_count_as_plain_ones() {
    let mut found = Findings::new();
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, 1.0e38] {
        for which in 0..3 {
            let mut sim = Sim::new(60.0);
            let road = plane(&mut sim, Quat::IDENTITY);
            let car = Plan::reference()
                .tire(|t| t.rolling_resistance = 0.01)
                .park(&mut sim, Quat::IDENTITY);
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(1.0);
            match which {
                0 => insert(&mut sim, road, SurfaceFriction::new(bad)),
                1 => insert(
                    &mut sim,
                    road,
                    SurfaceFriction {
                        rolling_resistance: bad,
                        ..default()
                    },
                ),
                _ => insert(
                    &mut sim,
                    road,
                    RoadVelocity {
                        linear: Vec3::X * bad,
                        angular: Vec3::splat(bad),
                    },
                ),
            }
            let case = format!("{bad} field {which}");
            let mut finite = true;
            for _ in 0..120 {
                sim.ticks(1);
                finite &= car.finite(&sim);
            }
            found.holds(format!("{case}: finite"), finite);
            if !bad.is_finite() || which != 2 {
                let y = car.pose(&sim).translation.y;
                found.near(format!("{case}: stands"), y, HEIGHT, 0.02);
            }
        }
    }
}

#[test]
fn a_body_with_locked_axes_is_solved_as_one() {
    let mut found = Findings::new();
    for hz in RATES {
        // On rails at a height: the springs carry what their compression says, no matter the weight.
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.05, 0.0));
        insert(&mut sim, car.body, LockedAxes::TRANSLATION_LOCKED_Y);
        sim.seconds(2.0);
        for (i, wheel) in car.all(&sim).iter().enumerate() {
            let wanted = 33_310.0 * (SAG - 0.05);
            let case = format!("{hz} Hz on rails wheel {i}: load");
            found.within(case, wheel.load, wanted, 0.005);
        }

        // A side-scroller on a slope across: its rail holds it, not its tyres.
        let rotation = side_on(15.0);
        let mut sim = Sim::new(hz);
        plane(&mut sim, rotation);
        let car = Plan::reference().park(&mut sim, rotation);
        insert(
            &mut sim,
            car.body,
            LockedAxes::TRANSLATION_LOCKED_X | LockedAxes::ROTATION_LOCKED_Z,
        );
        sim.seconds(3.0);
        let side: f32 = car.all(&sim).iter().map(|w| w.force.y.abs()).sum();
        let x = car.pose(&sim).translation.x;
        found.at_most(
            format!("{hz} Hz across: still"),
            car.velocity(&sim).linear.length(),
            1.0e-3,
        );
        found.holds(
            format!("{hz} Hz across: finite {x} {side}"),
            car.finite(&sim),
        );
        let mut worst = 0.0f32;
        let before = car.loads(&sim);
        for _ in 0..hz as usize {
            sim.ticks(1);
            for (a, b) in car.loads(&sim).iter().zip(&before) {
                worst = worst.max((a - b).abs());
            }
        }
        found.at_most(format!("{hz} Hz across: loads shake"), worst, 10.0);
    }
}

#[test]
fn a_light_plate_on_a_moving_floor_carries_its_wheel() {
    let mut found = Findings::new();
    for hz in RATES {
        for (name, velocity) in [
            ("lift", Vec3::Y * 2.0),
            ("sinking lift", Vec3::Y * -2.0),
            ("ferry", Vec3::X * 5.0),
        ] {
            let mut sim = Sim::new(hz);
            let moves = || Velocity {
                linear: velocity,
                angular: Vec3::ZERO,
            };
            let floor = sim.spawn((
                RigidBody::KinematicVelocityBased,
                Collider::cuboid(20.0, 0.5, 20.0),
                moves(),
                Transform::from_xyz(0.0, -0.5, 0.0),
            ));
            let plate = sim.dynamic(
                Collider::cuboid(0.25, 0.025, 0.25),
                Transform::from_xyz(-HALF_TRACK, 0.026, -HALF_BASE),
                5.0,
            );
            let car =
                Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.05, 0.0));
            insert(&mut sim, plate, moves());
            insert(&mut sim, car.body, moves());
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(3.0);
            let (mut low, mut high) = (f32::MAX, f32::MIN);
            let (mut light, mut heavy) = (f32::MAX, f32::MIN);
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                let height = sim.position(car.body).y - sim.position(floor).y - 0.5;
                (low, high) = (low.min(height), high.max(height));
                let load: f32 = car.loads(&sim).iter().sum();
                (light, heavy) = (light.min(load), heavy.max(load));
            }
            let case = format!("{hz} Hz {name}");
            let contact = car.wheel(&sim, 0).contact.map(|c| c.entity);
            found.holds(format!("{case}: on the plate"), contact == Some(plate));
            found.at_least(format!("{case}: lowest"), low, HEIGHT - 0.02);
            found.at_most(format!("{case}: highest"), high, HEIGHT + 0.05);
            found.within(format!("{case}: least load"), light, MASS * G, 0.002);
            found.within(format!("{case}: most load"), heavy, MASS * G, 0.002);
        }
    }
}

#[test]
fn a_braked_car_keeps_its_place_on_a_bed_that_goes_round_a_bend() {
    // Half of the bend's acceleration times the square of the tick, in each tick, would be half a metre at 30 Hz.
    let mut found = Findings::new();
    for hz in RATES {
        for (radius, speed) in [(20.0f32, 8.0f32), (6.0, 4.0)] {
            let mut sim = Sim::new(hz);
            let at = move |t: f64| {
                let rotation = Quat::from_rotation_y(t as f32 * speed / radius);
                Transform::from_translation(rotation * Vec3::new(radius, -0.5, 0.0))
                    .with_rotation(rotation)
            };
            let mover = sim.moving(at);
            let bed = sim.spawn((
                RigidBody::KinematicPositionBased,
                Collider::cuboid(1.5, 0.5, 4.0),
                at(0.0),
                mover,
            ));
            let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(radius, HEIGHT, 0.0));
            let along = Velocity {
                linear: Vec3::NEG_Z * speed,
                angular: Vec3::Y * (speed / radius),
            };
            insert(&mut sim, car.body, along);
            car.ask(&mut sim, |i| i.brake = 1.0);
            let place = |sim: &Sim| {
                let bed = sim.get::<Transform>(bed);
                bed.rotation.inverse() * (sim.position(car.body) - bed.translation)
            };
            sim.seconds(3.0);
            let start = place(&sim);
            sim.seconds(10.0);
            let moved = (place(&sim) - start).length();
            found.at_most(format!("{hz} Hz {radius} m"), moved, 0.02);
        }
    }
}
