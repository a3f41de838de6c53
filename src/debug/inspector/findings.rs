//! What the last tick found out, as text.

use bevy::{color::ColorToPacked, prelude::*};
use bevy_egui::egui::{Color32, Grid, RichText, Ui};

use crate::{
    character::{CharacterContacts, CharacterState, StepAttempt},
    debug::explain::Explain,
};

/// State, refusals, last step and contacts of a character.
pub(super) fn show(
    ui: &mut Ui,
    state: &CharacterState,
    contacts: &CharacterContacts,
    last_step: Option<(StepAttempt, f64)>,
    name: impl Fn(Entity) -> String,
) {
    Grid::new("findings")
        .num_columns(2)
        .spacing([8.0, 3.0])
        .show(ui, |ui| {
            ui.label("ground");
            let on = state.ground.entity.map(&name).unwrap_or_default();
            ui.label(colored(
                format!("{} {on}", state.ground.state.text()),
                state.ground.state.color(),
            ));
            ui.end_row();
            row(ui, "slope", format!("{:.1}°", slope(state).to_degrees()));
            row(
                ui,
                "speed",
                format!(
                    "{:.2} m/s own, {:.2} m/s platform",
                    state.velocity.length(),
                    state.platform_velocity.length()
                ),
            );
            row(ui, "mode", format!("{:?}, {:?}", state.mode, state.stance));
            row(ui, "height", format!("{:.2} m", state.height));
            row(ui, "air time", format!("{:.2} s", state.air_time));
            row(ui, "snapped", format!("{:.4} m", contacts.snapped));
            row(ui, "queries", contacts.queries.to_string());
            ui.label("last step");
            match last_step {
                Some((attempt, age)) => ui.label(colored(
                    format!("{}, {age:.1} s ago", attempt.result.text()),
                    attempt.result.color(),
                )),
                None => ui.weak("none tried"),
            };
            ui.end_row();
            ui.label("stance");
            match &contacts.stance_refused {
                Some(refusal) => ui.label(colored(refusal.text(), refusal.color())),
                None => ui.weak("not refused"),
            };
            ui.end_row();
            if state.crushed {
                ui.label("");
                ui.label(colored("crushed".into(), Color::srgb(0.94, 0.27, 0.27)));
                ui.end_row();
            }
        });
    ui.separator();
    Grid::new("contacts")
        .num_columns(4)
        .striped(true)
        .spacing([8.0, 2.0])
        .show(ui, |ui| {
            for title in ["touches", "depth mm", "slope", "impulse N·s"] {
                ui.strong(title);
            }
            ui.end_row();
            for contact in &contacts.contacts {
                let text = RichText::new(name(contact.entity));
                ui.label(if contact.blocked { text.strong() } else { text });
                ui.label(format!("{:.1}", -contact.distance * 1000.0));
                ui.label(format!(
                    "{:.0}°",
                    contact.normal.angle_between(state.up).to_degrees()
                ));
                ui.label(format!("{:.1}", contact.impulse.length()));
                ui.end_row();
            }
        });
}

fn row(ui: &mut Ui, name: &str, value: String) {
    ui.label(name);
    ui.label(value);
    ui.end_row();
}

/// Angle of the ground from level, radians.
fn slope(state: &CharacterState) -> f32 {
    state.ground.normal.angle_between(state.up)
}

fn colored(text: String, color: Color) -> RichText {
    let [red, green, blue] = color.to_srgba().to_u8_array_no_alpha();
    RichText::new(text).color(Color32::from_rgb(red, green, blue))
}
