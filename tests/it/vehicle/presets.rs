//! Every preset stands, drives, steers and stops as its kind does.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

fn spawn(sim: &mut Sim, preset: &VehiclePreset, name: &str) -> Entity {
    let mut queue = bevy::ecs::world::CommandQueue::default();
    let entity = {
        let mut commands = Commands::new(&mut queue, sim.app.world());
        preset.spawn(&mut commands, Transform::default())
    };
    queue.apply(sim.app.world_mut());
    insert(sim, entity, Velocity::default());
    if name == "motorcycle" {
        insert(sim, entity, LeanControl::default());
    }
    entity
}

fn ask(sim: &mut Sim, entity: Entity, change: impl FnOnce(&mut VehicleIntent)) {
    edit(sim, entity, change);
}

#[test]
fn every_preset_stands_at_its_height_drives_off_and_stops() {
    let mut found = Findings::new();
    for (name, preset) in VehiclePreset::all() {
        for hz in RATES {
            let mut sim = Sim::new(hz);
            plane(&mut sim, Quat::IDENTITY);
            let car = spawn(&mut sim, &preset, name);
            sim.seconds(3.0);
            let case = format!("{name} {hz} Hz");
            let y = sim.position(car).y;
            found.near(format!("{case}: stands at"), y, 0.0, 0.02);
            let still = sim.get::<Velocity>(car).linear.length();
            found.at_most(format!("{case}: still"), still, 0.02);
            ask(&mut sim, car, |i| i.throttle = 1.0);
            sim.seconds(8.0);
            let fast = sim.get::<VehicleTelemetry>(car);
            found.at_least(format!("{case}: speed"), fast.speed, 3.5);
            found.at_most(format!("{case}: speed"), fast.speed, 90.0);
            ask(&mut sim, car, |i| {
                i.throttle = 0.0;
                i.brake = 1.0;
            });
            sim.seconds(12.0);
            let slow = sim.get::<Velocity>(car).linear.length();
            found.at_most(format!("{case}: stopped"), slow, 0.02);
            let up = (sim.get::<Transform>(car).rotation * Vec3::Y).y;
            found.at_least(format!("{case}: upright"), up, 0.97);
        }
    }
}

#[test]
fn every_preset_turns_to_the_side_it_is_steered_to() {
    let mut found = Findings::new();
    for (name, preset) in VehiclePreset::all() {
        for steer in [-0.5, 0.5] {
            let mut sim = Sim::new(60.0);
            plane(&mut sim, Quat::IDENTITY);
            let car = spawn(&mut sim, &preset, name);
            sim.seconds(1.0);
            ask(&mut sim, car, |i| i.throttle = 0.4);
            sim.seconds(2.0);
            ask(&mut sim, car, |i| i.steer = steer);
            sim.seconds(1.5);
            let turned = -sim.get::<Velocity>(car).angular.y * steer.signum();
            found.at_least(format!("{name} {steer}: turns"), turned, 0.03);
            let up = (sim.get::<Transform>(car).rotation * Vec3::Y).y;
            found.at_least(format!("{name} {steer}: upright"), up, 0.7);
        }
    }
}

#[test]
fn a_tracked_vehicle_turns_on_the_spot() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let tank = spawn(&mut sim, &VehiclePreset::tracked(), "tracked vehicle");
        sim.seconds(2.0);
        ask(&mut sim, tank, |i| {
            i.steer = 1.0;
            i.gear = Gear::Neutral;
        });
        sim.seconds(4.0);
        let turned = -sim.get::<Velocity>(tank).angular.y;
        found.at_least(format!("{hz} Hz: turns"), turned, 0.15);
        let at = sim.position(tank);
        found.at_most(
            format!("{hz} Hz: stays"),
            Vec2::new(at.x, at.z).length(),
            0.5,
        );
    }
}

#[test]
fn a_trailer_on_a_joint_follows_its_car() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        plane(&mut sim, Quat::IDENTITY);
        let car = spawn(&mut sim, &VehiclePreset::suv(), "suv");
        let mut trailer = VehiclePreset::hatchback();
        trailer.vehicle = Vehicle::unpowered();
        trailer.mass =
            VehicleMass::of_box(700.0, Vec3::new(1.8, 1.0, 3.0), Vec3::new(0.0, 0.6, -0.05));
        trailer.hull = Vec3::new(1.8, 1.0, 3.0);
        trailer.hull_center = Vec3::Y * 0.9;
        trailer.wheels.truncate(2);
        for wheel in &mut trailer.wheels {
            wheel.attachment.z = 0.0;
            wheel.steer = 0.0;
            wheel.driven = false;
        }
        let behind = spawn(&mut sim, &trailer, "trailer");
        edit::<Transform>(&mut sim, behind, |t| t.translation.z = 5.2);
        let ball = SphericalJointBuilder::new()
            .local_anchor1(Vec3::new(0.0, 0.5, 2.6))
            .local_anchor2(Vec3::new(0.0, 0.5, -2.6));
        insert(&mut sim, behind, ImpulseJoint::new(car, ball));
        sim.seconds(2.0);
        ask(&mut sim, car, |i| i.throttle = 0.5);
        sim.seconds(6.0);
        let gap = (sim.position(behind) - sim.position(car)).length();
        found.near(format!("{hz} Hz: gap"), gap, 5.2, 0.05);
        let speed = sim.get::<VehicleTelemetry>(behind).speed;
        found.at_least(format!("{hz} Hz: follows"), speed, 5.0);
        ask(&mut sim, car, |i| {
            i.throttle = 0.0;
            i.brake = 1.0;
        });
        sim.seconds(8.0);
        let rest = sim.get::<Velocity>(car).linear.length();
        found.at_most(format!("{hz} Hz: stops"), rest, 0.01);
    }
}
