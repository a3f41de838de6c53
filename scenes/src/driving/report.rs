//! Plays driving stations without a window.

use std::{
    sync::atomic::{AtomicUsize, Ordering},
    thread,
};

use bevy::{ecs::system::RunSystemOnce, prelude::*};
use bevy_embody::{interpolation::EmbodyInterpolationPlugin, prelude::*};

use super::{DriveRun, DriveStation, Figures, drive_stations};
use crate::{
    Sim,
    course::{Course, CourseError, CoursePlugin, spawn_course},
    stations::StationResult,
};

/// Plays every preset on every driving station for which `station/preset` contains `filter`, each in
/// a fresh world at `hz`, with the proving ground of this project.
///
/// # Errors
/// When the proving ground cannot be loaded.
pub fn run_driving(filter: Option<&str>, hz: f64) -> Result<Vec<StationResult>, CourseError> {
    Ok(run_driving_with(
        &Course::load(Course::proving_ground_path())?,
        filter,
        hz,
    ))
}

/// As [`run_driving`], with this level.
pub fn run_driving_with(level: &Course, filter: Option<&str>, hz: f64) -> Vec<StationResult> {
    let count = drive_stations().len();
    let drives: Vec<(usize, Figures)> = (0..count)
        .flat_map(|station| Figures::all().into_iter().map(move |f| (station, f)))
        .collect();
    // The worlds know nothing of each other, so they run beside each other.
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            let Some((station, figures)) = drives.get(i) else {
                return done;
            };
            if let Some(station) = drive_stations().into_iter().nth(*station)
                && let Some(result) = play(level, station, figures, filter, hz)
            {
                done.push((i, result));
            }
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut results: Vec<(usize, StationResult)> = thread::scope(|scope| {
        let all: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        all.into_iter()
            .flat_map(|one| match one.join() {
                Ok(done) => done,
                Err(panic) => std::panic::resume_unwind(panic),
            })
            .collect()
    });
    results.sort_by_key(|(i, _)| *i);
    results.into_iter().map(|(_, result)| result).collect()
}

fn play(
    level: &Course,
    station: DriveStation,
    figures: &Figures,
    filter: Option<&str>,
    hz: f64,
) -> Option<StationResult> {
    let name = format!("{}/{}", station.name, figures.name);
    if filter.is_some_and(|part| !name.contains(part)) {
        return None;
    }
    if let Err(why) = station.plan(figures) {
        return Some(StationResult {
            name,
            checks: Vec::new(),
            seconds: 0.0,
            exempt: Some(why),
        });
    }
    let plugins = EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>();
    let mut sim = Sim::with(hz, (plugins, CoursePlugin)).in_line();
    // Only what the station is made of: a level is dear to build, and each world builds its own.
    let family = station.name.replace("side_", "hill_");
    let mut part = level.clone();
    part.nodes
        .retain(|node| node.name == "meadow" || node.name.starts_with(&family));
    sim.app.insert_resource(part);
    let spawned =
        sim.app
            .world_mut()
            .run_system_once(|mut commands: Commands, level: Res<Course>| {
                spawn_course(&mut commands, &level);
            });
    debug_assert!(spawned.is_ok(), "the level is a resource");
    sim.ticks(2);
    let mut run = DriveRun::begin(sim.app.world_mut(), station, figures.clone())?;
    while !run.tick(sim.app.world_mut()) {
        sim.ticks(1);
    }
    Some(run.result())
}
