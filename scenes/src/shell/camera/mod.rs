//! Third-person and first-person camera around the player, on foot and in a vehicle.

mod arm;
mod chase;
mod ease;

use bevy::{input::common_conditions::input_just_pressed, math::ops, prelude::*};
use bevy_egui::input::egui_wants_any_keyboard_input;
use bevy_embody::prelude::*;

pub use chase::Seat;
pub use ease::ViewEase;

use super::{Player, input::Controls, light::haze};

/// Where the camera looks from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CameraMode {
    /// From behind, on an arm that shortens where something is in the way.
    #[default]
    ThirdPerson,
    /// From the eyes.
    FirstPerson,
    /// From where it was put; nothing moves it.
    Fixed,
}

/// On the camera: how it follows the player.
#[derive(Component, Clone, Debug)]
pub struct CameraRig {
    /// Where it looks from.
    pub mode: CameraMode,
    /// Turns world axes to axes whose `+Y` is the player's up.
    pub base: Quat,
    /// Turn about up, radians; 0 looks along `-Z` of the base.
    pub yaw: f32,
    /// Angle above the horizon of where it looks, radians.
    pub pitch: f32,
    /// Length of the arm when nothing is in the way, metres.
    pub distance: f32,
    /// Length of the arm now, metres.
    pub(in crate::shell) arm: f32,
    /// Height of the eyes above the foot now, metres; 0 before the first frame.
    pub(in crate::shell) eye: f32,
    /// Time since the player last turned it, seconds.
    pub(in crate::shell) idle: f32,
}

impl Default for CameraRig {
    fn default() -> Self {
        Self {
            mode: CameraMode::default(),
            base: Quat::IDENTITY,
            yaw: 0.0,
            pitch: -0.3,
            distance: Self::DISTANCE,
            arm: Self::DISTANCE,
            eye: 0.0,
            idle: 10.0,
        }
    }
}

impl CameraRig {
    /// Length of the arm at the start, metres.
    pub(in crate::shell) const DISTANCE: f32 = 5.0;

    /// Which way it looks.
    pub fn rotation(&self) -> Quat {
        self.heading() * Quat::from_rotation_x(self.pitch)
    }

    /// Which way it looks, made level.
    pub fn heading(&self) -> Quat {
        self.base * Quat::from_rotation_y(self.yaw)
    }

    /// Looks where a pose looks, from a little above, and forgets how it got there.
    pub fn reset_to(&mut self, pose: &Transform) {
        self.base = pose.rotation;
        self.yaw = 0.0;
        self.pitch = -0.3;
        self.arm = self.distance;
        self.eye = 0.0;
        self.idle = 10.0;
    }
}

/// Adds a camera that follows the [`Player`]. `V` changes between third and first person.
pub(super) struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, spawn)
            .add_systems(FixedLast, ease::keep)
            .add_systems(
                Update,
                change_mode
                    .run_if(input_just_pressed(KeyCode::KeyV))
                    .run_if(not(egui_wants_any_keyboard_input)),
            )
            // Before the ticks, so that they go where the player already looks.
            .add_systems(
                RunFixedMainLoop,
                look.in_set(RunFixedMainLoopSystems::BeforeFixedMainLoop),
            )
            // After everything that moves the player or writes interpolated poses.
            .add_systems(
                PostUpdate,
                (follow_up, arm::place, chase::chase)
                    .chain()
                    .before(TransformSystems::Propagate),
            );
    }
}

fn spawn(mut commands: Commands) {
    commands.spawn((
        Name::new("camera"),
        Camera3d::default(),
        CameraRig::default(),
        Projection::from(PerspectiveProjection {
            fov: 60f32.to_radians(),
            near: 0.05,
            ..default()
        }),
        haze(),
    ));
}

fn change_mode(mut rigs: Query<&mut CameraRig>) {
    for mut rig in &mut rigs {
        rig.mode = match rig.mode {
            CameraMode::FirstPerson => CameraMode::ThirdPerson,
            CameraMode::ThirdPerson | CameraMode::Fixed => CameraMode::FirstPerson,
        };
    }
}

/// Turns the camera by what mouse and stick did since the last frame.
fn look(mut rigs: Query<&mut CameraRig>, mut players: Query<&mut Controls, With<Player>>) {
    for mut controls in &mut players {
        let (turn, zoom) = controls.take_look();
        for mut rig in &mut rigs {
            if turn.length_squared() > 1e-8 {
                rig.idle = 0.0;
            }
            rig.yaw -= turn.x;
            rig.pitch = (rig.pitch - turn.y).clamp(-1.5, 1.5);
            rig.distance = (rig.distance * ops::exp(-0.15 * zoom)).clamp(1.5, 20.0);
        }
    }
}

/// Tilts the camera's axes with the player's up by the least turn, so that walking round a planet
/// never flips them.
fn follow_up(mut rigs: Query<&mut CameraRig>, players: Query<&CharacterState, With<Player>>) {
    let Ok(state) = players.single() else {
        return;
    };
    if !state.up.is_normalized() {
        return;
    }
    for mut rig in &mut rigs {
        let up = rig.base * Vec3::Y;
        if up.distance_squared(state.up) > 1e-10 {
            rig.base = (Quat::from_rotation_arc(up, state.up) * rig.base).normalize();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tilting_with_up_keeps_up_exact_and_the_heading_continuous() {
        let mut app = App::new();
        app.add_systems(Update, follow_up);
        let rig = app.world_mut().spawn(CameraRig::default()).id();
        let player = app
            .world_mut()
            .spawn((Player, CharacterState::default()))
            .id();
        let mut last = Quat::IDENTITY;
        // Over the pole and down the other side of a planet.
        for step in 0..=360u16 {
            let angle = f32::from(step).to_radians();
            let up = Vec3::new(0.0, ops::cos(angle), ops::sin(angle));
            if let Some(mut state) = app.world_mut().get_mut::<CharacterState>(player) {
                state.up = up;
            }
            app.update();
            let base = app.world().get::<CameraRig>(rig).unwrap().base;
            assert!((base * Vec3::Y).distance(up) < 1e-4);
            assert!(base.angle_between(last) < 0.03, "step {step}");
            last = base;
        }
        assert!(last.angle_between(Quat::IDENTITY) < 0.01);
    }
}
