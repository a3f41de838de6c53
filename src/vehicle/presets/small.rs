//! Light ones: go-kart, motorcycle.

use bevy::prelude::*;

use super::{
    VehiclePreset,
    parts::{Body, aero, brakes, clutch, driven, engine, four, gearbox, road_tire, wheel},
};
use crate::vehicle::{
    config::Vehicle,
    drivetrain::{Differential, Drivetrain},
    steering::{SteerPoint, Steering},
    tire::TireModel,
    wheel::Wheel,
};

impl VehiclePreset {
    /// A go-kart: 170 kg with its driver, one gear, no springs to speak of, a rigid rear axle.
    pub fn kart() -> Self {
        let body = Body {
            mass: 170.0,
            size: Vec3::new(1.3, 0.35, 1.7),
            height: 0.24,
            ahead: -0.08,
        };
        let mut tire = road_tire(420.0, 1.4);
        tire.along = TireModel::Brush { stiffness: 14.0e3 };
        tire.across = TireModel::Brush { stiffness: 11.0e3 };
        tire.relaxation_length = Vec2::new(0.08, 0.12);
        let mut base = wheel(0.14, 0.16, 0.05, tire, 5.5, 0.05);
        base.suspension.stop_length = 0.01;
        base.suspension.stop_stiffness = 8.0e4;
        base.suspension.unsprung_mass = 3.0;
        let mut wheels = four(&base, 0.52, 0.55, false, true);
        for wheel in &mut wheels[..2] {
            wheel.brake = 0.0;
        }
        Self {
            vehicle: Vehicle {
                steering: Steering {
                    max_angle: 25f32.to_radians(),
                    rate: 4.0,
                    ..default()
                },
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (1500.0, 9.0),
                            (6000.0, 14.0),
                            (10_000.0, 15.0),
                            (13_000.0, 11.0),
                        ],
                        13_500.0,
                        0.004,
                    ),
                    clutch: clutch(30.0),
                    gearbox: gearbox(&[1.0], 1.0, 13_000.0, 2000.0),
                    final_drive: 6.5,
                    efficiency: 0.95,
                    axles: vec![driven(1, 1.0, Differential::Locked)],
                    ..default()
                }),
                brakes: brakes(330.0, 0.0, 100.0),
                aero: Some(aero(0.55, 0.0, 0.0)),
                ..default()
            },
            wheels,
            ..body.preset()
        }
    }

    /// A motorcycle: 270 kg with its rider. Spawn it with
    /// [`LeanControl`](crate::vehicle::LeanControl), or it falls over.
    pub fn motorcycle() -> Self {
        let body = Body {
            mass: 270.0,
            size: Vec3::new(0.5, 1.2, 1.9),
            height: 0.6,
            ahead: 0.0,
        };
        let mut tire = road_tire(1400.0, 1.2);
        tire.along = TireModel::Brush { stiffness: 30.0e3 };
        tire.across = TireModel::Brush { stiffness: 22.0e3 };
        // Lean alone carries about its tangent in g, as round tyres do.
        tire.camber_stiffness = 0.06;
        tire.relaxation_length = Vec2::new(0.1, 0.2);
        let mut base = wheel(0.31, 0.14, 0.5, tire, 2.0, 0.14);
        base.suspension.unsprung_mass = 14.0;
        base.suspension.stop_stiffness = 6.0e4;
        base.suspension.stop_length = 0.02;
        let one = |z: f32, axle: u8| Wheel {
            attachment: base.attachment + Vec3::Z * z,
            axle,
            steer: if axle == 0 { 1.0 } else { 0.0 },
            driven: axle == 1,
            handbrake: axle == 1,
            ..base.clone()
        };
        Self {
            vehicle: Vehicle {
                steering: Steering {
                    max_angle: 30f32.to_radians(),
                    speed_curve: vec![
                        SteerPoint {
                            speed: 2.0,
                            part: 1.0,
                        },
                        SteerPoint {
                            speed: 10.0,
                            part: 0.2,
                        },
                        SteerPoint {
                            speed: 30.0,
                            part: 0.03,
                        },
                    ],
                    ..default()
                },
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (1500.0, 50.0),
                            (5000.0, 75.0),
                            (8000.0, 80.0),
                            (10_500.0, 65.0),
                        ],
                        11_000.0,
                        0.02,
                    ),
                    clutch: clutch(160.0),
                    gearbox: gearbox(&[2.6, 1.9, 1.5, 1.25, 1.05, 0.95], 2.6, 9500.0, 3500.0),
                    final_drive: 4.8,
                    efficiency: 0.94,
                    ..default()
                }),
                brakes: brakes(1100.0, 0.65, 300.0),
                aero: Some(aero(0.55, 0.0, 0.0)),
                ..default()
            },
            wheels: vec![one(-0.72, 0), one(0.72, 1)],
            ..body.preset()
        }
    }
}
