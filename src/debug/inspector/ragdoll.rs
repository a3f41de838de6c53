//! The window of the ragdolls.

use bevy::{ecs::query::QueryData, prelude::*};
use bevy_egui::{
    EguiContexts, EguiPrimaryContextPass,
    egui::{CollapsingHeader, Color32, Grid, Ui},
};

use super::{
    InspectorPanel,
    edits::TuningEdits,
    fields::Form,
    pick, plots,
    record::{Record, Timed},
    units::ragdoll_unit,
    window::{self, Subject},
};
use crate::ragdoll::{
    BoneControl, BoneOutput, Bones, Ragdoll, RagdollBalance, RagdollBone, RagdollIntent,
    RagdollState,
};

const YELLOW: Color32 = Color32::from_rgb(250, 204, 21);
const BLUE: Color32 = Color32::from_rgb(56, 189, 248);
const RED: Color32 = Color32::from_rgb(251, 113, 133);

/// What is plotted of one tick: the worst and the mean of all bones.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct FallSample {
    time: f64,
    /// Of the fastest bone, metres per second.
    speed: f32,
    /// Widest gap of a joint, metres.
    gap: f32,
    /// Farthest that a joint is beyond its limits, radians.
    violation: f32,
    /// Mean and largest angle between joints and the pose asked for, radians.
    error: [f32; 2],
}

impl Timed for FallSample {
    fn time(&self) -> f64 {
        self.time
    }
}

impl FallSample {
    fn of<'a>(time: f64, bones: impl Iterator<Item = &'a BoneOutput>) -> Self {
        let mut sample = Self { time, ..default() };
        let mut count = 0.0f32;
        for bone in bones {
            count += 1.0;
            sample.speed = sample.speed.max(bone.velocity.length());
            sample.gap = sample.gap.max(bone.gap);
            sample.violation = sample.violation.max(bone.violation);
            sample.error[0] += bone.error;
            sample.error[1] = sample.error[1].max(bone.error);
        }
        sample.error[0] /= count.max(1.0);
        sample
    }
}

/// What the panel shows of a ragdoll.
#[derive(QueryData)]
struct Shown {
    ragdoll: &'static Ragdoll,
    intent: &'static RagdollIntent,
    state: &'static RagdollState,
    bones: Option<&'static Bones>,
    balance: Option<&'static RagdollBalance>,
}

/// What the panel shows of a bone.
#[derive(QueryData)]
struct ShownBone {
    bone: &'static RagdollBone,
    output: &'static BoneOutput,
    control: &'static BoneControl,
}

pub(super) fn add(app: &mut App) {
    app.register_type::<Ragdoll>()
        .register_type::<RagdollBalance>()
        .register_type::<BoneControl>()
        .init_resource::<Record<FallSample>>()
        .add_systems(FixedLast, record)
        .add_systems(
            EguiPrimaryContextPass,
            show.run_if(|panel: Res<InspectorPanel>| panel.open)
                .run_if(any_with_component::<Ragdoll>),
        );
}

fn record(
    time: Res<Time<Fixed>>,
    panel: Res<InspectorPanel>,
    mut record: ResMut<Record<FallSample>>,
    ragdolls: Query<(Entity, Shown)>,
    bones: Query<&BoneOutput>,
) {
    let Some((entity, shown)) = pick(panel.ragdoll, ragdolls.iter()) else {
        return;
    };
    let tied = shown.bones.iter().flat_map(|bones| bones.iter());
    let outputs = tied.filter_map(|bone| bones.get(bone).ok());
    let sample = FallSample::of(time.elapsed_secs_f64(), outputs);
    record.add(entity, sample, panel.seconds);
}

