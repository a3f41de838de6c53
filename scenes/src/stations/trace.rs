//! What a walker did, tick by tick, in the station's axes: the evidence that checks judge.

use bevy::prelude::*;
use bevy_embody::character::{GroundState, MovementMode};

/// The walker after a tick.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The step of the script that the tick belonged to.
    pub step: usize,
    /// Seconds since the start of the station.
    pub time: f64,
    /// The foot, metres.
    pub foot: Vec3,
    /// Own velocity, metres per second.
    pub velocity: Vec3,
    /// Up axis, unit length.
    pub up: Vec3,
    /// Height of the walker, metres.
    pub height: f32,
    /// How the ground holds it.
    pub ground: GroundState,
    /// How it moves.
    pub mode: MovementMode,
    /// Whether a change of stance was refused.
    pub refused: bool,
    /// Poses of the nodes that the station tracks, in its order.
    pub nodes: Vec<Transform>,
}

impl Sample {
    /// Whether it stands on ground that holds it.
    pub fn on_ground(&self) -> bool {
        self.ground == GroundState::OnGround
    }
}

/// A sample that belongs to a step of a script.
pub trait OfStep {
    /// The step, from 0.
    fn step(&self) -> usize;
    /// Seconds since the start.
    fn time(&self) -> f64;
}

impl OfStep for Sample {
    fn step(&self) -> usize {
        self.step
    }

    fn time(&self) -> f64 {
        self.time
    }
}

/// All samples of a station.
#[derive(Clone, Debug)]
pub struct Trace<S = Sample> {
    /// The walker or driver at the start and after each tick.
    pub samples: Vec<S>,
    /// Length of a tick, seconds.
    pub dt: f64,
}

impl<S: OfStep> Trace<S> {
    /// An empty trace of ticks of this length, seconds.
    pub fn new(dt: f64) -> Self {
        Self {
            samples: Vec::new(),
            dt,
        }
    }

    /// Seconds since the start of the sample that comes next.
    pub fn time(&self) -> f64 {
        self.samples.len() as f64 * self.dt
    }

    /// The ticks of a step of the script; the sample before its first tick is not among them.
    pub fn step(&self, step: usize) -> &[S] {
        self.steps(step..step + 1)
    }

    /// The ticks of several steps.
    pub fn steps(&self, steps: core::ops::Range<usize>) -> &[S] {
        let first = self.samples.partition_point(|s| s.step() < steps.start);
        let end = self.samples.partition_point(|s| s.step() < steps.end);
        &self.samples[first..end]
    }

    /// The last sample.
    pub fn last(&self) -> Option<&S> {
        self.samples.last()
    }
}

/// The first moment at which a quantity passes a value from below, between two ticks, seconds.
pub fn crossing(samples: &[Sample], quantity: impl Fn(&Sample) -> f32, value: f32) -> Option<f64> {
    samples.windows(2).find_map(|pair| {
        let (before, after) = (quantity(&pair[0]), quantity(&pair[1]));
        (before < value && after >= value).then(|| {
            let part = f64::from((value - before) / (after - before));
            pair[0].time + part * (pair[1].time - pair[0].time)
        })
    })
}

/// The least and the greatest value of a quantity; NaN if there are no samples or one is NaN, so
/// that what never happened meets no bound.
pub fn range(samples: &[Sample], quantity: impl Fn(&Sample) -> f32) -> (f32, f32) {
    let values = samples.iter().map(quantity).map(|value| (value, value));
    values
        .reduce(|(low, high), (value, _)| {
            if value.is_nan() || low.is_nan() {
                (f32::NAN, f32::NAN)
            } else {
                (low.min(value), high.max(value))
            }
        })
        .unwrap_or((f32::NAN, f32::NAN))
}

/// Length of the path of the foot, metres.
pub fn path(samples: &[Sample]) -> f32 {
    samples
        .windows(2)
        .map(|pair| pair[1].foot.distance(pair[0].foot))
        .sum()
}

/// Seconds between the first and the last of these samples.
pub fn duration(samples: &[Sample]) -> f64 {
    match (samples.first(), samples.last()) {
        (Some(first), Some(last)) => last.time - first.time,
        _ => 0.0,
    }
}

/// Number of ticks in the air.
pub fn airborne(samples: &[Sample]) -> usize {
    samples
        .iter()
        .filter(|s| s.ground == GroundState::InAir)
        .count()
}
