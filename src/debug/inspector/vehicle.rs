//! The window of the vehicles.

use arrayvec::ArrayVec;
use bevy::{ecs::query::QueryData, math::ops, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{CollapsingHeader, Color32, Grid, Ui},
};
use egui_plot::{Line, Plot, PlotPoints, Points};

use super::{
    InspectorPanel,
    edits::TuningEdits,
    fields::Form,
    pick, plots,
    record::{Record, Timed},
    units::vehicle_unit,
    window::{self, Subject},
};
use crate::vehicle::{Vehicle, VehicleState, VehicleTelemetry, Wheel, WheelState, Wheels};

/// Gravity that the g-g diagram is scaled by, metres per second squared.
const GRAVITY: f32 = 9.81;

/// What is plotted of one tick.
#[derive(Clone, Debug)]
struct DriveSample {
    time: f64,
    speed: f32,
    rpm: f32,
    gear: i8,
    /// To the right and ahead, in g.
    pull: Vec2,
    /// Load (newtons), slip ratio and slip angle (radians) of each wheel.
    wheels: ArrayVec<[f32; 3], { Wheel::MOST }>,
}

impl Timed for DriveSample {
    fn time(&self) -> f64 {
        self.time
    }
}

/// What the panel shows of a vehicle.
#[derive(QueryData)]
struct Shown {
    vehicle: &'static Vehicle,
    telemetry: &'static VehicleTelemetry,
    state: &'static VehicleState,
    wheels: &'static Wheels,
}

pub(super) fn add(app: &mut App) {
    app.register_type::<Vehicle>()
        .register_type::<Wheel>()
        .init_resource::<Record<DriveSample>>()
        .add_systems(FixedLast, record)
        .add_systems(
            EguiPrimaryContextPass,
            show.run_if(|panel: Res<InspectorPanel>| panel.open)
                .run_if(any_with_component::<Vehicle>),
        );
}

fn record(
    time: Res<Time<Fixed>>,
    panel: Res<InspectorPanel>,
    mut record: ResMut<Record<DriveSample>>,
    vehicles: Query<(Entity, Shown)>,
    states: Query<&WheelState>,
) {
    let Some((entity, shown)) = pick(panel.vehicle, vehicles.iter()) else {
        return;
    };
    let pull = shown.telemetry.acceleration / GRAVITY;
    let wheels = shown
        .wheels
        .iter()
        .filter_map(|wheel| states.get(wheel).ok())
        .map(|state| [state.load, state.slip_ratio, state.slip_angle])
        .take(Wheel::MOST)
        .collect();
    record.add(
        entity,
        DriveSample {
            time: time.elapsed_secs_f64(),
            speed: shown.telemetry.speed,
            rpm: shown.telemetry.rpm,
            gear: shown.telemetry.gear,
            pull: Vec2::new(pull.x, -pull.z),
            wheels,
        },
        panel.seconds,
    );
}

fn show(
    mut contexts: EguiContexts,
    mut panel: ResMut<InspectorPanel>,
    mut edits: ResMut<TuningEdits>,
    registry: Res<AppTypeRegistry>,
    record: Res<Record<DriveSample>>,
    vehicles: Query<(Entity, Shown)>,
    wheels: Query<(&Wheel, &WheelState)>,
    names: Query<&Name>,
) -> Result {
    window::show(
        contexts.ctx_mut()?,
        &mut panel,
        Subject::Vehicle,
        vehicles.iter(),
        &names,
        |ui, seconds, entity, shown| {
            plot(ui, &record, seconds);
            CollapsingHeader::new("Wheels")
                .default_open(true)
                .show(ui, |ui| table(ui, &shown, &wheels));
            let registry = registry.read();
            CollapsingHeader::new("Vehicle")
                .default_open(true)
                .show(ui, |ui| {
                    Form::new(&registry, &mut edits, entity, vehicle_unit)
                        .component(ui, shown.vehicle);
                });
            for (i, wheel) in shown.wheels.iter().enumerate() {
                let Ok((config, _)) = wheels.get(wheel) else {
                    continue;
                };
                CollapsingHeader::new(format!("Wheel {}", i + 1)).show(ui, |ui| {
                    Form::new(&registry, &mut edits, wheel, vehicle_unit).component(ui, config);
                });
            }
        },
    );
    Ok(())
}

