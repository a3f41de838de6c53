//! Timers and counters per system, published to Bevy's diagnostics.

use core::time::Duration;

use bevy::{
    diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic},
    prelude::*,
};

/// What the characters of the last tick cost.
#[cfg(feature = "character")]
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

#[cfg(feature = "character")]
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

/// What the vehicles of the last tick cost.
#[cfg(feature = "vehicle")]
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct VehicleDiagnostics {
    /// Time that all vehicles together took, from the first of the tick's driving systems to the last.
    pub tick_time: Duration,
    /// Number of vehicles.
    pub vehicles: u32,
    /// Number of vehicles that slept and were left alone.
    pub asleep: u32,
    /// Sweeps of all solves together.
    pub sweeps: u32,
}

#[cfg(feature = "vehicle")]
impl VehicleDiagnostics {
    /// Time per tick of all vehicles together, milliseconds.
    pub const TICK_TIME: DiagnosticPath = DiagnosticPath::const_new("embody/vehicle/tick_time");
    /// Number of vehicles.
    pub const VEHICLES: DiagnosticPath = DiagnosticPath::const_new("embody/vehicle/count");
    /// Number of vehicles that were left alone because they sleep.
    pub const ASLEEP: DiagnosticPath = DiagnosticPath::const_new("embody/vehicle/asleep");
    /// Sweeps of all solves per tick.
    pub const SWEEPS: DiagnosticPath = DiagnosticPath::const_new("embody/vehicle/sweeps");
}

/// Publishes what each system costs to Bevy's [`Diagnostics`] after each tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyDiagnosticsPlugin;

impl Plugin for EmbodyDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        #[cfg(feature = "vehicle")]
        app.init_resource::<VehicleDiagnostics>()
            .register_diagnostic(Diagnostic::new(VehicleDiagnostics::TICK_TIME).with_suffix(" ms"))
            .register_diagnostic(Diagnostic::new(VehicleDiagnostics::VEHICLES))
            .register_diagnostic(Diagnostic::new(VehicleDiagnostics::ASLEEP))
            .register_diagnostic(Diagnostic::new(VehicleDiagnostics::SWEEPS))
            .add_systems(FixedLast, publish_vehicles);
        #[cfg(feature = "character")]
        app.init_resource::<CharacterDiagnostics>()
            .register_diagnostic(
                Diagnostic::new(CharacterDiagnostics::TICK_TIME).with_suffix(" ms"),
            )
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::QUERIES))
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::CHARACTERS))
            .register_diagnostic(Diagnostic::new(CharacterDiagnostics::IDLE))
            .add_systems(FixedLast, publish_characters);
    }
}

#[cfg(feature = "vehicle")]
fn publish_vehicles(measured: Res<VehicleDiagnostics>, mut diagnostics: Diagnostics) {
    diagnostics.add_measurement(&VehicleDiagnostics::TICK_TIME, || {
        measured.tick_time.as_secs_f64() * 1000.0
    });
    diagnostics.add_measurement(&VehicleDiagnostics::VEHICLES, || measured.vehicles.into());
    diagnostics.add_measurement(&VehicleDiagnostics::ASLEEP, || measured.asleep.into());
    diagnostics.add_measurement(&VehicleDiagnostics::SWEEPS, || measured.sweeps.into());
}

#[cfg(feature = "character")]
fn publish_characters(measured: Res<CharacterDiagnostics>, mut diagnostics: Diagnostics) {
    diagnostics.add_measurement(&CharacterDiagnostics::TICK_TIME, || {
        measured.tick_time.as_secs_f64() * 1000.0
    });
    diagnostics.add_measurement(&CharacterDiagnostics::QUERIES, || measured.queries.into());
    diagnostics.add_measurement(&CharacterDiagnostics::CHARACTERS, || {
        measured.characters.into()
    });
    diagnostics.add_measurement(&CharacterDiagnostics::IDLE, || measured.idle.into());
}
