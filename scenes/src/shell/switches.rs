//! Keys that show and hide things: gizmos and the tuning panel.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, input::egui_wants_any_keyboard_input};
use bevy_embody::debug::{CharacterGizmos, InspectorPanel, RagdollGizmos, VehicleGizmos};

use super::overlay::Plate;

/// What is shown from the start.
#[derive(Resource, Clone, Copy, Debug)]
pub struct Switches {
    /// Whether the gizmos are drawn.
    pub gizmos: bool,
    /// Whether the tuning panel is open.
    pub panel: bool,
    /// Whether the head-up display is shown.
    pub display: bool,
}

impl Default for Switches {
    fn default() -> Self {
        Self {
            gizmos: false,
            panel: false,
            display: true,
        }
    }
}

/// `G` toggles the gizmos, `Tab` the tuning panel.
pub(super) struct SwitchesPlugin;

impl Plugin for SwitchesPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Switches>()
            .add_systems(PostStartup, set)
            .add_systems(
                Update,
                (
                    gizmos
                        .run_if(input_just_pressed(KeyCode::KeyG))
                        .run_if(not(egui_wants_any_keyboard_input)),
                    // Never gated: it must always be possible to close the panel.
                    panel.run_if(input_just_pressed(KeyCode::Tab)),
                ),
            )
            .add_systems(
                EguiPrimaryContextPass,
                keep_tab_for_the_game.run_if(input_just_pressed(KeyCode::Tab)),
            );
    }
}

fn set(
    switches: Res<Switches>,
    mut store: ResMut<GizmoConfigStore>,
    mut panel: ResMut<InspectorPanel>,
    mut plates: Query<&mut Visibility, With<Plate>>,
) {
    for mut visibility in plates.iter_mut().filter(|_| !switches.display) {
        *visibility = Visibility::Hidden;
    }
    show_gizmos(&mut store, switches.gizmos);
    panel.open = switches.panel;
}

fn gizmos(mut store: ResMut<GizmoConfigStore>) {
    let shown = store.config::<CharacterGizmos>().0.enabled;
    show_gizmos(&mut store, !shown);
}

fn show_gizmos(store: &mut GizmoConfigStore, shown: bool) {
    store.config_mut::<CharacterGizmos>().0.enabled = shown;
    store.config_mut::<VehicleGizmos>().0.enabled = shown;
    store.config_mut::<RagdollGizmos>().0.enabled = shown;
}

fn panel(mut panel: ResMut<InspectorPanel>) {
    panel.open = !panel.open;
}

/// To egui the key means the next field, which would then swallow the game's keys.
fn keep_tab_for_the_game(mut contexts: EguiContexts) -> Result {
    let context = contexts.ctx_mut()?;
    context.memory_mut(|memory| {
        if let Some(focused) = memory.focused() {
            memory.surrender_focus(focused);
        }
    });
    Ok(())
}
