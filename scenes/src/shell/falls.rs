//! How ragdolls fell in a run without a window, and whether they did what they should.

use bevy::prelude::*;
use bevy_embody::prelude::*;

/// The highest joint of who lies is below this, metres; that of who stands above the other.
const LIES: f32 = 0.7;
const STANDS: f32 = 1.4;
/// How fast somebody may be, metres per second: what the script does makes nobody faster.
const FASTEST: f32 = 25.0;
/// A joint may part by this for a tick under a blow that alone makes a bone as fast as 20 m/s, metres.
const WIDEST: f32 = 0.2;

/// What has happened so far.
#[derive(Resource, Default)]
pub(super) struct Falls {
    ticks: u32,
    told: Option<RagdollMode>,
    /// Heights of the lowest and the highest joint in the last tick, metres.
    heights: (f32, f32),
    /// Ticks in which somebody lay, limp.
    lay: u32,
    /// How often somebody began to get up.
    rose: u32,
    /// Ticks in which a bone was nowhere, too fast, or off its joint.
    unsound: u32,
    /// Widest gap of a joint, metres.
    widest: f32,
}

impl Falls {
    /// Says what was asked and what came of it; whether all of it did.
    #[expect(
        clippy::print_stdout,
        reason = "the report is what a headless run is for"
    )]
    pub fn tell(&self) -> bool {
        let (low, high) = self.heights;
        let asked = [
            (
                "it lies limp",
                self.lay > 0,
                format!("in {} ticks", self.lay),
            ),
            ("it gets up", self.rose > 0, format!("{} times", self.rose)),
            (
                "it stands in the end",
                high > STANDS && low.abs() < 0.3,
                format!("joints from {low:.2} m to {high:.2} m"),
            ),
            (
                "no bone is nowhere, too fast, or off its joint",
                self.unsound == 0,
                format!(
                    "in {} ticks, at most {:.0} mm off",
                    self.unsound,
                    1e3 * self.widest
                ),
            ),
        ];
        for (what, so, got) in &asked {
            println!("{}: {what}: {got}", if *so { "pass" } else { "FAIL" });
        }
        asked.iter().all(|(_, so, _)| *so)
    }
}

/// Looks at every figure after a tick, and tells of each change of its mode.
#[expect(
    clippy::print_stdout,
    reason = "the report is what a headless run is for"
)]
pub(super) fn report(
    mut falls: ResMut<Falls>,
    time: Res<Time<Fixed>>,
    ragdolls: Query<(&RagdollState, &Bones), With<Ragdoll>>,
    outputs: Query<&BoneOutput>,
) {
    falls.ticks += 1;
    for (state, bones) in &ragdolls {
        let places = state.bones.iter().map(|bone| bone.place.position);
        let mut sound = state
            .bones
            .iter()
            .all(|bone| bone.place.position.is_finite() && bone.place.rotation.is_finite());
        let (low, high) = places.fold((f32::MAX, f32::MIN), |(a, b), p| (a.min(p.y), b.max(p.y)));
        let mut fastest = 0.0f32;
        for output in outputs.iter_many(bones.iter()) {
            let speed = output.velocity.length();
            let gap = if output.simulated { output.gap } else { 0.0 };
            // What is no number is within no bound.
            sound &= speed < FASTEST && gap < WIDEST;
            falls.widest = falls.widest.max(gap);
            fastest = fastest.max(speed);
        }
        falls.unsound += u32::from(!sound);
        falls.heights = (low, high);
        falls.lay += u32::from(state.mode == RagdollMode::Limp && high < LIES);
        if falls.told == Some(state.mode) {
            continue;
        }
        falls.told = Some(state.mode);
        falls.rose += u32::from(state.mode == RagdollMode::GettingUp);
        println!(
            "after {:.1} s it is {:?}: {} joints from {low:.2} m to {high:.2} m above the ground, none faster than {fastest:.2} m/s",
            falls.ticks as f32 * time.timestep().as_secs_f32(),
            state.mode,
            state.bones.len(),
        );
    }
}
