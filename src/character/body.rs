//! The character's shape as the solver and the physics world have it.

use bevy::prelude::*;
use bevy_rapier3d::prelude::Collider;

use super::{
    config::{Character, CharacterShape},
    intent::Stance,
    motor::CharacterMotor,
    output::{CharacterContacts, CharacterSnapshot},
    report::{CharacterMemory, CharacterReport},
    state::CharacterState,
    validate,
};
use crate::{
    backend::{collider, neighbourhood::Mover},
    validate::Problem,
};

/// How much smaller than the character its collider is, metres: dynamic bodies are pushed by the
/// solver at the outline, and meet the unyielding collider only when they are pressed in deeper.
const MARGIN: f32 = 0.02;

/// The shape at its present height; absent when the config is refused.
#[derive(Component, Default)]
pub(crate) struct CharacterBody {
    pub mover: Option<Mover>,
    /// Height of the mover, metres.
    pub height: f32,
    /// The shape that it was built from.
    shape: Option<CharacterShape>,
    /// Whether that shape spans no volume.
    flat: bool,
    /// Height of the collider, metres; 0 when it is to be built anew.
    collider_height: f32,
    owns_collider: bool,
    /// The refused value of the character and of its motor.
    told: [Option<Problem>; 2],
    /// Which filter components were there in the last tick.
    pub filters: u8,
    /// Whether a bad transform or intent was reported, so that it is reported once.
    pub warned: bool,
}

impl CharacterBody {
    /// Remembers what is refused of the character (0) or its motor (1), and tells it once.
    fn tell(&mut self, entity: Entity, of: usize, problem: Option<Problem>) {
        if let Some(Problem { field, value, need }) = &problem
            && self.told[of] != problem
        {
            warn_bad(entity, field, value, need);
        }
        if self.told[of] != problem {
            self.told[of] = problem;
        }
    }
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
    // A capsule may be lower than its two radii by a rounding.
    Some(height.clamp(least.min(full), full))
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
///
/// Whoever restores a state from before a change of height gets the height of that state, and only
/// a shape or height that is another one is built anew.
pub(super) fn build_bodies(
    mut characters: Query<
        (
            Entity,
            Ref<Character>,
            Ref<CharacterMotor>,
            &mut CharacterState,
            &mut CharacterBody,
        ),
        Or<(
            Changed<Character>,
            Changed<CharacterMotor>,
            Changed<CharacterState>,
            Added<CharacterBody>,
        )>,
    >,
) {
    for (entity, config, motor, mut state, mut body) in &mut characters {
        let fresh = body.is_added();
        if fresh || config.is_changed() {
            let problem = validate::character(&config);
            body.tell(entity, 0, problem);
        }
        if fresh || motor.is_changed() {
            let problem = validate::motor(&motor);
            body.tell(entity, 1, problem);
        }
        if body.told.iter().any(Option::is_some) {
            if body.mover.is_some() {
                body.mover = None;
            }
            continue;
        }
        let standing = config.shape.height();
        let first = !(state.height > 0.0);
        let height = if first {
            standing
        } else {
            state.height.min(standing)
        };
        let same_shape = if fresh || config.is_changed() {
            body.shape.as_ref() == Some(&config.shape)
        } else {
            body.shape.is_some()
        };
        // A hull that spans no volume is tried again only when it is another one.
        let built = same_shape && body.height == height;
        if !(built && body.mover.is_some() || same_shape && body.flat) {
            let mover = mover(&config.shape, height);
            let flat = mover.is_none();
            if flat {
                warn_bad(
                    entity,
                    "Character::shape",
                    "points",
                    "points that span a volume",
                );
            }
            if !same_shape {
                body.shape = Some(config.shape.clone());
                body.collider_height = 0.0;
            }
            body.mover = mover;
            body.flat = flat;
            body.height = height;
        }
        if first && body.mover.is_some() {
            state.height = height;
        }
    }
}

/// Gives the physics world the outline of characters whose shape or height changed.
pub(super) fn resize_colliders(
    mut commands: Commands,
    mut characters: Query<
        (
            Entity,
            &Character,
            &mut CharacterBody,
            Option<&mut Collider>,
        ),
        Changed<CharacterBody>,
    >,
) {
    for (entity, config, mut body, collider) in &mut characters {
        if body.mover.is_none() || body.collider_height == body.height {
            continue;
        }
        let body = body.bypass_change_detection();
        body.owns_collider |= collider.is_none();
        if !body.owns_collider {
            continue;
        }
        body.collider_height = body.height;
        match (collider, shrunk(config, body.height)) {
            (Some(mut collider), Some(new)) => *collider = new,
            (None, Some(new)) => {
                commands.entity(entity).insert(new);
            }
            (_, None) => {}
        }
    }
}

/// Takes away what made a character of an entity that is none any more. Its
/// [`CharacterState`] stays, for who takes over, and so do its rigid body and a collider of the
/// game's own.
pub(super) fn unmake(
    removed: On<Remove, Character>,
    mut commands: Commands,
    bodies: Query<&CharacterBody>,
) {
    let Ok(mut entity) = commands.get_entity(removed.entity) else {
        return;
    };
    entity.try_remove::<(
        CharacterBody,
        CharacterReport,
        CharacterMemory,
        CharacterSnapshot,
        CharacterContacts,
    )>();
    if bodies
        .get(removed.entity)
        .is_ok_and(|body| body.owns_collider)
    {
        entity.try_remove::<Collider>();
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
    let then = "the character is left where it is";
    crate::validate::warn_bad(entity, field, value, need, then);
}
