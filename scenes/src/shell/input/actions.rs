//! What a player can ask for, and the keys, buttons and sticks that ask for it.
//!
//! Gamepads are bound always; one is only ever found when the feature `gamepad` is on.

use bevy::prelude::*;
use bevy_enhanced_input::prelude::*;

use super::Controls;

/// The situation in which the actions below hold: on foot and at the wheel.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(super) struct InControl;

/// Right and forward, length up to 1.
#[derive(InputAction)]
#[action_output(Vec2)]
pub(super) struct Move;

/// Turn of the camera, radians: right and up.
#[derive(InputAction)]
#[action_output(Vec2)]
pub(super) struct Look;

/// Camera closer.
#[derive(InputAction)]
#[action_output(Vec2)]
pub(super) struct Zoom;

/// Jump.
#[derive(InputAction)]
#[action_output(bool)]
pub(super) struct Jump;

/// Sprint while held.
#[derive(InputAction)]
#[action_output(bool)]
pub(super) struct Sprint;

/// Crouch while held.
#[derive(InputAction)]
#[action_output(bool)]
pub(super) struct Crouch;

/// Start or stop flying.
#[derive(InputAction)]
#[action_output(bool)]
pub(super) struct Fly;

/// Turn for each point that the mouse moves, radians.
const MOUSE: f32 = 0.003;
/// Turn rate of a stick that is fully tilted, radians per second.
const STICK: f32 = 3.0;

/// Accelerator of a gamepad, `0..=1`.
#[derive(InputAction)]
#[action_output(f32)]
pub(super) struct Throttle;

/// Brake of a gamepad, `0..=1`.
#[derive(InputAction)]
#[action_output(f32)]
pub(super) struct Brake;

/// Binds everything for a new player.
pub(super) fn bind(added: On<Add, Controls>, mut commands: Commands) {
    commands.entity(added.entity).insert((
        InControl,
        actions!(InControl[
            (
                Action::<Move>::new(),
                DeadZone::default(),
                Bindings::spawn((
                    Cardinal::wasd_keys(),
                    Cardinal::arrows(),
                    Axial::left_stick(),
                )),
            ),
            (
                Action::<Throttle>::new(),
                bindings![GamepadButton::RightTrigger2],
            ),
            (
                Action::<Brake>::new(),
                bindings![GamepadButton::LeftTrigger2],
            ),
            (
                Action::<Look>::new(),
                Bindings::spawn((
                    Spawn((Binding::mouse_motion(), Scale::splat(MOUSE))),
                    Axial::right_stick().with((
                        DeadZone::default(),
                        Scale::splat(STICK),
                        DeltaScale::default(),
                    )),
                )),
            ),
            (
                Action::<Zoom>::new(),
                bindings![Binding::mouse_wheel()],
            ),
            (
                Action::<Jump>::new(),
                bindings![KeyCode::Space, GamepadButton::South],
            ),
            (
                Action::<Sprint>::new(),
                bindings![KeyCode::ShiftLeft, GamepadButton::LeftThumb],
            ),
            (
                Action::<Crouch>::new(),
                bindings![KeyCode::KeyC, KeyCode::ControlLeft, GamepadButton::East],
            ),
            (
                Action::<Fly>::new(),
                bindings![KeyCode::KeyF, GamepadButton::North],
            ),
        ]),
    ));
}
