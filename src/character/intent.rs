//! What the game or an AI asks of a character; read once per tick.

use bevy::prelude::*;

/// What a character is asked to do. The game writes it in `FixedUpdate` or before; the tick that
/// follows consumes it. It is never written by the plugin.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterIntent {
    /// Direction to move in, in world axes, as a fraction of the full speed (`0..=1`, longer is
    /// cut to 1). The part along up counts only when flying, swimming or on a ladder.
    pub movement: Vec3,
    /// Whether jump is held. A press is remembered for
    /// [`CharacterMotor::jump_buffer`](super::CharacterMotor::jump_buffer).
    pub jump: bool,
    /// Whether to sprint.
    pub sprint: bool,
    /// Height to take up.
    pub stance: Stance,
    /// Direction to face, in world axes; `None` is where it walks. Turned to at
    /// [`CharacterMotor::turn_rate`](super::CharacterMotor::turn_rate); while that is `None`, as it is
    /// by default, it has no effect.
    pub facing: Option<Vec3>,
}

/// How tall a character stands.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum Stance {
    /// The shape's full height.
    #[default]
    Stand,
    /// [`Character::crouch_height`](super::Character::crouch_height).
    Crouch,
    /// Any total height, metres; kept between the least that the shape allows and its full height.
    /// The speed on foot goes with it.
    Height(f32),
}
