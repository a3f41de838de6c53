//! A clip: poses at equal steps in time.

use super::skeleton::{Pose, Skeleton};

#[derive(Clone, Debug)]
pub struct Clip {
    pub name: &'static str,
    /// Seconds.
    pub duration: f64,
    pub loops: bool,
    /// Metres per second along `+Z` at which the ground passes without feet sliding.
    pub speed: f64,
    /// First and last included.
    pub poses: Vec<Pose>,
}

impl Clip {
    /// Samples a motion given over seconds, about `rate` times per second.
    pub fn sample(
        name: &'static str,
        duration: f64,
        rate: f64,
        motion: impl Fn(f64) -> Pose,
    ) -> Self {
        let steps = (duration * rate).round().max(1.0) as usize;
        let mut poses: Vec<Pose> = (0..=steps)
            .map(|i| motion(duration * i as f64 / steps as f64))
            .collect();
        // The shorter way from each key to the next.
        for i in 1..poses.len() {
            let (before, here) = poses.split_at_mut(i);
            for (turn, last) in here[0].turns.iter_mut().zip(&before[i - 1].turns) {
                if turn.dot(*last) < 0.0 {
                    *turn = -*turn;
                }
            }
        }
        Self {
            name,
            duration,
            loops: false,
            speed: 0.0,
            poses,
        }
    }

    /// Starts over at its end, while the ground passes at a speed.
    pub fn looping(mut self, speed: f64) -> Self {
        self.loops = true;
        self.speed = speed;
        self
    }

    pub fn time(&self, key: usize) -> f64 {
        self.duration * key as f64 / (self.poses.len() - 1) as f64
    }
}

/// A body with a skeleton, a skin and clips.
#[derive(Clone, Debug)]
pub struct Figure {
    pub name: &'static str,
    pub skeleton: Skeleton,
    pub gates: Vec<super::skin::Gate>,
    pub shells: Vec<super::surface::Shell>,
    pub clips: Vec<Clip>,
}
