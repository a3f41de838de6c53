//! The last seconds of a character, tick by tick.

use std::collections::VecDeque;

use bevy::prelude::*;

use super::InspectorPanel;
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

/// The samples of the character that the panel shows, oldest first.
#[derive(Resource, Debug, Default)]
pub(super) struct Record {
    of: Option<Entity>,
    pub(super) samples: VecDeque<Sample>,
}

impl Record {
    fn add(&mut self, of: Entity, sample: Sample, kept: f64) {
        // A clock that went back means another run.
        let runs_on = self.of == Some(of)
            && self
                .samples
                .back()
                .is_none_or(|last| last.time <= sample.time);
        if !runs_on {
            self.samples.clear();
            self.of = Some(of);
        }
        self.samples.push_back(sample);
        while self
            .samples
            .front()
            .is_some_and(|first| sample.time - first.time > kept)
        {
            self.samples.pop_front();
        }
    }
}

pub(super) fn record(
    time: Res<Time<Fixed>>,
    panel: Res<InspectorPanel>,
    mut record: ResMut<Record>,
    characters: Query<(Entity, &CharacterState), With<Character>>,
) {
    let Some((entity, state)) = panel.pick(characters.iter()) else {
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
        let mut record = Record::default();
        for tick in 0..1000 {
            record.add(Entity::PLACEHOLDER, sample(f64::from(tick) / 100.0), 2.0);
        }
        assert!((200..=202).contains(&record.samples.len()));
        record.add(Entity::PLACEHOLDER, sample(0.0), 2.0);
        assert_eq!(record.samples.len(), 1);
    }
}
