//! What the actions of all frames since the last tick add up to, and how a tick reads it.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_enhanced_input::prelude::*;

use super::{
    actions::{Brake, Crouch, Fly, Jump, Look, Move, Sprint, Throttle, Zoom},
    button::Button,
    drive::{HeldWheel, write_drive},
};
use crate::shell::{
    Player,
    camera::{CameraMode, CameraRig},
    visit::Playing,
};

/// What the player asks for. Frames add to it, ticks take from it, so nothing is lost however the
/// two fall.
#[derive(Component, Clone, Debug, Default)]
pub struct Controls {
    pub(super) movement: Vec2,
    pub(super) throttle: f32,
    pub(super) brake: f32,
    pub(super) held: HeldWheel,
    look: Vec2,
    zoom: f32,
    pub(super) jump: Button,
    sprint: bool,
    crouch: bool,
    fly: bool,
}

impl Controls {
    /// Turn (radians, right and up) and zoom (notches) since this was last asked.
    pub fn take_look(&mut self) -> (Vec2, f32) {
        (
            core::mem::take(&mut self.look),
            core::mem::take(&mut self.zoom),
        )
    }
}

pub(super) fn plugin(app: &mut App) {
    axis::<Move>(app, |controls, value| controls.movement = value);
    pedal::<Throttle>(app, |controls, value| controls.throttle = value);
    pedal::<Brake>(app, |controls, value| controls.brake = value);
    axis::<Look>(app, |controls, value| controls.look += value);
    axis::<Zoom>(app, |controls, value| controls.zoom += value.y);
    button::<Jump>(app, |controls, down| {
        if down {
            controls.jump.press();
        } else {
            controls.jump.release();
        }
    });
    button::<Sprint>(app, |controls, down| controls.sprint = down);
    button::<Crouch>(app, |controls, down| controls.crouch = down);
    button::<Fly>(app, |controls, down| controls.fly ^= down);
    app.add_systems(
        FixedPreUpdate,
        (write_intent, write_drive).run_if(not(Playing::takes_player)),
    );
}

fn axis<A: InputAction<Output = Vec2>>(app: &mut App, set: fn(&mut Controls, Vec2)) {
    hand_on::<A, Vec2>(app, set);
}

fn pedal<A: InputAction<Output = f32>>(app: &mut App, set: fn(&mut Controls, f32)) {
    hand_on::<A, f32>(app, set);
}

/// Hands the value of an action on, each frame while it acts and once more, at rest, when it ends.
fn hand_on<A: InputAction<Output = T>, T: ActionOutput + Default + 'static>(
    app: &mut App,
    set: fn(&mut Controls, T),
) {
    app.add_observer(move |event: On<Fire<A>>, mut all: Query<&mut Controls>| {
        if let Ok(mut controls) = all.get_mut(event.context) {
            set(&mut controls, event.value);
        }
    })
    .add_observer(
        move |event: On<Complete<A>>, mut all: Query<&mut Controls>| {
            if let Ok(mut controls) = all.get_mut(event.context) {
                set(&mut controls, T::default());
            }
        },
    );
}

/// Hands on when a button goes down and when it comes up.
fn button<A: InputAction<Output = bool>>(app: &mut App, set: fn(&mut Controls, bool)) {
    app.add_observer(move |event: On<Start<A>>, mut all: Query<&mut Controls>| {
        if let Ok(mut controls) = all.get_mut(event.context) {
            set(&mut controls, true);
        }
    })
    .add_observer(
        move |event: On<Complete<A>>, mut all: Query<&mut Controls>| {
            if let Ok(mut controls) = all.get_mut(event.context) {
                set(&mut controls, false);
            }
        },
    );
}

/// Turns what was asked into the intent of the tick that begins.
fn write_intent(
    rigs: Query<&CameraRig>,
    mut players: Query<(&mut Controls, &mut CharacterIntent, &mut CharacterState), With<Player>>,
) {
    let Ok(rig) = rigs.single() else {
        return;
    };
    for (mut controls, mut intent, mut state) in &mut players {
        if core::mem::take(&mut controls.fly) {
            state.mode = match state.mode {
                MovementMode::Fly => MovementMode::Walk,
                _ => MovementMode::Fly,
            };
        }
        let jump = controls.jump.next_tick();
        *intent = CharacterIntent {
            movement: movement(rig, state.mode, &controls, jump),
            jump: jump && state.mode != MovementMode::Fly,
            sprint: controls.sprint,
            stance: if controls.crouch && matches!(state.mode, MovementMode::Walk) {
                Stance::Crouch
            } else {
                Stance::Stand
            },
            facing: (rig.mode == CameraMode::FirstPerson).then(|| rig.heading() * Vec3::NEG_Z),
        };
    }
}

/// The direction asked for, in world axes.
fn movement(rig: &CameraRig, mode: MovementMode, controls: &Controls, jump: bool) -> Vec3 {
    let asked = Vec3::new(controls.movement.x, 0.0, -controls.movement.y);
    let rise = f32::from(jump) - f32::from(controls.crouch);
    let up = rig.base * Vec3::Y;
    let movement = match mode {
        MovementMode::Fly | MovementMode::Swim => rig.rotation() * asked + up * rise,
        // Forward climbs, unless the player looks well down.
        MovementMode::Climb => {
            let sign = if rig.pitch < -0.7 { -1.0 } else { 1.0 };
            rig.heading() * asked + up * (controls.movement.y * sign)
        }
        _ => rig.heading() * asked,
    };
    movement.clamp_length_max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(x: f32, y: f32) -> Controls {
        Controls {
            movement: Vec2::new(x, y),
            ..default()
        }
    }

    #[test]
    fn forward_is_where_the_camera_looks_made_level() {
        let rig = CameraRig {
            yaw: core::f32::consts::FRAC_PI_2,
            pitch: -1.0,
            ..default()
        };
        let walk = movement(&rig, MovementMode::Walk, &asked(0.0, 1.0), false);
        assert!(walk.distance(Vec3::NEG_X) < 1e-5, "{walk}");
        let fly = movement(&rig, MovementMode::Fly, &asked(0.0, 1.0), false);
        assert!(fly.y < -0.8 && (fly.length() - 1.0).abs() < 1e-5, "{fly}");
    }

    #[test]
    fn nothing_asks_for_more_than_full_speed() {
        let mut controls = asked(1.0, 1.0);
        controls.crouch = true;
        for mode in [MovementMode::Walk, MovementMode::Swim, MovementMode::Climb] {
            let asked = movement(&CameraRig::default(), mode, &controls, false);
            assert!(asked.length() <= 1.0 + 1e-6);
        }
    }
}
