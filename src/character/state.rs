//! What a character carries from tick to tick: all that a rollback must restore.

use bevy::{
    ecs::{entity::MapEntities, reflect::ReflectMapEntities},
    prelude::*,
};

use super::intent::Stance;

/// The state of a character. Together with its [`Transform`] it is everything of the character that
/// a save or a rollback must restore: the same state, transform, intents and world give the same
/// bits. The world is the physics world as well: a rollback that restores components alone gets
/// the same motion only as exactly as Rapier takes up the bodies around.
///
/// A state that is set back to its default is that of a character which is just spawned: it stands
/// at its full height where its [`Transform`] is, in the tick that follows.
#[derive(Component, Reflect, Clone, Debug, PartialEq, MapEntities)]
#[reflect(Component, Default, Debug, PartialEq, Clone, MapEntities)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterState {
    /// Own velocity in world axes, metres per second, relative to the ground that carries it.
    /// With [`CustomMotor`](super::CustomMotor) the game writes it before each tick; the solver
    /// takes out of it what walls, floors and ceilings stop.
    pub velocity: Vec3,
    /// Velocity of the carrying ground at the foot, world axes, metres per second.
    pub platform_velocity: Vec3,
    /// What the character stands on.
    #[entities]
    pub ground: Ground,
    /// Where the foot stands on its ground, in the ground's own frame.
    #[entities]
    pub anchor: Option<Anchor>,
    /// Current up axis, unit length. Follows [`CharacterUp`](super::CharacterUp).
    pub up: Vec3,
    /// Current total height, metres; 0 until the first tick.
    pub height: f32,
    /// Stance last reached.
    pub stance: Stance,
    /// Position that single precision cannot hold in the transform, metres; far from the origin it
    /// keeps small motions from being lost.
    pub residual: Vec3,
    /// How a moving character is driven.
    pub mode: MovementMode,
    /// Seconds since the character last stood on ground; 0 while it does.
    pub air_time: f32,
    /// Seconds left in which a remembered press still becomes a jump.
    pub jump_buffer: f32,
    /// Seconds left in which a jump is still allowed after leaving the ground.
    pub coyote_time: f32,
    /// Whether jump was held in the last tick.
    pub jump_held: bool,
    /// Whether it is in the air because it jumped.
    pub jumping: bool,
    /// Whether it was climbing a step in the last tick.
    pub stepping: bool,
    /// The water that its waist is in; of several the one that it was in first.
    #[entities]
    pub water: Option<Entity>,
    /// The ladder that its waist is at; of several the one that it was at first.
    #[entities]
    pub ladder: Option<Entity>,
    /// The mode that water or a ladder gave it; it ends with them. Another mode than this was set
    /// by the game.
    pub volume_mode: Option<MovementMode>,
    /// Whether it was inside something in the last tick.
    pub overlapping: bool,
    /// Whether the last tick left it pinned between two things that close on it.
    pub crushed: bool,
    /// What a camera adds to the position to see steps as ramps, world axes, metres.
    pub view_offset: Vec3,
    /// Force with which it weighs on the dynamic body that it stands on, newtons.
    pub weight: f32,
    /// Pose that the last tick ended with, to tell a teleport from a motion; `None` before the
    /// first tick.
    pub last_pose: Option<LastPose>,
}

impl Default for CharacterState {
    fn default() -> Self {
        Self {
            velocity: Vec3::ZERO,
            platform_velocity: Vec3::ZERO,
            ground: Ground::default(),
            anchor: None,
            up: Vec3::Y,
            height: 0.0,
            stance: Stance::Stand,
            residual: Vec3::ZERO,
            mode: MovementMode::Walk,
            air_time: 0.0,
            jump_buffer: 0.0,
            coyote_time: 0.0,
            jump_held: false,
            jumping: false,
            stepping: false,
            water: None,
            ladder: None,
            volume_mode: None,
            overlapping: false,
            crushed: false,
            view_offset: Vec3::ZERO,
            weight: 0.0,
            last_pose: None,
        }
    }
}

impl CharacterState {
    /// Velocity in the world: its own plus that of what carries it, metres per second.
    pub fn world_velocity(&self) -> Vec3 {
        self.velocity + self.platform_velocity
    }

    /// Whether it stands on ground that holds it.
    pub fn on_ground(&self) -> bool {
        self.ground.state == GroundState::OnGround
    }
}

/// How the ground holds a character.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum GroundState {
    /// Stands on ground that holds it, a wedge between steep walls included.
    OnGround,
    /// Touches ground too steep to hold it: slides, cannot jump.
    Steep,
    /// Touches something, but nothing that could carry it.
    Unsupported,
    /// Touches nothing.
    #[default]
    InAir,
}

/// What a character stands on.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Ground {
    /// How it holds.
    pub state: GroundState,
    /// The entity of the collider, if any is touched.
    #[entities]
    pub entity: Option<Entity>,
    /// Normal of the surface, unit length, world axes; up when in the air.
    pub normal: Vec3,
    /// Where it is touched, world, metres.
    pub point: Vec3,
    /// Velocity of the surface there, metres per second, conveyors included.
    pub velocity: Vec3,
    /// What the surface is made of.
    pub material: GroundMaterial,
}

impl Default for Ground {
    fn default() -> Self {
        Self {
            state: GroundState::InAir,
            entity: None,
            normal: Vec3::Y,
            point: Vec3::ZERO,
            velocity: Vec3::ZERO,
            material: GroundMaterial::default(),
        }
    }
}

/// What a surface is made of, as its collider tells.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct GroundMaterial {
    /// Coulomb friction coefficient of the collider, dimensionless.
    pub friction: f32,
    /// Restitution coefficient of the collider, dimensionless.
    pub restitution: f32,
    /// Grip of the surface for walking, 0 (none) to 1 (full) and above; see
    /// [`SurfaceGrip`](super::SurfaceGrip).
    pub grip: f32,
}

impl Default for GroundMaterial {
    fn default() -> Self {
        Self {
            friction: 0.5,
            restitution: 0.0,
            grip: 1.0,
        }
    }
}

/// Where a tick ended.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct LastPose {
    /// The foot, world, metres.
    pub position: Vec3,
    /// Rotation in the world, unit length.
    pub rotation: Quat,
}

/// Where a foot stands in the frame of its ground.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, MapEntities)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Anchor {
    /// The entity of the ground's collider.
    #[entities]
    pub entity: Entity,
    /// Pose of the collider when the anchor was set: position.
    pub position: Vec3,
    /// Pose of the collider when the anchor was set: rotation.
    pub rotation: Quat,
}

/// How a character moves.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum MovementMode {
    /// On foot, and falling when there is no ground.
    #[default]
    Walk,
    /// Free in all directions, without gravity.
    Fly,
    /// In water: buoyed, slowed, free in all directions. Entered and left by a
    /// [`WaterVolume`](super::WaterVolume); set by the game outside of water it stays until the game
    /// ends it.
    Swim,
    /// On a ladder. Entered by moving towards a [`Ladder`](super::Ladder), also out of water, and
    /// left with it; without a ladder it ends at once.
    Climb,
}
