//! The proving ground: measures of the driving stations. Its ground is level with the plaza, its
//! lanes run north, `-Z`, from a line of starts in the south.

use bevy::{math::ops, prelude::*};

use super::{Heading, Place};

/// The middle of the oval on the ground.
pub const GROUND: Vec3 = Vec3::new(260.0, 0.0, -20.0);
/// From the oval's middle to the corners of the ground: west and north, east and south.
pub const GROUND_EXTENT: [Vec2; 2] = [Vec2::new(-206.0, -180.0), Vec2::new(66.0, 150.0)];

const fn lane(x: f32, z: f32) -> Place {
    Place::new(GROUND.x + x, GROUND.z + z, Heading::North)
}

/// Half the width of an ordinary lane.
pub const LANE: f32 = 3.0;

/// An oval with banked turns, driven with turns to the left.
pub mod oval {
    use super::*;

    /// Where it starts: on the line of the middle of the lane, in the middle of the eastern straight.
    pub const PLACE: Place = lane(INNER + 0.5 * WIDTH, 0.0);
    /// Radius of the inner edge of the turns.
    pub const INNER: f32 = 40.0;
    /// Length of a straight.
    pub const STRAIGHT: f32 = 140.0;
    /// Width of the surface, measured on it.
    pub const WIDTH: f32 = 12.0;
    /// Bank of the turns, degrees.
    pub const BANK: f32 = 30.0;
    /// Length on a straight over which the bank grows.
    const GROWTH: f32 = 50.0;
    /// Length of the inner edge.
    pub const LENGTH: f32 = 2.0 * STRAIGHT + core::f32::consts::TAU * INNER;

    /// A cross-section: a point of the inner edge, the direction of travel, and the bank in radians.
    #[derive(Clone, Copy, Debug)]
    pub struct Section {
        /// Relative to the middle of the oval.
        pub edge: Vec3,
        /// Unit length, level.
        pub ahead: Vec3,
        /// Radians.
        pub bank: f32,
    }

    impl Section {
        /// A point of the surface this far from the inner edge, relative to the middle of the oval.
        pub fn point(&self, across: f32) -> Vec3 {
            let (sin, cos) = ops::sin_cos(self.bank);
            self.edge + (self.ahead.cross(Vec3::Y) * cos + Vec3::Y * sin) * across
        }

        /// The normal of the surface.
        pub fn normal(&self) -> Vec3 {
            let (sin, cos) = ops::sin_cos(self.bank);
            Vec3::Y * cos - self.ahead.cross(Vec3::Y) * sin
        }
    }

    /// The cross-section after this length of the inner edge, from the start on.
    pub fn section(length: f32) -> Section {
        let half = 0.5 * STRAIGHT;
        let turn = core::f32::consts::PI * INNER;
        // Both halves are the same, turned about the middle.
        let along = length.rem_euclid(LENGTH);
        let (second, s) = if along >= 0.5 * LENGTH {
            (true, along - 0.5 * LENGTH)
        } else {
            (false, along)
        };
        let full = BANK.to_radians();
        let rise = |rest: f32| {
            let t = (1.0 - rest / GROWTH).clamp(0.0, 1.0);
            full * t * t * (3.0 - 2.0 * t)
        };
        let mut at = if s < half {
            Section {
                edge: Vec3::new(INNER, 0.0, -s),
                ahead: Vec3::NEG_Z,
                bank: rise(half - s),
            }
        } else if s < half + turn {
            let (sin, cos) = ops::sin_cos((s - half) / INNER);
            Section {
                edge: Vec3::new(INNER * cos, 0.0, -half - INNER * sin),
                ahead: Vec3::new(-sin, 0.0, -cos),
                bank: full,
            }
        } else {
            let s = s - half - turn;
            Section {
                edge: Vec3::new(-INNER, 0.0, -half + s),
                ahead: Vec3::Z,
                bank: rise(s),
            }
        };
        if second {
            at.edge = Vec3::new(-at.edge.x, at.edge.y, -at.edge.z);
            at.ahead = -at.ahead;
        }
        at
    }

    /// Radius of the turns on the line of the middle of the lane.
    pub fn radius() -> f32 {
        INNER + 0.5 * WIDTH * ops::cos(BANK.to_radians())
    }

    /// The speed at which the banked turn needs no side force.
    pub fn balanced_speed() -> f32 {
        ops::sqrt(9.81 * radius() * ops::tan(BANK.to_radians()))
    }

