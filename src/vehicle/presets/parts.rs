//! What the presets have in common.

use core::f32::consts::TAU;

use bevy::prelude::*;

use super::VehiclePreset;
use crate::vehicle::{
    aero::Aero,
    config::{Brakes, VehicleMass},
    drivetrain::{
        Clutch, Differential, DrivenAxle, Drivetrain, ElectricMotor, Engine, Gearbox, PowerSource,
        Shifting, TorquePoint,
    },
    steering::{SteerPoint, Steering},
    suspension::{Damper, SpringRate, Suspension},
    tire::{Tire, TireModel},
    wheel::Wheel,
};

/// Mass and outline.
pub(super) struct Body {
    /// Kilograms.
    pub mass: f32,
    /// Width, height and length, metres.
    pub size: Vec3,
    /// Of the centre of mass above the ground, metres.
    pub height: f32,
    /// Of the centre of mass before the middle of the wheelbase, metres.
    pub ahead: f32,
}

impl Body {
    pub fn preset(self) -> VehiclePreset {
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
pub(super) fn wheel(
    radius: f32,
    width: f32,
    inertia: f32,
    tire: Tire,
    hz: f32,
    travel: f32,
) -> Wheel {
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
pub(super) fn pair(
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
pub(super) fn four(
    base: &Wheel,
    half_base: f32,
    half_track: f32,
    front: bool,
    rear: bool,
) -> Vec<Wheel> {
    let mut wheels = Vec::with_capacity(4);
    wheels.extend(pair(base, 0, -half_base, half_track, true, front));
    wheels.extend(pair(base, 1, half_base, half_track, false, rear));
    wheels
}

/// A road tyre with a peak at a slip of about 0.12 and a falling tail.
pub(super) fn road_tire(load: f32, friction: f32) -> Tire {
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

pub(super) fn road_steering(degrees: f32) -> Steering {
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

pub(super) fn engine(curve: &[(f32, f32)], redline: f32, inertia: f32) -> PowerSource {
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

pub(super) fn electric(torque: f32, power: f32, redline: f32, ratio: f32) -> Drivetrain {
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

pub(super) fn clutch(torque: f32) -> Clutch {
    Clutch {
        torque,
        automatic: true,
    }
}

pub(super) fn gearbox(forward: &[f32], reverse: f32, up: f32, down: f32) -> Gearbox {
    Gearbox {
        forward: forward.to_vec(),
        reverse,
        shift_time: 0.2,
        shifting: Shifting::Automatic { up, down },
    }
}

pub(super) fn brakes(torque: f32, balance: f32, hand_torque: f32) -> Brakes {
    Brakes {
        torque,
        balance,
        hand_torque,
    }
}

pub(super) fn aero(drag_area: f32, front: f32, rear: f32) -> Aero {
    Aero {
        drag_area,
        downforce_area: Vec2::new(front, rear),
        air_control: Vec3::ZERO,
    }
}

pub(super) fn driven(axle: u8, share: f32, differential: Differential) -> DrivenAxle {
    DrivenAxle {
        axle,
        share,
        differential,
    }
}
