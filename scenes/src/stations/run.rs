//! Plays a station's script with a walker and keeps what happened.

use bevy::{math::ops, prelude::*};
use bevy_embody::character::{
    Character, CharacterContacts, CharacterIntent, CharacterState, Stance,
};

use super::{Sample, Station, StationResult, Step, Trace, result::Played, tracked::Tracked};

/// A station being played. Call [`tick`](Self::tick) once before each fixed tick, best in
/// `FixedPreUpdate`: there poses are exact, and the course has not moved on yet.
pub struct StationRun {
    station: Station,
    walker: Entity,
    tracked: Tracked,
    trace: Trace,
    step: usize,
    in_step: f64,
    turned: f32,
    stance: Stance,
    stopped: Option<String>,
}

impl StationRun {
    /// Spawns a walker at the start of a station.
    pub fn begin(world: &mut World, station: Station) -> Self {
        let walker = world
            .spawn((
                Name::new("walker"),
                station.character.clone(),
                station.motor.clone(),
                station.start,
            ))
            .id();
        Self::with(world, station, walker)
    }

    /// Puts an existing character at the start of a station, at rest, and makes it the walker.
    pub fn with(world: &mut World, station: Station, walker: Entity) -> Self {
        if let Ok(mut entity) = world.get_entity_mut(walker) {
            entity.insert((
                station.character.clone(),
                station.motor.clone(),
                station.start,
                CharacterState::default(),
                CharacterIntent::default(),
            ));
        }
        let tracked = Tracked::find(world, &station.track);
        let dt = world.resource::<Time<Fixed>>().timestep().as_secs_f64();
        Self {
            station,
            walker,
            tracked,
            trace: Trace::new(dt),
            step: 0,
            in_step: 0.0,
            turned: 0.0,
            stance: Stance::Stand,
            stopped: None,
        }
    }

    /// The station.
    pub fn station(&self) -> &Station {
        &self.station
    }

    /// The walker.
    pub fn walker(&self) -> Entity {
        self.walker
    }

    /// What it does now; none when it is done.
    pub fn current(&self) -> Option<&Step> {
        self.station.script.get(self.step)
    }

    /// What happened so far.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// Looks at the tick that has passed and says what to do in the next one. Returns whether the
    /// script is done.
    pub fn tick(&mut self, world: &mut World) -> bool {
        if self.stopped.is_some() || self.step >= self.station.script.len() {
            return true;
        }
        let Some(sample) = self.sample(world) else {
            self.stopped = Some("the walker is gone".into());
            return true;
        };
        if !sample.foot.is_finite() {
            self.stopped = Some(format!("the walker is at {}", sample.foot));
            return true;
        }
        if let (Some(Step::Orbit { axis, center, .. }), Some(before)) =
            (self.current(), self.trace.last())
        {
            let (axis, center) = (*axis, *center);
            self.turned += angle_about(axis, before.foot - center, sample.foot - center);
        }
        self.trace.samples.push(sample.clone());

        // Steps that take no time fall through to the next one.
        let mut placed = None;
        while let Some(step) = self.station.script.get(self.step) {
            match outcome(step, &sample, self.in_step, self.turned, self.trace.dt) {
                Outcome::Goes => break,
                Outcome::GivesUp => {
                    self.stopped = Some(format!(
                        "could not {}: stopped at {:.2}",
                        step.describe(),
                        sample.foot
                    ));
                    self.write(world, CharacterIntent::default());
                    return true;
                }
                Outcome::Done => {}
            }
            match step {
                Step::Take(stance) => self.stance = *stance,
                Step::Place(at) => placed = Some(self.station.place.transform(*at)),
                _ => {}
            }
            self.step += 1;
            self.in_step = 0.0;
            self.turned = 0.0;
        }
        if let Some(at) = placed
            && let Ok(mut walker) = world.get_entity_mut(self.walker)
        {
            walker.insert((at, CharacterState::default()));
        }
        let intent = self.intent(&sample);
        self.write(world, intent);
        self.in_step += self.trace.dt;
        self.step >= self.station.script.len()
    }

    /// Judges what happened.
    pub fn result(&self) -> StationResult {
        StationResult::judge(
            self.station.name.clone(),
            &self.station.describe,
            &Played {
                stopped: self.stopped.as_deref(),
                step: self.step,
                steps: self.station.script.len(),
                tracked: &self.tracked,
            },
            &self.station.checks,
            &self.trace,
        )
    }

    fn sample(&self, world: &World) -> Option<Sample> {
        let place = &self.station.place;
        let walker = world.get_entity(self.walker).ok()?;
        let transform = walker.get::<Transform>()?;
        let state = walker.get::<CharacterState>()?;
        let contacts = walker.get::<CharacterContacts>()?;
        walker.get::<Character>()?;
        Some(Sample {
            step: self.step,
            time: self.trace.time(),
            foot: place.local_point(transform.translation),
            velocity: place.local_direction(state.velocity),
            up: place.local_direction(state.up),
            height: state.height,
            ground: state.ground.state,
            mode: state.mode,
            refused: contacts.stance_refused.is_some(),
            nodes: self.tracked.poses(world, place),
        })
    }

    fn intent(&self, sample: &Sample) -> CharacterIntent {
        let place = &self.station.place;
        let movement = match self.current() {
            Some(Step::Walk { to, up, .. }) => {
                let way = *to - sample.foot;
                Vec3::new(way.x, 0.0, way.z).normalize_or_zero() + Vec3::Y * *up
            }
            Some(Step::Hold { movement, .. }) => *movement,
            Some(Step::Orbit { axis, center, .. }) => {
                axis.cross(sample.foot - *center).normalize_or_zero()
            }
            _ => Vec3::ZERO,
        };
        CharacterIntent {
            movement: place.direction(movement),
            jump: matches!(self.current(), Some(Step::Jump(_))),
            stance: self.stance,
            ..default()
        }
    }

    fn write(&self, world: &mut World, intent: CharacterIntent) {
        if let Some(mut current) = world.get_mut::<CharacterIntent>(self.walker) {
            *current = intent;
        }
    }
}

enum Outcome {
    Goes,
    Done,
    GivesUp,
}

/// What has become of a step that has been going for `elapsed` seconds.
fn outcome(step: &Step, sample: &Sample, elapsed: f64, turned: f32, dt: f64) -> Outcome {
    // Half a tick, so that a whole number of ticks is not missed by rounding.
    let over = |seconds: f32| elapsed + 0.5 * dt >= f64::from(seconds);
    let (done, timeout) = match step {
        Step::Walk {
            to,
            within,
            timeout,
            ..
        } => {
            let way = *to - sample.foot;
            (Vec2::new(way.x, way.z).length() <= *within, *timeout)
        }
        Step::Orbit { angle, timeout, .. } => (turned >= *angle, *timeout),
        Step::Hold { seconds, .. } | Step::Wait(seconds) | Step::Jump(seconds) => {
            (over(*seconds), f32::INFINITY)
        }
        Step::Take(_) | Step::Place(_) => (true, f32::INFINITY),
    };
    if done {
        Outcome::Done
    } else if over(timeout) {
        Outcome::GivesUp
    } else {
        Outcome::Goes
    }
}

/// Signed angle from one vector to another about an axis, radians.
fn angle_about(axis: Vec3, from: Vec3, to: Vec3) -> f32 {
    let flat = |v: Vec3| v - axis * v.dot(axis);
    let (from, to) = (flat(from), flat(to));
    ops::atan2(axis.dot(from.cross(to)), from.dot(to))
}
