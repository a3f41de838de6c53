//! The stations' measures.

use bevy::{math::ops, prelude::*};

use super::{Heading, Place};

/// The walk down the avenue.
pub const PLAZA: Place = Place::new(0.0, 38.0, Heading::North);
/// How far it is.
pub const PLAZA_WALK: f32 = 25.0;

/// A straight flight of stairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Name of its station.
    pub name: String,
    /// Where it is; the first riser is at `z = -APPROACH`.
    pub place: Place,
    /// Height of a step.
    pub rise: f32,
    /// Depth of a step.
    pub tread: f32,
    /// Number of steps.
    pub steps: usize,
    /// Whether each step is a box of its own; otherwise the flight is one mesh.
    pub boxes: bool,
}

/// Distance from the start of a station to the thing itself, where there is no reason for another.
pub const APPROACH: f32 = 3.0;
/// Height of the top of all stairs.
pub const STAIR_TOP: f32 = 3.0;
/// Width of a flight.
pub const STAIR_WIDTH: f32 = 2.6;
/// Depth of the landing that the flights share.
pub const STAIR_LANDING: f32 = 3.5;
/// Distance of neighbouring flights.
pub const STAIR_SPACING: f32 = 3.2;
/// World `x` at which all flights end.
pub const STAIR_TOP_X: f32 = -14.0;

impl Flight {
    /// Length on the map.
    pub fn run(&self) -> f32 {
        self.tread * self.steps as f32
    }

    /// Length along the edges of the steps.
    pub fn pitch_line(&self) -> f32 {
        ops::hypot(self.run(), STAIR_TOP)
    }
}

/// The straight flights.
pub fn flights() -> Vec<Flight> {
    [
        (0.2, 0.25, true),
        (0.2, 0.4, false),
        (0.3, 0.25, false),
        (0.3, 0.4, true),
    ]
    .into_iter()
    .enumerate()
    .map(|(i, (rise, tread, boxes))| {
        let steps = ops::round(STAIR_TOP / rise) as usize;
        let start = STAIR_TOP_X + tread * steps as f32 + APPROACH;
        Flight {
            name: format!("stairs_{:02.0}_{:02.0}", rise * 100.0, tread * 100.0),
            place: Place::new(start, 41.0 - STAIR_SPACING * i as f32, Heading::West),
            rise,
            tread,
            steps,
            boxes,
        }
    })
    .collect()
}

/// A spiral stair; it turns left, its first riser is straight ahead of the walker.
pub mod spiral {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(-6.0, 25.0, Heading::West);
    /// The axis.
    pub const CENTER: Vec3 = Vec3::new(-1.4, 0.0, -4.0);
    /// Radius of the column.
    pub const COLUMN: f32 = 0.35;
    /// Outer radius of the treads.
    pub const OUTER: f32 = 2.3;
    /// Radius of the walking line.
    pub const WALK: f32 = 1.4;
    /// Height of a step.
    pub const RISE: f32 = 0.2;
    /// Angle of a step, degrees.
    pub const STEP_DEGREES: f32 = 20.0;
    /// Number of steps; the last is drawn out to the full circle as a landing.
    pub const STEPS: usize = 15;

    /// A point on a circle about the axis, `degrees` after the first riser.
    pub fn on_circle(radius: f32, degrees: f32, height: f32) -> Vec3 {
        let (sin, cos) = ops::sin_cos(degrees.to_radians());
        CENTER + Vec3::new(radius * cos, height, -radius * sin)
    }
}

/// A straight ramp.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    /// Name of its station.
    pub name: String,
    /// Where it is; it begins at `z = -APPROACH`.
    pub place: Place,
    /// Angle from level, degrees.
    pub degrees: f32,
    /// Length on the map.
    pub run: f32,
    /// Height of its top.
    pub top: f32,
}

/// Width of a ramp.
pub const RAMP_WIDTH: f32 = 2.0;
/// Depth of the landing behind a ramp.
pub const RAMP_LANDING: f32 = 2.5;

impl Ramp {
    /// Angle from level, radians.
    pub fn angle(&self) -> f32 {
        self.degrees.to_radians()
    }

    /// Where the foot of a capsule of this radius is when it touches the ramp at height `y`.
    pub fn capsule_on(&self, radius: f32, y: f32) -> Vec3 {
        let (sin, cos) = ops::sin_cos(self.angle());
        let touch = Vec3::new(0.0, y, -APPROACH - y * cos / sin);
        touch + Vec3::new(0.0, cos, sin) * radius - Vec3::Y * radius
    }
}

