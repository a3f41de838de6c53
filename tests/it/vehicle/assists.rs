//! Help for the driver, each beside a car without it.

use bevy::{ecs::world::CommandQueue, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::{Collider, RigidBody, Sleeping};
use embody_scenes::Sim;

use super::support::*;

#[test]
fn traction_control_keeps_driven_wheels_from_spinning() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |control: bool| {
            let mut sim = Sim::new(hz);
            let floor = plane(&mut sim, Quat::IDENTITY);
            insert(&mut sim, floor, SurfaceFriction::new(0.4));
            let car = Plan::reference()
                .direct(4000.0, |i| i < 2)
                .park(&mut sim, Quat::IDENTITY);
            if control {
                insert(&mut sim, car.body, TractionControl::default());
            }
            sim.seconds(1.0);
            car.ask(&mut sim, |i| i.throttle = 1.0);
            sim.seconds(3.0);
            let slip = car.wheel(&sim, 0).slip_ratio;
            (slip, car.telemetry(&sim).speed)
        };
        let (free, controlled) = (run(false), run(true));
        found.at_least(format!("{hz} Hz: spins without"), free.0, 0.5);
        found.at_most(format!("{hz} Hz: slip with"), controlled.0, 0.3);
        found.at_least(format!("{hz} Hz: speed"), controlled.1, 0.8 * free.1);
    }
}

/// A car let go on a hill of 10 degrees stays for the time of its hill hold, seconds, then rolls.
fn held_then_rolls(found: &mut Findings, hz: f64, time: f32, with: impl Bundle) {
    let rotation = uphill(10.0);
    let mut sim = Sim::new(hz);
    plane(&mut sim, rotation);
    let car = Plan::reference().park(&mut sim, rotation);
    insert(&mut sim, car.body, (HillHold { time }, with));
    car.ask(&mut sim, |i| i.brake = 1.0);
    sim.seconds(4.0);
    let start = car.pose(&sim).translation;
    car.ask(&mut sim, |i| i.brake = 0.0);
    sim.seconds(f64::from(time) - 0.1);
    let held = (car.pose(&sim).translation - start).length();
    found.at_most(format!("{hz} Hz: held"), held, 0.001);
    sim.seconds(1.1);
    let rolled = (car.pose(&sim).translation - start).length();
    found.at_least(format!("{hz} Hz: rolls"), rolled, 0.5);
}

/// How far up a hill of this angle a car gets in three seconds from a stop, metres, nose up or, in reverse,
/// nose down.
fn climb(
    preset: &VehiclePreset,
    hz: f64,
    angle: f32,
    gear: Gear,
    throttle: f32,
    helper: Option<TractionControl>,
) -> f32 {
    let backward = gear == Gear::Reverse;
    let rotation = uphill(if backward { -angle } else { angle });
    let mut sim = Sim::new(hz);
    plane(&mut sim, rotation);
    let mut queue = CommandQueue::default();
    let mut commands = Commands::new(&mut queue, sim.app.world());
    let car = preset.spawn(&mut commands, Transform::from_rotation(rotation));
    queue.apply(sim.app.world_mut());
    if let Some(helper) = helper {
        insert(&mut sim, car, helper);
    }
    edit::<VehicleIntent>(&mut sim, car, |i| {
        i.brake = 1.0;
        i.gear = gear;
    });
    sim.seconds(1.5);
    let start = sim.position(car).y;
    edit::<VehicleIntent>(&mut sim, car, |i| {
        i.brake = 0.0;
        i.throttle = throttle;
    });
    sim.seconds(3.0);
    sim.position(car).y - start
}

/// Every car with traction control and its foot down, beside the best driver: who gives as much throttle
/// as climbs farthest. At least seven tenths of that way, on hills that can be climbed at every tick rate;
/// tells how many.
fn climbs_beside_the_best(found: &mut Findings, gear: Gear) -> usize {
    let mut climbed = 0;
    for (name, preset) in [
        ("hatchback", VehiclePreset::hatchback()),
        ("sports car", VehiclePreset::sports_car()),
        ("suv", VehiclePreset::suv()),
        ("electric car", VehiclePreset::electric_car()),
    ] {
        for angle in [10.0, 20.0, 30.0] {
            let go = |hz, throttle, helper| climb(&preset, hz, angle, gear, throttle, helper);
            let best = [30.0, 60.0, 240.0].map(|hz| {
                let by_foot = [0.6, 0.8, 1.0].map(|throttle| go(hz, throttle, None));
                (hz, by_foot.into_iter().fold(f32::MIN, f32::max))
            });
            if best.iter().any(|(_, best)| *best < 0.3) {
                continue;
            }
            climbed += 1;
            for (hz, best) in best {
                let helped = go(hz, 1.0, Some(TractionControl::default()));
                let case = format!("{hz} Hz {name} on {angle}°, {best} m by the best foot");
                found.at_least(case, helped, 0.7 * best);
            }
        }
    }
    climbed
}

