//! Plays stations without a window and shows the outcome.

use core::fmt::Write;

use bevy::{ecs::system::RunSystemOnce, prelude::*};

use bevy_embody::{interpolation::EmbodyInterpolationPlugin, prelude::*};

use super::{StationResult, StationRun, stations};
use crate::{
    Sim,
    course::{Course, CourseError, CoursePlugin, spawn_course},
};

/// Plays every station whose name contains `filter`, each in a fresh world at `hz`, with the
/// course of this project.
///
/// # Errors
/// When the course cannot be loaded.
pub fn run_headless(filter: Option<&str>, hz: f64) -> Result<Vec<StationResult>, CourseError> {
    Ok(run_headless_with(
        &Course::load(Course::default_path())?,
        filter,
        hz,
    ))
}

/// As [`run_headless`], with this course.
pub fn run_headless_with(course: &Course, filter: Option<&str>, hz: f64) -> Vec<StationResult> {
    stations()
        .into_iter()
        .filter(|station| filter.is_none_or(|part| station.name.contains(part)))
        .map(|station| {
            // Between ticks a walker is looked at, and an eased pose is not where it is.
            let plugins = EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>();
            let mut sim = Sim::with(hz, (plugins, CoursePlugin)).in_line();
            sim.app.insert_resource(course.clone());
            let spawned = sim.app.world_mut().run_system_once(
                |mut commands: Commands, course: Res<Course>| {
                    spawn_course(&mut commands, &course);
                },
            );
            debug_assert!(spawned.is_ok(), "the course is a resource");
            // Queries see colliders from the tick after they were spawned.
            sim.ticks(2);
            let mut run = StationRun::begin(sim.app.world_mut(), station);
            while !run.tick(sim.app.world_mut()) {
                sim.ticks(1);
            }
            run.result()
        })
        .collect()
}

/// What was asked and what happened, one line per check, and why nothing was asked where nothing
/// was; the last line is `N passed, N failed`.
pub fn table(results: &[StationResult]) -> String {
    let wide = |text: &str| text.chars().count();
    let name = results.iter().map(|r| wide(&r.name)).max().unwrap_or(0);
    let asked = results
        .iter()
        .flat_map(|r| &r.checks)
        .map(|check| wide(&check.asked))
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for result in results {
        if let Some(why) = &result.exempt {
            let _ = writeln!(
                text,
                "{:name$}  --    {:asked$}  {why}",
                result.name, "not asked"
            );
        }
        for (i, check) in result.checks.iter().enumerate() {
            let mark = if check.pass { "ok  " } else { "FAIL" };
            let label = if i == 0 { result.name.as_str() } else { "" };
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{label:name$}  {mark}  {:asked$}  {}",
                check.asked, check.got
            );
        }
    }
    let count = |what: fn(&StationResult) -> bool| results.iter().filter(|r| what(r)).count();
    let exempt = count(|result| result.exempt.is_some());
    if exempt > 0 {
        let _ = writeln!(text, "{exempt} not asked, for the reasons above");
    }
    let _ = writeln!(
        text,
        "{} passed, {} failed",
        count(StationResult::passed),
        count(StationResult::failed)
    );
    text
}

/// Prints the [`table`].
#[expect(
    clippy::print_stdout,
    reason = "the table is what a headless run is for"
)]
pub fn print_table(results: &[StationResult]) {
    print!("{}", table(results));
}
