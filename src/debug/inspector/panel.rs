//! The window of the characters.

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_egui::{EguiContexts, egui::CollapsingHeader};

use super::{
    InspectorPanel,
    edits::TuningEdits,
    fields::Form,
    findings, plots,
    record::{Record, Sample},
    units::unit,
    window::{self, Subject},
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
    #[cfg(feature = "ragdoll")] ragdolls: Query<(), With<crate::ragdoll::Ragdoll>>,
    names: Query<&Name>,
) -> Result {
    // Who drives looks at the window of the vehicle.
    #[cfg(feature = "vehicle")]
    if characters.is_empty() && !vehicles.is_empty() {
        return Ok(());
    }
    #[cfg(feature = "ragdoll")]
    if characters.is_empty() && !ragdolls.is_empty() {
        return Ok(());
    }
    window::show(
        contexts.ctx_mut()?,
        &mut panel,
        Subject::Character,
        characters.iter(),
        &names,
        |ui, seconds, entity, shown| {
            plots::show(ui, &record, seconds);
            let step = last_step(&shown, time.elapsed_secs_f64());
            CollapsingHeader::new("Findings")
                .default_open(true)
                .show(ui, |ui| {
                    findings::show(ui, shown.state, shown.contacts, step, |entity| {
                        window::name(&names, entity)
                    });
                });
            let registry = registry.read();
            let mut form = Form::new(&registry, &mut edits, entity, unit);
            CollapsingHeader::new("Character")
                .default_open(true)
                .show(ui, |ui| form.component(ui, shown.character));
            CollapsingHeader::new("Motor")
                .default_open(true)
                .show(ui, |ui| form.component(ui, shown.motor));
        },
    );
    Ok(())
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
