//! Plays a driving station's script with a vehicle and keeps what happened.

use bevy::prelude::*;
use bevy_embody::{
    Teleported,
    vehicle::{
        LeanControl, Vehicle, VehicleIntent, VehicleState, VehicleTelemetry, WheelProbe,
        WheelState, Wheels,
    },
};
use bevy_rapier3d::prelude::{Collider, ReadMassProperties, Velocity};

use super::{
    DriveStation, Figures, Plan,
    driver::{DriveStep, Driver, Progress},
    trace::{DriveSample, DriveTrace},
};
use crate::stations::{Played, StationResult, Tracked};

/// A driving station being played. Call [`tick`](Self::tick) once before each fixed tick.
pub struct DriveRun {
    station: DriveStation,
    figures: Figures,
    plan: Plan,
    vehicle: Entity,
    tracked: Tracked,
    trace: DriveTrace,
    driver: Driver,
    step: usize,
    in_step: f32,
    stopped: Option<String>,
}

/// Spawns a preset as it is driven here: wheels feel the ground with all of their tread, and a
/// motorcycle has the control that keeps it upright.
pub fn spawn_vehicle(commands: &mut Commands, figures: &Figures, at: Transform) -> Entity {
    let mut preset = figures.preset.clone();
    for wheel in &mut preset.wheels {
        wheel.probe = WheelProbe::Cylinder;
    }
    let vehicle = preset.spawn(commands, at);
    // Bumpers that rise towards the ends, as those of vehicles do, instead of the preset's plain box.
    if let Some(hull) = Collider::convex_hull(&figures.outline()) {
        commands.entity(vehicle).insert(hull);
    }
    let mut entity = commands.entity(vehicle);
    entity.insert((
        Name::new(figures.name),
        Velocity::default(),
        ReadMassProperties::default(),
    ));
    if figures.leans() {
        entity.insert(LeanControl::default());
    }
    vehicle
}

impl DriveRun {
    /// Spawns a vehicle at the start of a station; `None` if there is nothing to drive there for it.
    pub fn begin(world: &mut World, station: DriveStation, figures: Figures) -> Option<Self> {
        let at = station.start();
        let vehicle = spawn_vehicle(&mut world.commands(), &figures, at);
        world.flush();
        Self::with(world, station, figures, vehicle)
    }

    /// Puts an existing vehicle at the start of a station, at rest, and drives it; `None` if there is
    /// nothing to drive there for it.
    pub fn with(
        world: &mut World,
        station: DriveStation,
        figures: Figures,
        vehicle: Entity,
    ) -> Option<Self> {
        let plan = (station.plan)(&figures).ok()?;
        place(world, vehicle, station.start());
        let tracked = Tracked::find(world, &station.track);
        tracked.restart(world);
        let dt = world.resource::<Time<Fixed>>().timestep().as_secs_f64();
        Some(Self {
            station,
            figures,
            plan,
            vehicle,
            tracked,
            trace: DriveTrace::new(dt),
            driver: Driver::default(),
            step: 0,
            in_step: 0.0,
            stopped: None,
        })
    }

    /// The vehicle.
    pub fn vehicle(&self) -> Entity {
        self.vehicle
    }

    /// What is done now; none when it is done.
    pub fn current(&self) -> Option<&DriveStep> {
        self.plan.steps.get(self.step)
    }

    /// Looks at the tick that has passed and says what to do in the next one. Returns whether the
    /// script is done.
    pub fn tick(&mut self, world: &mut World) -> bool {
        if self.stopped.is_some() || self.step >= self.plan.steps.len() {
            return true;
        }
        let Some((sample, yaw)) = self.sample(world) else {
            self.stopped = Some("the vehicle is gone".into());
            return true;
        };
        if !sample.pose.translation.is_finite() {
            self.stopped = Some(format!("the vehicle is at {}", sample.pose.translation));
            return true;
        }
        let dt = self.trace.dt as f32;
        while let Some(step) = self.plan.steps.get(self.step) {
            match self.driver.progress(step, &sample, self.in_step, dt) {
                Progress::Goes => break,
                Progress::GivesUp => {
                    self.stopped = Some(format!(
                        "could not {}: is at {:.1} with {:.1} m/s",
                        step.describe(),
                        sample.pose.translation,
                        sample.telemetry.speed,
                    ));
                    self.trace.samples.push(sample);
                    self.write(world, VehicleIntent::default());
                    return true;
                }
                Progress::Done => {
                    self.step += 1;
                    self.in_step = 0.0;
                    self.driver = Driver::default();
                }
            }
        }
        let intent = match self.plan.steps.get(self.step) {
            Some(step) => self.driver.intent(
                step,
                &sample,
                &self.figures.preset.vehicle,
                self.figures.wheelbase(),
                yaw,
                dt,
            ),
            None => VehicleIntent {
                brake: 0.5,
                ..default()
            },
        };
        self.trace.samples.push(sample);
        self.write(world, intent);
        self.in_step += dt;
        self.step >= self.plan.steps.len()
    }

    /// Judges what happened.
    pub fn result(&self) -> StationResult {
        StationResult::judge(
            format!("{}/{}", self.station.name, self.figures.name),
            &self.station.describe,
            &Played {
                stopped: self.stopped.as_deref(),
                step: self.step,
                steps: self.plan.steps.len(),
                tracked: &self.tracked,
            },
            &self.plan.checks,
            &self.trace,
        )
    }

    fn sample(&self, world: &World) -> Option<(DriveSample, f32)> {
        let place = &self.station.place;
        let vehicle = world.get_entity(self.vehicle).ok()?;
        let transform = vehicle.get::<Transform>()?;
        let velocity = vehicle.get::<Velocity>()?;
        let pose = place.local_pose(transform);
        let sample = DriveSample {
            step: self.step,
            time: self.trace.time(),
            center: pose.transform_point(self.figures.preset.mass.center),
            pose,
            velocity: place.local_direction(velocity.linear),
            telemetry: *vehicle.get::<VehicleTelemetry>()?,
            wheels: vehicle
                .get::<Wheels>()?
                .iter()
                .filter_map(|wheel| world.get::<WheelState>(wheel).copied())
                .collect(),
            nodes: self.tracked.poses(world, place),
        };
        // To the right.
        let yaw = -velocity.angular.dot(transform.rotation * Vec3::Y);
        Some((sample, yaw))
    }

    fn write(&self, world: &mut World, intent: VehicleIntent) {
        if let Some(mut current) = world.get_mut::<VehicleIntent>(self.vehicle) {
            *current = intent;
        }
    }
}

/// Puts a vehicle somewhere at rest, its gears and wheels as new.
pub fn place(world: &mut World, vehicle: Entity, at: Transform) {
    if let Ok(mut entity) = world.get_entity_mut(vehicle)
        && entity.contains::<Vehicle>()
    {
        entity.insert((
            at,
            Velocity::default(),
            VehicleState::default(),
            VehicleIntent::default(),
        ));
        world.trigger(Teleported { entity: vehicle });
    }
}
