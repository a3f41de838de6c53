//! Draws what each character touches, stands on and tries to climb.

use bevy::{color::palettes::tailwind, gizmos::config::GizmoConfigGroup, prelude::*};

use super::{
    explain::Explain,
    hull::hull_edges,
    trail::{StepTrail, lay_trails, lift_trail, remember_steps},
};
use crate::character::{Character, CharacterContacts, CharacterShape, CharacterState};

/// Draws every character's outline, ground, contacts, steps, snap and velocity; see
/// [`CharacterGizmos`] for what is drawn how.
///
/// Drawing needs a renderer: in a game that has Bevy's default plugins this works as it is.
#[derive(Clone, Copy, Debug, Default)]
pub struct EmbodyDebugPlugin;

impl Plugin for EmbodyDebugPlugin {
    fn build(&self, app: &mut App) {
        app.insert_gizmo_config(
            CharacterGizmos::default(),
            GizmoConfig {
                // Just enough that a plane wins against the surface it lies on.
                depth_bias: -0.02,
                ..default()
            },
        )
        .add_observer(lift_trail)
        .add_systems(FixedLast, (lay_trails, remember_steps).chain())
        .add_systems(
            PostUpdate,
            (draw_bodies, draw_contacts, draw_steps, draw_velocities)
                .after(TransformSystems::Propagate),
        );
    }
}

/// What is drawn of each character. Change it, or switch all of it off, through Bevy's
/// [`GizmoConfigStore`].
#[derive(Clone, Copy, Debug, Reflect, GizmoConfigGroup)]
#[reflect(Default)]
pub struct CharacterGizmos {
    /// The outline at its present height, in the colour of the ground state: green on ground,
    /// orange on steep ground, violet unsupported, blue in the air, red when crushed.
    pub outline: bool,
    /// The ground's point and normal, in the same colour.
    pub ground: bool,
    /// A disc in the plane of each contact: red where it stopped the character, grey where it did
    /// not; a line for the impulse that it received.
    pub contacts: bool,
    /// An arrow at each riser that was tried in the last seconds, in the colour of the result; see
    /// [`Explain`] for the colours.
    pub steps: bool,
    /// A blue line as long as the pull down that kept the character on the ground.
    pub snap: bool,
    /// An arrow for the own velocity (yellow) and for the platform's (cyan).
    pub velocity: bool,
    /// Length of a velocity arrow, metres for each metre per second.
    pub velocity_scale: f32,
    /// Length of an impulse line, metres for each newton-second.
    pub impulse_scale: f32,
}

impl Default for CharacterGizmos {
    fn default() -> Self {
        Self {
            outline: true,
            ground: true,
            contacts: true,
            steps: true,
            snap: true,
            velocity: true,
            velocity_scale: 0.2,
            impulse_scale: 0.01,
        }
    }
}

fn state_color(state: &CharacterState) -> Color {
    if state.crushed {
        tailwind::RED_500.into()
    } else {
        state.ground.state.color()
    }
}

fn draw_bodies(
    mut gizmos: Gizmos<CharacterGizmos>,
    characters: Query<(&Character, &CharacterState, &GlobalTransform)>,
) {
    let shown = *gizmos.config_ext;
    for (character, state, transform) in &characters {
        let color = state_color(state);
        let (_, rotation, foot) = transform.to_scale_rotation_translation();
        if !foot.is_finite() || !rotation.is_finite() {
            continue;
        }
        if shown.outline {
            draw_outline(
                &mut gizmos,
                &character.shape,
                state.height,
                foot,
                rotation,
                color,
            );
        }
        if shown.ground && state.ground.entity.is_some() {
            let ground = &state.ground;
            disc(&mut gizmos, ground.point, ground.normal, 0.25, color);
            gizmos
                .arrow(ground.point, ground.point + ground.normal * 0.6, color)
                .with_tip_length(0.1);
        }
    }
}

