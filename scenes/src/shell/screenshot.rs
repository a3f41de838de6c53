//! Takes a picture of a station and exits.

use core::time::Duration;
use std::path::PathBuf;

use bevy::{
    prelude::*,
    render::view::screenshot::{Screenshot, ScreenshotCaptured, save_to_disk},
    time::TimeUpdateStrategy,
};

use super::{
    camera::{CameraMode, CameraRig},
    visit::ReadyToWalk,
};

/// Frames per second of the picture's time.
const RATE: f32 = 60.0;

/// The picture to take.
#[derive(Resource, Clone, Debug)]
pub struct Shot {
    /// Where to save it; the ending chooses the format.
    pub file: PathBuf,
    /// How long to let the world run before, seconds.
    pub seconds: f32,
    /// From where: turn and pitch (radians) against the player's facing, and distance (metres).
    pub view: Option<Vec3>,
    /// Looks from this pose at the whole course instead.
    pub overview: Option<Transform>,
}

/// Takes the [`Shot`], with a clock that advances by the same time each frame, and exits: with
/// success only if the file is there.
pub struct ShotPlugin(pub Shot);

impl Plugin for ShotPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f32(
            1.0 / RATE,
        )))
        .insert_resource(self.0.clone())
        .add_systems(PostStartup, aim.after(ReadyToWalk))
        .add_systems(Update, (shoot, finish.run_if(resource_exists::<Taken>)));
    }
}

fn aim(shot: Res<Shot>, mut rigs: Query<(&mut CameraRig, &mut Transform)>) {
    for (mut rig, mut transform) in &mut rigs {
        if let Some(view) = shot.view {
            rig.yaw += view.x;
            // Nothing swings it back behind a vehicle.
            rig.idle = f32::NEG_INFINITY;
            rig.pitch = view.y;
            rig.distance = view.z;
        }
        if let Some(overview) = shot.overview {
            rig.mode = CameraMode::Fixed;
            *transform = overview;
        }
    }
}

fn shoot(mut frame: Local<u32>, shot: Res<Shot>, mut commands: Commands) {
    *frame += 1;
    let wanted = (shot.seconds.max(0.1) * RATE).round() as u32;
    if *frame == wanted {
        // An older picture must not pass for this one.
        let _ = std::fs::remove_file(&shot.file);
        commands
            .spawn(Screenshot::primary_window())
            .observe(save_to_disk(shot.file.clone()))
            .observe(|_: On<ScreenshotCaptured>, mut commands: Commands| {
                commands.insert_resource(Taken);
            });
    }
}

/// The picture was handed to all who save it.
#[derive(Resource)]
struct Taken;

fn finish(shot: Res<Shot>, mut exit: MessageWriter<AppExit>) {
    exit.write(if shot.file.is_file() {
        AppExit::Success
    } else {
        error!("no picture was saved to {}", shot.file.display());
        AppExit::error()
    });
}