    /// The line of the middle of the lane in the axes of the place.
    pub fn middle_line() -> Vec<Vec3> {
        let pieces = 240;
        (0..=pieces + 6)
            .map(|i| {
                let section = section(LENGTH * i as f32 / pieces as f32);
                section.point(0.5 * WIDTH) + GROUND - PLACE.origin
            })
            .collect()
    }
}

/// A level disc with painted circles.
pub mod skid_pad {
    use super::*;

    /// Where it starts: on the middle circle, east of the middle, facing along it.
    pub const PLACE: Place = lane(CIRCLES[1], 42.0);
    /// Radii of the circles.
    pub const CIRCLES: [f32; 3] = [10.0, 20.0, 30.0];
    /// Radius of the disc.
    pub const RADIUS: f32 = 34.0;
    /// Its middle.
    pub const CENTER: Vec3 = Vec3::new(-CIRCLES[1], 0.0, 0.0);
}

/// A straight road with marks.
pub mod drag {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-66.0, 140.0);
    /// The finish.
    pub const LENGTH: f32 = 200.0;
    /// Distance of the marks.
    pub const MARK: f32 = 25.0;
    /// Where the road ends.
    pub const END: f32 = 310.0;
}

/// A loop: a band that turns faster towards its top, as roller coasters have it.
pub mod looping {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-84.0, 140.0);
    /// Length of the run-up.
    pub const RUN_UP: f32 = 190.0;
    /// Radius at its foot and at its top.
    pub const RADII: [f32; 2] = [18.0, 10.0];
    /// How far the way out lies beside the way in.
    pub const SHIFT: f32 = 7.0;
    /// Half its width.
    pub const HALF_WIDTH: f32 = 2.8;
    /// Number of straight pieces.
    pub const PIECES: usize = 216;

    fn curvature(turned: f32) -> f32 {
        let [foot, top] = RADII.map(|radius| 1.0 / radius);
        foot + (top - foot) * 0.5 * (1.0 - ops::cos(turned))
    }

    /// The middle line: points and directions up from the surface, in the axes of the place.
    pub fn line() -> Vec<(Vec3, Vec3)> {
        let mut at = Vec2::ZERO;
        let mut line = Vec::with_capacity(PIECES + 1);
        let step = core::f32::consts::TAU / PIECES as f32;
        for i in 0..=PIECES {
            let turned = step * i as f32;
            let t = i as f32 / PIECES as f32;
            let shift = SHIFT * t * t * (3.0 - 2.0 * t);
            let (sin, cos) = ops::sin_cos(turned);
            line.push((
                Vec3::new(shift, at.y, -RUN_UP - at.x),
                Vec3::new(0.0, cos, sin),
            ));
            // The middle of the piece stands for all of it.
            let middle = turned + 0.5 * step;
            let (sin, cos) = ops::sin_cos(middle);
            at += Vec2::new(cos, sin) * (step / curvature(middle));
        }
        line
    }

    /// Height of the top.
    pub fn height() -> f32 {
        line().iter().map(|(point, _)| point.y).fold(0.0, f32::max)
    }

    /// The least speed at the foot with which a body that is not driven stays on at the top.
    pub fn least_speed() -> f32 {
        ops::sqrt(9.81 * (RADII[1] + 2.0 * height()))
    }
}

/// A kicker, a gap and a landing.
pub mod jump {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-104.0, 140.0);
    /// Length of the run-up.
    pub const RUN_UP: f32 = 80.0;
    /// Radius of the kicker, and its angle at the lip in degrees.
    pub const RADIUS: f32 = 40.0;
    /// Degrees.
    pub const ANGLE: f32 = 12.0;
    /// Width of the gap.
    pub const GAP: f32 = 7.0;
    /// Angle of the landing, degrees.
    pub const LANDING: f32 = 8.0;

    /// Length and height of the kicker.
    pub fn lip() -> Vec2 {
        let (sin, cos) = ops::sin_cos(ANGLE.to_radians());
        Vec2::new(RADIUS * sin, RADIUS * (1.0 - cos))
    }

    /// Length of the landing.
    pub fn landing() -> f32 {
        lip().y / ops::tan(LANDING.to_radians())
    }
}

/// Brakes on wet ground and on ice.
pub mod ice {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-116.0, 140.0);
    /// From where to where the ground is wet.
    pub const WET: [f32; 2] = [45.0, 75.0];
    /// From where to where there is ice.
    pub const ICE: [f32; 2] = [120.0, 200.0];
    /// Friction of wet ground.
    pub const WET_FRICTION: f32 = 0.7;
    /// Friction of ice.
    pub const ICE_FRICTION: f32 = 0.1;
}