fn draw_outline(
    gizmos: &mut Gizmos<CharacterGizmos>,
    shape: &CharacterShape,
    height: f32,
    foot: Vec3,
    rotation: Quat,
    color: Color,
) {
    // Before its first tick a character has no height of its own.
    let full = shape.height();
    let height = if height > 0.0 { height } else { full };
    let middle = Isometry3d::new(foot + rotation * Vec3::Y * (height * 0.5), rotation);
    match shape {
        CharacterShape::Capsule { radius, .. } => {
            let length = (height - 2.0 * radius).max(0.0);
            gizmos.primitive_3d(&Capsule3d::new(*radius, length), middle, color);
        }
        CharacterShape::Cylinder { radius, .. } => {
            gizmos.primitive_3d(&Cylinder::new(*radius, height), middle, color);
        }
        CharacterShape::Box { size } => {
            let size = Vec3::new(size.x, height, size.z);
            gizmos.primitive_3d(&Cuboid::from_size(size), middle, color);
        }
        CharacterShape::ConvexHull { points } => {
            let squeeze = Vec3::new(1.0, if full > 0.0 { height / full } else { 1.0 }, 1.0);
            // The lowest point is at the foot, wherever the points have their origin.
            let low = points.iter().map(|p| p.y).fold(f32::MAX, f32::min);
            let at = |p: Vec3| foot + rotation * ((p - Vec3::Y * low) * squeeze);
            for (i, j) in hull_edges(points) {
                gizmos.line(at(points[i]), at(points[j]), color);
            }
        }
    }
}

fn draw_contacts(
    mut gizmos: Gizmos<CharacterGizmos>,
    characters: Query<(&CharacterContacts, &CharacterState, &GlobalTransform)>,
) {
    let shown = *gizmos.config_ext;
    for (contacts, state, transform) in &characters {
        if shown.contacts {
            for contact in &contacts.contacts {
                let color: Color = if contact.blocked {
                    tailwind::RED_400.into()
                } else {
                    tailwind::GRAY_400.into()
                };
                disc(&mut gizmos, contact.point, contact.normal, 0.12, color);
                gizmos.ray(contact.point, contact.normal * 0.15, color);
                gizmos.ray(
                    contact.point,
                    contact.impulse * shown.impulse_scale,
                    tailwind::PINK_400,
                );
            }
        }
        if shown.snap && contacts.snapped > 0.0 {
            let foot = transform.translation();
            gizmos.ray(foot, state.up * contacts.snapped, tailwind::BLUE_500);
        }
    }
}

fn draw_steps(
    mut gizmos: Gizmos<CharacterGizmos>,
    time: Res<Time<Fixed>>,
    trails: Query<(&StepTrail, &CharacterState)>,
) {
    if !gizmos.config_ext.steps {
        return;
    }
    let now = time.elapsed_secs_f64();
    for (trail, state) in &trails {
        for step in &trail.steps {
            let age = ((now - step.time) / StepTrail::KEPT).clamp(0.0, 1.0) as f32;
            let color = step.attempt.result.color().with_alpha(1.0 - age);
            let at = step.attempt.point;
            gizmos
                .arrow(at - step.attempt.direction * 0.3, at, color)
                .with_tip_length(0.08);
            gizmos.ray(at, state.up * 0.3, color);
        }
    }
}

fn draw_velocities(
    mut gizmos: Gizmos<CharacterGizmos>,
    characters: Query<(&CharacterState, &GlobalTransform)>,
) {
    let shown = *gizmos.config_ext;
    if !shown.velocity {
        return;
    }
    for (state, transform) in &characters {
        let from = transform.translation() + state.up * (state.height * 0.5);
        for (velocity, color) in [
            (state.velocity, tailwind::YELLOW_300),
            (state.platform_velocity, tailwind::CYAN_300),
        ] {
            if velocity.length_squared() > 0.01 {
                gizmos
                    .arrow(from, from + velocity * shown.velocity_scale, color)
                    .with_tip_length(0.1);
            }
        }
    }
}

/// A circle in a plane, if the plane has a direction.
fn disc(
    gizmos: &mut Gizmos<CharacterGizmos>,
    center: Vec3,
    normal: Vec3,
    radius: f32,
    color: Color,
) {
    if let Ok(normal) = Dir3::new(normal) {
        let facing = Quat::from_rotation_arc(Vec3::Z, *normal);
        gizmos
            .circle(Isometry3d::new(center, facing), radius, color)
            .resolution(24);
    }
}
