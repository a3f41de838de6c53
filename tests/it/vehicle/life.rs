//! Events, sleep, wheels that are seen, spawning and despawning.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[derive(Resource, Default)]
struct Log(Vec<String>);

fn record(sim: &mut Sim) {
    sim.app
        .init_resource::<Log>()
        .add_observer(|e: On<GearShifted>, mut log: ResMut<Log>| {
            log.0.push(format!("gear {} {}", e.from, e.to));
        })
        .add_observer(|_: On<WheelLanded>, mut log: ResMut<Log>| log.0.push("landed".into()))
        .add_observer(|_: On<WheelLeftGround>, mut log: ResMut<Log>| log.0.push("left".into()))
        .add_observer(|_: On<BottomedOut>, mut log: ResMut<Log>| log.0.push("bottomed".into()))
        .add_observer(|_: On<EngineStalled>, mut log: ResMut<Log>| log.0.push("stalled".into()))
        .add_observer(|_: On<SlipStarted>, mut log: ResMut<Log>| log.0.push("slip".into()))
        .add_observer(|_: On<SlipEnded>, mut log: ResMut<Log>| log.0.push("grip".into()));
}

fn taken(sim: &mut Sim) -> Vec<String> {
    core::mem::take(&mut sim.app.world_mut().resource_mut::<Log>().0)
}

fn count(log: &[String], what: &str) -> usize {
    log.iter().filter(|l| l.as_str() == what).count()
}

#[test]
fn a_drop_is_four_landings_with_hard_stops_and_a_lift_off_four_leavings() {
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        sim.floor(0.0);
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 3.0, 0.0));
        sim.seconds(4.0);
        let log = taken(&mut sim);
        assert!(count(&log, "bottomed") >= 4, "{hz} Hz: {log:?}");
        assert_eq!(
            count(&log, "landed"),
            count(&log, "left") + 4,
            "{hz} Hz: {log:?}"
        );
        car.push(&mut sim, Vec3::Y * 6.0);
        sim.seconds(0.4);
        let log = taken(&mut sim);
        assert_eq!(count(&log, "left"), 4, "{hz} Hz: {log:?}");
    }
}

#[test]
fn a_locked_stop_begins_and_ends_slipping_on_each_wheel_once() {
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        plane(&mut sim, Quat::IDENTITY);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.roll(&mut sim, Vec3::NEG_Z * 20.0);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(4.0);
        let log = taken(&mut sim);
        assert_eq!(count(&log, "slip"), 4, "{hz} Hz: {log:?}");
        assert_eq!(count(&log, "grip"), 4, "{hz} Hz: {log:?}");
    }
}

#[test]
fn a_shift_cuts_the_torque_for_the_shift_time() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference().wheel(|_, w| w.driven = true);
        plan.vehicle.drivetrain = Some(Drivetrain::default());
        let car = plan.park(&mut sim, Quat::IDENTITY);
        sim.seconds(1.0);
        car.ask(&mut sim, |i| i.throttle = 1.0);
        let mut cut = 0;
        let mut shifted = false;
        for _ in 0..(6.0 * hz) as usize {
            sim.ticks(1);
            shifted |= taken(&mut sim).iter().any(|l| l == "gear 1 2");
            if shifted {
                let torque: f32 = car.all(&sim).iter().map(|w| w.drive_torque.abs()).sum();
                if torque > 1.0 {
                    break;
                }
                cut += 1;
            }
        }
        found.holds(format!("{hz} Hz: shifted"), shifted);
        let time = f32::from(cut as u16) / hz as f32;
        found.near(format!("{hz} Hz: cut"), time, 0.25, 1.01 / hz as f32);
    }
}

#[test]
fn an_engine_that_is_held_below_its_stall_speed_dies_and_can_be_started() {
    for hz in RATES {
        let mut sim = Sim::new(hz);
        record(&mut sim);
        plane(&mut sim, Quat::IDENTITY);
        let mut plan = Plan::reference().wheel(|_, w| w.driven = true);
        plan.vehicle.drivetrain = Some(Drivetrain {
            source: PowerSource::Engine(Engine {
                stall: Some(400.0),
                ..default()
            }),
            clutch: Clutch {
                torque: 500.0,
                automatic: false,
            },
            ..default()
        });
        let car = plan.park(&mut sim, Quat::IDENTITY);
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(2.0);
        assert_eq!(count(&taken(&mut sim), "stalled"), 1, "{hz} Hz");
        assert!(car.telemetry(&sim).rpm < 50.0, "{hz} Hz");
        car.ask(&mut sim, |i| {
            i.clutch = 1.0;
            i.starter = true;
        });
        sim.seconds(1.0);
        let rpm = car.telemetry(&sim).rpm;
        assert!((rpm - 850.0).abs() < 50.0, "{hz} Hz: {rpm}");
    }
}

