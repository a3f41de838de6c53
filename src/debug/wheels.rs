//! Draws what each wheel touches, carries and slips.

use bevy::{color::palettes::tailwind, gizmos::config::GizmoConfigGroup, prelude::*};

use crate::vehicle::{Vehicle, Wheel, WheelOf, WheelState};

/// Draws every vehicle's springs, contacts, forces, slips and friction ellipses; see
/// [`VehicleGizmos`] for what is drawn how.
///
/// Drawing needs a renderer: in a game that has Bevy's default plugins this works as it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct VehicleDebugPlugin;

impl Plugin for VehicleDebugPlugin {
    fn build(&self, app: &mut App) {
        app.insert_gizmo_config(
            VehicleGizmos::default(),
            GizmoConfig {
                depth_bias: -0.02,
                ..default()
            },
        )
        .add_systems(PostUpdate, draw_wheels.after(TransformSystems::Propagate));
    }
}

/// What is drawn of each wheel. Change it, or switch all of it off, through Bevy's
/// [`GizmoConfigStore`].
#[derive(Clone, Copy, Debug, Reflect, GizmoConfigGroup)]
#[reflect(Default)]
pub struct VehicleGizmos {
    /// The suspension's travel in grey, and the compressed part of it: green, red at the end.
    pub spring: bool,
    /// The contact: a disc in the plane of the ground, and its load as a line along the normal.
    pub contact: bool,
    /// The tyre's force as a yellow arrow.
    pub force: bool,
    /// The friction ellipse around the contact: white, orange where the tyre is near its limit.
    pub ellipse: bool,
    /// Slip along and across as a violet arrow.
    pub slip: bool,
    /// Length of a force arrow, metres for each newton.
    pub force_scale: f32,
    /// Length of the arrow of a full slip, metres.
    pub slip_scale: f32,
}

impl Default for VehicleGizmos {
    fn default() -> Self {
        Self {
            spring: true,
            contact: true,
            force: true,
            ellipse: true,
            slip: true,
            force_scale: 2.0e-4,
            slip_scale: 1.0,
        }
    }
}

fn draw_wheels(
    mut gizmos: Gizmos<VehicleGizmos>,
    vehicles: Query<&GlobalTransform, With<Vehicle>>,
    wheels: Query<(&Wheel, &WheelOf, &WheelState)>,
) {
    let shown = *gizmos.config_ext;
    for (wheel, of, state) in &wheels {
        let Ok(vehicle) = vehicles.get(of.0) else {
            continue;
        };
        let (_, rotation, origin) = vehicle.to_scale_rotation_translation();
        if !origin.is_finite() || !rotation.is_finite() {
            continue;
        }
        let top = origin + rotation * wheel.attachment;
        let down = rotation * wheel.direction.normalize_or(Vec3::NEG_Y);
        let travel = wheel.suspension.travel;
        if shown.spring {
            let hub = top + down * (travel - state.compression);
            let bottomed = state.compression >= travel;
            let color = if bottomed {
                tailwind::RED_500
            } else {
                tailwind::GREEN_400
            };
            gizmos.line(top, hub, tailwind::GRAY_400);
            gizmos.line(hub, top + down * travel, color);
        }
        let Some(contact) = state.contact else {
            continue;
        };
        let (point, n) = (contact.point, contact.normal);
        let across = contact.forward.cross(n);
        if shown.contact {
            let turned = Quat::from_rotation_arc(Vec3::Z, n);
            gizmos.circle(Isometry3d::new(point, turned), 0.08, tailwind::SKY_400);
            gizmos.line(
                point,
                point + n * (state.load * shown.force_scale),
                tailwind::SKY_400,
            );
        }
        let on_ground = |v: Vec2| contact.forward * v.x + across * v.y;
        if shown.force {
            let force = on_ground(state.force) * shown.force_scale;
            gizmos
                .arrow(point, point + force, tailwind::YELLOW_400)
                .with_tip_length(0.06);
        }
        if shown.ellipse && state.limit.min_element() > 0.0 {
            let used = (state.force / state.limit).length();
            let color = if used > 0.98 {
                tailwind::ORANGE_500
            } else {
                tailwind::GRAY_50
            };
            let axes = Mat3::from_cols(across, contact.forward, across.cross(contact.forward));
            let turned = Quat::from_mat3(&axes);
            let half = Vec2::new(state.limit.y, state.limit.x) * shown.force_scale;
            gizmos.ellipse(Isometry3d::new(point, turned), half, color);
        }
        if shown.slip {
            let slip = Vec2::new(state.slip_ratio, state.slip_angle) * shown.slip_scale;
            gizmos
                .arrow(point, point + on_ground(slip), tailwind::VIOLET_400)
                .with_tip_length(0.04);
        }
    }
}
