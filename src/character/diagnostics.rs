//! Timers and counters per system, published to Bevy's diagnostics.

use core::time::Duration;

use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic},
    prelude::*,
};

/// What the characters of the last tick cost.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CharacterDiagnostics {
    /// Time that all characters together took to be moved and solved and to act on other bodies: all
    /// of [`EmbodySystems::Drive`](crate::EmbodySystems::Drive). The building of bodies before it and
    /// the events after it are left out.
    pub tick_time: Duration,
    /// Number of geometry queries (distance evaluations) of all characters together.
    pub queries: u32,
    /// Number of characters.
    pub characters: u32,
    /// Number of characters that stood still on still ground and were left alone.
    pub idle: u32,
}

impl CharacterDiagnostics {
    /// Time per tick of all characters together, milliseconds.
    pub const TICK_TIME: DiagnosticPath = DiagnosticPath::const_new("embody/character/tick_time");
    /// Geometry queries per tick of all characters together.
    pub const QUERIES: DiagnosticPath = DiagnosticPath::const_new("embody/character/queries");
    /// Number of characters.
    pub const CHARACTERS: DiagnosticPath = DiagnosticPath::const_new("embody/character/count");
    /// Number of characters that were left alone because nothing about them changes.
    pub const IDLE: DiagnosticPath = DiagnosticPath::const_new("embody/character/idle");
}

/// Publishes [`CharacterDiagnostics`] to Bevy's [`Diagnostics`] after each tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyDiagnosticsPlugin;

impl Plugin for EmbodyDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<CharacterDiagnostics>()
            .register_diagnostic(
                Diagnostic::new(CharacterDiagnostics::TICK_TIME).with_suffix(" ms"),
            )
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::QUERIES))
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::CHARACTERS))
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::IDLE))
            .add_systems(FixedLast, publish);
    }
}

fn publish(measured: Res<CharacterDiagnostics>, mut diagnostics: Diagnostics) {
    diagnostics.add_measurement(&CharacterDiagnostics::TICK_TIME, || {
        measured.tick_time.as_secs_f64() * 1000.0
    });
    diagnostics.add_measurement(&CharacterDiagnostics::QUERIES, || measured.queries.into());
    diagnostics.add_measurement(&CharacterDiagnostics::CHARACTERS, || {
        measured.characters.into()
    });
    diagnostics.add_measurement(&CharacterDiagnostics::IDLE, || measured.idle.into());
}
