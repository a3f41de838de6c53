//! The list of keys.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};

use super::plate;

const KEYS: &[(&str, &str)] = &[
    ("W A S D", "walk"),
    ("Space", "jump; up when flying"),
    ("Shift", "sprint"),
    ("C, Ctrl", "crouch; down when flying"),
    ("F", "fly"),
    ("click, Esc", "mouse looks, mouse is free"),
    (
        "click, Shift+click",
        "while it looks: push what is in the middle, harder",
    ),
    ("wheel", "camera distance"),
    ("V", "first or third person"),
    (
        "1 .. 0",
        "station 1 to 10, +Shift 11 to 20, +Alt 21 to 30, both 31 to 40",
    ),
    ("PageUp, PageDown", "next station, last station"),
    ("E", "get into a vehicle, get out"),
    ("N, Shift+N", "next vehicle, last vehicle"),
    (
        "W S, A D, Space",
        "drive, brake and reverse, steer, hand brake",
    ),
    ("U, X", "put the vehicle upright, its helpers on and off"),
    ("T", "watch the station's own walker, driver or fall"),
    ("R, Shift+R", "back to the start, and reset the course"),
    ("P, O, L", "pause, single tick, slow motion"),
    ("G", "gizmos"),
    ("Tab", "tuning panel and plots"),
    ("F1, F2", "this help, the display"),
];

#[derive(Component)]
struct Help;

/// Shows the keys on `F1`.
pub(super) struct HelpPlugin;

impl Plugin for HelpPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, spawn)
            .add_systems(Update, toggle.run_if(input_just_pressed(KeyCode::F1)));
    }
}

fn spawn(mut commands: Commands) {
    let column = |part: fn(&(&'static str, &'static str)) -> &'static str| {
        KEYS.iter().map(part).collect::<Vec<_>>().join("\n")
    };
    let text = |text: String, color: Color| {
        (
            Text::new(text),
            TextFont::from_font_size(15.0),
            TextColor(color),
        )
    };
    commands.spawn((
        Help,
        plate(),
        Visibility::Hidden,
        Node {
            position_type: PositionType::Absolute,
            right: px(16.0),
            top: px(16.0),
            padding: UiRect::all(px(14.0)),
            column_gap: px(18.0),
            border_radius: BorderRadius::all(px(6.0)),
            ..default()
        },
        children![
            text(column(|key| key.0), Color::srgb(1.0, 0.85, 0.5)),
            text(column(|key| key.1), Color::WHITE),
        ],
    ));
}

fn toggle(mut helps: Query<&mut Visibility, With<Help>>) {
    for mut visibility in &mut helps {
        *visibility = match *visibility {
            Visibility::Hidden => Visibility::Inherited,
            _ => Visibility::Hidden,
        };
    }
}
