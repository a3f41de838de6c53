//! Pause, single step and slow motion, through Bevy's virtual clock.

use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use bevy_egui::input::egui_wants_any_keyboard_input;

/// Speed of slow motion, as a part of real time.
const SLOW: f32 = 0.2;

/// `P` pauses, `O` runs one tick, `L` toggles slow motion.
pub(super) struct ClockPlugin;

impl Plugin for ClockPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            RunFixedMainLoop,
            (
                pause.run_if(input_just_pressed(KeyCode::KeyP)),
                single_step.run_if(input_just_pressed(KeyCode::KeyO)),
                slow_motion.run_if(input_just_pressed(KeyCode::KeyL)),
            )
                .chain()
                .run_if(not(egui_wants_any_keyboard_input))
                .in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
        );
    }
}

fn pause(mut time: ResMut<Time<Virtual>>) {
    if time.is_paused() {
        time.unpause();
    } else {
        time.pause();
    }
}

/// Hands the fixed clock exactly the time of one tick while the virtual clock stands.
fn single_step(mut time: ResMut<Time<Virtual>>, mut fixed: ResMut<Time<Fixed>>) {
    if time.is_paused() {
        let tick = fixed.timestep();
        fixed.accumulate_overstep(tick);
    } else {
        time.pause();
    }
}

fn slow_motion(mut time: ResMut<Time<Virtual>>) {
    let speed = if time.relative_speed() < 1.0 {
        1.0
    } else {
        SLOW
    };
    time.set_relative_speed(speed);
}