#[test]
fn a_parked_car_sleeps_wakes_without_a_hop_and_drives_off() {
    let mut found = Findings::new();
    for hz in RATES {
        for rotation in [Quat::IDENTITY, uphill(15.0)] {
            let mut sim = Sim::new(hz);
            plane(&mut sim, rotation);
            let car = Plan::reference()
                .direct(2000.0, |_| true)
                .park(&mut sim, rotation);
            insert(&mut sim, car.body, Sleeping::default());
            car.ask(&mut sim, |i| i.brake = 1.0);
            sim.seconds(15.0);
            let case = format!("{hz} Hz {:.2}", rotation.to_scaled_axis().x);
            found.holds(format!("{case}: sleeps"), car.telemetry(&sim).asleep);
            let before = car.pose(&sim).translation;
            // Steering wakes it, and nothing else happens.
            car.ask(&mut sim, |i| i.steer = 0.1);
            let mut farthest = 0.0f32;
            for _ in 0..hz as usize {
                sim.ticks(1);
                farthest = farthest.max((car.pose(&sim).translation - before).length());
            }
            found.holds(format!("{case}: awake"), !car.telemetry(&sim).asleep);
            found.at_most(format!("{case}: hop"), farthest, 0.001);
            car.ask(&mut sim, |i| {
                i.steer = 0.0;
                i.brake = 0.0;
                i.throttle = 1.0;
            });
            sim.seconds(1.0);
            let speed = car.telemetry(&sim).speed;
            found.at_least(format!("{case}: drives"), speed, 1.0);
        }
    }
}

#[test]
fn a_sleeping_car_wakes_when_its_lift_starts() {
    let mut sim = Sim::new(60.0);
    let lift = sim.kinematic(
        Collider::cuboid(5.0, 0.5, 5.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
    );
    let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
    insert(&mut sim, car.body, Sleeping::default());
    sim.seconds(10.0);
    assert!(car.telemetry(&sim).asleep);
    for tick in 0..120 {
        sim.place(lift, Vec3::new(0.0, -0.5 + 0.02 * tick as f32, 0.0));
        sim.ticks(1);
    }
    let y = car.pose(&sim).translation.y;
    assert!((y - (HEIGHT + 2.38)).abs() < 0.1, "{y}");
}

#[test]
fn wheels_are_seen_where_they_touch() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        sim.floor(0.0);
        let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
        sim.seconds(3.0);
        for (i, wheel) in car.wheels.iter().enumerate() {
            let at = sim.position(*wheel);
            found.near(format!("{hz} Hz wheel {i}: height"), at.y, RADIUS, 0.002);
            found.near(
                format!("{hz} Hz wheel {i}: aside"),
                at.x.abs(),
                HALF_TRACK,
                1.0e-3,
            );
        }
    }
}

#[test]
fn a_despawned_car_takes_its_wheels_along_and_leaves_no_force() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let crate_ = sim.dynamic(
        Collider::cuboid(3.0, 0.5, 3.0),
        Transform::from_xyz(0.0, 0.5, 0.0),
        500.0,
    );
    let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, 1.0 + HEIGHT, 0.0));
    sim.seconds(2.0);
    sim.app.world_mut().despawn(car.body);
    sim.ticks(2);
    assert!(sim.app.world().get_entity(car.wheels[0]).is_err());
    sim.place(crate_, Vec3::new(0.0, 50.0, 0.0));
    sim.ticks(2);
    let before = sim.get::<Velocity>(crate_).linear.y;
    sim.seconds(1.0);
    let fallen = before - sim.get::<Velocity>(crate_).linear.y;
    assert!((fallen - G).abs() < 0.05, "{fallen}");
}
