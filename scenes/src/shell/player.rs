//! Who keyboard, mouse and camera belong to.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use super::{camera::ViewEase, figure::FigureOf, input::Controls};

/// The character or the vehicle that keyboard, mouse and camera belong to.
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(Controls)]
pub struct Player;

/// A character that the player steers, with its foot at this pose.
pub fn player(start: Transform) -> impl Bundle {
    (
        Name::new("player"),
        Player,
        ViewEase::default(),
        FigureOf::default(),
        Character::default(),
        player_motor(&CharacterMotor::default()),
        start,
    )
}

/// A motor that turns the figure to where it walks.
pub(super) fn player_motor(motor: &CharacterMotor) -> CharacterMotor {
    CharacterMotor {
        turn_rate: Some(12.0),
        ..motor.clone()
    }
}
