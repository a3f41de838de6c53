//! Drivetrains with closed forms, on the reference car.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use crate::{Sim, reference::Plan};

/// Wheel radius of the [`corvette`], metres.
pub const CORVETTE_RADIUS: f32 = 0.34;
/// Its first gear and final drive.
pub const CORVETTE_RATIO: f32 = 2.66 * 3.42;

/// 448 N·m at every speed, gears of 2.66 and 1.78, final drive 3.42, efficiency 0.7, rear wheels driven;
/// the engine has this inertia, kg·m², and a shift takes 0.3 s.
pub fn corvette(inertia: f32) -> Plan {
    let mut plan = Plan::reference().wheel(|i, wheel| {
        wheel.driven = i >= 2;
        wheel.radius = CORVETTE_RADIUS;
        wheel.attachment.y += 0.04;
        wheel.tire.friction = Vec2::splat(3.0);
    });
    plan.vehicle.drivetrain = Some(Drivetrain {
        source: PowerSource::Engine(Engine {
            torque: vec![TorquePoint {
                rpm: 1000.0,
                torque: 448.0,
            }],
            idle: 700.0,
            redline: 6000.0,
            inertia,
            friction: 0.0,
            viscosity: 0.0,
            stall: None,
        }),
        clutch: Clutch {
            torque: 2000.0,
            automatic: false,
        },
        gearbox: Gearbox {
            forward: vec![2.66, 1.78],
            reverse: 2.9,
            shift_time: 0.3,
            shifting: Shifting::Manual,
        },
        final_drive: 3.42,
        efficiency: 0.7,
        ..default()
    });
    plan
}

/// A motor of this torque, N·m, straight on a differential between the rear wheels.
pub fn rear_motor(torque: f32, differential: Differential) -> Plan {
    let mut plan = Plan::reference().wheel(|i, wheel| wheel.driven = i >= 2);
    plan.vehicle.drivetrain = Some(Drivetrain {
        source: PowerSource::Motor(ElectricMotor {
            torque,
            power: 1.0e9,
            redline: 1.0e6,
            inertia: 1.0e-3,
            recuperation: 0.0,
        }),
        gearbox: Gearbox {
            forward: vec![1.0],
            ..default()
        },
        final_drive: 1.0,
        efficiency: 1.0,
        axles: vec![DrivenAxle {
            axle: 1,
            share: 1.0,
            differential,
        }],
        ..default()
    });
    plan
}

/// Ice (friction 0.1) to the left of `x = 0`, asphalt (1) to the right.
pub fn split_road(sim: &mut Sim) {
    for (x, friction) in [(-50.0, 0.1), (50.0, 1.0)] {
        let slab = sim.block(Vec3::new(x, -0.5, 0.0), Vec3::new(100.0, 1.0, 400.0));
        let mut slab = sim.app.world_mut().entity_mut(slab);
        slab.insert(SurfaceFriction::new(friction));
    }
}
