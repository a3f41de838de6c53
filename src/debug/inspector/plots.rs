//! Curves over the last seconds.

use bevy_egui::egui::{Color32, Rangef, Ui};
use egui_plot::{AxisHints, Corner, Legend, Line, Plot, PlotPoints};

use super::record::{Record, Sample};
use crate::{character::GroundState, debug::explain::Explain};

const STATES: [GroundState; 4] = [
    GroundState::InAir,
    GroundState::Unsupported,
    GroundState::Steep,
    GroundState::OnGround,
];

/// Draws curves with their names, against seconds before now; the scale reaches from 0 to `top` at least.
pub(super) fn curves(
    ui: &mut Ui,
    id: &'static str,
    seconds: f64,
    top: f64,
    lines: Vec<(impl Into<String>, Color32, Vec<[f64; 2]>)>,
) {
    base(id, seconds)
        .height(84.0)
        .custom_y_axes(vec![labels()])
        .include_y(0.0)
        .include_y(top)
        .legend(Legend::default().position(Corner::LeftTop))
        .show(ui, |plot| {
            for (name, color, points) in lines {
                plot.line(Line::new(name, PlotPoints::from(points)).color(color));
            }
        });
}

/// Draws speed and ground state against seconds before now.
pub(super) fn show(ui: &mut Ui, record: &Record<Sample>, seconds: f64) {
    if record.samples.is_empty() {
        ui.weak("nothing recorded yet");
        return;
    }
    let level = record.curve(|sample| sample.level.into());
    let rise = record.curve(|sample| sample.rise.into());
    let lines = vec![
        ("level m/s", Color32::from_rgb(250, 204, 21), level),
        ("rise m/s", Color32::from_rgb(56, 189, 248), rise),
    ];
    curves(ui, "speed", seconds, 6.0, lines);

    let states = steps(&record.curve(|sample| level_of(sample.ground)));
    base("ground", seconds)
        .height(80.0)
        .include_y(-0.3)
        .include_y(3.3)
        .custom_y_axes(vec![labels().formatter(|mark, _| {
            STATES
                .iter()
                .find(|state| (level_of(**state) - mark.value).abs() < 0.01)
                .map(Explain::text)
                .unwrap_or_default()
        })])
        .y_grid_spacer(|_| {
            STATES
                .map(|state| egui_plot::GridMark {
                    value: level_of(state),
                    step_size: 1.0,
                })
                .to_vec()
        })
        .show(ui, |plot| {
            plot.line(
                Line::new("ground", PlotPoints::from(states))
                    .color(Color32::from_rgb(74, 222, 128)),
            );
        });
}

pub(super) fn base(name: &'static str, seconds: f64) -> Plot<'static> {
    Plot::new(name)
        .include_x(-seconds)
        .include_x(0.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
}

/// A vertical axis whose labels do not fade where its lines are near each other.
pub(super) fn labels() -> AxisHints<'static> {
    AxisHints::new_y()
        .label_spacing(Rangef::new(8.0, 14.0))
        .min_thickness(70.0)
}

fn level_of(state: GroundState) -> f64 {
    match state {
        GroundState::InAir => 0.0,
        GroundState::Unsupported => 1.0,
        GroundState::Steep => 2.0,
        GroundState::OnGround => 3.0,
    }
}

/// A curve that holds each value until the next, without slopes between them.
pub(super) fn steps(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut held = Vec::with_capacity(points.len() * 2);
    let mut last: Option<f64> = None;
    for &[x, y] in points {
        if let Some(before) = last
            && before != y
        {
            held.push([x, before]);
        }
        held.push([x, y]);
        last = Some(y);
    }
    held
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_state_is_a_vertical_line() {
        let held = steps(&[[0.0, 3.0], [1.0, 3.0], [2.0, 0.0]]);
        assert_eq!(held, [[0.0, 3.0], [1.0, 3.0], [2.0, 3.0], [2.0, 0.0]]);
    }
}
