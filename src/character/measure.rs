//! What the characters of a tick cost, for whoever added the diagnostics.

use bevy::{platform::time::Instant, prelude::*};

use super::{output::CharacterContacts, report::CharacterReport};
use crate::diagnostics::CharacterDiagnostics;

/// When this tick's work began.
#[derive(Resource, Default)]
pub(super) struct Stopwatch(Option<Instant>);

/// Starts the watch before the first of the tick's systems, if anybody wants to know.
pub(super) fn start(mut watch: ResMut<Stopwatch>, wanted: Option<Res<CharacterDiagnostics>>) {
    watch.0 = wanted.map(|_| Instant::now());
}

/// Reads the watch after the last of them, and counts.
pub(super) fn stop(
    watch: Res<Stopwatch>,
    characters: Query<(&CharacterReport, &CharacterContacts)>,
    measured: Option<ResMut<CharacterDiagnostics>>,
) {
    let Some(mut measured) = measured else { return };
    *measured = CharacterDiagnostics {
        tick_time: watch.0.map(|began| began.elapsed()).unwrap_or_default(),
        ..default()
    };
    for (report, contacts) in &characters {
        measured.characters += 1;
        if report.solved {
            measured.queries = measured.queries.saturating_add(contacts.queries);
        } else {
            measured.idle += 1;
        }
    }
}
