//! What a scripted walker does: a list of small steps in the station's axes.

use bevy::prelude::*;
use bevy_embody::character::Stance;

/// One thing that a walker does until it is done.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Walks straight towards a point of the map.
    Walk {
        /// Where to, metres; its height is not looked at.
        to: Vec3,
        /// How near counts as there, metres on the map.
        within: f32,
        /// How much of the asked movement is upwards, for ladders and water.
        up: f32,
        /// Gives up after this long, seconds.
        timeout: f32,
    },
    /// Walks in a direction for a time, whatever comes of it.
    Hold {
        /// The direction; its length is the fraction of full speed.
        movement: Vec3,
        /// How long, seconds.
        seconds: f32,
    },
    /// Walks straight on along a great circle of a planet.
    Orbit {
        /// Axis of the circle through the planet's middle, unit length.
        axis: Vec3,
        /// How far round, radians.
        angle: f32,
        /// Middle of the planet, metres.
        center: Vec3,
        /// Gives up after this long, seconds.
        timeout: f32,
    },
    /// Does nothing for a time, seconds.
    Wait(f32),
    /// Presses jump and waits, seconds.
    Jump(f32),
    /// Asks for a stance from now on; takes no time.
    Take(Stance),
    /// Is put somewhere at rest; takes no time.
    Place(Vec3),
}

impl Step {
    /// Walks to a point within 0.3 m of it.
    pub fn walk(to: Vec3, timeout: f32) -> Self {
        Self::Walk {
            to,
            within: 0.3,
            up: 0.0,
            timeout,
        }
    }

    /// Walks ahead at full speed for a time, seconds.
    pub fn ahead(seconds: f32) -> Self {
        Self::Hold {
            movement: Vec3::NEG_Z,
            seconds,
        }
    }

    /// What it does, for a reader.
    pub fn describe(&self) -> String {
        match self {
            Self::Walk { to, timeout, .. } => {
                format!("walk to ({:.1}, {:.1}) within {timeout:.1} s", to.x, to.z)
            }
            Self::Hold { movement, seconds } => {
                format!(
                    "walk along ({:.2}, {:.2}) for {seconds:.1} s",
                    movement.x, movement.z
                )
            }
            Self::Orbit { angle, timeout, .. } => format!(
                "go {:.0} degrees round within {timeout:.1} s",
                angle.to_degrees()
            ),
            Self::Wait(seconds) => format!("wait {seconds:.1} s"),
            Self::Jump(_) => "jump".into(),
            Self::Take(stance) => format!("take the stance {stance:?}"),
            Self::Place(at) => format!("be put at ({:.1}, {:.1}, {:.1})", at.x, at.y, at.z),
        }
    }
}
