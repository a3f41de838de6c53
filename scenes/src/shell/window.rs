//! The window, or the lack of one.

use bevy::{app::PluginGroupBuilder, prelude::*, render::RenderPlugin, window::WindowResolution};

/// Whether a window can be opened: on Linux, whether an X or Wayland server is named in the
/// environment.
pub fn has_display() -> bool {
    let named = |variable| std::env::var_os(variable).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || named("DISPLAY") || named("WAYLAND_DISPLAY")
}

/// Bevy's default plugins with a window of this title. With `whole_frames` every frame is complete
/// from the first one on, as a picture needs it; a game would rather start at once.
pub fn window_plugins(title: &str, whole_frames: bool) -> PluginGroupBuilder {
    DefaultPlugins
        .set(WindowPlugin {
            primary_window: Some(Window {
                title: title.into(),
                resolution: WindowResolution::new(1280, 720),
                ..default()
            }),
            ..default()
        })
        .set(RenderPlugin {
            synchronous_pipeline_compilation: whole_frames,
            ..default()
        })
}
