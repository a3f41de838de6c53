//! The falling stations: humans who are pushed, thrown, run over, and get up.
//!
//! A [`FallStation`] is data: what stands there, who takes part, what is done to them, and what is asked.
//! [`FallRun`] plays one in any world that has the yard in it, a window included; [`run_falling`] plays
//! them all, each in a fresh world.

mod heights;
mod report;
mod run;
mod script;
mod stage;
mod struck;
mod trace;
mod upright;

use core::fmt;

use bevy::prelude::*;

pub use report::run_falling;
pub use run::FallRun;
pub use script::{Crew, FallStep, Scene};
pub use stage::{Block, YARD};
pub use trace::{FallSample, FallTrace, Fallen};

use crate::{
    course::layout::{Heading, Place},
    stations::{Check, Verdict},
};

/// A place to fall.
pub struct FallStation {
    /// Its name, as `--station` takes it.
    pub name: &'static str,
    /// What it shows, one line.
    pub describe: &'static str,
    /// The axes in which script and checks speak.
    pub place: Place,
    /// Where a visitor stands, and where from the camera looks.
    pub visitor: Transform,
    /// What stands there, in those axes.
    pub ground: Vec<Block>,
    /// Spawns who takes part.
    pub cast: fn(&mut Scene),
    /// What is done.
    pub steps: Vec<FallStep>,
    /// What is asked.
    pub checks: Vec<Check<FallTrace>>,
}

impl fmt::Debug for FallStation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FallStation")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl FallStation {
    /// A station at this point of the yard, with nobody in it.
    fn new(name: &'static str, describe: &'static str, x: f32, z: f32) -> Self {
        Self {
            name,
            describe,
            place: Place::new(x, z, Heading::North),
            visitor: Transform::IDENTITY,
            ground: Vec::new(),
            cast: |_| {},
            steps: Vec::new(),
            checks: Vec::new(),
        }
    }

    /// Where a visitor stands, and what they look at.
    fn seen(mut self, from: Vec3, at: Vec3) -> Self {
        self.visitor = Transform::from_translation(from).looking_at(at.with_y(from.y), Vec3::Y);
        self
    }

    fn ground(mut self, blocks: impl IntoIterator<Item = Block>) -> Self {
        self.ground.extend(blocks);
        self
    }

    fn cast(mut self, cast: fn(&mut Scene)) -> Self {
        self.cast = cast;
        self
    }

    fn steps(mut self, steps: impl IntoIterator<Item = FallStep>) -> Self {
        self.steps.extend(steps);
        self
    }

    fn ask(
        mut self,
        asked: impl Into<String>,
        judge: impl Fn(&FallTrace) -> Verdict + Send + Sync + 'static,
    ) -> Self {
        self.checks.push(Check::new(asked, judge));
        self
    }

    /// Asks what is true of everyone who falls: nothing goes through the ground, joints hold.
    fn ask_whole(self, sunk: f64, widest: f64) -> Self {
        self.ask(
            format!("nobody is more than {:.0} mm in the ground", 1e3 * sunk),
            move |trace| {
                let (deepest, when) = most(trace, |f| f.sunk);
                let got = format!("{:.1} mm, {when}", 1e3 * deepest);
                Verdict::at_most(deepest, sunk, got)
            },
        )
        .ask(
            format!("no joint parts by more than {:.0} mm", 1e3 * widest),
            move |trace| {
                let (gap, when) = most(trace, |f| f.gap[0]);
                Verdict::at_most(gap, widest, format!("{:.1} mm, {when}", 1e3 * gap))
            },
        )
    }

    /// Asks that in the end everyone lies still, joints closed.
    fn ask_at_rest(self) -> Self {
        self.ask("in the end joints are closed within 2 mm", |trace| {
            let gap = greatest(last(trace).map(|f| f.gap[0]));
            Verdict::at_most(gap.into(), 2e-3, format!("{:.2} mm", 1e3 * gap))
        })
        .ask("in the end everyone is asleep", |trace| {
            let awake = last(trace).filter(|f| f.simulated[1] > 0).count();
            Verdict::new(awake == 0, format!("{awake} awake"))
        })
    }

    /// Where a visitor stands, world.
    pub fn start(&self) -> Transform {
        let at = self.place.transform(self.visitor.translation);
        at.with_rotation(at.rotation * self.visitor.rotation)
    }

    /// What stands there, world.
    pub fn blocks(&self) -> impl Iterator<Item = Block> {
        let place = self.place.transform(Vec3::ZERO);
        self.ground.iter().map(move |block| block.seen_from(&place))
    }
}

