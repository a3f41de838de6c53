//! Cars: hatchback, sports car, SUV, electric car.

use bevy::prelude::*;

use super::{
    VehiclePreset,
    parts::{
        Body, aero, brakes, clutch, driven, electric, engine, four, gearbox, road_steering,
        road_tire, wheel,
    },
};
use crate::vehicle::{
    config::Vehicle,
    drivetrain::{Differential, Drivetrain},
};

impl VehiclePreset {
    /// A small front-wheel drive car: 1.1 t, 75 kW, five gears.
    pub fn hatchback() -> Self {
        let body = Body {
            mass: 1100.0,
            size: Vec3::new(1.7, 1.3, 4.0),
            height: 0.52,
            ahead: 0.12,
        };
        let wheel = wheel(0.29, 0.19, 0.8, road_tire(3000.0, 1.0), 1.4, 0.2);
        Self {
            vehicle: Vehicle {
                steering: road_steering(38.0),
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (900.0, 95.0),
                            (2000.0, 125.0),
                            (4000.0, 140.0),
                            (6200.0, 115.0),
                        ],
                        6400.0,
                        0.12,
                    ),
                    clutch: clutch(260.0),
                    gearbox: gearbox(&[3.55, 1.95, 1.3, 0.97, 0.78], 3.3, 5500.0, 2000.0),
                    final_drive: 3.94,
                    efficiency: 0.92,
                    ..default()
                }),
                brakes: brakes(6000.0, 0.7, 1500.0),
                anti_roll: vec![9000.0, 5000.0],
                aero: Some(aero(0.68, 0.0, 0.0)),
                ..default()
            },
            wheels: four(&wheel, 1.28, 0.73, true, false),
            ..body.preset()
        }
    }

    /// A rear-wheel drive sports car: 1.4 t, 300 kW, limited slip.
    pub fn sports_car() -> Self {
        let body = Body {
            mass: 1400.0,
            size: Vec3::new(1.85, 1.15, 4.5),
            height: 0.45,
            ahead: -0.08,
        };
        let mut wheel = wheel(0.33, 0.27, 1.3, road_tire(3800.0, 1.2), 2.1, 0.16);
        wheel.camber = 1.0f32.to_radians();
        Self {
            vehicle: Vehicle {
                steering: road_steering(35.0),
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (900.0, 330.0),
                            (2500.0, 420.0),
                            (5000.0, 460.0),
                            (7200.0, 400.0),
                        ],
                        7500.0,
                        0.16,
                    ),
                    clutch: clutch(800.0),
                    gearbox: gearbox(&[3.1, 2.15, 1.6, 1.25, 1.0, 0.82], 3.0, 6900.0, 2600.0),
                    final_drive: 3.7,
                    efficiency: 0.9,
                    axles: vec![driven(
                        1,
                        1.0,
                        Differential::LimitedSlip {
                            bias: 2.5,
                            preload: 60.0,
                        },
                    )],
                    ..default()
                }),
                brakes: brakes(11_000.0, 0.62, 2500.0),
                anti_roll: vec![28_000.0, 18_000.0],
                aero: Some(aero(0.66, 0.25, 0.45)),
                ..default()
            },
            wheels: four(&wheel, 1.3, 0.8, false, true),
            ..body.preset()
        }
    }

    /// A four-wheel drive car with three differentials: 2.1 t, 180 kW.
    pub fn suv() -> Self {
        let body = Body {
            mass: 2100.0,
            size: Vec3::new(1.95, 1.7, 4.8),
            height: 0.72,
            ahead: 0.0,
        };
        let mut wheel = wheel(0.38, 0.25, 1.9, road_tire(5500.0, 0.95), 1.35, 0.28);
        wheel.suspension.unsprung_mass = 40.0;
        Self {
            vehicle: Vehicle {
                steering: road_steering(36.0),
                drivetrain: Some(Drivetrain {
                    source: engine(
                        &[
                            (800.0, 320.0),
                            (1600.0, 480.0),
                            (3000.0, 500.0),
                            (4600.0, 360.0),
                        ],
                        4800.0,
                        0.3,
                    ),
                    clutch: clutch(900.0),
                    gearbox: gearbox(&[4.2, 2.5, 1.7, 1.25, 1.0, 0.8], 3.9, 4100.0, 1500.0),
                    final_drive: 3.6,
                    efficiency: 0.87,
                    axles: vec![
                        driven(0, 0.4, Differential::Open),
                        driven(
                            1,
                            0.6,
                            Differential::LimitedSlip {
                                bias: 2.0,
                                preload: 80.0,
                            },
                        ),
                    ],
                    center: Differential::LimitedSlip {
                        bias: 2.0,
                        preload: 100.0,
                    },
                    tracks: false,
                }),
                brakes: brakes(15_000.0, 0.6, 3500.0),
                anti_roll: vec![18_000.0, 14_000.0],
                aero: Some(aero(0.95, 0.0, 0.0)),
                ..default()
            },
            wheels: four(&wheel, 1.42, 0.82, true, true),
            ..body.preset()
        }
    }

    /// A rear-wheel drive electric car: 1.8 t, 150 kW.
    pub fn electric_car() -> Self {
        let body = Body {
            mass: 1800.0,
            size: Vec3::new(1.85, 1.4, 4.3),
            height: 0.48,
            ahead: -0.03,
        };
        let wheel = wheel(0.34, 0.22, 1.3, road_tire(4600.0, 1.05), 1.5, 0.2);
        Self {
            vehicle: Vehicle {
                steering: road_steering(38.0),
                drivetrain: Some(electric(310.0, 150.0e3, 16_000.0, 9.7)),
                brakes: brakes(11_000.0, 0.62, 2500.0),
                anti_roll: vec![20_000.0, 14_000.0],
                aero: Some(aero(0.6, 0.0, 0.0)),
                ..default()
            },
            wheels: four(&wheel, 1.38, 0.79, false, true),
            ..body.preset()
        }
    }
}
