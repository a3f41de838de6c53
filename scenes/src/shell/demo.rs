//! Runs a small example without a window: holds its keys down for some seconds and tells where the
//! characters and vehicles went, and how ragdolls fell. Who falls must lie, be hit, and get up: otherwise
//! the run fails.

use core::time::Duration;

use bevy::{
    app::PluginGroupBuilder,
    input::{InputPlugin, InputSystems},
    log::LogPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_embody::{prelude::*, ragdoll::SkinReport};

use super::{
    falls::{self, Falls},
    has_display, window_plugins,
};
use crate::figures::FigureAssetsPlugins;

/// Length of a run without a window, ticks.
const TICKS: u32 = 320;
/// The same where somebody has to fall and get up.
const FALL_TICKS: u32 = 512;
/// How long a figure may take to load, seconds.
const PATIENCE: u64 = 60;

/// Bevy's default plugins with a window; without one, and with a short scripted run, if the
/// program was started with `--headless` or there is no display.
#[expect(clippy::print_stdout, reason = "says why there is no window")]
pub fn demo_plugins(title: &str) -> PluginGroupBuilder {
    let asked = std::env::args().any(|argument| argument == "--headless");
    if !asked && has_display() {
        return window_plugins(title, false);
    }
    if !asked {
        println!("There is no display: running for some seconds without a window.");
    }
    MinimalPlugins
        .build()
        .add(LogPlugin::default())
        .add(TransformPlugin)
        .add(InputPlugin)
        .add(AssetPlugin::default())
        .add_group(FigureAssetsPlugins)
        .add(ScriptedRun)
}

/// Holds `W` all the time and `Space` for a moment in the middle, then reports and exits.
struct ScriptedRun;

impl Plugin for ScriptedRun {
    fn build(&self, app: &mut App) {
        app.init_resource::<Loaded>()
            .init_resource::<Falls>()
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .add_systems(PreUpdate, hold_keys.after(InputSystems))
            .add_systems(FixedFirst, wait)
            .add_systems(
                FixedLast,
                (falls::report, report)
                    .chain()
                    .run_if(|loaded: Res<Loaded>| loaded.0.is_some()),
            );
    }
}

/// When all that has to be loaded was there, seconds of fixed time.
#[derive(Resource, Default)]
struct Loaded(Option<f32>);

/// Gives figures the real time that they take to load.
fn wait(
    time: Res<Time<Fixed>>,
    real: Res<Time<Real>>,
    mut loaded: ResMut<Loaded>,
    figures: Query<(), (With<RagdollFromSkin>, Without<SkinReport>)>,
    mut exit: MessageWriter<AppExit>,
) {
    if loaded.0.is_some() {
        return;
    }
    if figures.is_empty() {
        loaded.0 = Some(time.elapsed_secs());
    } else if real.elapsed() > Duration::from_secs(PATIENCE) {
        error!("a figure has not been loaded in {PATIENCE} s");
        exit.write(AppExit::error());
    } else {
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn hold_keys(mut keys: ResMut<ButtonInput<KeyCode>>, loaded: Res<Loaded>, time: Res<Time<Fixed>>) {
    keys.press(KeyCode::KeyW);
    let since = loaded.0.map_or(0.0, |began| time.elapsed_secs() - began);
    if (1.0..1.1).contains(&since) {
        keys.press(KeyCode::Space);
    } else {
        keys.release(KeyCode::Space);
    }
}

#[expect(
    clippy::print_stdout,
    reason = "the report is what a headless run is for"
)]
fn report(
    mut ticks: Local<u32>,
    mut starts: Local<Vec<(Entity, Vec3)>>,
    mut highest: Local<f32>,
    characters: Query<(Entity, &Transform, &CharacterState), With<Character>>,
    vehicles: Query<(Entity, &Transform, &VehicleTelemetry)>,
    ragdolls: Query<(), With<Ragdoll>>,
    falls: Res<Falls>,
    time: Res<Time<Fixed>>,
    mut exit: MessageWriter<AppExit>,
) {
    let most = if ragdolls.is_empty() {
        TICKS
    } else {
        FALL_TICKS
    };
    *ticks += 1;
    if *ticks == 1 {
        *starts = characters
            .iter()
            .map(|(entity, transform, _)| (entity, transform.translation))
            .collect();
    }
    for (_, transform, _) in &characters {
        *highest = highest.max(transform.translation.y);
    }
    if *ticks < most {
        return;
    }
    for (entity, transform, state) in &characters {
        let end = transform.translation;
        let start = starts
            .iter()
            .find(|(known, _)| *known == entity)
            .map_or(end, |(_, start)| *start);
        println!(
            "character {entity} walked from ({:.2}, {:.2}, {:.2}) to ({:.2}, {:.2}, {:.2}), {:.2} m in {:.1} s, {:?} at {:.2} m/s, highest {:.2} m",
            start.x,
            start.y,
            start.z,
            end.x,
            end.y,
            end.z,
            start.distance(end),
            time.elapsed_secs(),
            state.ground.state,
            state.velocity.length(),
            *highest,
        );
    }
    for (entity, transform, telemetry) in &vehicles {
        let end = transform.translation;
        println!(
            "vehicle {entity} drove to ({:.2}, {:.2}, {:.2}) in {:.1} s, {:.2} m/s in gear {} at {:.0} rpm, {} wheels on the ground",
            end.x,
            end.y,
            end.z,
            time.elapsed_secs(),
            telemetry.speed,
            telemetry.gear,
            telemetry.rpm,
            telemetry.grounded,
        );
    }
    let done = ragdolls.is_empty() || falls.tell();
    exit.write(if done {
        AppExit::Success
    } else {
        AppExit::error()
    });
}
