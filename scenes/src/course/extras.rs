//! What a node of a level says about its physics: the JSON under `"embody"` in its glTF `extras`.
//!
//! The generator writes these types and the loader reads them, so the two cannot drift apart. All
//! lengths are metres, all axes the node's own unless a field says otherwise.

use serde::{Deserialize, Serialize};

/// The key in a node's `extras` under which everything below is found.
pub const EXTRAS_KEY: &str = "embody";

/// The physics of a node. A node without any of it is only looked at.
#[derive(Serialize, Deserialize, Clone, Debug, Default, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct NodeExtras {
    /// Shape of the collider; none leaves the node without a body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub collider: Option<ColliderSpec>,
    /// How the body moves.
    #[serde(skip_serializing_if = "BodyKind::is_fixed")]
    pub body: BodyKind,
    /// Mass of a dynamic body, kilograms.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mass: Option<f32>,
    /// Coulomb friction coefficient; where two bodies meet the smaller one holds.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<f32>,
    /// Friction for tyres, 1 on dry asphalt; none leaves it at that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub road: Option<f32>,
    /// How a kinematic body moves with time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion: Option<Motion>,
    /// Velocity of the surface of a conveyor, metres per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub conveyor: Option<[f32; 3]>,
    /// The collider is a volume of water that flows this fast, metres per second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub water: Option<[f32; 3]>,
    /// The collider is the space in front of a ladder; `+Z` points to the climber.
    #[serde(skip_serializing_if = "is_false")]
    pub ladder: bool,
    /// The node is a planet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planet: Option<PlanetSpec>,
    /// The body turns about a hinge on another node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hinge: Option<Hinge>,
    /// The node's pose is where the walker or the vehicle of this station starts, its lowest point
    /// first, facing `-Z`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub station: Option<String>,
}

fn is_false(value: &bool) -> bool {
    !value
}

#[expect(
    clippy::trivially_copy_pass_by_ref,
    reason = "serde asks for a reference"
)]
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

fn is_origin(point: &[f32; 3]) -> bool {
    *point == [0.0; 3]
}

/// The shape of a collider, centred on the node's origin where it is not a mesh.
#[derive(Serialize, Deserialize, Clone, Debug, PartialEq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum ColliderSpec {
    /// A box.
    Box {
        /// Full width, height and depth.
        size: [f32; 3],
    },
    /// A ball.
    Ball {
        /// Radius.
        radius: f32,
    },
    /// An upright cylinder.
    Cylinder {
        /// Full height.
        height: f32,
        /// Radius.
        radius: f32,
    },
    /// The triangles of the node's mesh.
    Trimesh,
    /// The convex hull of the node's mesh.
    Convex,
    /// Cubes on a grid.
    Voxels {
        /// Edge of a cube.
        size: f32,
        /// Columns of filled cubes: grid x, grid z, and how many from grid y = 0 upwards.
        columns: Vec<[i32; 3]>,
    },
}

/// How a body moves.
#[derive(Serialize, Deserialize, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum BodyKind {
    /// It does not.
    #[default]
    Fixed,
    /// As its [`Motion`] says.
    Kinematic,
    /// As forces say.
    Dynamic,
}

impl BodyKind {
    fn is_fixed(&self) -> bool {
        *self == Self::Fixed
    }
}

/// A motion as an exact function of time, starting from the node's pose.
#[derive(Serialize, Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Motion {
    /// To and fro on a straight line at constant speed: waits, goes, waits, comes back.
    Shuttle {
        /// From one end to the other, in the axes of the node's parent.
        travel: [f32; 3],
        /// Speed, metres per second.
        speed: f32,
        /// Seconds of rest at the start of each cycle.
        wait_near: f32,
        /// Seconds of rest at the other end.
        wait_far: f32,
        /// Seconds in which it gets to its speed, and in which it comes to rest.
        #[serde(default, skip_serializing_if = "is_zero")]
        ramp: f32,
    },
    /// Round and round.
    Turn {
        /// The axis through the node's origin.
        axis: [f32; 3],
        /// Turns per second, counter-clockwise about the axis.
        rate: f32,
    },
}

/// A round body that has a gravity of its own.
#[derive(Serialize, Deserialize, Clone, Copy, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PlanetSpec {
    /// Gravity towards the node's origin, metres per second squared.
    pub gravity: f32,
    /// Distance from the origin within which it acts.
    pub reach: f32,
}

/// A hinge.
#[derive(Serialize, Deserialize, Clone, Debug, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Hinge {
    /// Name of the node that carries it.
    pub on: String,
    /// Where the hinge is on that node.
    #[serde(default, skip_serializing_if = "is_origin")]
    pub on_anchor: [f32; 3],
    /// Where the hinge is on this node.
    pub anchor: [f32; 3],
    /// Its axis.
    pub axis: [f32; 3],
    /// Greatest turn to either side, radians.
    pub limit: f32,
}
