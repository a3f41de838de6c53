//! What a character is made of: size, slope and step limits, strength.
//!
//! Everything here is plain data that can change at any time; a change acts from the next tick on.

use bevy::prelude::*;
use bevy_rapier3d::prelude::RigidBody;

use super::{
    body::CharacterBody,
    intent::CharacterIntent,
    motor::CharacterMotor,
    output::{CharacterContacts, CharacterSnapshot},
    report::{CharacterMemory, CharacterReport},
    state::CharacterState,
};

/// A kinematic character: add it to an entity with a [`Transform`] and it stands, walks and falls.
///
/// The entity's origin is the **foot**: a character at `y = 0` stands on a floor whose top is at
/// `y = 0`. Its local `+Y` is its up axis.
///
/// What it should do is asked through [`CharacterIntent`]; what it does is in [`CharacterState`].
/// The [`CharacterMotor`] turns the one into velocity; add [`CustomMotor`](super::CustomMotor) to
/// write [`CharacterState::velocity`] yourself.
///
/// A value out of its range is refused with one warning; the character then stays where it is
/// until the value is mended.
///
/// It gets a collider a little smaller than its shape, for others to meet. A collider of the game's
/// own is left as it is: the solver moves by [`Self::shape`] all the same, so the collider is only
/// what bodies and queries find, and it does not follow the stance.
///
/// Without this component it is a character no more: outputs and the collider made for it go, its
/// [`CharacterState`] and its [`RigidBody`] stay for who takes over. While it has a
/// [`RigidBodyDisabled`](bevy_rapier3d::prelude::RigidBodyDisabled) nothing happens to it.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(
    CharacterIntent,
    CharacterMotor,
    CharacterState,
    CharacterContacts,
    CharacterSnapshot,
    CharacterBody,
    CharacterReport,
    CharacterMemory,
    Transform,
    RigidBody::KinematicPositionBased
)]
pub struct Character {
    /// Outline when standing.
    pub shape: CharacterShape,
    /// Total height when crouched, metres. Lower than a capsule's two radii it is raised to them;
    /// higher than the standing height it has no effect.
    pub crouch_height: f32,
    /// Steepest ground that can be stood on and walked up, radians from level, `0..=π/2`.
    /// At 0 only level ground holds; at π/2 everything below a vertical wall does.
    pub max_slope: f32,
    /// What the speed asked for means on a slope.
    pub slope_speed: SlopeSpeed,
    /// Climbing of stairs; `None` leaves it out.
    pub step: Option<StepConfig>,
    /// How far below the foot ground is looked for to stay on it when walking down, metres.
    /// 0 lets the character fly off every crest; more than the step height lets it walk down
    /// stairs that it cannot climb.
    pub ground_snap: f32,
    /// Greatest speed at which an overlap is undone, metres per second. At 0 a character that
    /// starts inside something stays there; at infinity it jumps out in one tick.
    pub recovery_speed: f32,
    /// Mass, kilograms, above 0: its weight on what it stands on, and its share when bodies run into
    /// it. Near 0 every body takes it along and none feels its weight; very large nothing that is
    /// loose moves it, and seesaws and rafts go down at once.
    pub mass: f32,
    /// Greatest force with which it pushes dynamic bodies aside, newtons. At 0 every body is a wall;
    /// at infinity a body of any mass is brought to the character's speed within a tick, as far as
    /// what is behind it lets it.
    pub push_strength: f32,
    /// Whether dynamic bodies that run into it push it, according to their mass.
    pub pushed_by_bodies: bool,
    /// What is kept of a platform's velocity on leaving it.
    pub leave_velocity: LeaveVelocity,
    /// Whether a turning platform turns the character with it.
    pub turn_with_platform: bool,
    /// Whether the character's weight acts on dynamic bodies it stands on.
    pub weighs_on_ground: bool,
    /// Time constant with which [`CharacterState::view_offset`] smooths steps, seconds; 0 leaves
    /// every step visible at once; above some tenths of a second the view lags behind on stairs.
    /// Finite.
    pub step_smoothing: f32,
}

