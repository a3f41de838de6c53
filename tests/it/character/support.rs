//! What the tests of the character share: motors, oracles, a log of events.

use bevy::{
    math::{DVec3, ops},
    prelude::*,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::{parry, parry::math::Pose, prelude::*};
use embody_scenes::Sim;

pub use crate::{
    physics::Physics,
    support::{Findings, G, RATES, edit, insert},
};

/// Walking speed of [`prompt`], metres per second.
pub const SPEED: f32 = 5.0;

/// A motor that reaches its speed and stops at once, so that distances have a closed form.
pub fn prompt() -> CharacterMotor {
    CharacterMotor {
        walk_speed: SPEED,
        acceleration: f32::INFINITY,
        friction: f32::INFINITY,
        ..default()
    }
}

/// Spawns a default character with a [`prompt`] motor.
pub fn runner(sim: &mut Sim, foot: Vec3) -> Entity {
    runner_with(sim, Character::default(), foot)
}

/// Spawns a character with a [`prompt`] motor.
pub fn runner_with(sim: &mut Sim, character: Character, foot: Vec3) -> Entity {
    sim.spawn((character, prompt(), Transform::from_translation(foot)))
}

/// Spawns a character whose velocity the test writes.
pub fn raw(sim: &mut Sim, foot: Vec3) -> Entity {
    sim.spawn((
        Character::default(),
        CustomMotor,
        Transform::from_translation(foot),
    ))
}

/// All that a rollback restores of a character.
pub fn save(sim: &Sim, who: Entity) -> (Transform, CharacterState, CharacterIntent) {
    (sim.get(who), sim.state(who), sim.get(who))
}

/// The highest that a character's foot comes in this time, metres.
pub fn highest(sim: &mut Sim, who: Entity, seconds: f64) -> f32 {
    let ticks = (seconds / f64::from(sim.dt())).round() as usize;
    (0..ticks).fold(f32::MIN, |high, _| {
        sim.ticks(1);
        high.max(sim.position(who).y)
    })
}

/// Writes a character's velocity, metres per second.
pub fn set_velocity(sim: &mut Sim, character: Entity, velocity: Vec3) {
    sim.app
        .world_mut()
        .get_mut::<CharacterState>(character)
        .expect("a character has a state")
        .velocity = velocity;
}

/// Position with the part that single precision cannot hold, as double precision.
pub fn exact_position(sim: &Sim, character: Entity) -> DVec3 {
    sim.position(character).as_dvec3() + sim.state(character).residual.as_dvec3()
}

/// A level direction at this angle from `+X` towards `+Z`, degrees.
pub fn heading(degrees: f32) -> Vec3 {
    let (sin, cos) = ops::sin_cos(degrees.to_radians());
    Vec3::new(cos, 0.0, sin)
}

/// Whether everything of a character is finite.
pub fn finite(sim: &Sim, character: Entity) -> bool {
    let (transform, state) = (sim.get::<Transform>(character), sim.state(character));
    transform.translation.is_finite()
        && transform.rotation.is_finite()
        && state.velocity.is_finite()
        && state.platform_velocity.is_finite()
        && state.up.is_finite()
        && state.height.is_finite()
        && state.view_offset.is_finite()
        && state.residual.is_finite()
        && state.ground.normal.is_finite()
        && state.ground.point.is_finite()
        && state.ground.velocity.is_finite()
}

/// The standing capsule of a character whose shape is one, as parry sees it.
fn capsule_of(sim: &Sim, character: Entity) -> (Pose, parry::shape::Capsule) {
    let CharacterShape::Capsule { radius, .. } = sim.get::<Character>(character).shape else {
        panic!("the depth oracle is for capsules");
    };
    let (transform, state) = (sim.get::<Transform>(character), sim.state(character));
    let capsule = parry::shape::Capsule::new(
        Vec3::Y * radius,
        Vec3::Y * (state.height - radius).max(radius),
        radius,
    );
    (
        Pose::from_parts(transform.translation, transform.rotation),
        capsule,
    )
}

/// How deep a capsule character is in a collider's entity, metres; negative when apart or far.
pub fn depth_in(sim: &Sim, character: Entity, other: Entity) -> f32 {
    let (pose, capsule) = capsule_of(sim, character);
    let (transform, collider) = (sim.get::<Transform>(other), sim.get::<Collider>(other));
    let other = Pose::from_parts(transform.translation, transform.rotation);
    // From the capsule's axis: parry's contact of a whole capsule may tell centimetres of depth where
    // only the vertex of a triangle touches, while its distance between separate shapes does not err.
    match parry::query::distance(&pose, &capsule.segment, &other, &*collider.raw) {
        Ok(apart) => (capsule.radius - apart).max(-0.5),
        Err(error) => panic!("depth: {error}"),
    }
}

/// How deep a capsule character is in the deepest of all fixed colliders, metres, and which that is.
pub fn depth(sim: &mut Sim, character: Entity) -> (f32, Option<Entity>) {
    let world = sim.app.world_mut();
    let mut query = world.query::<(Entity, &RigidBody, &Collider)>();
    let fixed: Vec<Entity> = query
        .iter(world)
        .filter(|(_, body, _)| **body == RigidBody::Fixed)
        .map(|(entity, ..)| entity)
        .collect();
    fixed
        .into_iter()
        .map(|entity| (depth_in(sim, character, entity), Some(entity)))
        .fold((-0.5, None), |a, b| if b.0 > a.0 { b } else { a })
}

/// A box slab: its origin is its middle, its top 0.25 m above.
pub fn board() -> Collider {
    Collider::cuboid(3.0, 0.25, 3.0)
}

/// Half a second at rest, then `path` with its own time.
pub fn later(
    path: impl Fn(f64) -> DVec3 + Send + Sync + 'static,
) -> impl Fn(f64) -> Transform + Send + Sync {
    move |t| Transform::from_translation(path((t - 0.5).max(0.0)).as_vec3())
}

/// Everything that happened, with the tick.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct EventLog {
    pub landed: Vec<Landed>,
    pub left: Vec<LeftGround>,
    pub stepped: Vec<Stepped>,
    pub hit: Vec<Hit>,
    pub stance: Vec<StanceChanged>,
    pub crushed: Vec<Crushed>,
}