/// A ridge with a straight slope on either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hill {
    /// Angle, degrees.
    pub degrees: f32,
    /// Where its foot is.
    pub place: Place,
}

/// Radius of the foot and of the edge of a hill.
pub const HILL_RADIUS: f32 = 15.0;
/// Length of the straight slope, measured on it.
pub const HILL_SLOPE: f32 = 13.0;
/// Length of the level top.
pub const HILL_TOP: f32 = 10.0;
/// Half the width of a hill.
pub const HILL_HALF_WIDTH: f32 = 6.0;

impl Hill {
    fn angle(&self) -> (f32, f32) {
        ops::sin_cos(self.degrees.to_radians())
    }

    /// Length on the map from the foot to the top, and height of the top.
    pub fn top(&self) -> Vec2 {
        let (sin, cos) = self.angle();
        Vec2::new(
            2.0 * HILL_RADIUS * sin + HILL_SLOPE * cos,
            2.0 * HILL_RADIUS * (1.0 - cos) + HILL_SLOPE * sin,
        )
    }

    /// The middle of the straight slope: distance ahead and height.
    pub fn middle(&self) -> Vec2 {
        self.top() * 0.5
    }

    /// The outline of one side from foot to top: distance ahead and height.
    pub fn outline(&self) -> Vec<Vec2> {
        let top = self.top();
        let pieces = 10;
        let arc = |i: usize| {
            let (sin, cos) = ops::sin_cos((self.degrees * i as f32 / pieces as f32).to_radians());
            Vec2::new(HILL_RADIUS * sin, HILL_RADIUS * (1.0 - cos))
        };
        let mut line: Vec<Vec2> = (0..=pieces).map(arc).collect();
        line.extend((0..=pieces).rev().map(|i| top - arc(i)));
        line
    }
}

/// The hills.
pub fn hills() -> Vec<Hill> {
    [10.0, 20.0, 30.0, 40.0]
        .into_iter()
        .enumerate()
        .map(|(i, degrees)| Hill {
            degrees,
            place: lane(-136.0 - 15.0 * i as f32, 30.0),
        })
        .collect()
}

/// A kerb to drive over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kerb {
    /// Height.
    pub height: f32,
    /// Where its lane starts.
    pub place: Place,
}

/// Distance of a kerb from the start, and the length of what is behind it.
pub const KERB: [f32; 2] = [16.0, 12.0];

/// The kerbs.
pub fn kerbs() -> Vec<Kerb> {
    [0.05, 0.10, 0.15]
        .into_iter()
        .enumerate()
        .map(|(i, height)| Kerb {
            height,
            place: lane(-130.0 - 7.0 * i as f32, 140.0),
        })
        .collect()
}

/// Waves across the road.
pub mod washboard {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-153.0, 140.0);
    /// Distance of the first wave, and length of all of them.
    pub const WAVES: [f32; 2] = [20.0, 32.0];
    /// From crest to crest.
    pub const WAVE: f32 = 0.8;
    /// From trough to crest.
    pub const HEIGHT: f32 = 0.04;

    /// Height at a distance from the first wave.
    pub fn height(at: f32) -> f32 {
        0.5 * HEIGHT * (1.0 - ops::cos(core::f32::consts::TAU * at / WAVE))
    }
}

/// Loose stones.
pub mod rubble {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-162.0, 140.0);
    /// Distance of the first stones, and length of all of them.
    pub const FIELD: [f32; 2] = [14.0, 14.0];
    /// Number of stones.
    pub const STONES: usize = 36;
    /// Height of the largest one.
    pub const LARGEST: f32 = 0.18;

    /// Where a stone lies and its size.
    pub fn stone(i: usize) -> (Vec3, f32) {
        // Looks random and is not.
        let mixed = |n: usize| ((i * n + 17 * n) % 61) as f32 / 61.0;
        let size = 0.1 + (LARGEST - 0.1) * mixed(23);
        let row = i as f32 / STONES as f32;
        let x = -2.2 + 4.4 * mixed(37);
        (Vec3::new(x, 0.55 * size, -FIELD[0] - FIELD[1] * row), size)
    }
}

