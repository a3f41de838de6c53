//! Vehicles with real numbers, as data.
//!
//! Masses, dimensions, gear ratios and torque curves are those of typical vehicles of each kind. The
//! origin of each lies on the ground below the middle of its wheelbase, so that one spawned with its
//! translation on the road stands on it.

use core::f32::consts::TAU;

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;

use super::{
    aero::Aero,
    config::{Brakes, Vehicle, VehicleMass},
    drivetrain::{
        Clutch, Differential, DrivenAxle, Drivetrain, ElectricMotor, Engine, Gearbox, PowerSource,
        Shifting, TorquePoint,
    },
    steering::{SteerPoint, Steering},
    suspension::{Damper, SpringRate, Suspension},
    tire::{Tire, TireModel},
    wheel::{Wheel, WheelOf},
};

/// A vehicle with its wheels, ready to be changed and spawned.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct VehiclePreset {
    /// The vehicle.
    pub vehicle: Vehicle,
    /// Its mass.
    pub mass: VehicleMass,
    /// Full size of its hull, metres.
    pub hull: Vec3,
    /// Centre of its hull, metres.
    pub hull_center: Vec3,
    /// Its wheels.
    pub wheels: Vec<Wheel>,
}

impl VehiclePreset {
    /// Spawns the vehicle with a box for a hull, and its wheels as its children.
    pub fn spawn(&self, commands: &mut Commands, at: Transform) -> Entity {
        let half = self.hull * 0.5;
        let hull = Collider::compound(vec![(
            self.hull_center,
            Quat::IDENTITY,
            Collider::cuboid(half.x, half.y, half.z),
        )]);
        let vehicle = commands
            .spawn((self.vehicle.clone(), self.mass, hull, at))
            .id();
        for wheel in &self.wheels {
            commands.spawn((wheel.clone(), WheelOf(vehicle), ChildOf(vehicle)));
        }
        vehicle
    }

