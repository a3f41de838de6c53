//! Whose the mouse is: the camera's while it is grabbed, the panel's while it is over it.

use bevy::{
    prelude::*,
    window::{CursorGrabMode, CursorOptions, PrimaryWindow},
};
use bevy_egui::input::EguiWantsInput;
use bevy_embody::debug::InspectorPanel;
use bevy_enhanced_input::prelude::*;

/// A click into the world grabs the pointer; `Esc`, another window or the panel lets it go.
pub(super) fn grab(
    mouse: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    panel: Res<InspectorPanel>,
    egui: Res<EguiWantsInput>,
    windows: Query<(&Window, &mut CursorOptions), With<PrimaryWindow>>,
) {
    for (window, mut cursor) in windows {
        let grabbed = cursor.grab_mode != CursorGrabMode::None;
        let clicked = mouse.just_pressed(MouseButton::Left) && !egui.wants_any_pointer_input();
        let free = keys.just_pressed(KeyCode::Escape)
            || !window.focused
            || (panel.open && panel.is_changed());
        if grabbed && free {
            cursor.grab_mode = CursorGrabMode::None;
            cursor.visible = true;
        } else if !grabbed && clicked && !free {
            cursor.grab_mode = CursorGrabMode::Locked;
            cursor.visible = false;
        }
    }
}

/// Gives the actions only the sources that are the game's at the moment.
pub(super) fn choose_sources(
    egui: Res<EguiWantsInput>,
    cursors: Query<&CursorOptions, With<PrimaryWindow>>,
    mut sources: ResMut<ActionSources>,
) {
    let grabbed = cursors
        .iter()
        .any(|cursor| cursor.grab_mode != CursorGrabMode::None);
    sources.keyboard = !egui.wants_any_keyboard_input();
    sources.mouse_motion = grabbed;
    sources.mouse_buttons = grabbed || !egui.wants_any_pointer_input();
    sources.mouse_wheel = grabbed || !egui.wants_any_pointer_input();
}