/// The ramps.
pub fn ramps() -> Vec<Ramp> {
    [5.0f32, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0]
        .into_iter()
        .enumerate()
        .map(|(i, degrees)| {
            let slope = ops::tan(degrees.to_radians());
            let run = (4.0 / slope).min(6.0);
            Ramp {
                name: format!("ramp_{degrees:02.0}"),
                place: Place::new(-5.0, 19.5 - 2.4 * i as f32, Heading::West),
                degrees,
                run,
                top: run * slope,
            }
        })
        .collect()
}

/// Two walls that meet.
#[derive(Clone, Debug, PartialEq)]
pub struct Corner {
    /// Name of its station.
    pub name: String,
    /// Where it is.
    pub place: Place,
    /// Angle between the walls, degrees.
    pub degrees: f32,
    /// Whether the walls are one mesh; otherwise two boxes.
    pub mesh: bool,
}

/// Where the walls of a corner meet.
pub const CORNER_APEX: Vec3 = Vec3::new(0.0, 0.0, -5.0);
/// Length and height of the walls of a corner.
pub const CORNER_WALL: Vec2 = Vec2::new(2.2, 2.2);

/// The corners.
pub fn corners() -> Vec<Corner> {
    [30.0, 60.0, 90.0, 120.0, 150.0]
        .into_iter()
        .enumerate()
        .map(|(i, degrees)| Corner {
            name: format!("corner_{degrees:03.0}"),
            place: Place::new(5.0, 40.0 - 5.0 * i as f32, Heading::East),
            degrees,
            mesh: i % 2 == 1,
        })
        .collect()
}

/// A pit between walls too steep to stand on.
#[derive(Clone, Debug, PartialEq)]
pub struct Funnel {
    /// Name of its station.
    pub name: String,
    /// Where it is; the walker starts in the air above it.
    pub place: Place,
    /// Number of walls: 2 make a trough along the heading.
    pub walls: usize,
}

impl Funnel {
    /// Where the walker starts: above the walls, not quite in the middle.
    pub fn start(&self) -> Vec3 {
        Vec3::new(0.12, FUNNEL_DROP, 0.07)
    }
}

/// Distance of the rim of a funnel from its middle.
pub const FUNNEL_RIM: f32 = 1.0;
/// Angle of the walls from level, degrees.
pub const FUNNEL_DEGREES: f32 = 65.0;
/// Height of the deepest point.
pub const FUNNEL_BOTTOM: f32 = 0.2;
/// Height from which the walker falls.
pub const FUNNEL_DROP: f32 = 3.2;

/// The funnels.
pub fn funnels() -> Vec<Funnel> {
    [2, 3, 4]
        .into_iter()
        .enumerate()
        .map(|(i, walls)| Funnel {
            name: format!("funnel_{walls}"),
            place: Place::new(17.5 + 4.5 * i as f32, 22.0, Heading::North),
            walls,
        })
        .collect()
}

/// Wavy ground of small triangles.
pub mod terrain {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(-5.0, -9.0, Heading::West);
    /// Its middle.
    pub const CENTER: Vec3 = Vec3::new(0.0, 0.0, -11.0);
    /// Half its width and length.
    pub const HALF: f32 = 9.0;
    /// Number of squares along a side; each is two triangles.
    pub const SQUARES: usize = 60;
    /// Height of its border above the plaza.
    pub const BORDER: f32 = 0.02;

    /// Height at a point relative to the middle.
    pub fn height(x: f32, z: f32) -> f32 {
        let edge = |v: f32| {
            let t = ((HALF - v.abs()) / 2.5).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let waves = 0.55
            + 0.30 * ops::sin(0.9 * x + 0.4) * ops::cos(0.7 * z)
            + 0.16 * ops::sin(1.7 * z - 0.6 * x)
            + 0.07 * ops::sin(2.9 * x + 1.3) * ops::sin(2.3 * z);
        BORDER + edge(x) * edge(z) * waves
    }

    /// Height of the triangles at a point relative to the middle, not outside of it.
    pub fn mesh_height(x: f32, z: f32) -> f32 {
        let spacing = 2.0 * HALF / SQUARES as f32;
        let at = |v: f32| {
            let squares = (v + HALF) / spacing;
            let square = ops::floor(squares).clamp(0.0, SQUARES as f32 - 1.0);
            (square, squares - square)
        };
        let ((column, u), (row, v)) = (at(x), at(z));
        let corner =
            |i: f32, k: f32| height(-HALF + spacing * (column + i), -HALF + spacing * (row + k));
        let (b, c) = (corner(1.0, 0.0), corner(0.0, 1.0));
        if u + v <= 1.0 {
            let a = corner(0.0, 0.0);
            a + u * (b - a) + v * (c - a)
        } else {
            let d = corner(1.0, 1.0);
            d + (1.0 - u) * (c - d) + (1.0 - v) * (b - d)
        }
    }
}

/// A wood of round pillars.
pub mod pillars {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(15.0, 35.0, Heading::East);
    /// Radius of a pillar.
    pub const RADIUS: f32 = 0.35;
    /// Height of a pillar.
    pub const HEIGHT: f32 = 2.6;
    /// Where the walker wants to get.
    pub const GOAL: Vec3 = Vec3::new(0.0, 0.0, -12.5);

