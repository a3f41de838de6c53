//! The driving stations: a scripted driver for each, and what physics asks of a preset there.
//!
//! A [`DriveStation`] turns the [`Figures`] of a preset into a [`Plan`]: what the driver does and what
//! is asked. Where a preset cannot do a station by its nature, the plan is the reason, in numbers.
//! [`DriveRun`] plays one in any world that has the proving ground in it, a window included;
//! [`run_driving`] plays every preset on every station, each in a fresh world.

pub mod driver;
mod figures;
mod machines;
mod obstacles;
mod report;
mod run;
mod slopes;
mod trace;
mod track;

use core::fmt;

use bevy::prelude::*;

pub use driver::DriveStep;
pub use figures::{Figures, GRAVITY, Sprint};
pub use report::{run_driving, run_driving_with};
pub use run::{DriveRun, place, spawn_vehicle};
pub use trace::{DriveSample, DriveTrace};

use crate::{
    course::layout::Place,
    stations::{Check, Verdict},
};

/// What a preset does at a station and what is asked of it.
#[derive(Debug, Default)]
pub struct Plan {
    /// What the driver does.
    pub steps: Vec<DriveStep>,
    /// What is asked.
    pub checks: Vec<Check<DriveTrace>>,
}

impl Plan {
    /// A plan of these steps.
    pub fn of(steps: impl IntoIterator<Item = DriveStep>) -> Self {
        Self {
            steps: steps.into_iter().collect(),
            checks: Vec::new(),
        }
    }

    /// Asks something.
    pub fn ask(
        mut self,
        asked: impl Into<String>,
        judge: impl Fn(&DriveTrace) -> Verdict + Send + Sync + 'static,
    ) -> Self {
        self.checks.push(Check::new(asked, judge));
        self
    }

    /// Asks that it ends on its wheels.
    pub fn ask_upright(self) -> Self {
        self.ask("ends upright, on its wheels", |trace| {
            let Some(last) = trace.last() else {
                return Verdict::never("drove");
            };
            let up = last.upright();
            Verdict::new(
                up > 0.8 && last.telemetry.grounded as usize >= last.wheels.len().div_ceil(2),
                format!(
                    "{:.0} degrees off upright, {} of {} wheels on the ground",
                    up.clamp(-1.0, 1.0).acos().to_degrees(),
                    last.telemetry.grounded,
                    last.wheels.len()
                ),
            )
        })
    }
}

/// A place to drive.
pub struct DriveStation {
    /// Its name, as `--station` takes it.
    pub name: String,
    /// What it shows, one line.
    pub describe: String,
    /// The axes in which script and checks speak.
    pub place: Place,
    /// Where the vehicle starts, in those axes: its origin, which is on the ground below it.
    pub local_start: Transform,
    /// Names of the nodes whose poses the trace keeps.
    pub track: Vec<String>,
    plan: Box<dyn Fn(&Figures) -> Result<Plan, String> + Send + Sync>,
}

impl fmt::Debug for DriveStation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DriveStation")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl DriveStation {
    /// A station at the origin of a place.
    pub fn new(
        name: impl Into<String>,
        describe: impl Into<String>,
        place: Place,
        plan: impl Fn(&Figures) -> Result<Plan, String> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            describe: describe.into(),
            place,
            local_start: Transform::IDENTITY,
            track: Vec::new(),
            plan: Box::new(plan),
        }
    }

    /// Starts somewhere else.
    pub fn from(mut self, local: Transform) -> Self {
        self.local_start = local;
        self
    }

    /// Keeps the pose of a node in the trace.
    pub fn track(mut self, node: impl Into<String>) -> Self {
        self.track.push(node.into());
        self
    }

    /// Where the vehicle starts, world.
    pub fn start(&self) -> Transform {
        let at = self.place.transform(self.local_start.translation);
        at.with_rotation(at.rotation * self.local_start.rotation)
    }

    /// What this preset does here.
    ///
    /// # Errors
    /// With the reason when there is nothing here for it.
    pub fn plan(&self, figures: &Figures) -> Result<Plan, String> {
        (self.plan)(figures)
    }
}

/// Every driving station, in the order of a visit.
pub fn drive_stations() -> Vec<DriveStation> {
    [
        track::stations(),
        slopes::stations(),
        obstacles::stations(),
        machines::stations(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{course::Course, stations::tests::assert_marked};

    #[test]
    fn every_driving_station_starts_where_the_level_marks_it() {
        let level = Course::load(Course::proving_ground_path()).unwrap();
        for station in drive_stations() {
            assert_marked(&level, &station.name, station.start(), 0.05, &station.track);
        }
    }

    #[test]
    fn every_preset_has_something_to_do_at_most_stations() {
        let stations = drive_stations();
        for figures in Figures::all() {
            let able = stations.iter().filter(|s| s.plan(&figures).is_ok()).count();
            assert!(able * 2 > stations.len(), "{}: {able}", figures.name);
        }
    }
}
