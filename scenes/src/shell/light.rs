//! Sun, sky and haze.

use bevy::{
    light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap},
    prelude::*,
};

/// Colour of the sky, and of what is far away.
pub(super) const SKY: Color = Color::srgb(0.62, 0.76, 0.88);

/// A sun with shadows, light from the sky, and its colour behind everything.
pub(super) struct LightPlugin;

impl Plugin for LightPlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(ClearColor(SKY))
            .insert_resource(DirectionalLightShadowMap { size: 2048 })
            .insert_resource(GlobalAmbientLight {
                color: Color::srgb(0.85, 0.92, 1.0),
                brightness: 380.0,
                ..default()
            })
            .add_systems(Startup, sun);
    }
}

/// Haze for a camera.
pub(super) fn haze() -> DistanceFog {
    DistanceFog {
        color: SKY,
        directional_light_color: Color::srgba(1.0, 0.95, 0.8, 0.25),
        directional_light_exponent: 12.0,
        falloff: FogFalloff::Linear {
            start: 70.0,
            end: 320.0,
        },
    }
}

fn sun(mut commands: Commands) {
    commands.spawn((
        Name::new("sun"),
        DirectionalLight {
            color: Color::srgb(1.0, 0.96, 0.88),
            illuminance: 11_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            num_cascades: 3,
            first_cascade_far_bound: 12.0,
            maximum_distance: 110.0,
            ..default()
        }
        .build(),
        Transform::from_xyz(-7.0, 9.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
}
