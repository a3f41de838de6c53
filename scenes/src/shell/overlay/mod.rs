//! Text over the picture: what the player does, where it is, which keys there are.

mod dash;
mod help;
mod hud;

use bevy::prelude::*;

pub use hud::{Hud, HudPart, Plate};

/// Help (`F1`) and head-up display (`F2`).
pub(super) struct OverlayPlugin;

impl Plugin for OverlayPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((help::HelpPlugin, hud::HudPlugin, dash::DashPlugin));
    }
}

/// A dark plate that text can be read on.
fn plate() -> impl Bundle {
    BackgroundColor(Color::srgba(0.05, 0.07, 0.1, 0.6))
}
