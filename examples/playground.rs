//! A walk through the course, a drive over the proving ground and falls in the yard: every part of the
//! character controller, of the vehicles and of the ragdolls.
//!
//! - `playground` opens a window; `F1` lists the keys.
//! - `playground --station oval --vehicle kart` starts there, driving that.
//! - `playground --headless` (also without a display) lets a scripted walker visit every station,
//!   a scripted driver every driving station with every vehicle, and humans fall at every falling
//!   station, and prints what was asked and what happened.
//! - `playground --screenshot FILE --station NAME` saves a picture; the name `overview` shows the
//!   whole course.

use std::{path::PathBuf, process::ExitCode};

use bevy::prelude::*;
use bevy_embody::EmbodyPlugins;
use clap::Parser;
use embody_scenes::{
    course::{Course, CourseError},
    driving::run_driving,
    falling::run_falling,
    shell::{
        CourseShellPlugin, Models, ShellPlugin, Shot, ShotPlugin, Start, Switches, has_display,
        window_plugins,
    },
    stations::{StationResult, print_table, run_headless},
};

/// The name that stands for the whole course in a picture.
const OVERVIEW: &str = "overview";

#[derive(Parser)]
struct Options {
    /// Visits every station without a window and prints a table.
    #[arg(long)]
    headless: bool,
    /// Visits only stations whose name contains this.
    #[arg(long)]
    filter: Option<String>,
    /// Ticks per second.
    #[arg(long, default_value_t = 64.0)]
    hz: f64,
    /// The station to start at.
    #[arg(long)]
    station: Option<String>,
    /// The vehicle to drive.
    #[arg(long)]
    vehicle: Option<String>,
    /// Saves a picture of the station here and exits.
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// Lets the station's own walker go for this long before the picture, seconds.
    #[arg(long, default_value_t = 1.0)]
    seconds: f32,
    /// Turn and pitch of the picture's camera, degrees, and its distance, metres.
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    view: Option<Vec<f32>>,
    /// Shows the gizmos from the start.
    #[arg(long)]
    gizmos: bool,
    /// Opens the tuning panel from the start.
    #[arg(long)]
    panel: bool,
}

#[expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a program talks to whoever started it"
)]
fn main() -> ExitCode {
    let options = Options::parse();
    let displayed = has_display();
    let done = if options.headless || !displayed {
        if !options.headless {
            println!("There is no display: visiting every station without a window.");
        }
        headless(&options)
    } else {
        window(&options)
    };
    match done {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn headless(options: &Options) -> Result<ExitCode, CourseError> {
    let mut results = run_headless(options.filter.as_deref(), options.hz)?;
    results.extend(run_driving(options.filter.as_deref(), options.hz)?);
    results.extend(run_falling(options.filter.as_deref(), options.hz));
    print_table(&results);
    // A filter that finds nothing proves nothing.
    let passed =
        results.iter().any(StationResult::passed) && !results.iter().any(StationResult::failed);
    Ok(if passed {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

fn window(options: &Options) -> Result<ExitCode, CourseError> {
    let mut course = Course::load(Course::default_path())?;
    course.add(Course::load(Course::proving_ground_path())?);
    let models = Models(Course::load(Course::vehicles_path())?);
    let picture = options.screenshot.is_some();
    let mut app = App::new();
    app.add_plugins(window_plugins("bevy_embody: playground", picture))
        .insert_resource(Time::<Fixed>::from_hz(options.hz))
        .insert_resource(course)
        .insert_resource(models)
        .insert_resource(Switches {
            gizmos: options.gizmos,
            panel: options.panel,
            display: options.station.as_deref() != Some(OVERVIEW),
        })
        .insert_resource(Start {
            station: options.station.clone().filter(|name| name != OVERVIEW),
            vehicle: options.vehicle.clone(),
            play: picture,
        })
        .add_plugins((EmbodyPlugins, ShellPlugin, CourseShellPlugin));
    if let Some(file) = &options.screenshot {
        app.add_plugins(ShotPlugin(shot(options, file)));
    }
    Ok(match app.run() {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(code) => ExitCode::from(code.get()),
    })
}

fn shot(options: &Options, file: &std::path::Path) -> Shot {
    let overview = options.station.as_deref() == Some(OVERVIEW);
    Shot {
        file: file.into(),
        seconds: options.seconds,
        view: options.view.as_deref().and_then(|view| match view {
            [turn, pitch, distance] => {
                Some(Vec3::new(turn.to_radians(), pitch.to_radians(), *distance))
            }
            _ => None,
        }),
        overview: overview.then(|| {
            Transform::from_xyz(27.0, 16.5, 44.0).looking_at(Vec3::new(-6.0, -3.5, 8.0), Vec3::Y)
        }),
    }
}
