//! Plays a falling station's script and keeps what happened.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use super::{
    FallStation,
    script::{Crew, FallStep, Scene},
    stage::Block,
    trace::{FallTrace, sample},
};
use crate::{
    figures::Animated,
    stations::{Played, StationResult, Tracked},
};

/// How long figures may take to load, seconds of real time.
const PATIENCE: f32 = 60.0;
/// Ticks that a loaded figure has before the script begins: its first pose is that of its clip then.
const SETTLE: u32 = 3;

/// A falling station being played. Call [`tick`](Self::tick) once before each fixed tick.
pub struct FallRun {
    station: FallStation,
    crew: Crew,
    /// All that is fixed, world.
    ground: Vec<Block>,
    trace: FallTrace,
    asked: f32,
    settled: u32,
    step: usize,
    in_step: f32,
    stopped: Option<String>,
}

impl FallRun {
    /// Spawns those who take part.
    pub fn begin(world: &mut World, station: FallStation) -> Self {
        let mut crew = Crew::default();
        (station.cast)(&mut Scene {
            world,
            place: station.place,
            crew: &mut crew,
        });
        let dt = world.resource::<Time<Fixed>>().timestep().as_secs_f64();
        let mut ground = vec![Block::yard()];
        ground.extend(station.blocks());
        Self {
            station,
            crew,
            ground,
            trace: FallTrace::new(dt),
            asked: world.resource::<Time<Real>>().elapsed_secs(),
            settled: 0,
            step: 0,
            in_step: 0.0,
            stopped: None,
        }
    }

    /// Despawns those who took part.
    pub fn end(self, world: &mut World) {
        let Crew {
            figures,
            props,
            car,
        } = self.crew;
        for entity in figures.into_iter().chain(props).chain(car) {
            world.despawn(entity);
        }
    }

    /// What is done now; none when it is done.
    pub fn current(&self) -> Option<&FallStep> {
        self.station.steps.get(self.step)
    }

    /// Whether figures have yet to be loaded.
    pub fn waits(&self) -> bool {
        self.settled < SETTLE
    }

    /// Looks at the tick that has passed and does what comes before the next one. Returns whether the
    /// script is done.
    pub fn tick(&mut self, world: &mut World) -> bool {
        if self.stopped.is_some() || self.step >= self.station.steps.len() {
            return true;
        }
        if self.waits() {
            let there = |figure: &Entity| {
                world.get::<Animated>(*figure).is_some() && world.get::<Bones>(*figure).is_some()
            };
            if self.crew.figures.iter().all(there) {
                self.settled += 1;
            } else if world.resource::<Time<Real>>().elapsed_secs() - self.asked > PATIENCE {
                self.stopped = Some("the figures could not be loaded".into());
            }
            return false;
        }
        let mut now = sample(world, &self.crew, &self.station.place, &self.ground);
        let dt = self.trace.dt as f32;
        now.step = self.step;
        now.time = self.trace.time();
        let lost = now.figures.iter().any(|f| !f.root.is_finite());
        self.trace.samples.push(now);
        if lost {
            self.stopped = Some("a figure is nowhere".into());
            return true;
        }
        while let Some(step) = self.current()
            && self.in_step + 0.5 * dt >= step.seconds
        {
            self.step += 1;
            self.in_step = 0.0;
        }
        let Some(step) = self.station.steps.get(self.step) else {
            return true;
        };
        let mut scene = Scene {
            world,
            place: self.station.place,
            crew: &mut self.crew,
        };
        step.act(&mut scene, self.in_step);
        self.in_step += dt;
        false
    }

    /// Judges what happened.
    pub fn result(&self) -> StationResult {
        StationResult::judge(
            self.station.name.into(),
            self.station.describe,
            &Played {
                stopped: self.stopped.as_deref(),
                step: self.step,
                steps: self.station.steps.len(),
                tracked: &Tracked::default(),
            },
            &self.station.checks,
            &self.trace,
        )
    }
}