/// Colour of a wheel's curve.
fn color(wheel: usize) -> Color32 {
    let [r, g, b] = [
        [250, 204, 21],
        [56, 189, 248],
        [251, 113, 133],
        [74, 222, 128],
        [192, 132, 252],
        [251, 146, 60],
    ][wheel % 6];
    Color32::from_rgb(r, g, b)
}

fn plot(ui: &mut Ui, record: &Record<DriveSample>, seconds: f64) {
    let Some(last) = record.samples.back() else {
        ui.weak("nothing recorded yet");
        return;
    };
    plots::curves(
        ui,
        "engine",
        seconds,
        60.0,
        vec![
            ("km/h", color(0), record.curve(|s| f64::from(3.6 * s.speed))),
            (
                "100 rpm",
                color(1),
                record.curve(|s| f64::from(0.01 * s.rpm)),
            ),
        ],
    );
    plots::curves(
        ui,
        "gear",
        seconds,
        3.0,
        vec![(
            "gear",
            color(3),
            plots::steps(&record.curve(|s| f64::from(s.gear))),
        )],
    );
    let of_wheels = |value: fn(&[f32; 3]) -> f32| {
        (0..last.wheels.len())
            .map(|i| {
                let points = record.curve(|s| s.wheels.get(i).map_or(0.0, value).into());
                (format!("{}", i + 1), color(i), points)
            })
            .collect::<Vec<_>>()
    };
    ui.label("wheel loads, kN");
    plots::curves(ui, "loads", seconds, 1.0, of_wheels(|w| 1e-3 * w[0]));
    ui.label("slip ratios");
    plots::curves(
        ui,
        "ratios",
        seconds,
        0.1,
        of_wheels(|w| w[1].clamp(-1.0, 1.0)),
    );
    ui.label("slip angles, degrees");
    plots::curves(
        ui,
        "angles",
        seconds,
        5.0,
        of_wheels(|w| w[2].to_degrees().clamp(-45.0, 45.0)),
    );
    ui.label("g-g diagram: right and ahead, g");
    let trail: Vec<[f64; 2]> = record
        .samples
        .iter()
        .map(|s| [f64::from(s.pull.x), f64::from(s.pull.y)])
        .collect();
    let now = vec![[f64::from(last.pull.x), f64::from(last.pull.y)]];
    Plot::new("g-g")
        .height(170.0)
        .data_aspect(1.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .include_x(-1.2)
        .include_x(1.2)
        .include_y(-1.2)
        .include_y(1.2)
        .show(ui, |plot| {
            let circle: Vec<[f64; 2]> = (0..=48u8)
                .map(|i| {
                    let (sin, cos) = ops::sin_cos(core::f32::consts::TAU * f32::from(i) / 48.0);
                    [f64::from(cos), f64::from(sin)]
                })
                .collect();
            plot.line(Line::new("1 g", PlotPoints::from(circle)).color(Color32::GRAY));
            plot.points(
                Points::new("trail", PlotPoints::from(trail))
                    .radius(1.5)
                    .color(color(1)),
            );
            plot.points(
                Points::new("now", PlotPoints::from(now))
                    .radius(4.0)
                    .color(color(0)),
            );
        });
}

fn table(ui: &mut Ui, shown: &ShownItem, wheels: &Query<(&Wheel, &WheelState)>) {
    let telemetry = shown.telemetry;
    ui.label(format!(
        "{:.1} m/s, {} wheels on the ground, {:.0} N, {} sweeps{}",
        telemetry.speed,
        telemetry.grounded,
        telemetry.load,
        telemetry.sweeps,
        if shown.state.stalled { ", stalled" } else { "" }
    ));
    Grid::new("wheels")
        .num_columns(6)
        .striped(true)
        .spacing([8.0, 2.0])
        .show(ui, |ui| {
            for title in ["", "load N", "travel mm", "ratio", "angle", "used"] {
                ui.strong(title);
            }
            ui.end_row();
            for (i, wheel) in shown.wheels.iter().enumerate() {
                let Ok((_, state)) = wheels.get(wheel) else {
                    continue;
                };
                let used = (state.force / state.limit.max(Vec2::splat(1.0))).length();
                ui.colored_label(color(i), format!("{}", i + 1));
                ui.label(format!("{:.0}", state.load));
                ui.label(format!("{:.0}", 1e3 * state.compression));
                ui.label(format!("{:+.2}", state.slip_ratio));
                ui.label(format!("{:+.1}°", state.slip_angle.to_degrees()));
                ui.label(format!("{:.0} %", 100.0 * used));
                ui.end_row();
            }
        });
}
