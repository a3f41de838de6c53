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
    /// Walking speed at the full height, metres per second. At 0 it stands; what it covers in a
    /// tick is swept, so no speed passes through walls.
    pub walk_speed: f32,
    /// Sprinting speed at the full height, metres per second. It may be lower than the walking
    /// speed.
    pub sprint_speed: f32,
    /// Speed at the crouched height and below, metres per second; between that and the full height
    /// it goes over into that of walking or sprinting, in proportion to the height.
    pub crouch_speed: f32,
    /// Greatest acceleration towards the speed asked for on the ground, metres per second squared.
    /// At infinity the speed is there at once; near 0 the character skates.
    pub acceleration: f32,
    /// Greatest deceleration on the ground when nothing is asked, metres per second squared.
    /// At 0 it never stops by itself; at infinity it stops at once.
    pub friction: f32,
    /// Greatest acceleration in the air, metres per second squared. At 0 a jump cannot be steered.
    pub air_acceleration: f32,
    /// Height of a jump above the ground it left, metres. It is reached at every tick rate. At 0, or
    /// without gravity, a jump only leaves the ground.
    pub jump_height: f32,
    /// How long after leaving the ground a jump is still allowed, seconds. At 0 only on ground;
    /// some seconds allow a jump in mid-air.
    pub coyote_time: f32,
    /// How long a press of jump is remembered, seconds. At 0 it counts in its own tick only.
    pub jump_buffer: f32,
    /// Part of gravity that acts, dimensionless. At 0 it hovers; negative it falls upwards, also off the
    /// ground, where it cannot walk or jump.
    pub gravity_scale: f32,
    /// Strength of gravity, metres per second squared, in place of the physics world's. Negative it
    /// acts along up.
    ///
    /// Gravity always acts against the character's own up: of the physics world's only the strength
    /// is taken. To fall where that points, follow it with
    /// [`UpDirection::AgainstGravity`](super::super::UpDirection::AgainstGravity).
    pub gravity: Option<f32>,
    /// Greatest falling speed, metres per second. At 0 it does not fall; at infinity it falls ever
    /// faster.
    pub max_fall_speed: f32,
    /// Speed when flying, metres per second. At 0 it hangs in the air.
    pub fly_speed: f32,
    /// Acceleration and deceleration when flying, metres per second squared. At infinity the speed is
    /// there at once; at 0 it drifts for ever.
    pub fly_acceleration: f32,
    /// Speed when swimming, relative to the water, metres per second. At 0 it goes with the flow.
    pub swim_speed: f32,
    /// Acceleration and deceleration when swimming, metres per second squared. At infinity water
    /// holds at once; at 0 it slides through.
    pub swim_acceleration: f32,
    /// Speed on a ladder, metres per second. At 0 it hangs on.
    pub climb_speed: f32,
    /// How fast the character turns to where it walks, or to
    /// [`CharacterIntent::facing`](super::super::CharacterIntent::facing), radians per second.
    /// At infinity it faces there at once; at 0 it never turns; `None` leaves its facing to the game,
    /// which writes the rotation of its [`Transform`].
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

impl CharacterMotor {
    /// Acceleration against up in a world with this gravity, metres per second squared.
    pub(crate) fn downward(&self, world: Vec3) -> f32 {
        self.gravity.unwrap_or(world.length()) * self.gravity_scale
    }
}

/// On a character: the game writes
/// [`CharacterState::velocity`](super::super::CharacterState::velocity) itself, in place of the
/// [`CharacterMotor`].
///
/// - Nothing else acts: no gravity, no jump, no mode, no water, no ladder;
///   [`LeftGround::jumped`](super::super::LeftGround::jumped) is never set.
/// - Of the motor two things are still used: [`CharacterMotor::turn_rate`] for the facing, and
///   [`CharacterMotor::gravity`] with [`CharacterMotor::gravity_scale`] for the weight on what it
///   stands on.
/// - Who stands on ground stays on it, up and down slopes and steps, until its velocity leads away
///   from it, and up, by more than 0.1 m/s.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CustomMotor;
