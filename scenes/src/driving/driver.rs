//! The scripted driver: steps, and how a line is followed.
//!
//! Steering is pure pursuit: the circle through the vehicle, along its heading, and a point of the line
//! ahead. It is found in the vehicle's own axes, so a loop is followed as a road is.

use std::sync::Arc;

use bevy::{math::ops, prelude::*};
use bevy_embody::vehicle::{Vehicle, VehicleIntent};

use super::trace::DriveSample;

/// Distance of the points of a line, metres.
const SPACING: f32 = 0.5;

/// One thing that a driver does until it is done.
#[derive(Clone, Debug)]
pub enum DriveStep {
    /// Holds pedals and wheel for a time.
    Hold {
        /// How.
        intent: VehicleIntent,
        /// How long, seconds.
        seconds: f32,
    },
    /// Drives along a line to its end.
    Follow {
        /// The line, points at equal distances in the station's axes.
        line: Arc<[Vec3]>,
        /// How fast, metres per second; infinite is full throttle.
        speed: f32,
        /// Gives up after this long, seconds.
        timeout: f32,
    },
    /// Brakes until it stands.
    Stop {
        /// Gives up after this long, seconds.
        timeout: f32,
    },
}

impl DriveStep {
    /// Holds foot and hand brake, seconds.
    pub fn brake(seconds: f32) -> Self {
        Self::Hold {
            intent: VehicleIntent {
                brake: 1.0,
                handbrake: 1.0,
                ..default()
            },
            seconds,
        }
    }

    /// Drives through these points.
    pub fn follow(points: &[Vec3], speed: f32, timeout: f32) -> Self {
        Self::Follow {
            line: resample(points).into(),
            speed,
            timeout,
        }
    }

    /// Drives straight ahead from one distance to another.
    pub fn ahead(from: f32, to: f32, speed: f32, timeout: f32) -> Self {
        Self::follow(&[Vec3::NEG_Z * from, Vec3::NEG_Z * to], speed, timeout)
    }

    /// What it does, for a reader.
    pub fn describe(&self) -> String {
        match self {
            Self::Hold { intent, seconds } => format!(
                "hold throttle {:.0} %, brake {:.0} % for {seconds:.1} s",
                100.0 * intent.throttle,
                100.0 * intent.brake
            ),
            Self::Follow { line, speed, .. } => {
                let way = SPACING * line.len() as f32;
                if speed.is_finite() {
                    format!("drive {way:.0} m at {:.0} km/h", 3.6 * speed)
                } else {
                    format!("drive {way:.0} m flat out")
                }
            }
            Self::Stop { .. } => "stop".into(),
        }
    }
}

/// The same line in points of equal distance.
fn resample(points: &[Vec3]) -> Vec<Vec3> {
    let mut line = Vec::new();
    let mut rest = 0.0;
    for pair in points.windows(2) {
        let length = pair[0].distance(pair[1]);
        while rest < length {
            line.push(pair[0].lerp(pair[1], rest / length));
            rest += SPACING;
        }
        rest -= length;
    }
    line.extend(points.last());
    line
}

/// What the driver remembers within a step.
#[derive(Clone, Debug, Default)]
pub struct Driver {
    /// The point of the line that is nearest.
    at: usize,
    /// Throttle that was needed so far.
    held: f32,
    /// Time that it stands, seconds.
    stands: f32,
    /// Time that a line has been followed, seconds.
    since: f32,
}

/// Whether a step goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// It does.
    Goes,
    /// It is done.
    Done,
    /// It took too long.
    GivesUp,
}

impl Driver {
    /// Looks at the vehicle: how far a step is after `elapsed` seconds.
    pub fn progress(
        &mut self,
        step: &DriveStep,
        now: &DriveSample,
        elapsed: f32,
        dt: f32,
    ) -> Progress {
        let (done, timeout) = match step {
            DriveStep::Hold { seconds, .. } => (elapsed + 0.5 * dt >= *seconds, f32::INFINITY),
            DriveStep::Follow { line, timeout, .. } => {
                let here = now.pose.translation;
                while let Some(next) = line.get(self.at + 1)
                    && here.distance_squared(*next) <= here.distance_squared(line[self.at])
                {
                    self.at += 1;
                }
                (self.at + 1 >= line.len(), *timeout)
            }
            DriveStep::Stop { timeout } => {
                self.stands = if now.telemetry.speed.abs() < 0.05 {
                    self.stands + dt
                } else {
                    0.0
                };
                (self.stands > 0.3, *timeout)
            }
        };
        match (done, elapsed > timeout) {
            (true, _) => Progress::Done,
            (false, true) => Progress::GivesUp,
            (false, false) => Progress::Goes,
        }
    }

