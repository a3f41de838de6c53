//! Plays falling stations without a window.

use core::time::Duration;

use bevy::prelude::*;
use bevy_embody::{interpolation::EmbodyInterpolationPlugin, prelude::*};

use super::{FallRun, FallStation, fall_stations, spawn_yard};
use crate::{
    Sim,
    course::Course,
    figures::{FigureAssetsPlugins, HumanPlugin},
    stations::StationResult,
};

/// Plays every falling station whose name contains `filter`, each in a fresh world at `hz`.
pub fn run_falling(filter: Option<&str>, hz: f64) -> Vec<StationResult> {
    fall_stations()
        .into_iter()
        .filter(|station| filter.is_none_or(|part| station.name.contains(part)))
        .map(|station| play(station, hz))
        .collect()
}

fn play(station: FallStation, hz: f64) -> StationResult {
    let plugins = EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>();
    // Where the levels are, wherever this is run.
    let folder = Course::default_path();
    let folder = folder.parent().and_then(|f| std::path::absolute(f).ok());
    let mut assets = AssetPlugin::default();
    if let Some(folder) = folder {
        assets.file_path = folder.to_string_lossy().into_owned();
    }
    let mut sim = Sim::with(hz, (assets, FigureAssetsPlugins, plugins, HumanPlugin)).in_line();
    spawn_yard(sim.app.world_mut(), core::slice::from_ref(&station));
    sim.ticks(2);
    let mut run = FallRun::begin(sim.app.world_mut(), station);
    while !run.tick(sim.app.world_mut()) {
        sim.ticks(1);
        if run.waits() {
            std::thread::sleep(Duration::from_millis(2));
        }
    }
    run.result()
}
