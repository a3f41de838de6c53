//! What the player's character does, and which station it is at.

use bevy::{
    diagnostic::{DiagnosticPath, DiagnosticsStore, FrameTimeDiagnosticsPlugin},
    input::common_conditions::input_just_pressed,
    prelude::*,
};
use bevy_embody::{
    CharacterDiagnostics,
    debug::{Explain, StepTrail},
    prelude::*,
};

use super::plate;
use crate::shell::Player;

/// What is written at the bottom.
#[derive(Resource, Clone, Debug, Default)]
pub struct Hud {
    /// The name of the place.
    pub title: String,
    /// More about it.
    pub detail: String,
}

/// A text of the display.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub enum HudPart {
    /// What the character does.
    State,
    /// How the ground holds it, in its colour.
    Ground,
    /// The last attempt to climb a step, in its colour.
    Step,
    /// Title of the place.
    Title,
    /// More about the place.
    Detail,
}

/// A plate of the display.
#[derive(Component, Clone, Copy, Debug)]
pub struct Plate;

/// Writes the display; `F2` hides it.
pub(super) struct HudPlugin;

impl Plugin for HudPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Hud>()
            .add_systems(Startup, spawn)
            .add_systems(
                Update,
                (
                    write_state,
                    write_place.run_if(resource_changed::<Hud>),
                    toggle.run_if(input_just_pressed(KeyCode::F2)),
                ),
            );
    }
}

fn text(part: HudPart, size: f32, color: Color) -> impl Bundle {
    (
        part,
        Text::default(),
        TextFont::from_font_size(size),
        TextColor(color),
    )
}

fn spawn(mut commands: Commands) {
    let dim = Color::srgb(0.86, 0.9, 0.94);
    commands.spawn((
        Plate,
        plate(),
        Node {
            position_type: PositionType::Absolute,
            left: px(16.0),
            bottom: px(16.0),
            padding: UiRect::all(px(10.0)),
            flex_direction: FlexDirection::Column,
            row_gap: px(2.0),
            min_width: px(230.0),
            border_radius: BorderRadius::all(px(6.0)),
            ..default()
        },
        children![
            text(HudPart::Ground, 17.0, Color::WHITE),
            text(HudPart::State, 13.0, dim),
            text(HudPart::Step, 13.0, dim),
            super::dash::gauges(),
        ],
    ));
    commands.spawn((
        Plate,
        plate(),
        Node {
            position_type: PositionType::Absolute,
            right: px(16.0),
            bottom: px(16.0),
            max_width: px(620.0),
            padding: UiRect::all(px(10.0)),
            flex_direction: FlexDirection::Column,
            row_gap: px(2.0),
            border_radius: BorderRadius::all(px(6.0)),
            ..default()
        },
        children![
            text(HudPart::Title, 17.0, Color::WHITE),
            text(HudPart::Detail, 13.0, dim),
            (
                Text::new("F1 keys   T watch   PageUp/PageDown next station"),
                TextFont::from_font_size(11.0),
                TextColor(Color::srgba(1.0, 1.0, 1.0, 0.5)),
            ),
        ],
    ));
}

fn write_state(
    players: Query<(&CharacterState, &CharacterContacts, Option<&StepTrail>), With<Player>>,
    diagnostics: Res<DiagnosticsStore>,
    fixed: Res<Time<Fixed>>,
    clock: Res<Time<Virtual>>,
    mut texts: Query<(&HudPart, &mut Text, &mut TextColor)>,
) {
    let Ok((state, contacts, trail)) = players.single() else {
        return;
    };
    let rise = state.world_velocity().dot(state.up);
    let level = (state.velocity - state.up * state.velocity.dot(state.up)).length();
    let slope = state.ground.normal.angle_between(state.up).to_degrees();
    for (part, mut text, mut color) in &mut texts {
        let (line, shade) = match part {
            HudPart::Ground => (
                format!("{level:.2} m/s  {}", state.ground.state.text()),
                state.ground.state.color(),
            ),
            HudPart::State => (
                format!(
                    "{:?}, {:.2} m tall, slope {slope:.0} deg, rise {rise:+.2} m/s\n{} contacts, {} queries\n{}",
                    state.mode,
                    state.height,
                    contacts.contacts.len(),
                    contacts.queries,
                    clocks(
                        &diagnostics,
                        &fixed,
                        &clock,
                        &CharacterDiagnostics::TICK_TIME
                    ),
                ),
                color.0,
            ),
            HudPart::Step => match trail.and_then(StepTrail::last) {
                Some(step) => (
                    format!("step: {}", step.attempt.result.text()),
                    step.attempt.result.color(),
                ),
                None => (String::new(), color.0),
            },
            HudPart::Title | HudPart::Detail => continue,
        };
        if text.0 != line {
            text.0 = line;
        }
        color.set_if_neq(TextColor(shade));
    }
}

/// Frame rate, tick rate, cost of a tick, and what the clock does if it is not running freely.
pub(super) fn clocks(
    diagnostics: &DiagnosticsStore,
    fixed: &Time<Fixed>,
    clock: &Time<Virtual>,
    tick: &DiagnosticPath,
) -> String {
    let smooth = |path| {
        diagnostics
            .get(path)
            .and_then(bevy::diagnostic::Diagnostic::smoothed)
            .unwrap_or(0.0)
    };
    let mut line = format!(
        "{:.1} fps, {:.0} Hz, {:.3} ms per tick",
        smooth(&FrameTimeDiagnosticsPlugin::FPS),
        1.0 / fixed.timestep().as_secs_f64(),
        smooth(tick),
    );
    if clock.is_paused() {
        line.push_str("\nPAUSED");
    } else if clock.relative_speed() != 1.0 {
        line.push_str(&format!("\nat {:.1} of full speed", clock.relative_speed()));
    }
    line
}

fn write_place(hud: Res<Hud>, mut texts: Query<(&HudPart, &mut Text)>) {
    for (part, mut text) in &mut texts {
        match part {
            HudPart::Title => text.0.clone_from(&hud.title),
            HudPart::Detail => text.0.clone_from(&hud.detail),
            _ => {}
        }
    }
}

fn toggle(mut plates: Query<&mut Visibility, With<Plate>>) {
    for mut visibility in &mut plates {
        *visibility = match *visibility {
            Visibility::Hidden => Visibility::Inherited,
            _ => Visibility::Hidden,
        };
    }
}
