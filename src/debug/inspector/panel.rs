//! The window of the characters.

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_egui::{
    EguiContexts,
    egui::{self, CollapsingHeader, ScrollArea},
};

use super::{
    InspectorPanel,
    edits::TuningEdits,
    fields::Form,
    findings, pick, plots,
    record::{Record, Sample},
    units::unit,
};
use crate::character::{Character, CharacterContacts, CharacterMotor, CharacterState, StepAttempt};
#[cfg(feature = "debug")]
use crate::debug::StepTrail;

/// What the panel shows of a character.
#[derive(QueryData)]
pub(super) struct Shown {
    character: &'static Character,
    motor: &'static CharacterMotor,
    state: &'static CharacterState,
    contacts: &'static CharacterContacts,
    #[cfg(feature = "debug")]
    trail: Option<&'static StepTrail>,
}

pub(super) fn show(
    mut contexts: EguiContexts,
    mut panel: ResMut<InspectorPanel>,
    mut edits: ResMut<TuningEdits>,
    registry: Res<AppTypeRegistry>,
    record: Res<Record<Sample>>,
    time: Res<Time<Fixed>>,
    characters: Query<(Entity, Shown)>,
    #[cfg(feature = "vehicle")] vehicles: Query<(), With<crate::vehicle::Vehicle>>,
    names: Query<&Name>,
) -> Result {
    let context = contexts.ctx_mut()?;
    let name = |entity: Entity| {
        names
            .get(entity)
            .map_or_else(|_| entity.to_string(), ToString::to_string)
    };
    // Who drives looks at the window of the vehicle.
    #[cfg(feature = "vehicle")]
    if characters.is_empty() && !vehicles.is_empty() {
        return Ok(());
    }
    let mut open = panel.open;
    egui::Window::new("Character")
        .id(egui::Id::new("embody character"))
        .open(&mut open)
        .default_pos([16.0, 16.0])
        .default_width(330.0)
        .default_height(560.0)
        .show(context, |ui| {
            let mut all: Vec<Entity> = characters.iter().map(|(entity, _)| entity).collect();
            all.sort_unstable();
            if all.len() > 1 {
                choose(ui, &mut panel.character, &all, name);
            }
            let Some((entity, shown)) = pick(panel.character, characters.iter()) else {
                ui.weak("there is no character");
                return;
            };
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                plots::show(ui, &record, panel.seconds);
                let step = last_step(&shown, time.elapsed_secs_f64());
                CollapsingHeader::new("Findings")
                    .default_open(true)
                    .show(ui, |ui| {
                        findings::show(ui, shown.state, shown.contacts, step, name);
                    });
                let registry = registry.read();
                let mut form = Form::new(&registry, &mut edits, entity, unit);
                CollapsingHeader::new("Character")
                    .default_open(true)
                    .show(ui, |ui| form.component(ui, shown.character));
                CollapsingHeader::new("Motor")
                    .default_open(true)
                    .show(ui, |ui| form.component(ui, shown.motor));
            });
        });
    if panel.open != open {
        panel.open = open;
    }
    Ok(())
}

/// A list to choose from.
pub(super) fn choose(
    ui: &mut egui::Ui,
    chosen: &mut Option<Entity>,
    all: &[Entity],
    name: impl Fn(Entity) -> String,
) {
    let shown = chosen.or(all.first().copied());
    egui::ComboBox::from_id_salt("choice")
        .selected_text(shown.map(&name).unwrap_or_default())
        .show_ui(ui, |ui| {
            for &entity in all {
                if ui
                    .selectable_label(shown == Some(entity), name(entity))
                    .clicked()
                {
                    *chosen = Some(entity);
                }
            }
        });
}

/// The last attempt to climb a step and its age, seconds.
fn last_step(shown: &ShownItem, now: f64) -> Option<(StepAttempt, f64)> {
    #[cfg(feature = "debug")]
    if let Some(step) = shown.trail.and_then(StepTrail::last) {
        return Some((step.attempt, (now - step.time).max(0.0)));
    }
    let _ = now;
    shown.contacts.step.map(|attempt| (attempt, 0.0))
}
