//! The last seconds of what the panel shows, tick by tick.

use std::collections::VecDeque;

use bevy::prelude::*;

use super::{InspectorPanel, pick};
use crate::character::{Character, CharacterState, GroundState};

/// What is plotted of one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Fixed time, seconds.
    pub(super) time: f64,
    /// Speed across up, relative to the ground, metres per second.
    pub(super) level: f32,
    /// Speed along up in the world, metres per second.
    pub(super) rise: f32,
    /// How the ground held.
    pub(super) ground: GroundState,
}

/// Something that was noted at a time.
pub(super) trait Timed {
    /// Fixed time, seconds.
    fn time(&self) -> f64;
}

impl Timed for Sample {
    fn time(&self) -> f64 {
        self.time
    }
}

/// The samples of the one that the panel shows, oldest first.
#[derive(Resource, Debug)]
pub(super) struct Record<S: Send + Sync + 'static> {
    of: Option<Entity>,
    pub(super) samples: VecDeque<S>,
}

impl<S: Send + Sync + 'static> Default for Record<S> {
    fn default() -> Self {
        Self {
            of: None,
            samples: VecDeque::new(),
        }
    }
}

impl<S: Timed + Send + Sync> Record<S> {
    pub(super) fn add(&mut self, of: Entity, sample: S, kept: f64) {
        let now = sample.time();
        // A clock that went back means another run.
        let runs_on =
            self.of == Some(of) && self.samples.back().is_none_or(|last| last.time() <= now);
        if !runs_on {
            self.samples.clear();
            self.of = Some(of);
        }
        self.samples.push_back(sample);
        while self
            .samples
            .front()
            .is_some_and(|first| now - first.time() > kept)
        {
            self.samples.pop_front();
        }
    }

    /// A quantity against seconds before now.
    pub(super) fn curve(&self, value: impl Fn(&S) -> f64) -> Vec<[f64; 2]> {
        let now = self.samples.back().map_or(0.0, Timed::time);
        self.samples
            .iter()
            .map(|sample| [sample.time() - now, value(sample)])
            .collect()
    }
}

pub(super) fn record(
    time: Res<Time<Fixed>>,
    panel: Res<InspectorPanel>,
    mut record: ResMut<Record<Sample>>,
    characters: Query<(Entity, &CharacterState), With<Character>>,
) {
    let Some((entity, state)) = pick(panel.character, characters.iter()) else {
        return;
    };
    let rise = state.velocity.dot(state.up);
    record.add(
        entity,
        Sample {
            time: time.elapsed_secs_f64(),
            level: (state.velocity - state.up * rise).length(),
            rise: state.world_velocity().dot(state.up),
            ground: state.ground.state,
        },
        panel.seconds,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(time: f64) -> Sample {
        Sample {
            time,
            level: 0.0,
            rise: 0.0,
            ground: GroundState::InAir,
        }
    }

    #[test]
    fn only_the_last_seconds_are_kept() {
        let mut record = Record::<Sample>::default();
        for tick in 0..1000 {
            record.add(Entity::PLACEHOLDER, sample(f64::from(tick) / 100.0), 2.0);
        }
        assert!((200..=202).contains(&record.samples.len()));
        record.add(Entity::PLACEHOLDER, sample(0.0), 2.0);
        assert_eq!(record.samples.len(), 1);
    }
}
