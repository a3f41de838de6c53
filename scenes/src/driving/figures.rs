//! What a preset can do by its numbers alone: the closed forms by which its driving is judged.

use bevy::{math::ops, prelude::*};
use bevy_embody::vehicle::{Drivetrain, PowerSource, Shifting, TireModel, VehiclePreset, Wheel};

/// Gravity, metres per second squared.
pub const GRAVITY: f32 = 9.81;

/// How steeply the underside rises towards the ends, as a tangent.
const RISE: f32 = 0.35;

/// A preset and what follows from it.
#[derive(Clone, Debug)]
pub struct Figures {
    /// Its name.
    pub name: &'static str,
    /// All of it.
    pub preset: VehiclePreset,
}

/// How a sprint from a standstill ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sprint {
    /// Seconds.
    pub time: f32,
    /// Metres per second.
    pub speed: f32,
}

impl Figures {
    /// Every preset.
    pub fn all() -> Vec<Self> {
        VehiclePreset::all()
            .into_iter()
            .map(|(name, preset)| Self { name, preset })
            .collect()
    }

    fn wheels(&self) -> &[Wheel] {
        &self.preset.wheels
    }

    /// Kilograms.
    pub fn mass(&self) -> f32 {
        self.preset.mass.mass
    }

    /// Newtons.
    pub fn weight(&self) -> f32 {
        self.mass() * GRAVITY
    }

    /// Whether it stands on two wheels and leans.
    pub fn leans(&self) -> bool {
        self.wheels().len() == 2
    }

    /// Whether it steers by driving one side against the other.
    pub fn tracked(&self) -> bool {
        self.preset.vehicle.steering.skid_torque > 0.0
    }

