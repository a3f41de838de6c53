//! The character's view offset between ticks.

use bevy::prelude::*;
use bevy_embody::prelude::*;

/// On a character that is looked at: its view offset at the two last ticks. The pose is shown
/// between two ticks, so what is added to it must be taken from between the same two.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct ViewEase {
    from: Vec3,
    to: Vec3,
}

impl ViewEase {
    /// The offset at this part of the way from the last tick but one to the last, world axes,
    /// metres.
    pub fn offset(&self, part: f32) -> Vec3 {
        self.from.lerp(self.to, part)
    }
}

pub(super) fn keep(mut views: Query<(&CharacterState, &mut ViewEase)>) {
    for (state, mut view) in &mut views {
        view.from = view.to;
        view.to = state.view_offset;
    }
}
