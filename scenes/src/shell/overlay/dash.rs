//! Instruments of the vehicle that the player drives: speed, gear, engine speed, wheel loads.

use bevy::{diagnostic::DiagnosticsStore, prelude::*};
use bevy_embody::{VehicleDiagnostics, prelude::*};

use super::hud::{HudPart, clocks};
use crate::shell::Player;

/// Most wheels that have a bar.
const BARS: usize = 10;
/// Height of a wheel's bar and length of the engine's, logical pixels.
const TALL: f32 = 44.0;
const LONG: f32 = 214.0;

/// A part of the instruments that changes.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
enum Gauge {
    /// All of them.
    All,
    /// Engine speed.
    Engine,
    /// Frame of a wheel's load.
    Frame(usize),
    /// Load of a wheel.
    Load(usize),
}

pub(super) struct DashPlugin;

impl Plugin for DashPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Update, (write, fill));
    }
}

/// The bars below the texts of the display.
pub(super) fn gauges() -> impl Bundle {
    let track = Color::srgba(1.0, 1.0, 1.0, 0.14);
    let wheel = move |i: usize| {
        (
            Gauge::Frame(i),
            BackgroundColor(track),
            Node {
                width: px(13.0),
                height: px(TALL),
                // A gap behind each axle.
                margin: UiRect::right(px(if i % 2 == 1 { 9.0 } else { 3.0 })),
                flex_direction: FlexDirection::ColumnReverse,
                ..default()
            },
            children![(
                Gauge::Load(i),
                BackgroundColor(Color::WHITE),
                Node {
                    width: percent(100.0),
                    height: px(0.0),
                    ..default()
                },
            )],
        )
    };
    (
        Gauge::All,
        Node {
            display: Display::None,
            flex_direction: FlexDirection::Column,
            row_gap: px(6.0),
            margin: UiRect::top(px(4.0)),
            ..default()
        },
        children![
            (
                BackgroundColor(track),
                Node {
                    width: px(LONG),
                    height: px(9.0),
                    ..default()
                },
                children![(
                    Gauge::Engine,
                    BackgroundColor(Color::WHITE),
                    Node {
                        width: px(0.0),
                        height: percent(100.0),
                        ..default()
                    },
                )],
            ),
            (
                Node::default(),
                children![
                    wheel(0),
                    wheel(1),
                    wheel(2),
                    wheel(3),
                    wheel(4),
                    wheel(5),
                    wheel(6),
                    wheel(7),
                    wheel(8),
                    wheel(9),
                ],
            ),
        ],
    )
}

type Driven = (
    &'static Vehicle,
    &'static VehicleTelemetry,
    &'static VehicleState,
    &'static Wheels,
);

fn write(
    players: Query<Driven, With<Player>>,
    diagnostics: Res<DiagnosticsStore>,
    fixed: Res<Time<Fixed>>,
    clock: Res<Time<Virtual>>,
    mut texts: Query<(&HudPart, &mut Text, &mut TextColor)>,
) {
    let Ok((_, telemetry, state, _)) = players.single() else {
        return;
    };
    let gear = match telemetry.gear {
        0 => "N".to_owned(),
        gear if gear < 0 => "R".to_owned(),
        gear => gear.to_string(),
    };
    let side = telemetry.acceleration / 9.81;
    for (part, mut text, mut color) in &mut texts {
        let (line, shade) = match part {
            HudPart::Ground => (
                format!("{:.0} km/h   gear {gear}", 3.6 * telemetry.speed.abs()),
                Color::WHITE,
            ),
            HudPart::State => (
                format!(
                    "{:.0} rpm, {:.0} N m\n{:+.2} g ahead, {:+.2} g to the right\n{}",
                    telemetry.rpm,
                    telemetry.engine_torque,
                    -side.z,
                    side.x,
                    clocks(&diagnostics, &fixed, &clock, &VehicleDiagnostics::TICK_TIME),
                ),
                color.0,
            ),
            HudPart::Step => {
                let signs = [
                    (telemetry.grounded == 0, "in the air"),
                    (state.stalled, "stalled"),
                    (telemetry.traction_control, "traction control"),
                    (telemetry.stability_control, "stability control"),
                    (state.hill_hold > 0.0, "hill hold"),
                    (telemetry.asleep, "asleep"),
                ];
                let lit: Vec<&str> = signs.iter().filter(|s| s.0).map(|s| s.1).collect();
                (lit.join(", "), Color::srgb(1.0, 0.8, 0.35))
            }
            HudPart::Title | HudPart::Detail => continue,
        };
        if text.0 != line {
            text.0 = line;
        }
        color.set_if_neq(TextColor(shade));
    }
}

/// Engine speed at which the bar is full.
fn redline(vehicle: &Vehicle) -> f32 {
    match vehicle.drivetrain.as_ref().map(|drive| &drive.source) {
        Some(PowerSource::Engine(engine)) => engine.redline,
        Some(PowerSource::Motor(motor)) => motor.redline,
        _ => 1.0,
    }
}

fn fill(
    players: Query<Driven, With<Player>>,
    wheels: Query<&WheelState>,
    mut gauges: Query<(&Gauge, &mut Node, Option<&mut BackgroundColor>)>,
) {
    let driven = players.single().ok();
    for (gauge, mut node, color) in &mut gauges {
        let show = |on: bool| if on { Display::Flex } else { Display::None };
        let Some((vehicle, telemetry, _, tied)) = driven else {
            if *gauge == Gauge::All && node.display != Display::None {
                node.display = Display::None;
            }
            continue;
        };
        match *gauge {
            Gauge::All => node.display = Display::Flex,
            Gauge::Engine => {
                let part = (telemetry.rpm / redline(vehicle)).clamp(0.0, 1.0);
                node.width = px(LONG * part);
                if let Some(mut color) = color {
                    color.0 = if part > 0.92 {
                        Color::srgb(0.95, 0.35, 0.3)
                    } else {
                        Color::srgb(0.55, 0.8, 0.95)
                    };
                }
            }
            Gauge::Frame(i) => node.display = show(i < tied.iter().count().min(BARS)),
            Gauge::Load(i) => {
                let Some(state) = tied.iter().nth(i).and_then(|wheel| wheels.get(wheel).ok())
                else {
                    continue;
                };
                // A wheel that carries its share of the weight fills half of its bar.
                let count = tied.iter().count() as f32;
                let share = (telemetry.load / count).max(1.0);
                node.height = px(TALL * (0.5 * state.load / share).clamp(0.0, 1.0));
                let used = (state.force / state.limit.max(Vec2::splat(1.0))).length();
                if let Some(mut color) = color {
                    color.0 = if used > 0.98 {
                        Color::srgb(0.95, 0.4, 0.3)
                    } else if used > 0.8 {
                        Color::srgb(0.95, 0.75, 0.3)
                    } else {
                        Color::srgb(0.45, 0.85, 0.5)
                    };
                }
            }
        }
    }
}
