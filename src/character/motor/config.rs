//! The numbers of the movement layer.

use bevy::prelude::*;

/// Turns a character's intent into velocity: walking, jumping, flying, swimming and climbing.
///
/// It is replaceable: a character with [`CustomMotor`] is left alone, and the game writes
/// [`CharacterState::velocity`](super::super::CharacterState::velocity) before each tick.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterMotor {
    /// Walking speed, metres per second.
    pub walk_speed: f32,
    /// Sprinting speed, metres per second.
    pub sprint_speed: f32,
    /// Speed while crouched, metres per second.
    pub crouch_speed: f32,
    /// Greatest acceleration towards the speed asked for on the ground, metres per second squared.
    /// At infinity the speed is there at once; near 0 the character skates.
    pub acceleration: f32,
    /// Greatest deceleration on the ground when nothing is asked, metres per second squared.
    /// At 0 it never stops by itself; at infinity it stops at once.
    pub friction: f32,
    /// Greatest acceleration in the air, metres per second squared. At 0 a jump cannot be steered.
    pub air_acceleration: f32,
    /// Height of a jump above the ground it left, metres. It is reached at every tick rate.
    pub jump_height: f32,
    /// How long after leaving the ground a jump is still allowed, seconds.
    pub coyote_time: f32,
    /// How long a press of jump is remembered, seconds.
    pub jump_buffer: f32,
    /// Part of the physics world's gravity that acts, dimensionless. At 0 it hovers; negative it
    /// falls upwards.
    pub gravity_scale: f32,
    /// Strength of gravity, metres per second squared, in place of the physics world's; it acts
    /// against the character's up.
    pub gravity: Option<f32>,
    /// Greatest falling speed, metres per second.
    pub max_fall_speed: f32,
    /// Speed when flying, metres per second.
    pub fly_speed: f32,
    /// Acceleration and deceleration when flying, metres per second squared.
    pub fly_acceleration: f32,
    /// Speed when swimming, metres per second.
    pub swim_speed: f32,
    /// Acceleration and deceleration when swimming, metres per second squared.
    pub swim_acceleration: f32,
    /// Speed on a ladder, metres per second.
    pub climb_speed: f32,
    /// How fast the character turns to where it walks, or to
    /// [`CharacterIntent::facing`](super::super::CharacterIntent::facing), radians per second;
    /// `None` leaves its facing to the game.
    pub turn_rate: Option<f32>,
}

impl Default for CharacterMotor {
    fn default() -> Self {
        Self {
            walk_speed: 5.0,
            sprint_speed: 8.0,
            crouch_speed: 2.5,
            acceleration: 50.0,
            friction: 40.0,
            air_acceleration: 12.0,
            jump_height: 1.2,
            coyote_time: 0.1,
            jump_buffer: 0.12,
            gravity_scale: 1.0,
            gravity: None,
            max_fall_speed: 100.0,
            fly_speed: 8.0,
            fly_acceleration: 40.0,
            swim_speed: 3.0,
            swim_acceleration: 12.0,
            climb_speed: 2.5,
            turn_rate: None,
        }
    }
}

/// On a character: its [`CharacterMotor`] does nothing; the game writes
/// [`CharacterState::velocity`](super::super::CharacterState::velocity) itself.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct CustomMotor;
