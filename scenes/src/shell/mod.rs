//! What every example with a window shares: window, light, cameras, input, clock keys, overlays.
//!
//! [`ShellPlugin`] adds all of it for one [`Player`]; [`CourseShellPlugin`] adds the course, its
//! looks and the menu of stations on top.

pub mod camera;
mod clock;
mod course_view;
mod demo;
mod falls;
pub mod figure;
mod garage;
pub mod input;
mod light;
mod looks;
mod models;
mod overlay;
mod player;
mod screenshot;
mod shoot;
mod stops;
mod switches;
mod visit;
mod window;

use bevy::{diagnostic::FrameTimeDiagnosticsPlugin, prelude::*};
use bevy_embody::{
    EmbodyDebugPlugin, EmbodyDiagnosticsPlugin, EmbodyInspectorPlugin, RagdollDebugPlugin,
    VehicleDebugPlugin,
};

pub use demo::demo_plugins;
pub use garage::Garage;
pub use models::{ModelOf, Models};
pub use overlay::{Hud, HudPart};
pub use player::{Player, player};
pub use screenshot::{Shot, ShotPlugin};
pub use stops::{Stop, Visit};
pub use switches::Switches;
pub use visit::Start;
pub use window::{has_display, window_plugins};

use crate::{course::CoursePlugin, figures::HumanPlugin};

/// Cameras, input, clock keys, overlays, gizmos and panel for one [`Player`], on foot or driving.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShellPlugin;

impl Plugin for ShellPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            FrameTimeDiagnosticsPlugin::default(),
            EmbodyDiagnosticsPlugin,
            EmbodyDebugPlugin,
            VehicleDebugPlugin,
            RagdollDebugPlugin,
            EmbodyInspectorPlugin,
        ))
        .add_plugins((
            light::LightPlugin,
            camera::CameraPlugin,
            input::InputPlugin,
            figure::FigurePlugin,
            clock::ClockPlugin,
            switches::SwitchesPlugin,
            overlay::OverlayPlugin,
            shoot::ShootPlugin,
        ));
    }
}

/// The course with its looks and the menu of stations.
#[derive(Clone, Copy, Debug, Default)]
pub struct CourseShellPlugin;

impl Plugin for CourseShellPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            CoursePlugin,
            HumanPlugin,
            course_view::CourseViewPlugin,
            models::ModelsPlugin,
            garage::GaragePlugin,
            visit::VisitPlugin,
        ));
    }
}
