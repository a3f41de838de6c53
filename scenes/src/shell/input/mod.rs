//! Keyboard, mouse and gamepad to the intent of a character or a vehicle.

mod actions;
mod button;
mod drive;
mod intent;
mod pointer;

use bevy::prelude::*;
use bevy_enhanced_input::prelude::*;

pub use button::Button;
pub use intent::Controls;

/// Actions, what they add up to between ticks, and the pointer's grab.
pub(super) struct InputPlugin;

impl Plugin for InputPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(EnhancedInputPlugin)
            .add_input_context::<actions::InControl>()
            .add_observer(actions::bind)
            .add_plugins(intent::plugin)
            .add_systems(
                PreUpdate,
                (pointer::grab, pointer::choose_sources)
                    .chain()
                    .after(bevy::input::InputSystems)
                    .before(EnhancedInputSystems::Update),
            );
    }
}