    /// Every preset with its name.
    pub fn all() -> [(&'static str, Self); 9] {
        [
            ("hatchback", Self::hatchback()),
            ("sports car", Self::sports_car()),
            ("suv", Self::suv()),
            ("truck", Self::truck()),
            ("kart", Self::kart()),
            ("forklift", Self::forklift()),
            ("electric car", Self::electric_car()),
            ("tracked vehicle", Self::tracked()),
            ("motorcycle", Self::motorcycle()),
        ]
    }

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

    /// A motorcycle: 270 kg with its rider. Spawn it with
    /// [`LeanControl`](super::LeanControl), or it falls over.
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
        tire.camber_stiffness = 0.9;
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

/// Mass and outline.
struct Body {
    mass: f32,
    /// Width, height and length, metres.
    size: Vec3,
    /// Of the centre of mass above the ground, metres.
    height: f32,
    /// Of the centre of mass before the middle of the wheelbase, metres.
    ahead: f32,
}

impl Body {
    fn preset(self) -> VehiclePreset {
        // The hull stays clear of the ground by as much as the springs may give.
        let clearance = 0.45 * self.height;
        VehiclePreset {
            mass: VehicleMass::of_box(
                self.mass,
                self.size,
                Vec3::new(0.0, self.height, -self.ahead),
            ),
            hull: self.size,
            hull_center: Vec3::Y * (clearance + 0.5 * self.size.y),
            ..default()
        }
    }
}

/// A wheel whose hub stands one radius above the origin's plane at rest. `hz` is the ride frequency.
fn wheel(radius: f32, width: f32, inertia: f32, tire: Tire, hz: f32, travel: f32) -> Wheel {
    let sag = 9.81 / (TAU * hz * TAU * hz);
    Wheel {
        attachment: Vec3::Y * (radius + (travel - sag)),
        radius,
        width,
        inertia,
        suspension: Suspension {
            spring: SpringRate::RideFrequency(hz),
            damping: Damper::Ratio {
                bump: 0.35,
                rebound: 0.55,
            },
            travel,
            stop_length: 0.2 * travel,
            ..default()
        },
        tire,
        ..default()
    }
}

/// Both wheels of an axle.
fn pair(
    base: &Wheel,
    axle: u8,
    z: f32,
    half_track: f32,
    steered: bool,
    driven: bool,
) -> [Wheel; 2] {
    [-half_track, half_track].map(|x| Wheel {
        attachment: base.attachment + Vec3::new(x, 0.0, z),
        axle,
        steer: if steered { 1.0 } else { 0.0 },
        driven,
        handbrake: axle > 0,
        ..base.clone()
    })
}

/// Four wheels, the front ones steered.
fn four(base: &Wheel, half_base: f32, half_track: f32, front: bool, rear: bool) -> Vec<Wheel> {
    let mut wheels = Vec::with_capacity(4);
    wheels.extend(pair(base, 0, -half_base, half_track, true, front));
    wheels.extend(pair(base, 1, half_base, half_track, false, rear));
    wheels
}

/// A road tyre with a peak at a slip of about 0.12 and a falling tail.
fn road_tire(load: f32, friction: f32) -> Tire {
    let along = TireModel::Magic {
        b: 12.0,
        c: 1.65,
        e: 0.4,
    };
    let across = TireModel::Magic {
        b: 10.0,
        c: 1.5,
        e: 0.2,
    };
    Tire {
        along,
        across,
        friction: Vec2::splat(friction),
        nominal_load: load,
        load_sensitivity: 0.08,
        ..default()
    }
}

fn road_steering(degrees: f32) -> Steering {
    Steering {
        max_angle: degrees.to_radians(),
        ackermann: 0.8,
        speed_curve: vec![
            SteerPoint {
                speed: 5.0,
                part: 1.0,
            },
            SteerPoint {
                speed: 20.0,
                part: 0.35,
            },
            SteerPoint {
                speed: 50.0,
                part: 0.12,
            },
        ],
        ..default()
    }
}

fn engine(curve: &[(f32, f32)], redline: f32, inertia: f32) -> PowerSource {
    let torque: Vec<TorquePoint> = curve
        .iter()
        .map(|&(rpm, torque)| TorquePoint { rpm, torque })
        .collect();
    let most = torque.iter().map(|p| p.torque).fold(0.0, f32::max);
    PowerSource::Engine(Engine {
        idle: curve.first().map_or(800.0, |p| p.0),
        redline,
        inertia,
        // A closed throttle brakes with about a fifth of the torque at the redline.
        friction: 0.08 * most,
        viscosity: 0.12 * most / (redline * TAU / 60.0),
        torque,
        stall: None,
    })
}

fn electric(torque: f32, power: f32, redline: f32, ratio: f32) -> Drivetrain {
    Drivetrain {
        source: PowerSource::Motor(ElectricMotor {
            torque,
            power,
            redline,
            inertia: 1.6e-4 * torque,
            recuperation: 0.15 * torque,
        }),
        gearbox: gearbox(&[1.0], 1.0, redline, 0.0),
        final_drive: ratio,
        efficiency: 0.94,
        ..default()
    }
}

fn clutch(torque: f32) -> Clutch {
    Clutch {
        torque,
        automatic: true,
    }
}

fn gearbox(forward: &[f32], reverse: f32, up: f32, down: f32) -> Gearbox {
    Gearbox {
        forward: forward.to_vec(),
        reverse,
        shift_time: 0.2,
        shifting: Shifting::Automatic { up, down },
    }
}

fn brakes(torque: f32, balance: f32, hand_torque: f32) -> Brakes {
    Brakes {
        torque,
        balance,
        hand_torque,
    }
}

fn aero(drag_area: f32, front: f32, rear: f32) -> Aero {
    Aero {
        drag_area,
        downforce_area: Vec2::new(front, rear),
        air_control: Vec3::ZERO,
    }
}

fn driven(axle: u8, share: f32, differential: Differential) -> DrivenAxle {
    DrivenAxle {
        axle,
        share,
        differential,
    }
}
