//! Cars on the ring roads of wavy ground: the scene in which the cost per vehicle is measured.
//!
//! Each tile of 100 m has eight rings, one car to 15 m of road, 100 cars in all. The cars of a ring
//! go at one speed, which changes every two seconds, so they brake and change gear, and one that a hill
//! slows down is caught up; rings beside each other turn in opposite ways and do not meet. The driver
//! steers for a point of the ring ahead.

use bevy::{
    math::{UVec2, ops},
    prelude::*,
};

use crate::terrain::{Waves, tiles_for, unit};

/// Cars on one tile.
pub const PER_TILE: u32 = 100;
/// Height of the lowest ground, metres.
pub const LOWEST: f32 = -GROUND.amplitude;
/// The ground, 8 degrees steep at most.
const GROUND: Waves = Waves {
    tile: 100.0,
    quads: 100,
    amplitude: 0.75,
    waves: 3.0,
};
/// Radius of a ring and how many cars are on it.
const RINGS: [(f32, u32); 8] = [
    (12.0, 5),
    (17.0, 7),
    (22.0, 9),
    (27.0, 11),
    (32.0, 14),
    (37.0, 16),
    (42.0, 18),
    (47.0, 20),
];
/// Centripetal acceleration of the slowest and the fastest leg, metres per second squared.
const SLOWEST: f32 = 1.0;
const FASTEST: f32 = 3.0;
/// Time between changes of speed, ticks of 1/60 s.
const LEG: u32 = 120;

/// The world of the cars.
#[derive(Clone, Copy, Debug)]
pub struct Traffic {
    tiles: UVec2,
}

impl Traffic {
    /// A world with room for this many cars.
    pub fn for_cars(count: u32) -> Self {
        Self {
            tiles: tiles_for(count, PER_TILE),
        }
    }

    /// Spawns the ground as one mesh.
    pub fn spawn_ground(&self, world: &mut World) {
        GROUND.spawn(world, self.tiles);
    }

    /// The driver of car `i`, and where its car starts: on its ring, heading along it, a little above
    /// the ground.
    pub fn driver(&self, i: u32) -> (Driver, Transform) {
        let mut place = i % PER_TILE;
        let mut ring = 0;
        while ring + 1 < RINGS.len() && place >= RINGS[ring].1 {
            place -= RINGS[ring].1;
            ring += 1;
        }
        let (radius, cars) = RINGS[ring];
        let driver = Driver {
            ring: i / PER_TILE * RINGS.len() as u32 + ring as u32,
            center: GROUND.middle(self.tiles, i / PER_TILE),
            radius,
            turn: if ring.is_multiple_of(2) { 1.0 } else { -1.0 },
            ticks: 0,
            throttle: 0.0,
            brake: 0.0,
            angle: 0.0,
            speed: 0.0,
        };
        let angle = core::f32::consts::TAU * place as f32 / cars as f32;
        let at = driver.point(angle);
        let ahead = driver.point(angle + 0.01 * driver.turn);
        // As high as the highest ground near it.
        let height = |offset: Vec2| GROUND.height(at.x + offset.x, at.y + offset.y);
        let top = [Vec2::ZERO, Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y]
            .map(|o| height(1.5 * o))
            .into_iter()
            .fold(f32::MIN, f32::max);
        let way = ahead - at;
        let start = Transform::from_xyz(at.x, top + 0.05, at.y)
            .looking_to(Vec3::new(way.x, 0.0, way.y), Vec3::Y);
        (driver, start)
    }
}

/// Somebody at the wheel. Ask it once per tick what to do.
#[derive(Component, Clone, Copy, Debug)]
pub struct Driver {
    ring: u32,
    center: Vec2,
    radius: f32,
    /// 1 with growing angle, −1 against it.
    turn: f32,
    ticks: u32,
    /// Accelerator, `0..=1`.
    pub throttle: f32,
    /// Brake, `0..=1`.
    pub brake: f32,
    /// Angle of the front wheels, radians, positive to the right.
    pub angle: f32,
    /// Speed that it wants, metres per second.
    pub speed: f32,
}

impl Driver {
    fn point(&self, angle: f32) -> Vec2 {
        let (sin, cos) = ops::sin_cos(angle);
        self.center + Vec2::new(cos, sin) * self.radius
    }

    /// Decides what to do in the tick that follows, from where the car is and how fast; `wheelbase`
    /// in metres.
    pub fn drive(&mut self, at: &Transform, velocity: Vec3, wheelbase: f32) {
        let leg = self.ticks / LEG;
        self.ticks += 1;
        let centripetal = SLOWEST + (FASTEST - SLOWEST) * unit(self.ring, leg, 7);
        self.speed = (centripetal * self.radius).sqrt();
        let speed = velocity.dot(*at.forward());
        // More would spin the wheels of a rear-driven car in a bend, and it would leave its ring.
        self.throttle = (0.4 * (self.speed - speed)).clamp(0.0, 0.55);
        self.brake = (0.15 * (speed - self.speed - 0.5)).clamp(0.0, 0.4);
        let place = Vec2::new(at.translation.x, at.translation.z) - self.center;
        let reach = 4.0 + 0.3 * speed.max(0.0);
        let ahead = ops::atan2(place.y, place.x) + self.turn * reach / self.radius;
        let target = self.point(ahead);
        let way = Vec3::new(target.x, 0.0, target.y) - at.translation.with_y(0.0);
        // The circle through the car, along its heading, that passes the target.
        let aside = way.dot(*at.right());
        let curvature = 2.0 * aside / way.length_squared().max(1.0);
        self.angle = ops::atan(wheelbase * curvature);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cars_of_a_tile_start_apart_from_each_other() {
        let traffic = Traffic::for_cars(100);
        let starts: Vec<Vec3> = (0..100).map(|i| traffic.driver(i).1.translation).collect();
        for (i, a) in starts.iter().enumerate() {
            for b in &starts[..i] {
                assert!((a - b).with_y(0.0).length() > 4.9, "{a} {b}");
            }
        }
    }

    #[test]
    fn a_driver_steers_towards_the_ring() {
        let (mut driver, start) = Traffic::for_cars(100).driver(0);
        let mut angle = |inward: f32| {
            let place = Vec3::new(start.translation.x, 0.0, start.translation.z);
            let mut at = start;
            at.translation -= place.normalize() * inward;
            driver.drive(&at, Vec3::ZERO, 2.6);
            driver.angle
        };
        // With growing angle a ring turns to the right.
        assert!(angle(2.0) < angle(0.0) && angle(0.0) < angle(-2.0));
        assert!(angle(0.0) > 0.0);
    }
}
