//! The last attempts of a character to climb, kept long enough to be seen.

use std::collections::VecDeque;

use bevy::prelude::*;

use crate::character::{Character, CharacterContacts, StepAttempt};

/// The last attempts of a character to climb a step; [`EmbodyDebugPlugin`](super::EmbodyDebugPlugin)
/// adds it to every character and fills it.
#[derive(Component, Clone, Debug, Default)]
pub struct StepTrail {
    /// The attempts, oldest first.
    pub steps: VecDeque<MarkedStep>,
}

/// An attempt and when it was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarkedStep {
    /// The attempt.
    pub attempt: StepAttempt,
    /// When, seconds of fixed time.
    pub time: f64,
}

impl StepTrail {
    /// How long an attempt is kept, seconds.
    pub const KEPT: f64 = 2.0;
    /// How many attempts are kept at most.
    pub const MOST: usize = 32;

    /// The newest attempt that is kept.
    pub fn last(&self) -> Option<&MarkedStep> {
        self.steps.back()
    }

    fn add(&mut self, attempt: StepAttempt, time: f64) {
        // Leaning against a wall is one attempt, not one per tick.
        if let Some(last) = self.steps.back_mut()
            && last.attempt.result == attempt.result
            && last.attempt.point.distance_squared(attempt.point) < 0.05 * 0.05
        {
            *last = MarkedStep { attempt, time };
            return;
        }
        if self.steps.len() >= Self::MOST {
            self.steps.pop_front();
        }
        self.steps.push_back(MarkedStep { attempt, time });
    }

    fn forget(&mut self, now: f64) {
        while self
            .steps
            .front()
            .is_some_and(|step| now - step.time > Self::KEPT)
        {
            self.steps.pop_front();
        }
    }
}

/// Gives every new character a trail.
pub(super) fn lay_trails(
    mut commands: Commands,
    characters: Query<Entity, (With<Character>, Without<StepTrail>)>,
) {
    for character in &characters {
        commands.entity(character).try_insert(StepTrail::default());
    }
}

/// Takes the trail of what is no character any more.
pub(super) fn lift_trail(removed: On<Remove, Character>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<StepTrail>();
    }
}

pub(super) fn remember_steps(
    time: Res<Time<Fixed>>,
    mut characters: Query<(&CharacterContacts, &mut StepTrail)>,
) {
    let now = time.elapsed_secs_f64();
    for (contacts, mut trail) in &mut characters {
        if let Some(attempt) = contacts.step {
            trail.add(attempt, now);
        } else if trail.steps.is_empty() {
            continue;
        }
        trail.forget(now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::StepResult;

    fn attempt(x: f32, result: StepResult) -> StepAttempt {
        StepAttempt {
            point: Vec3::new(x, 0.0, 0.0),
            direction: Vec3::X,
            result,
        }
    }

    #[test]
    fn leaning_against_one_riser_is_one_mark() {
        let mut trail = StepTrail::default();
        for tick in 0..100 {
            trail.add(attempt(0.0, StepResult::TooHigh), f64::from(tick) / 60.0);
        }
        trail.add(attempt(1.0, StepResult::TooHigh), 1.7);
        assert_eq!(trail.steps.len(), 2);
    }

    #[test]
    fn marks_are_forgotten_and_never_too_many() {
        let mut trail = StepTrail::default();
        for i in 0..100u8 {
            trail.add(attempt(f32::from(i), StepResult::Climbed(0.2)), 0.0);
        }
        assert_eq!(trail.steps.len(), StepTrail::MOST);
        trail.forget(StepTrail::KEPT * 1.5);
        assert!(trail.steps.is_empty());
    }
}
