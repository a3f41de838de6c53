//! The stations of the course: a scripted walker for each, and what is asked of it.
//!
//! A [`Station`] is data: where the walker starts, the [`Step`]s it takes and the [`Check`]s that
//! judge its [`Trace`]. [`StationRun`] plays one in any world that has the course in it, a window
//! included; [`run_headless`] plays them all, each in a fresh world, and [`print_table`] shows
//! what was asked and what happened.

mod check;
mod report;
mod result;
mod run;
mod script;
pub mod trace;
mod tracked;

mod ground;
mod machines;
mod measure;
mod obstacles;
mod places;
mod slopes;
mod stairs;

use bevy::prelude::*;
use bevy_embody::character::{Character, CharacterMotor};

use crate::course::layout::Place;

pub use check::{Check, Verdict};
pub use report::{print_table, run_headless, run_headless_with, table};
pub use result::{CheckResult, Played, StationResult};
pub use run::StationRun;
pub use script::Step;
pub use trace::{OfStep, Sample, Trace};
pub use tracked::Tracked;

/// A place of the course with something to do.
#[derive(Debug)]
pub struct Station {
    /// Its name, as `--station` takes it.
    pub name: String,
    /// What it shows, one line.
    pub describe: String,
    /// Where the walker starts: foot, facing `-Z`.
    pub start: Transform,
    /// The axes in which script and checks speak.
    pub place: Place,
    /// Who walks.
    pub character: Character,
    /// How it walks.
    pub motor: CharacterMotor,
    /// What it does.
    pub script: Vec<Step>,
    /// Names of the nodes whose poses the trace keeps.
    pub track: Vec<String>,
    /// What is asked.
    pub checks: Vec<Check>,
}

impl Station {
    /// A station with the default character at the origin of a place, and nothing to do.
    pub fn new(name: impl Into<String>, describe: impl Into<String>, place: Place) -> Self {
        Self {
            name: name.into(),
            describe: describe.into(),
            start: place.transform(Vec3::ZERO),
            place,
            character: Character::default(),
            motor: CharacterMotor::default(),
            script: Vec::new(),
            track: Vec::new(),
            checks: Vec::new(),
        }
    }

    /// Starts somewhere else, in the place's axes.
    pub fn from(mut self, local: Vec3) -> Self {
        self.start = self.place.transform(local);
        self
    }

    /// Adds steps to the script.
    pub fn script(mut self, steps: impl IntoIterator<Item = Step>) -> Self {
        self.script.extend(steps);
        self
    }

    /// Keeps the pose of a node in the trace.
    pub fn track(mut self, node: impl Into<String>) -> Self {
        self.track.push(node.into());
        self
    }

    /// Asks something.
    pub fn ask(
        mut self,
        asked: impl Into<String>,
        judge: impl Fn(&Trace) -> Verdict + Send + Sync + 'static,
    ) -> Self {
        self.checks.push(Check::new(asked, judge));
        self
    }
}

/// Every station, in the order of a walk through the course.
pub fn stations() -> Vec<Station> {
    [
        ground::stations(),
        stairs::stations(),
        slopes::stations(),
        obstacles::stations(),
        machines::stations(),
        places::stations(),
    ]
    .into_iter()
    .flatten()
    .collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::course::Course;

    /// Asserts that a level marks where a station starts, within metres, and has the nodes that it tracks.
    pub(crate) fn assert_marked(
        level: &Course,
        name: &str,
        start: Transform,
        within: f32,
        track: &[String],
    ) {
        let marked = level.start(name);
        let marked = marked.unwrap_or_else(|| panic!("no mark for {name}"));
        let gap = marked.translation.distance(start.translation);
        assert!(gap < within, "{name} starts {gap} m off its mark");
        let turn = marked.rotation.angle_between(start.rotation);
        assert!(turn < 1e-3, "{name} starts {turn} rad off its mark");
        for node in track {
            assert!(level.node(node).is_some(), "{name} has no {node}");
        }
    }

    #[test]
    fn every_station_starts_where_the_level_marks_it_and_tracks_nodes_that_are_there() {
        let level = Course::load(Course::default_path()).unwrap();
        for station in stations() {
            assert_marked(&level, &station.name, station.start, 1e-4, &station.track);
        }
    }
}
