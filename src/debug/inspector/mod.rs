//! A panel that shows a character, a vehicle or a ragdoll live and tunes it.

mod edits;
mod fields;
mod findings;
mod panel;
mod plots;
#[cfg(feature = "ragdoll")]
mod ragdoll;
mod record;
mod units;
mod variants;
#[cfg(feature = "vehicle")]
mod vehicle;
mod window;

use bevy::prelude::*;
use bevy_egui::{EguiPlugin, EguiPrimaryContextPass};

pub use edits::TuningEdits;

use crate::character::{Character, CharacterMotor};

/// The tuning panel: every field of [`Character`] and [`CharacterMotor`] live, plots of speed and
/// ground state, the last step with its reason, refusals and contacts; every field of a vehicle and
/// its wheels live, plots of speed, engine, gear, wheel loads, slips and the g-g diagram; every field of
/// a ragdoll and its bones live, plots of speed, gaps of joints, limits passed and error of the pose.
///
/// It is drawn by `bevy_egui`, which is added if it is not there. Open and close it through
/// [`InspectorPanel`]; keep the game's own input away from it with `bevy_egui`'s run conditions
/// `egui_wants_any_pointer_input` and `egui_wants_any_keyboard_input`.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyInspectorPlugin;

impl Plugin for EmbodyInspectorPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<EguiPlugin>() {
            app.add_plugins(EguiPlugin::default());
        }
        app.register_type::<Character>()
            .register_type::<CharacterMotor>()
            .init_resource::<InspectorPanel>()
            .init_resource::<TuningEdits>()
            .init_resource::<record::Record<record::Sample>>()
            .add_systems(FixedPreUpdate, edits::apply_edits)
            .add_systems(FixedLast, record::record)
            .add_systems(
                EguiPrimaryContextPass,
                panel::show.run_if(|panel: Res<InspectorPanel>| panel.open),
            );
        #[cfg(feature = "vehicle")]
        vehicle::add(app);
        #[cfg(feature = "ragdoll")]
        ragdoll::add(app);
    }
}

/// Whether the panel is shown, and of whom.
#[derive(Resource, Clone, Debug)]
pub struct InspectorPanel {
    /// Whether it is shown.
    pub open: bool,
    /// The character to show; `None` shows the one with the lowest entity index.
    pub character: Option<Entity>,
    /// The vehicle to show; `None` shows the one with the lowest entity index.
    pub vehicle: Option<Entity>,
    /// The ragdoll to show; `None` shows the one with the lowest entity index.
    pub ragdoll: Option<Entity>,
    /// How far back the plots reach, seconds.
    pub seconds: f64,
}

impl Default for InspectorPanel {
    fn default() -> Self {
        Self {
            open: true,
            character: None,
            vehicle: None,
            ragdoll: None,
            seconds: 10.0,
        }
    }
}

/// The chosen one out of all there are, else the one with the lowest entity index.
fn pick<D>(
    chosen: Option<Entity>,
    mut all: impl Iterator<Item = (Entity, D)>,
) -> Option<(Entity, D)> {
    match chosen {
        Some(chosen) => all.find(|(entity, _)| *entity == chosen),
        None => all.min_by_key(|(entity, _)| *entity),
    }
}
