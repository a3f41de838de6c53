//! What the vehicles of a tick cost, for whoever added the diagnostics.

use bevy::{platform::time::Instant, prelude::*};

use super::{output::VehicleTelemetry, report::VehicleReport};
use crate::diagnostics::VehicleDiagnostics;

/// When this tick's work began.
#[derive(Resource, Default)]
pub(super) struct Stopwatch(Option<Instant>);

/// Starts the watch before the first of the tick's systems.
pub(super) fn start(mut watch: ResMut<Stopwatch>) {
    watch.0 = Some(Instant::now());
}

/// Reads the watch after the last of them, and counts.
pub(super) fn stop(
    watch: Res<Stopwatch>,
    vehicles: Query<(&VehicleReport, &VehicleTelemetry)>,
    mut measured: ResMut<VehicleDiagnostics>,
) {
    *measured = VehicleDiagnostics {
        tick_time: watch.0.map(|began| began.elapsed()).unwrap_or_default(),
        ..default()
    };
    for (report, telemetry) in &vehicles {
        measured.vehicles += 1;
        if report.solved {
            measured.sweeps = measured.sweeps.saturating_add(telemetry.sweeps);
        } else if report.asleep {
            measured.asleep += 1;
        }
    }
}
