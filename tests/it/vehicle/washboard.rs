//! Short waves: loads along normals that lean to and fro.

use bevy::{ecs::world::CommandQueue, math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Waves of 4 cm every 0.8 m along −Z from the origin on, 48 m of them.
fn waves() -> Collider {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=600u32 {
        let at = i as f32 * 0.08;
        let y = 0.02 * (1.0 - ops::cos(core::f32::consts::TAU * at / 0.8));
        points.extend([Vec3::new(-4.0, y, -at), Vec3::new(4.0, y, -at)]);
        if i < 600 {
            let a = 2 * i;
            triangles.extend([[a, a + 1, a + 2], [a + 1, a + 3, a + 2]]);
        }
    }
    Collider::trimesh(points, triangles).expect("there are triangles")
}

#[test]
fn over_waves_what_the_wheels_push_up_is_the_weight_and_what_lifts_the_car() {
    // Their mean load is not: along normals that lean, beside what drives and brakes, and over a time in
    // which the car begins to fall or to rise, it is other than m g by some hundredths.
    let mut found = Findings::new();
    for (hz, probe) in RATES
        .iter()
        .flat_map(|hz| [WheelProbe::Ray, WheelProbe::Cylinder].map(|probe| (*hz, probe)))
    {
        for speed in [3.0, 8.0] {
            let mut preset = VehiclePreset::kart();
            // Its belly above all crests, and no air.
            preset.hull_center.y += 1.0;
            preset.vehicle.aero = None;
            for wheel in &mut preset.wheels {
                wheel.probe = probe;
            }
            let mass = preset.mass.mass;
            let mut sim = Sim::new(hz);
            sim.block(Vec3::new(0.0, -0.5, 20.0), Vec3::new(8.0, 1.0, 40.0));
            sim.fixed(waves(), Transform::default());
            let mut queue = CommandQueue::default();
            let start = Transform::from_xyz(0.0, 0.0, 15.0);
            let kart = preset.spawn(&mut Commands::new(&mut queue, sim.app.world()), start);
            queue.apply(sim.app.world_mut());
            insert(&mut sim, kart, Velocity::default());
            sim.seconds(1.0);
            let wheels: Vec<Entity> = sim
                .app
                .world()
                .get::<Wheels>(kart)
                .map(|wheels| wheels.iter().collect())
                .unwrap_or_default();
            let (mut up, mut load, mut ticks) = (0.0f64, 0.0f64, 0u32);
            let (mut first, mut last) = (None, 0.0);
            // The way there and across it takes less than this.
            for _ in 0..(30.0 * hz) as usize {
                if sim.position(kart).z < -30.0 {
                    break;
                }
                let velocity = sim.get::<Velocity>(kart).linear;
                edit::<VehicleIntent>(&mut sim, kart, |i| {
                    i.throttle = (0.5 * (speed + velocity.z) + 0.1).clamp(0.0, 1.0);
                });
                sim.ticks(1);
                if sim.position(kart).z > -4.0 {
                    continue;
                }
                ticks += 1;
                first = first.or(Some(velocity.y));
                last = sim.get::<Velocity>(kart).linear.y;
                for wheel in &wheels {
                    let wheel = sim.get::<WheelState>(*wheel);
                    load += f64::from(wheel.load);
                    if let Some(contact) = wheel.contact {
                        let across = contact.forward.cross(contact.normal);
                        let force = contact.normal * wheel.load
                            + contact.forward * wheel.force.x
                            + across * wheel.force.y;
                        up += f64::from(force.y);
                    }
                }
            }
            let ticks = f64::from(ticks);
            let weight = f64::from(mass * G) * ticks;
            let lift = f64::from((last - first.unwrap_or(0.0)) * mass) * hz;
            let case = format!(
                "{hz} Hz {probe:?} {speed} m/s, loads of {:.3} m g",
                load / weight
            );
            found.at_least(format!("{case}: ticks"), ticks as f32, hz as f32);
            let got = (up - lift) / weight;
            found.near(case, got as f32, 1.0, 2.0e-3);
        }
    }
}