    /// The middles of their feet.
    pub fn all() -> Vec<Vec3> {
        let mut all = Vec::new();
        for row in 0..5 {
            for column in 0..5 {
                let shift = if row % 2 == 0 { 0.3 } else { 1.1 };
                all.push(Vec3::new(
                    -3.6 + 1.6 * column as f32 + shift,
                    0.0,
                    -3.0 - 1.8 * row as f32,
                ));
            }
        }
        all
    }
}

/// A tunnel too low to stand in.
pub mod crawl {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(5.0, 14.5, Heading::East);
    /// Height inside.
    pub const HEIGHT: f32 = 1.1;
    /// Width inside.
    pub const WIDTH: f32 = 1.4;
    /// Length.
    pub const LENGTH: f32 = 4.0;
    /// Thickness of walls and roof.
    pub const WALL: f32 = 0.3;
}

/// A ladder to a ledge.
pub mod ladder {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(5.0, 10.0, Heading::East);
    /// Height of the ledge.
    pub const LEDGE: f32 = 4.0;
    /// Width and depth of the tower.
    pub const TOWER: f32 = 3.0;
    /// Width of the ladder.
    pub const WIDTH: f32 = 0.8;
    /// How far the space in front of the rungs reaches out.
    pub const REACH: f32 = 0.7;
    /// How far it reaches above the ledge.
    pub const ABOVE: f32 = 0.3;
}

/// A belt that carries away from the walker.
pub mod conveyor {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(5.0, 5.5, Heading::East);
    /// Speed of the belt.
    pub const SPEED: f32 = 2.0;
    /// Length.
    pub const LENGTH: f32 = 12.0;
    /// Width.
    pub const WIDTH: f32 = 2.0;
    /// Height of its top.
    pub const TOP: f32 = 0.2;
}

/// A platform that goes to and fro.
#[derive(Clone, Debug, PartialEq)]
pub struct Lift {
    /// Name of its station.
    pub name: String,
    /// Name of its node.
    pub node: String,
    /// Where it is.
    pub place: Place,
    /// Speed.
    pub speed: f32,
    /// From the near end to the far end.
    pub travel: Vec3,
}

/// The middle of a lift's top at its near end.
pub const LIFT_TOP: Vec3 = Vec3::new(0.0, 0.15, -APPROACH);
/// Width and depth of a lift.
pub const LIFT_SIZE: f32 = 2.2;
/// Thickness of a lift's platform; it does not reach the ground.
pub const LIFT_THICK: f32 = 0.12;
/// Seconds that a lift waits at its near end; at the far end it turns at once.
pub const LIFT_WAIT: f32 = 2.0;

impl Lift {
    fn new(name: &str, z: f32, speed: f32, travel: Vec3) -> Self {
        Self {
            name: name.into(),
            node: format!("{name}.platform"),
            place: Place::new(5.0, z, Heading::East),
            speed,
            travel,
        }
    }

    /// Seconds from one end to the other.
    pub fn one_way(&self) -> f32 {
        self.travel.length() / self.speed
    }
}

/// The lifts, and the platform that goes up at an angle.
pub fn lifts() -> Vec<Lift> {
    vec![
        Lift::new("lift_slow", 1.0, 0.5, Vec3::Y * 3.0),
        Lift::new("lift", -2.5, 1.0, Vec3::Y * 3.0),
        Lift::new("lift_fast", -6.0, 3.0, Vec3::Y * 6.0),
        Lift::new("diagonal", -9.5, 2.0, Vec3::new(0.0, 3.0, -4.0)),
    ]
}

/// A round platform that turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Turntable {
    /// Name of its station.
    pub name: String,
    /// Name of its node.
    pub node: String,
    /// Where it is; the walker starts on it.
    pub place: Place,
    /// Radius.
    pub radius: f32,
    /// Turns per second.
    pub rate: f32,
}

/// Height of a turntable's top.
pub const TABLE_TOP: f32 = 0.2;
/// Distance of the walker from the axis, as a part of the radius.
pub const TABLE_STAND: f32 = 0.6;

impl Turntable {
    /// Where the walker starts.
    pub fn start(&self) -> Vec3 {
        Vec3::new(0.0, TABLE_TOP, TABLE_STAND * self.radius)
    }
}

