//! Vehicles: our full model beside Rapier's `DynamicRayCastVehicleController`.

use bevy::{ecs::world::CommandQueue, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{
    Sim,
    harness::around_tick,
    terrain::StableId,
    traffic::{Driver, LOWEST, Traffic},
};

use super::{Bounds, Compared, Seen, Subject, Variant};
use crate::{
    peer::{Peer, peer, update_controllers},
    probe::{begin, end},
    scene::Scene,
    side::Side,
};

pub const SUBJECT: Subject = Subject {
    name: "vehicles",
    one: "vehicle",
    scenes: &[
        Scene {
            name: "vehicles",
            about: "sports cars on ring roads over a wavy mesh, wheels by rays",
            warm_up: 120,
            build: |sim, side, count| traffic(sim, side, count, WheelProbe::Ray),
        },
        Scene {
            name: "vehicles_cylinders",
            about: "the same, wheels by cylinder casts",
            warm_up: 120,
            build: |sim, side, count| traffic(sim, side, count, WheelProbe::Cylinder),
        },
        Scene {
            name: "vehicles_parked",
            about: "the same, all parked",
            warm_up: 240,
            build: parked,
        },
    ],
    compared: &[
        Compared {
            scene: "vehicles",
            tag: "probe=ray",
            label: "wheels by rays",
            ratio: None,
            most: Some(10.0),
        },
        Compared {
            scene: "vehicles_cylinders",
            tag: "probe=cylinder",
            label: "wheels by cylinder casts",
            ratio: None,
            most: Some(25.0),
        },
    ],
    plugin: add_plugin,
    watch,
    // Nobody gets above this without being thrown.
    level: LOWEST - 0.3..4.0,
    count: 1000,
    steps: 200,
    variants: &[Variant {
        scene: "vehicles_parked",
        name: "parked",
        label: "parked",
        count: 1000,
        most: 0.3,
    }],
    bounds: Bounds {
        speed_up: 1.7,
        growth: 1.2,
    },
    together: false,
    counted: "What is timed is the vehicles' work alone: all our systems; for Rapier the update of its controllers,\n\
              which have neither engine nor gears, spinning wheels, tyre curves or anti-roll bars.",
};

fn add_plugin(app: &mut App, side: Side) {
    match side {
        Side::Ours => {
            use VehicleSystems::{Drive, Prepare, React};
            app.add_plugins(VehiclePlugin);
            around_tick(app, [Prepare, Drive, React], begin, end);
        }
        Side::Rapier => {
            app.add_systems(
                FixedPostUpdate,
                (begin, update_controllers, end)
                    .chain()
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
            );
        }
    }
}

/// A sports car with its limited slip differential, gearbox, magic formula tyres and anti-roll bars;
/// it changes gear early, so that it does so on short roads.
fn car() -> VehiclePreset {
    let mut car = VehiclePreset::sports_car();
    if let Some(drivetrain) = &mut car.vehicle.drivetrain {
        drivetrain.gearbox.shifting = Shifting::Automatic {
            up: 3000.0,
            down: 1500.0,
        };
    }
    car
}

/// Distance of the axles, metres.
fn wheelbase(car: &VehiclePreset) -> f32 {
    let z = car.wheels.iter().map(|wheel| wheel.attachment.z);
    let (low, high) = z.fold((f32::MAX, f32::MIN), |(a, b), z| (a.min(z), b.max(z)));
    high - low
}

fn spawn(side: Side, world: &mut World, car: &VehiclePreset, at: Transform, extra: impl Bundle) {
    let entity = match side {
        Side::Ours => {
            let mut queue = CommandQueue::default();
            let entity = car.spawn(&mut Commands::new(&mut queue, world), at);
            queue.apply(world);
            entity
        }
        Side::Rapier => {
            let half = car.hull * 0.5;
            let hull = Collider::compound(vec![(
                car.hull_center,
                Quat::IDENTITY,
                Collider::cuboid(half.x, half.y, half.z),
            )]);
            world.spawn((peer(&car.mass, hull, &car.wheels), at)).id()
        }
    };
    world
        .entity_mut(entity)
        .insert((Velocity::default(), extra));
}

#[derive(Resource)]
struct Fleet {
    car: VehiclePreset,
    wheelbase: f32,
}

fn traffic(sim: &mut Sim, side: Side, count: u32, probe: WheelProbe) {
    let mut car = car();
    for wheel in &mut car.wheels {
        wheel.probe = probe;
    }
    place(sim, side, count, &car);
    sim.app
        .insert_resource(Fleet {
            wheelbase: wheelbase(&car),
            car,
        })
        .add_systems(FixedUpdate, (ask_drivers, steer_ours, steer_peers).chain());
}

fn place(sim: &mut Sim, side: Side, count: u32, car: &VehiclePreset) {
    let traffic = Traffic::for_cars(count);
    let world = sim.app.world_mut();
    traffic.spawn_ground(world);
    for i in 0..count {
        let (driver, start) = traffic.driver(i);
        spawn(side, world, car, start, (StableId(i), driver));
    }
}

fn parked(sim: &mut Sim, side: Side, count: u32) {
    let car = car();
    place(sim, side, count, &car);
    let brake = |mut intents: Query<&mut VehicleIntent>| {
        for mut intent in &mut intents {
            intent.set_if_neq(VehicleIntent {
                brake: 1.0,
                ..default()
            });
        }
    };
    sim.app
        .insert_resource(Fleet {
            wheelbase: wheelbase(&car),
            car,
        })
        .add_systems(FixedUpdate, brake);
}

/// The drivers are the game's part, the same on every side and not measured.
fn ask_drivers(fleet: Res<Fleet>, mut drivers: Query<(&mut Driver, &Transform, &Velocity)>) {
    for (mut driver, at, velocity) in &mut drivers {
        driver.drive(at, velocity.linear, fleet.wheelbase);
    }
}

fn steer_ours(fleet: Res<Fleet>, mut cars: Query<(&Driver, &Velocity, &mut VehicleIntent)>) {
    let steering = &fleet.car.vehicle.steering;
    for (driver, velocity, mut intent) in &mut cars {
        // The wheel turns less at speed: asked for so that the angle is the driver's.
        let most = steering.target(1.0, velocity.linear.length());
        intent.throttle = driver.throttle;
        intent.brake = driver.brake;
        intent.steer = (driver.angle / most).clamp(-1.0, 1.0);
    }
}

fn steer_peers(fleet: Res<Fleet>, mut cars: Query<(&Driver, &mut Peer)>) {
    let weight = fleet.car.mass.mass * 9.81;
    for (driver, mut peer) in &mut cars {
        // A sports car's 0.8 g, and its 1 g of brakes as an impulse of each wheel in a tick.
        let brake = driver.brake * 0.25 * weight / 60.0;
        peer.ask(driver.angle, driver.throttle * 0.8 * weight, brake);
    }
}

fn watch(world: &mut World) -> Vec<Seen> {
    let mut cars = world.query::<(&StableId, &Driver, &Transform)>();
    cars.iter(world)
        .map(|(id, driver, transform)| Seen {
            id: *id,
            at: transform.translation,
            wished: driver.speed,
            upright: transform.up().y > 0.3,
        })
        .collect()
}