/// Starts to record events.
pub fn record(sim: &mut Sim) {
    sim.app
        .init_resource::<EventLog>()
        .add_observer(|e: On<Landed>, mut log: ResMut<EventLog>| log.landed.push(*e))
        .add_observer(|e: On<LeftGround>, mut log: ResMut<EventLog>| log.left.push(*e))
        .add_observer(|e: On<Stepped>, mut log: ResMut<EventLog>| log.stepped.push(*e))
        .add_observer(|e: On<Hit>, mut log: ResMut<EventLog>| log.hit.push(*e))
        .add_observer(|e: On<StanceChanged>, mut log: ResMut<EventLog>| log.stance.push(*e))
        .add_observer(|e: On<Crushed>, mut log: ResMut<EventLog>| log.crushed.push(*e));
}

/// What was recorded since the last call.
pub fn take_events(sim: &mut Sim) -> EventLog {
    core::mem::take(&mut *sim.app.world_mut().resource_mut::<EventLog>())
}

/// Tangents and normals of a slope of this angle (radians) that rises along `+X`.
pub fn slope_axes(angle: f32) -> (Vec3, Vec3) {
    let (sin, cos) = ops::sin_cos(angle);
    (Vec3::new(cos, sin, 0.0), Vec3::new(-sin, cos, 0.0))
}

/// The foot of a capsule of this radius that rests on a slope of this angle (radians) at a point:
/// its lowest point hangs free on the uphill side.
pub fn foot_on_slope(point: Vec3, angle: f32, radius: f32) -> Vec3 {
    let (_, normal) = slope_axes(angle);
    point + normal * radius - Vec3::Y * radius
}