/// The turntables.
pub fn turntables() -> Vec<Turntable> {
    [
        ("turntable", 10.0, 2.8, 0.25),
        ("turntable_fast", 17.5, 2.2, 1.0),
    ]
    .into_iter()
    .map(|(name, x, radius, rate)| Turntable {
        name: name.into(),
        node: format!("{name}.table"),
        place: Place::new(x, -15.5, Heading::East),
        radius,
        rate,
    })
    .collect()
}

/// A board on a hinge.
pub mod seesaw {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(5.0, -21.0, Heading::East);
    /// Name of the board's node.
    pub const BOARD: &str = "seesaw.board";
    /// The hinge.
    pub const HINGE: Vec3 = Vec3::new(0.0, 0.8, -6.5);
    /// Length, thickness and width of the board.
    pub const SIZE: Vec3 = Vec3::new(1.6, 0.12, 5.0);
    /// Mass of the board.
    pub const MASS: f32 = 60.0;
    /// Greatest tilt, radians.
    pub const TILT: f32 = 0.2;
    /// How far the block before the board is higher than the board's lowered end.
    pub const DROP: f32 = 0.02;

    /// Height of the top of the board's end when it is down.
    pub fn low_end() -> f32 {
        let (sin, cos) = ops::sin_cos(TILT);
        HINGE.y - 0.5 * SIZE.z * sin + 0.5 * SIZE.y * cos
    }
}

/// A box to push.
#[derive(Clone, Debug, PartialEq)]
pub struct Crate {
    /// Name of its station.
    pub name: String,
    /// Name of its node.
    pub node: String,
    /// Where its lane is.
    pub place: Place,
    /// Mass, kilograms.
    pub mass: f32,
    /// Edge.
    pub size: f32,
}

/// Friction coefficient between a crate and the plaza.
pub const CRATE_FRICTION: f32 = 0.3;

/// The crates.
pub fn crates() -> Vec<Crate> {
    [(1.0, 0.5), (10.0, 0.65), (100.0, 0.9), (1000.0, 1.2)]
        .into_iter()
        .enumerate()
        .map(|(i, (mass, size))| Crate {
            name: format!("crate_{mass}"),
            node: format!("crate_{mass}.crate"),
            place: Place::new(5.0, -26.0 - 2.6 * i as f32, Heading::East),
            mass,
            size,
        })
        .collect()
}

impl Crate {
    /// The middle of the crate.
    pub fn center(&self) -> Vec3 {
        Vec3::new(0.0, 0.5 * self.size, -APPROACH - 0.5 * self.size)
    }
}

/// A hill of cubes.
pub mod voxels {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(-5.0, -36.5, Heading::West);
    /// The middle of its foot.
    pub const CENTER: Vec3 = Vec3::new(0.0, 0.0, -9.0);
    /// Edge of a cube.
    pub const CUBE: f32 = 0.25;
    /// Radius in cubes.
    pub const RADIUS: i32 = 24;
    /// Height in cubes.
    pub const HEIGHT: i32 = 9;

    /// Number of cubes above each other in a column of the grid.
    pub fn column(x: i32, z: i32) -> i32 {
        let (x, z) = (x as f32 + 0.5, z as f32 + 0.5);
        let part = 1.0 - ops::hypot(x, z) / RADIUS as f32;
        ((HEIGHT as f32 + 1.0) * 1.15 * part).clamp(0.0, HEIGHT as f32) as i32
    }
}

/// A pool with a ramp at either end.
pub mod pool {
    use super::*;

    /// Where it is.
    pub const PLACE: Place = Place::new(-5.0, -24.5, Heading::West);
    /// Depth of the basin.
    pub const DEPTH: f32 = 2.4;
    /// Distance of the water below the plaza.
    pub const WATER: f32 = 0.15;
    /// Length on the map of a ramp into it.
    pub const RAMP: f32 = 4.2;
    /// Length of its level bottom.
    pub const BOTTOM: f32 = 5.0;
    /// Width.
    pub const WIDTH: f32 = 6.0;
    /// Length altogether.
    pub const LENGTH: f32 = BOTTOM + 2.0 * RAMP;
}

/// A planet above the end of the avenue; its place is on its top.
pub mod planet {
    use super::*;

    /// Radius.
    pub const RADIUS: f32 = 6.0;
    /// Height of its middle.
    pub const HEIGHT: f32 = 13.0;
    /// Where the walker starts.
    pub const PLACE: Place = Place {
        origin: Vec3::new(0.0, HEIGHT + RADIUS, -34.0),
        heading: Heading::North,
    };
    /// Its middle.
    pub const CENTER: Vec3 = Vec3::new(0.0, -RADIUS, 0.0);
    /// Gravity at its surface.
    pub const GRAVITY: f32 = 9.81;
    /// Distance from its middle within which its gravity acts.
    pub const REACH: f32 = 11.5;
}
