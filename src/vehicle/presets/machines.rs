//! Heavy ones: truck, forklift, tracked vehicle.

use bevy::prelude::*;

use super::{
    VehiclePreset,
    parts::{
        Body, aero, brakes, clutch, driven, electric, engine, gearbox, pair, road_steering,
        road_tire, wheel,
    },
};
use crate::vehicle::{
    config::Vehicle,
    drivetrain::{Differential, Drivetrain, Gearbox},
    steering::Steering,
    tire::TireModel,
};

impl VehiclePreset {
    /// A truck of 18 t on six wheels, the rear four driven.
    pub fn truck() -> Self {
        let body = Body {
            mass: 18_000.0,
            size: Vec3::new(2.5, 2.8, 8.5),
            height: 1.35,
            ahead: -0.75,
        };
        let mut tire = road_tire(30_000.0, 0.75);
        tire.along = TireModel::Brush { stiffness: 400.0e3 };
        tire.across = TireModel::Brush { stiffness: 280.0e3 };
        tire.rolling_resistance = 0.007;
        tire.relaxation_length = Vec2::new(0.4, 0.7);
        let mut base = wheel(0.5, 0.32, 12.0, tire, 1.5, 0.28);
        base.suspension.unsprung_mass = 250.0;
        base.suspension.stop_stiffness = 1.5e6;
        let mut wheels = Vec::new();
        for (axle, z) in [(0u8, -2.6), (1, 1.6), (2, 2.95)] {
            wheels.extend(pair(&base, axle, z, 1.0, axle == 0, axle > 0));
        }
        Self {
            vehicle: Vehicle {
                steering: Steering {
                    rate: 1.2,
                    ..road_steering(40.0)
                },
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (600.0, 1300.0),
                            (1000.0, 1900.0),
                            (1500.0, 1950.0),
                            (2100.0, 1500.0),
                        ],
                        2200.0,
                        2.5,
                    ),
                    clutch: clutch(3500.0),
                    gearbox: Gearbox {
                        shift_time: 0.5,
                        ..gearbox(
                            &[9.2, 6.6, 4.8, 3.5, 2.6, 1.9, 1.4, 1.0],
                            8.5,
                            1800.0,
                            1050.0,
                        )
                    },
                    final_drive: 4.1,
                    efficiency: 0.88,
                    axles: vec![
                        driven(1, 0.5, Differential::Open),
                        driven(2, 0.5, Differential::Open),
                    ],
                    center: Differential::LimitedSlip {
                        bias: 3.0,
                        preload: 300.0,
                    },
                    tracks: false,
                }),
                brakes: brakes(85_000.0, 0.38, 14_000.0),
                anti_roll: vec![120_000.0, 90_000.0, 90_000.0],
                aero: Some(aero(5.2, 0.0, 0.0)),
                ..default()
            },
            wheels,
            ..body.preset()
        }
    }

    /// A forklift: 4 t, driven in front, steered behind, electric.
    pub fn forklift() -> Self {
        let body = Body {
            mass: 4000.0,
            size: Vec3::new(1.2, 1.8, 2.4),
            height: 0.7,
            ahead: -0.2,
        };
        let mut tire = road_tire(10_000.0, 0.8);
        tire.relaxation_length = Vec2::splat(0.1);
        let base = wheel(0.3, 0.25, 2.0, tire, 4.0, 0.06);
        let mut wheels = Vec::new();
        wheels.extend(pair(&base, 0, -0.75, 0.5, false, true));
        wheels.extend(pair(&base, 1, 0.75, 0.45, true, false));
        for wheel in &mut wheels {
            wheel.suspension.stop_length = 0.01;
            wheel.suspension.stop_stiffness = 1.0e6;
        }
        Self {
            vehicle: Vehicle {
                steering: Steering {
                    max_angle: 70f32.to_radians(),
                    rate: 1.5,
                    ..default()
                },
                drivetrain: Some(electric(120.0, 15.0e3, 3500.0, 20.0)),
                brakes: brakes(9000.0, 1.0, 4000.0),
                aero: Some(aero(1.8, 0.0, 0.0)),
                ..default()
            },
            wheels,
            ..body.preset()
        }
    }

    /// A tracked vehicle: 12 t on two times five road wheels, each side turning as one; steers by
    /// driving one side against the other.
    pub fn tracked() -> Self {
        let body = Body {
            mass: 12_000.0,
            size: Vec3::new(2.6, 1.6, 5.0),
            height: 1.0,
            ahead: 0.0,
        };
        let mut tire = road_tire(12_000.0, 0.8);
        tire.friction = Vec2::new(0.9, 0.6);
        tire.rolling_resistance = 0.04;
        let mut base = wheel(0.34, 0.4, 8.0, tire, 1.4, 0.3);
        base.suspension.unsprung_mass = 120.0;
        base.suspension.stop_stiffness = 8.0e5;
        let mut wheels = Vec::new();
        for axle in 0..5u8 {
            let z = -1.8 + 0.9 * f32::from(axle);
            wheels.extend(pair(&base, axle, z, 1.1, false, true));
        }
        Self {
            vehicle: Vehicle {
                steering: Steering {
                    max_angle: 0.0,
                    skid_torque: 2600.0,
                    ..default()
                },
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[(700.0, 900.0), (1400.0, 1200.0), (2400.0, 1000.0)],
                        2600.0,
                        1.5,
                    ),
                    clutch: clutch(2500.0),
                    gearbox: gearbox(&[5.0, 3.0, 1.9, 1.3], 5.0, 2200.0, 1100.0),
                    final_drive: 5.0,
                    efficiency: 0.8,
                    tracks: true,
                    ..default()
                }),
                brakes: brakes(40_000.0, 0.5, 3000.0),
                aero: Some(aero(4.0, 0.0, 0.0)),
                ..default()
            },
            wheels,
            ..body.preset()
        }
    }
}