    fn ends(&self, value: impl Fn(&Wheel) -> f32) -> (f32, f32) {
        let values = self.wheels().iter().map(value);
        values.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), v| {
            (low.min(v), high.max(v))
        })
    }

    /// Radius of the wheels, metres.
    pub fn radius(&self) -> f32 {
        self.wheels().first().map_or(0.3, |wheel| wheel.radius)
    }

    /// From the first axle to the last, metres.
    pub fn wheelbase(&self) -> f32 {
        let (front, rear) = self.ends(|wheel| wheel.attachment.z);
        rear - front
    }

    /// Half the distance of the wheels of an axle, metres.
    pub fn half_track(&self) -> f32 {
        self.ends(|wheel| wheel.attachment.x.abs()).0
    }

    /// How far the hull is before the first and behind the last axle, metres, the longer of the two.
    pub fn overhang(&self) -> f32 {
        let (front, rear) = self.ends(|wheel| wheel.attachment.z);
        let (half, middle) = (0.5 * self.preset.hull.z, self.preset.hull_center.z);
        (front - (middle - half)).max(middle + half - rear)
    }

    /// Height of the hull's underside at rest, metres.
    pub fn clearance(&self) -> f32 {
        self.preset.hull_center.y - 0.5 * self.preset.hull.y
    }

    /// Corners of a hull whose underside rises before the first and behind the last axle, metres.
    pub fn outline(&self) -> Vec<Vec3> {
        let (size, middle) = (self.preset.hull, self.preset.hull_center);
        let (low, high) = (middle - 0.5 * size, middle + 0.5 * size);
        let (first, last) = self.ends(|wheel| wheel.attachment.z);
        let end = |over: f32| low.y + (RISE * over.max(0.0)).min(0.6 * size.y);
        let mut corners = Vec::new();
        for x in [low.x, high.x] {
            corners.extend([
                Vec3::new(x, low.y, first.max(low.z)),
                Vec3::new(x, low.y, last.min(high.z)),
                Vec3::new(x, end(first - low.z), low.z),
                Vec3::new(x, end(high.z - last), high.z),
                Vec3::new(x, high.y, low.z),
                Vec3::new(x, high.y, high.z),
            ]);
        }
        corners
    }

    /// How much of the clearance remains on a surface that curves up with this radius, when the
    /// springs are pressed together: negative scrapes, metres.
    pub fn clearance_in(&self, radius: f32) -> f32 {
        let (base, over) = (self.wheelbase(), self.overhang());
        let sag = 1.0
            / self
                .ends(|wheel| match wheel.suspension.spring {
                    bevy_embody::vehicle::SpringRate::RideFrequency(hz) => {
                        let omega = core::f32::consts::TAU * hz;
                        omega * omega / GRAVITY
                    }
                    bevy_embody::vehicle::SpringRate::Stiffness(k) => {
                        k * self.wheels().len() as f32 / self.weight()
                    }
                })
                .1;
        let bump = self.ends(|wheel| wheel.suspension.travel).1 - sag;
        self.clearance() + RISE * over - bump - over * (base + over) / (2.0 * radius)
    }

    /// Load of each wheel on a slope (radians, nose up) while it speeds up, newtons. Equal wheels of an
    /// axle, and axles on a line.
    pub fn loads(&self, slope: f32, acceleration: f32) -> Vec<f32> {
        let (sin, cos) = ops::sin_cos(slope);
        let center = self.preset.mass.center;
        let arms: Vec<f32> = self
            .wheels()
            .iter()
            .map(|wheel| wheel.attachment.z - center.z)
            .collect();
        let n = arms.len() as f32;
        let (s1, s2) = (
            arms.iter().sum::<f32>(),
            arms.iter().map(|a| a * a).sum::<f32>(),
        );
        let sum = self.weight() * cos;
        let moment = center.y * (self.weight() * sin + self.mass() * acceleration);
        let b = (n * moment - s1 * sum) / (n * s2 - s1 * s1);
        let a = (sum - b * s1) / n;
        arms.iter().map(|arm| (a + b * arm).max(0.0)).collect()
    }

    /// Friction of a wheel along and across at a load.
    pub fn friction(wheel: &Wheel, load: f32) -> Vec2 {
        let tire = &wheel.tire;
        let relative = load / tire.nominal_load;
        tire.friction * (1.0 - tire.load_sensitivity * (relative - 1.0)).clamp(0.2, 2.0)
    }

    /// Sum of what the chosen wheels hold along and across, newtons.
    pub fn grip(&self, slope: f32, acceleration: f32, chosen: impl Fn(&Wheel) -> bool) -> Vec2 {
        self.wheels()
            .iter()
            .zip(self.loads(slope, acceleration))
            .filter(|(wheel, _)| chosen(wheel))
            .map(|(wheel, load)| Self::friction(wheel, load) * load)
            .sum()
    }

    /// Torque of the foot brake on a wheel, newton-metres.
    pub fn foot_brake(&self, wheel: &Wheel) -> f32 {
        let brakes = &self.preset.vehicle.brakes;
        let same = |w: &&Wheel| (w.axle == 0) == (wheel.axle == 0);
        let part = if wheel.axle == 0 {
            brakes.balance
        } else {
            1.0 - brakes.balance
        };
        let among: f32 = self.wheels().iter().filter(same).map(|w| w.brake).sum();
        brakes.torque * part * wheel.brake / among.max(1e-6)
    }

    /// What foot and hand brake together hold on a slope, newtons: as long as nothing slides, and
    /// still when everything does.
    pub fn braking(&self, slope: f32) -> [f32; 2] {
        let brakes = &self.preset.vehicle.brakes;
        let hold = |wheel: &Wheel, grip: f32| {
            let hand = if wheel.handbrake {
                brakes.hand_torque
            } else {
                0.0
            };
            ((self.foot_brake(wheel) + hand) / wheel.radius).min(grip)
        };
        let mut held = [0.0; 2];
        for (wheel, load) in self.wheels().iter().zip(self.loads(slope, 0.0)) {
            let grip = Self::friction(wheel, load).x * load;
            held[0] += hold(wheel, grip);
            held[1] += hold(wheel, grip * Self::sliding(&wheel.tire.along));
        }
        held
    }

    /// Part of its greatest force that a tyre keeps when it slides altogether.
    pub fn sliding(model: &TireModel) -> f32 {
        match model {
            TireModel::Magic { b, c, e } => {
                let bent = b - e * (b - ops::atan(*b));
                ops::sin(c * ops::atan(bent))
            }
            TireModel::Curve { points } => points.last().map_or(1.0, |p| p.force),
            _ => 1.0,
        }
    }

    /// Side acceleration at which it tips over, in g; leaning vehicles do not.
    pub fn tipping(&self) -> f32 {
        if self.leans() {
            f32::INFINITY
        } else {
            self.half_track() / self.preset.mass.center.y
        }
    }

    fn drivetrain(&self) -> Option<&Drivetrain> {
        self.preset.vehicle.drivetrain.as_ref()
    }

    /// Torque of the source at a shaft speed, newton-metres; none above the redline.
    fn torque(source: &PowerSource, rpm: f32) -> f32 {
        match source {
            PowerSource::Engine(engine) if rpm <= engine.redline => {
                let first = engine.torque.first().map_or(0.0, |p| p.torque);
                let mut before = None;
                for point in &engine.torque {
                    if rpm < point.rpm {
                        return before.map_or(first, |(x, y): (f32, f32)| {
                            y + (point.torque - y) * (rpm - x) / (point.rpm - x)
                        });
                    }
                    before = Some((point.rpm, point.torque));
                }
                before.map_or(0.0, |point| point.1)
            }
            PowerSource::Motor(motor) if rpm <= motor.redline => {
                let speed = (rpm * core::f32::consts::TAU / 60.0).max(1.0);
                motor.torque.min(motor.power / speed)
            }
            _ => 0.0,
        }
    }

    /// Force of the drivetrain at the wheels at no speed, newtons, whatever the tyres hold.
    pub fn launch_force(&self) -> f32 {
        let Some(drivetrain) = self.drivetrain() else {
            return 0.0;
        };
        let rpm = match &drivetrain.source {
            PowerSource::Engine(engine) => 1.5 * engine.idle,
            _ => 0.0,
        };
        let radius = self.radius();
        let ratio = drivetrain.gearbox.forward.first().copied().unwrap_or(1.0);
        Self::torque(&drivetrain.source, rpm)
            * ratio
            * drivetrain.final_drive
            * drivetrain.efficiency
            / radius
    }

    /// A sprint over this distance with all that tyres and engine have.
    pub fn sprint(&self, distance: f32) -> Sprint {
        let mut way = 0.0;
        let mut last = Sprint {
            time: 0.0,
            speed: 0.0,
        };
        self.drive(|sprint, dt| {
            way += sprint.speed * dt;
            last = sprint;
            way < distance && sprint.time < 300.0
        });
        last
    }

    /// The speed it ends up at, metres per second.
    pub fn top_speed(&self) -> f32 {
        let mut best = 0.0f32;
        self.drive(|sprint, _| {
            best = best.max(sprint.speed);
            sprint.time < 90.0
        });
        best
    }

    /// Integrates a sprint in small steps for as long as it is asked to.
    fn drive(&self, mut go_on: impl FnMut(Sprint, f32) -> bool) {
        let Some(drivetrain) = self.drivetrain() else {
            return;
        };
        let dt = 0.005;
        let radius = self.radius();
        let spin: f32 = self
            .wheels()
            .iter()
            .map(|w| w.inertia / (w.radius * w.radius))
            .sum();
        let (idle, inertia) = match &drivetrain.source {
            PowerSource::Engine(engine) => (engine.idle, engine.inertia),
            PowerSource::Motor(motor) => (0.0, motor.inertia),
            PowerSource::Direct { .. } => (0.0, 0.0),
        };
        let rolling = self
            .wheels()
            .first()
            .map_or(0.0, |w| w.tire.rolling_resistance)
            * self.weight();
        let drag = 0.5 * 1.225 * self.preset.vehicle.aero.map_or(0.0, |aero| aero.drag_area);
        let (mut gear, mut pause, mut acceleration) = (0usize, 0.0f32, 0.0f32);
        let mut at = Sprint {
            time: 0.0,
            speed: 0.0,
        };
        while go_on(at, dt) {
            let ratio = |gear: usize| {
                drivetrain.gearbox.forward.get(gear).copied().unwrap_or(1.0)
                    * drivetrain.final_drive
            };
            let rpm = |gear: usize| at.speed / radius * ratio(gear) * 60.0 / core::f32::consts::TAU;
            if let Shifting::Automatic { up, .. } = drivetrain.gearbox.shifting
                && pause <= 0.0
                && rpm(gear) > up
                && gear + 1 < drivetrain.gearbox.forward.len()
            {
                gear += 1;
                pause = drivetrain.gearbox.shift_time;
            }
            let force = if pause > 0.0 {
                0.0
            } else {
                // Below that the clutch slips.
                let torque = Self::torque(&drivetrain.source, rpm(gear).max(1.5 * idle));
                let wheels = torque * ratio(gear) * drivetrain.efficiency / radius;
                wheels.min(self.grip(0.0, acceleration, |w| w.driven).x)
            };
            pause -= dt;
            // While the clutch slips, the engine does not have to be sped up with the car.
            let shaft = if rpm(gear) > 1.5 * idle {
                inertia * ratio(gear) * ratio(gear) / (radius * radius)
            } else {
                0.0
            };
            let resist = rolling + drag * at.speed * at.speed;
            acceleration = (force - resist) / (self.mass() + spin + shaft);
            at.speed = (at.speed + acceleration * dt).max(0.0);
            at.time += dt;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loads_add_up_and_move_to_the_rear_uphill() {
        for figures in Figures::all() {
            let flat = figures.loads(0.0, 0.0);
            let sum: f32 = flat.iter().sum();
            assert!(
                (sum / figures.weight() - 1.0).abs() < 1e-3,
                "{}",
                figures.name
            );
            let up = figures.loads(0.3, 0.0);
            assert!(up[0] < flat[0], "{}", figures.name);
        }
    }

    #[test]
    fn top_speeds_are_those_of_such_vehicles() {
        let top = |name: &str| {
            let figures = Figures::all().into_iter().find(|f| f.name == name);
            figures.map_or(0.0, |f| f.top_speed() * 3.6)
        };
        assert!(
            (150.0..200.0).contains(&top("hatchback")),
            "{}",
            top("hatchback")
        );
        assert!(
            (15.0..25.0).contains(&top("forklift")),
            "{}",
            top("forklift")
        );
    }
}