#[test]
fn with_traction_control_a_foot_that_is_down_climbs_hills_seven_tenths_as_far_as_the_best() {
    let mut found = Findings::new();
    let climbed = climbs_beside_the_best(&mut found, Gear::Drive);
    // All of 10°, all but the front-wheel drive of 20°, the four-wheel drive of 30°.
    found.at_least("hills that can be climbed", climbed as f32, 8.0);
}

#[test]
fn with_traction_control_hills_are_climbed_backward_too() {
    // Backward the front-wheel drive has the weight on its axle, and the others lose it.
    let mut found = Findings::new();
    let climbed = climbs_beside_the_best(&mut found, Gear::Reverse);
    found.at_least("hills that can be climbed", climbed as f32, 6.0);
}

#[test]
fn hill_hold_keeps_the_car_for_its_time_and_no_longer() {
    let mut found = Findings::new();
    for hz in RATES {
        held_then_rolls(&mut found, hz, 2.0, ());
    }
}

#[test]
fn a_car_that_hill_hold_keeps_does_not_sleep_through_its_end() {
    let mut found = Findings::new();
    for hz in RATES {
        held_then_rolls(&mut found, hz, 8.0, Sleeping::default());
    }
}

#[test]
fn stability_control_catches_an_oversteering_car() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |control: bool| {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            // Much less grip behind than in front.
            let plan = Plan::reference().wheel(|i, w| {
                if i >= 2 {
                    w.tire.across = TireModel::Linear { stiffness: 45.0e3 };
                    w.tire.friction = Vec2::splat(0.8);
                }
            });
            let car = plan.park(&mut sim, Quat::IDENTITY);
            if control {
                insert(&mut sim, car.body, StabilityControl::default());
            }
            sim.seconds(1.0);
            car.roll(&mut sim, Vec3::NEG_Z * 27.0);
            car.ask(&mut sim, |i| i.steer = 0.06);
            let mut most = 0.0f32;
            for _ in 0..(2.5 * hz) as usize {
                sim.ticks(1);
                let v = car.velocity(&sim).linear;
                let slide = v.angle_between(forward(&car.pose(&sim)));
                most = most.max(slide);
            }
            most.to_degrees()
        };
        let (free, controlled) = (run(false), run(true));
        found.at_least(format!("{hz} Hz: spins without"), free, 60.0);
        found.at_most(format!("{hz} Hz: slides with"), controlled, 25.0);
    }
}

#[test]
fn stability_control_leaves_a_car_alone_that_the_ground_turns() {
    // Half a radian per second, six times what it leaves alone.
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        let mover = sim.moving(|t| {
            let turned = Quat::from_rotation_y(0.5 * t as f32);
            Transform::from_xyz(0.0, -0.5, 0.0).with_rotation(turned)
        });
        sim.spawn((
            RigidBody::KinematicPositionBased,
            Collider::cuboid(200.0, 0.5, 200.0),
            Transform::from_xyz(0.0, -0.5, 0.0),
            mover,
        ));
        let car = Plan::reference().spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT, 0.0));
        insert(&mut sim, car.body, StabilityControl::default());
        car.ask(&mut sim, |i| i.brake = 1.0);
        sim.seconds(2.0);
        let mut busy = 0;
        for driven in [false, true] {
            if driven {
                car.ask(&mut sim, |i| i.brake = 0.0);
                let ahead = forward(&car.pose(&sim));
                car.roll(&mut sim, ahead * 8.0);
            }
            for _ in 0..(0.5 * hz) as usize {
                sim.ticks(1);
                busy += u32::from(car.telemetry(&sim).stability_control);
            }
        }
        found.at_least(format!("{hz} Hz: drives"), car.telemetry(&sim).speed, 7.0);
        found.at_most(format!("{hz} Hz: ticks of braking"), busy as f32, 0.0);
    }
}

#[test]
fn air_control_turns_the_car_in_flight_and_only_there() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |height: f32| {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let mut plan = Plan::reference();
            plan.vehicle.aero = Some(Aero {
                drag_area: 0.0,
                air_control: Vec3::splat(1200.0),
                ..default()
            });
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + height, 0.0));
            car.ask(&mut sim, |i| i.air = Vec3::new(1.0, 0.0, 0.0));
            sim.seconds(1.0);
            car.velocity(&sim).angular.x
        };
        // 1200 N·m on 2400 kg·m² for a second.
        found.within(format!("{hz} Hz: in the air"), run(30.0), 0.5, 0.05);
        found.near(format!("{hz} Hz: on the ground"), run(0.0), 0.0, 1.0e-3);
    }
}
