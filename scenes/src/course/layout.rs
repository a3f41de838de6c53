//! Where things stand on the plaza and how large they are: what the generator builds and the
//! stations judge by. Metres and seconds.
//!
//! The plaza's top is at `y = 0`; an avenue runs along `z` through its middle. Every station has a
//! [`Place`]: its own axes, in which the walker starts at the origin and faces `-Z`.

pub mod driving;
mod features;

use bevy::prelude::*;

pub use features::*;

/// Half the width (x) and length (z) of the plaza.
pub const PLAZA_HALF: Vec2 = Vec2::new(32.0, 44.0);

/// The axes of a station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The origin, world.
    pub origin: Vec3,
    /// Which way the station's `-Z` points.
    pub heading: Heading,
}

/// A compass direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heading {
    /// `-Z`.
    #[default]
    North,
    /// `+X`.
    East,
    /// `-X`.
    West,
}

impl Place {
    /// Axes at this point of the plaza.
    pub const fn new(x: f32, z: f32, heading: Heading) -> Self {
        Self {
            origin: Vec3::new(x, 0.0, z),
            heading,
        }
    }

    /// A direction of the station in the world; exact.
    pub fn direction(&self, local: Vec3) -> Vec3 {
        match self.heading {
            Heading::North => local,
            Heading::East => Vec3::new(-local.z, local.y, local.x),
            Heading::West => Vec3::new(local.z, local.y, -local.x),
        }
    }

    /// A point of the station in the world.
    pub fn point(&self, local: Vec3) -> Vec3 {
        self.origin + self.direction(local)
    }

    /// A direction of the world in the station's axes; exact.
    pub fn local_direction(&self, world: Vec3) -> Vec3 {
        match self.heading {
            Heading::North => world,
            Heading::East => Vec3::new(world.z, world.y, -world.x),
            Heading::West => Vec3::new(-world.z, world.y, world.x),
        }
    }

    /// A point of the world in the station's axes.
    pub fn local_point(&self, world: Vec3) -> Vec3 {
        self.local_direction(world - self.origin)
    }

    /// A pose of the world in the station's axes.
    pub fn local_pose(&self, world: &Transform) -> Transform {
        Transform::from_translation(self.local_point(world.translation))
            .with_rotation(self.rotation().inverse() * world.rotation)
    }

    /// The rotation from the station's axes to the world.
    pub fn rotation(&self) -> Quat {
        use core::f32::consts::FRAC_PI_2;
        match self.heading {
            Heading::North => Quat::IDENTITY,
            Heading::East => Quat::from_rotation_y(-FRAC_PI_2),
            Heading::West => Quat::from_rotation_y(FRAC_PI_2),
        }
    }

    /// Pose of a thing of the station in the world.
    pub fn transform(&self, local: Vec3) -> Transform {
        Transform::from_translation(self.point(local)).with_rotation(self.rotation())
    }

    /// The same axes moved by this much, in the station's own axes.
    pub fn moved(&self, local: Vec3) -> Self {
        Self {
            origin: self.point(local),
            heading: self.heading,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_and_its_rotation_say_the_same() {
        for heading in [Heading::North, Heading::East, Heading::West] {
            let place = Place::new(3.0, -7.0, heading);
            let local = Vec3::new(1.0, 2.0, 5.0);
            let turned = place.rotation() * local;
            assert!(
                turned.distance(place.direction(local)) < 1e-5,
                "{heading:?}"
            );
            assert_eq!(place.local_point(place.point(local)), local);
        }
    }
}
