//! The character's shape as the solver and the physics world have it.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;

use super::{
    config::{Character, CharacterShape},
    intent::Stance,
    motor::CharacterMotor,
    state::CharacterState,
    validate::{self, Problem},
};
use crate::backend::{collider, neighbourhood::Mover};

/// How much smaller than the character its collider is, metres: dynamic bodies are pushed by the
/// solver at the outline, and meet the unyielding collider only when they are pressed in deeper.
const MARGIN: f32 = 0.02;

/// The shape at its present height; absent when the config is refused.
#[derive(Component, Default)]
pub(crate) struct CharacterBody {
    pub mover: Option<Mover>,
    /// Height of the mover, metres.
    pub height: f32,
    /// Height of the collider, metres.
    collider_height: f32,
    owns_collider: bool,
    /// Which filter components were there in the last tick.
    pub filters: u8,
    /// Whether a bad transform or intent was reported, so that it is reported once.
    pub warned: bool,
}

/// How much thicker than its collider a character is, metres.
pub(super) fn margin(shape: &CharacterShape) -> f32 {
    MARGIN.min(0.1 * shape.radius()).min(0.1 * shape.height())
}

/// The height that a stance asks for, metres; `None` when it asks for nonsense.
pub(super) fn wanted_height(config: &Character, stance: Stance) -> Option<f32> {
    let full = config.shape.height();
    let least = match config.shape {
        CharacterShape::Capsule { radius, .. } => 2.0 * radius,
        _ => (0.1 * full).min(0.2),
    };
    let height = match stance {
        Stance::Stand => full,
        Stance::Crouch => config.crouch_height,
        Stance::Height(height) if height.is_finite() && height > 0.0 => height,
        Stance::Height(_) => return None,
    };
    Some(height.clamp(least, full))
}

/// The mover of a shape at this height.
pub(super) fn mover(shape: &CharacterShape, height: f32) -> Option<Mover> {
    Some(match shape {
        CharacterShape::Capsule { radius, .. } => Mover::capsule(*radius, height),
        CharacterShape::Cylinder { radius, .. } => Mover::cylinder(*radius, height),
        CharacterShape::Box { size } => Mover::cuboid(size.with_y(height)),
        CharacterShape::ConvexHull { points } => {
            let scale = Vec3::new(1.0, height / shape.height(), 1.0);
            let points: Vec<Vec3> = points.iter().map(|p| *p * scale).collect();
            Mover::convex_hull(&points)?
        }
    })
}

/// Builds what is new and rebuilds what changed, before the physics world takes over the changes.
pub(super) fn build_bodies(
    mut commands: Commands,
    mut characters: Query<
        (
            Entity,
            &Character,
            &CharacterMotor,
            &mut CharacterState,
            &mut CharacterBody,
            Option<&Collider>,
        ),
        Or<(
            Changed<Character>,
            Changed<CharacterMotor>,
            Added<CharacterBody>,
        )>,
    >,
) {
    for (entity, config, motor, mut state, mut body, collider) in &mut characters {
        let problems = [validate::character(config), validate::motor(motor)];
        for Problem { field, value, need } in problems.iter().flatten() {
            warn_bad(entity, field, value, need);
        }
        let first = state.height <= 0.0;
        let standing = config.shape.height();
        let height = if first {
            standing
        } else {
            state.height.min(standing)
        };
        body.mover = if problems.iter().any(Option::is_some) {
            None
        } else {
            let mover = mover(&config.shape, height);
            if mover.is_none() {
                warn_bad(
                    entity,
                    "Character::shape",
                    "points",
                    "points that span a volume",
                );
            }
            mover
        };
        if body.mover.is_none() {
            continue;
        }
        if first {
            state.height = height;
        }
        body.height = height;
        if body.owns_collider || collider.is_none() {
            body.owns_collider = true;
            body.collider_height = height;
            if let Some(collider) = shrunk(config, height) {
                commands.entity(entity).insert(collider);
            }
        }
    }
}

/// Gives the physics world the new outline of characters whose height changed.
pub(super) fn resize_colliders(
    mut characters: Query<(&Character, &mut CharacterBody, &mut Collider), Changed<CharacterBody>>,
) {
    for (config, mut body, mut collider) in &mut characters {
        if body.owns_collider && body.mover.is_some() && body.collider_height != body.height {
            body.collider_height = body.height;
            if let Some(new) = shrunk(config, body.height) {
                *collider = new;
            }
        }
    }
}

fn shrunk(config: &Character, height: f32) -> Option<Collider> {
    let by = margin(&config.shape);
    match &config.shape {
        CharacterShape::Capsule { radius, .. } => {
            let r = radius - by;
            let low = Vec3::Y * *radius;
            let high = Vec3::Y * (height - radius).max(*radius);
            Some(Collider::capsule(low, high, r))
        }
        CharacterShape::Cylinder { radius, .. } => Some(collider::raised(
            Collider::cylinder(height * 0.5 - by, radius - by),
            height * 0.5,
        )),
        CharacterShape::Box { size } => {
            let half = size.with_y(height) * 0.5 - by;
            Some(collider::raised(
                Collider::cuboid(half.x, half.y, half.z),
                height * 0.5,
            ))
        }
        CharacterShape::ConvexHull { points } => {
            let (low, high) = points
                .iter()
                .fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
            let extent = (high - low).max(Vec3::splat(1.0e-3));
            let center = (low + high) * 0.5;
            let stretch = Vec3::new(1.0, height / extent.y, 1.0);
            let shrink = (extent - 2.0 * by) / extent;
            let points: Vec<Vec3> = points
                .iter()
                .map(|p| ((*p - center) * shrink + center - Vec3::Y * low.y) * stretch)
                .collect();
            Collider::convex_hull(&points)
        }
    }
}

/// The one warning that a refused value gets.
pub(super) fn warn_bad(entity: Entity, field: &str, value: &str, need: &str) {
    tracing::warn!(
        "{entity}: {field} is {value}, but needs {need}; the character is left where it is"
    );
}