impl Default for Character {
    fn default() -> Self {
        Self {
            shape: CharacterShape::default(),
            crouch_height: 1.0,
            max_slope: 50f32.to_radians(),
            slope_speed: SlopeSpeed::default(),
            step: Some(StepConfig::default()),
            ground_snap: 0.4,
            recovery_speed: 3.0,
            mass: 70.0,
            push_strength: 500.0,
            pushed_by_bodies: true,
            leave_velocity: LeaveVelocity::default(),
            turn_with_platform: true,
            weighs_on_ground: true,
            step_smoothing: 0.08,
        }
    }
}

impl Character {
    /// A capsule of this radius and total height, metres.
    pub fn capsule(radius: f32, height: f32) -> Self {
        Self {
            shape: CharacterShape::Capsule { radius, height },
            ..default()
        }
    }

    /// An upright cylinder of this radius and height, metres.
    pub fn cylinder(radius: f32, height: f32) -> Self {
        Self {
            shape: CharacterShape::Cylinder { radius, height },
            ..default()
        }
    }

    /// A box of this width (x), height (y) and depth (z), metres.
    pub fn cuboid(width: f32, height: f32, depth: f32) -> Self {
        Self {
            shape: CharacterShape::Box {
                size: Vec3::new(width, height, depth),
            },
            ..default()
        }
    }
}

/// The outline of a standing character; its lowest point is the entity's origin.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum CharacterShape {
    /// Round bottom and top: the fastest, and the smoothest over edges.
    Capsule {
        /// Radius, metres, above 0.
        radius: f32,
        /// Total height, metres, at least two radii.
        height: f32,
    },
    /// Flat bottom and top: stands on edges without sliding off.
    Cylinder {
        /// Radius, metres, above 0.
        radius: f32,
        /// Total height, metres, above 0.
        height: f32,
    },
    /// A box that turns with the entity.
    Box {
        /// Width, height and depth, metres, each above 0.
        size: Vec3,
    },
    /// The convex hull of these points, metres, relative to the foot. Each query costs in proportion
    /// to the points on the hull: some dozens are fast, some hundreds are slow in a crowd.
    ConvexHull {
        /// At least four points that span a volume. The lowest is taken to the height of the foot.
        points: Vec<Vec3>,
    },
}

impl Default for CharacterShape {
    fn default() -> Self {
        Self::Capsule {
            radius: 0.3,
            height: 1.8,
        }
    }
}

impl CharacterShape {
    /// Total height when standing, metres.
    pub fn height(&self) -> f32 {
        match self {
            Self::Capsule { height, .. } | Self::Cylinder { height, .. } => *height,
            Self::Box { size } => size.y,
            Self::ConvexHull { points } => {
                let (low, high) = points.iter().fold((f32::MAX, f32::MIN), |(low, high), p| {
                    (low.min(p.y), high.max(p.y))
                });
                (high - low).max(0.0)
            }
        }
    }

    /// Largest horizontal distance of the outline from the axis, metres.
    pub fn radius(&self) -> f32 {
        match self {
            Self::Capsule { radius, .. } | Self::Cylinder { radius, .. } => *radius,
            Self::Box { size } => Vec2::new(size.x, size.z).length() * 0.5,
            Self::ConvexHull { points } => points
                .iter()
                .map(|p| Vec2::new(p.x, p.z).length())
                .fold(0.0, f32::max),
        }
    }
}

/// Climbing of stairs and kerbs.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct StepConfig {
    /// Highest step that is climbed, metres, measured along up from the foot.
    pub height: f32,
    /// Depth of walkable ground that must lie behind the edge, metres. At 0 any ledge is climbed,
    /// however narrow; above the depth of a stair's treads the stair becomes a wall.
    pub min_width: f32,
    /// Whether dynamic bodies are stepped onto.
    pub onto_dynamic: bool,
}

impl Default for StepConfig {
    fn default() -> Self {
        Self {
            height: 0.4,
            min_width: 0.1,
            onto_dynamic: false,
        }
    }
}

/// What a speed asked for means on a slope.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum SlopeSpeed {
    /// The speed along the ground: a 45° ramp takes √2 times as long per metre of map.
    #[default]
    AlongGround,
    /// The speed on the map: a ramp takes as long as level ground.
    Horizontal,
}

/// What is kept of a platform's velocity on leaving it, by a jump or a step. From one ground onto
/// another it is the difference of their velocities that is kept or not.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum LeaveVelocity {
    /// Nothing.
    None,
    /// All of it, as physics has it.
    #[default]
    Full,
    /// Its upward part only, and that only when it is upward.
    UpOnly,
}
