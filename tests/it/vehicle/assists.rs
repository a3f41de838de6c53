//! Help for the driver, each beside a car without it.

use bevy::{ecs::world::CommandQueue, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::Sleeping;
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

#[test]
fn traction_control_starts_on_every_hill_that_the_car_climbs_without_it() {
    let mut found = Findings::new();
    let mut climbed = 0.0;
    for (name, preset) in [
        ("hatchback", VehiclePreset::hatchback()),
        ("sports car", VehiclePreset::sports_car()),
        ("suv", VehiclePreset::suv()),
        ("electric car", VehiclePreset::electric_car()),
    ] {
        for (hz, angle) in RATES
            .iter()
            .flat_map(|hz| [10.0, 20.0, 30.0].map(|a| (*hz, a)))
        {
            let run = |control: bool| {
                let rotation = uphill(angle);
                let mut sim = Sim::new(hz);
                plane(&mut sim, rotation);
                let mut queue = CommandQueue::default();
                let mut commands = Commands::new(&mut queue, sim.app.world());
                let car = preset.spawn(&mut commands, Transform::from_rotation(rotation));
                queue.apply(sim.app.world_mut());
                if control {
                    insert(&mut sim, car, TractionControl::default());
                }
                edit::<VehicleIntent>(&mut sim, car, |i| i.brake = 1.0);
                sim.seconds(1.5);
                let start = sim.position(car).y;
                edit::<VehicleIntent>(&mut sim, car, |i| {
                    i.brake = 0.0;
                    i.throttle = 1.0;
                });
                sim.seconds(3.0);
                sim.position(car).y - start
            };
            let (free, controlled) = (run(false), run(true));
            let case = format!("{hz} Hz {name} on {angle}°, {free} m without");
            if free > 0.3 {
                climbed += 1.0;
                found.at_least(case, controlled, 0.3);
            }
        }
    }
    // Not the front-wheel drive on the steeper ones.
    found.at_least("hills that were climbed", climbed, 24.0);
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