/// The most of something over everyone and all ticks, and when that is.
fn most(trace: &FallTrace, of: impl Fn(&Fallen) -> f32) -> (f64, String) {
    // Of nothing it is no number, which is within no bound.
    let (mut most, mut when) = (f32::NAN, String::new());
    for sample in &trace.samples {
        for figure in &sample.figures {
            let value = of(figure);
            // What is no number stays.
            if when.is_empty() || !most.is_nan() && !(value <= most) {
                most = value;
                when = format!("{:?} at {:.2} s", figure.mode, sample.time);
            }
        }
    }
    (most.into(), when)
}

/// The larger; what is no number stays.
fn larger(a: f32, b: f32) -> f32 {
    if a.is_nan() || b <= a { a } else { b }
}

/// The greatest of all; no number when there are none, or one of them is none.
fn greatest(all: impl IntoIterator<Item = f32>) -> f32 {
    all.into_iter().reduce(larger).unwrap_or(f32::NAN)
}

/// The least of all, likewise.
fn least(all: impl IntoIterator<Item = f32>) -> f32 {
    -greatest(all.into_iter().map(|value| -value))
}

/// Everyone in the end.
fn last(trace: &FallTrace) -> impl Iterator<Item = &Fallen> {
    trace.last().into_iter().flat_map(|s| &s.figures)
}

/// A figure in each tick of a step, with the time since the step began.
fn during(trace: &FallTrace, step: usize, figure: usize) -> impl Iterator<Item = (f64, &Fallen)> {
    let ticks = trace.step(step);
    let began = ticks.first().map_or(0.0, |s| s.time);
    (ticks.iter()).filter_map(move |s| Some((s.time - began, s.figures.get(figure)?)))
}

/// Every falling station, in the order of a visit.
pub fn fall_stations() -> Vec<FallStation> {
    [upright::stations(), heights::stations(), struck::stations()]
        .into_iter()
        .flatten()
        .collect()
}

/// Builds the yard and what stands on it.
pub fn spawn_yard(world: &mut World, stations: &[FallStation]) {
    Block::yard().spawn(world);
    for block in stations.iter().flat_map(FallStation::blocks) {
        block.spawn(world);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_the_greatest_and_the_least() {
        assert_eq!(greatest([1.0, 3.0, 2.0]), 3.0);
        assert_eq!(least([1.0, -3.0, 2.0]), -3.0);
        for at in 0..3 {
            let mut all = [1.0, 2.0, 3.0];
            all[at] = f32::NAN;
            assert!(greatest(all).is_nan() && least(all).is_nan(), "{at}");
        }
        assert!(greatest([]).is_nan() && least([]).is_nan());
    }

    #[test]
    fn everything_stands_on_the_yard_and_no_station_in_another() {
        let stations = fall_stations();
        let inside = |at: Vec3| {
            let off = (at - YARD.0).abs() - 0.5 * YARD.1;
            off.x < 0.0 && off.z < 0.0
        };
        for station in &stations {
            assert!(inside(station.start().translation), "{}", station.name);
            for block in station.blocks() {
                assert!(inside(block.at.translation), "{}", station.name);
            }
        }
        for (i, a) in stations.iter().enumerate() {
            for b in &stations[i + 1..] {
                let gap = a.place.origin.distance(b.place.origin);
                assert!(gap > 20.0, "{} and {}: {gap} m", a.name, b.name);
            }
        }
    }
}