fn show(
    mut contexts: EguiContexts,
    mut panel: ResMut<InspectorPanel>,
    mut edits: ResMut<TuningEdits>,
    registry: Res<AppTypeRegistry>,
    record: Res<Record<FallSample>>,
    ragdolls: Query<(Entity, Shown)>,
    bones: Query<ShownBone>,
    names: Query<&Name>,
) -> Result {
    window::show(
        contexts.ctx_mut()?,
        &mut panel,
        Subject::Ragdoll,
        ragdolls.iter(),
        &names,
        |ui, seconds, entity, shown| {
            plot(ui, &record, seconds);
            ui.label(format!(
                "{:?} asked, {:?} for {:.1} s, still for {:.1} s",
                shown.intent.mode, shown.state.mode, shown.state.age, shown.state.still
            ));
            CollapsingHeader::new("Bones")
                .default_open(true)
                .show(ui, |ui| table(ui, &shown, &bones, &names));
            let registry = registry.read();
            CollapsingHeader::new("Ragdoll")
                .default_open(true)
                .show(ui, |ui| {
                    Form::new(&registry, &mut edits, entity, ragdoll_unit)
                        .component(ui, shown.ragdoll);
                });
            if let Some(balance) = shown.balance {
                CollapsingHeader::new("Balance").show(ui, |ui| {
                    Form::new(&registry, &mut edits, entity, ragdoll_unit).component(ui, balance);
                });
            }
            for bone in shown.bones.iter().flat_map(|bones| bones.iter()) {
                let Ok(known) = bones.get(bone) else {
                    continue;
                };
                CollapsingHeader::new(window::name(&names, bone))
                    .id_salt(bone)
                    .show(ui, |ui| {
                        Form::new(&registry, &mut edits, bone, ragdoll_unit)
                            .component(ui, known.control);
                    });
            }
        },
    );
    Ok(())
}

fn plot(ui: &mut Ui, record: &Record<FallSample>, seconds: f64) {
    if record.samples.is_empty() {
        ui.weak("nothing recorded yet");
        return;
    }
    let speed = record.curve(|s| s.speed.into());
    let gap = record.curve(|s| f64::from(1e3 * s.gap));
    let degrees = |value: fn(&FallSample) -> f32| record.curve(|s| value(s).to_degrees().into());
    let fastest = vec![("fastest bone, m/s", BLUE, speed)];
    plots::curves(ui, "bones", seconds, 1.0, fastest);
    let widest = vec![("widest gap, mm", RED, gap)];
    plots::curves(ui, "gap", seconds, 1.0, widest);
    let angles = vec![
        ("beyond limits", RED, degrees(|s| s.violation)),
        ("mean error", BLUE, degrees(|s| s.error[0])),
        ("largest error", YELLOW, degrees(|s| s.error[1])),
    ];
    ui.label("angles, degrees");
    plots::curves(ui, "joints", seconds, 5.0, angles);
}

fn table(ui: &mut Ui, shown: &ShownItem, bones: &Query<ShownBone>, names: &Query<&Name>) {
    let Some(tied) = shown.bones else {
        ui.weak("it has no bones");
        return;
    };
    Grid::new("bones")
        .num_columns(6)
        .striped(true)
        .spacing([8.0, 2.0])
        .show(ui, |ui| {
            for title in ["", "is", "m/s", "gap mm", "beyond", "error"] {
                ui.strong(title);
            }
            ui.end_row();
            for entity in tied.iter() {
                let Ok(known) = bones.get(entity) else {
                    continue;
                };
                let output = known.output;
                let body = (shown.state.bones.get(known.bone.order)).map(|b| b.body);
                ui.label(window::name(names, entity));
                ui.label(match (output.asleep, body) {
                    (true, _) => "asleep".into(),
                    (false, Some(body)) => format!("{body:?}").to_lowercase(),
                    (false, None) => String::new(),
                });
                ui.label(format!("{:.2}", output.velocity.length()));
                ui.label(format!("{:.1}", 1e3 * output.gap));
                ui.label(format!("{:.1}°", output.violation.to_degrees()));
                ui.label(format!("{:.1}°", output.error.to_degrees()));
                ui.end_row();
            }
        });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_holds_the_worst_of_all_bones_and_their_mean_error() {
        let bone = |gap: f32, error: f32| BoneOutput {
            gap,
            error,
            ..default()
        };
        let bones = [bone(0.001, 0.1), bone(0.003, 0.3), bone(0.002, 0.2)];
        let sample = FallSample::of(1.0, bones.iter());
        assert_eq!(sample.gap, 0.003);
        assert_eq!(sample.error[1], 0.3);
        assert!((sample.error[0] - 0.2).abs() < 1.0e-6);
        assert_eq!(FallSample::of(0.0, [].iter()), FallSample::default());
    }
}