/// Planks that hang on hinges between two banks.
pub mod bridge {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-171.0, 140.0);
    /// Distance of the ramp, its length, and of the bank behind it.
    pub const RAMP: [f32; 3] = [10.0, 9.0, 3.0];
    /// Height of the banks.
    pub const HEIGHT: f32 = 1.6;
    /// Number of planks.
    pub const PLANKS: usize = 12;
    /// Size of a plank.
    pub const PLANK: Vec3 = Vec3::new(4.2, 0.16, 1.0);
    /// Mass of a plank.
    pub const MASS: f32 = 250.0;
    /// The heaviest vehicle that it is made for.
    pub const RATED: f32 = 5000.0;
    /// Distance at which the planks begin.
    pub const BEGIN: f32 = RAMP[0] + RAMP[1] + RAMP[2];
    /// Distance at which they end.
    pub const END: f32 = BEGIN + PLANKS as f32 * PLANK.z;
}

/// A board on a hinge that a vehicle tips.
pub mod car_seesaw {
    use super::*;

    /// Where it starts.
    pub const PLACE: Place = lane(-181.0, 140.0);
    /// Name of the board's node.
    pub const BOARD: &str = "car_seesaw.board";
    /// The hinge.
    pub const HINGE: Vec3 = Vec3::new(0.0, 0.75, -20.0);
    /// Width, thickness and length of the board.
    pub const SIZE: Vec3 = Vec3::new(4.2, 0.2, 11.0);
    /// Mass of the board.
    pub const MASS: f32 = 900.0;
    /// Greatest tilt, radians.
    pub const TILT: f32 = 0.1;
    /// Length of the ramps before and behind it.
    pub const RAMP: f32 = 3.0;

    /// Height of the top of the board's end when it is down.
    pub fn low_end() -> f32 {
        let (sin, cos) = ops::sin_cos(TILT);
        HINGE.y - 0.5 * SIZE.z * sin + 0.5 * SIZE.y * cos
    }
}

/// A deck that goes across water.
pub mod ferry {
    use super::*;

    /// Where it starts: on the deck.
    pub const PLACE: Place = lane(-14.0, -16.0);
    /// Name of its node.
    pub const NODE: &str = "ferry.deck";
    /// Width, thickness and length of the deck.
    pub const DECK: Vec3 = Vec3::new(6.0, 0.4, 13.0);
    /// Height of its top.
    pub const TOP: f32 = 1.0;
    /// How far it goes.
    pub const TRAVEL: f32 = 18.0;
    /// Speed.
    pub const SPEED: f32 = 3.0;
    /// Seconds of rest at either side.
    pub const WAIT: f32 = 5.0;
    /// Seconds in which it gets to its speed.
    pub const RAMP: f32 = 2.0;
    /// Seconds from one side to the other.
    pub const CROSSING: f32 = TRAVEL / SPEED + RAMP;
    /// Length of a dock and of its ramp.
    pub const DOCK: [f32; 2] = [6.0, 9.0];
    /// Gap between dock and deck.
    pub const GAP: f32 = 0.04;
}

/// A platform that lifts vehicles to a deck.
pub mod car_lift {
    use super::*;

    /// Where it starts: on the platform.
    pub const PLACE: Place = lane(16.0, -16.0);
    /// Name of its node.
    pub const NODE: &str = "car_lift.platform";
    /// Width, thickness and length.
    pub const SIZE: Vec3 = Vec3::new(4.6, 0.2, 11.0);
    /// Height of its top when it is down.
    pub const TOP: f32 = 0.2;
    /// How far it goes up.
    pub const TRAVEL: f32 = 3.0;
    /// Speed.
    pub const SPEED: f32 = 1.0;
    /// Seconds of rest at either end.
    pub const WAIT: f32 = 4.0;
    /// Seconds in which it gets to its speed.
    pub const RAMP: f32 = 0.5;
    /// Seconds from one end to the other.
    pub const RISE: f32 = TRAVEL / SPEED + RAMP;
    /// Length of the deck above and of the ramp down from it.
    pub const DECK: [f32; 2] = [6.0, 16.0];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oval_closes_and_its_middle_line_has_no_corners() {
        let line = oval::middle_line();
        assert!(line[0].distance(Vec3::ZERO) < 1e-3, "{}", line[0]);
        assert!(line[240].distance(line[0]) < 1e-2);
        for points in line.windows(3) {
            let turn = (points[1] - points[0]).angle_between(points[2] - points[1]);
            assert!(turn < 0.08, "{points:?}");
        }
    }

    #[test]
    fn the_loop_comes_back_to_the_ground() {
        let line = looping::line();
        let (end, up) = line[looping::PIECES];
        assert!(end.y.abs() < 0.05 && up.distance(Vec3::Y) < 1e-3, "{end}");
        assert!((end.x - looping::SHIFT).abs() < 1e-4);
        assert!(looping::height() > 2.0 * looping::RADII[1]);
    }
}
