//! Runs a small example without a window: holds its keys down for some seconds and tells where the
//! characters and vehicles went.

use bevy::{
    app::PluginGroupBuilder,
    input::{InputPlugin, InputSystems},
    log::LogPlugin,
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_embody::prelude::*;

use super::{has_display, window_plugins};

/// Length of a run without a window, ticks.
const TICKS: u32 = 320;

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
        .add(ScriptedRun)
}

/// Holds `W` all the time and `Space` for a moment in the middle, then reports and exits.
struct ScriptedRun;

impl Plugin for ScriptedRun {
    fn build(&self, app: &mut App) {
        // Only so that the example can spawn what nobody will look at.
        app.init_asset::<Mesh>()
            .init_asset::<StandardMaterial>()
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .add_systems(PreUpdate, hold_keys.after(InputSystems))
            .add_systems(FixedLast, report);
    }
}

fn hold_keys(mut keys: ResMut<ButtonInput<KeyCode>>, time: Res<Time<Fixed>>) {
    keys.press(KeyCode::KeyW);
    if (1.0..1.1).contains(&time.elapsed_secs()) {
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
    time: Res<Time<Fixed>>,
    mut exit: MessageWriter<AppExit>,
) {
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
    if *ticks < TICKS {
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
    exit.write(AppExit::Success);
}