    /// What to ask of the vehicle in the next tick.
    pub fn intent(
        &mut self,
        step: &DriveStep,
        now: &DriveSample,
        vehicle: &Vehicle,
        wheelbase: f32,
        yaw: f32,
        dt: f32,
    ) -> VehicleIntent {
        match step {
            DriveStep::Hold { intent, .. } => *intent,
            DriveStep::Stop { .. } => VehicleIntent {
                brake: 1.0,
                ..default()
            },
            DriveStep::Follow { line, speed, .. } => {
                let v = now.telemetry.speed;
                let steer = self.steer(line, now, vehicle, wheelbase, yaw);
                self.since += dt;
                let mut intent = self.pedals(*speed, v, now, dt, steer);
                // A start uphill, as it is taught: the hand brake holds until the clutch pulls.
                let uphill = -(now.pose.rotation * Vec3::Z).y;
                if self.since < 0.8 && uphill > 0.1 {
                    intent.handbrake = 1.0;
                    intent.brake = 0.3;
                    intent.throttle = 1.0;
                }
                intent
            }
        }
    }

    fn steer(
        &self,
        line: &[Vec3],
        now: &DriveSample,
        vehicle: &Vehicle,
        wheelbase: f32,
        yaw: f32,
    ) -> f32 {
        let v = now.telemetry.speed.abs();
        let look = (0.45 * v).clamp(1.4 * wheelbase.max(1.0), 14.0);
        let at = self.at + (look / SPACING) as usize;
        let target = line.get(at).copied().unwrap_or_else(|| {
            let last = line[line.len() - 1];
            let before = line[line.len().saturating_sub(2)];
            last + (last - before).normalize_or_zero() * (SPACING * (at + 1 - line.len()) as f32)
        });
        let local = now.pose.rotation.inverse() * (target - now.pose.translation);
        let curvature = 2.0 * local.x / Vec2::new(local.x, local.z).length_squared().max(0.1);
        let steering = &vehicle.steering;
        if steering.skid_torque > 0.0 {
            // Tracks answer to torque, not to an angle: the turn rate is what is held.
            return (1.2 * (curvature * v.max(1.0) - yaw) + 0.4 * curvature * v).clamp(-1.0, 1.0);
        }
        let full = steering.target(1.0, v).max(1e-3);
        // What the tyres give away is steered on top, until the front slides: more angle is less force
        // then.
        let missing = if v > 2.0 { curvature - yaw / v } else { 0.0 };
        let wanted = ops::atan(wheelbase * (curvature + missing));
        let front = now
            .wheels
            .first()
            .map_or(0.0, |wheel| wheel.slip_angle.abs());
        let ease = (0.14 / front.max(0.14)).max(0.4);
        (ease * wanted / full).clamp(-1.0, 1.0)
    }

    fn pedals(
        &mut self,
        speed: f32,
        v: f32,
        now: &DriveSample,
        dt: f32,
        steer: f32,
    ) -> VehicleIntent {
        let error = speed - v;
        let throttle = if speed.is_finite() {
            self.held = (self.held + 0.25 * error * dt).clamp(0.0, 1.0);
            (0.5 * error + self.held).clamp(0.0, 1.0)
        } else {
            1.0
        };
        // Feels the wheels spin, as a driver does.
        let slip = now
            .wheels
            .iter()
            .filter(|wheel| wheel.drive_torque > 0.0)
            .map(|wheel| wheel.slip_ratio)
            .fold(0.0, f32::max);
        let ease = if v > 1.5 {
            (1.0 - 6.0 * (slip - 0.1).max(0.0)).max(0.15)
        } else {
            1.0
        };
        VehicleIntent {
            throttle: throttle * ease,
            brake: (-0.15 * (error + 1.0)).clamp(0.0, 1.0),
            steer,
            ..default()
        }
    }
}
