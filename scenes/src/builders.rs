//! Pieces of level, by number: floors of every kind of collider, walls, stairs, ramps, movers.

use bevy::{math::ops, prelude::*};
use bevy_rapier3d::prelude::*;

use crate::Sim;

/// What a level floor is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloorKind {
    /// One box.
    Box,
    /// A triangle mesh of 0.5 m squares, two triangles each.
    Triangles,
    /// Boxes of 1 m side by side, each a body of its own.
    Tiles,
    /// Voxels of 0.5 m.
    Voxels,
    /// A height field of 0.5 m cells.
    HeightField,
}

impl FloorKind {
    /// Every kind.
    pub const ALL: [Self; 5] = [
        Self::Box,
        Self::Triangles,
        Self::Tiles,
        Self::Voxels,
        Self::HeightField,
    ];
}

/// What a wall, ramp or flight of stairs is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Make {
    /// Boxes.
    Boxes,
    /// One triangle mesh.
    Mesh,
}

impl Make {
    /// Every make.
    pub const ALL: [Self; 2] = [Self::Boxes, Self::Mesh];
}

/// A flight of stairs that goes up along local `+X`; its first riser is at `x = 0`, its middle at `z = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stairs {
    /// Number of steps.
    pub steps: usize,
    /// Height of a step, metres.
    pub rise: f32,
    /// Depth of a step, metres.
    pub tread: f32,
    /// Width of the flight, metres.
    pub width: f32,
    /// Length of the level floors before and behind the flight, metres.
    pub landing: f32,
    /// Boxes or one mesh.
    pub make: Make,
    /// A stepped ceiling, if any.
    pub ceiling: Option<StairCeiling>,
}

/// A ceiling of one level piece for each tread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StairCeiling {
    /// Free height above each tread, metres.
    pub free: f32,
    /// How far each piece lies before the tread it belongs to, metres. A body of radius `r` that
    /// climbs a vertical riser is under the ceiling of the step before until `2 r` before the riser.
    pub lead: f32,
}

impl Stairs {
    /// Where a tread begins and ends and how high it is, metres; the lower landing is number -1.
    fn tread(&self, i: i32) -> (f32, f32, f32) {
        let start = if i < 0 {
            -self.landing
        } else {
            i as f32 * self.tread
        };
        let end = if i == self.steps as i32 - 1 {
            self.last_riser() + self.landing
        } else {
            (i + 1) as f32 * self.tread
        };
        (start, end, (i + 1) as f32 * self.rise)
    }

    /// Height of the whole flight, metres.
    pub fn height(&self) -> f32 {
        self.steps as f32 * self.rise
    }

    /// Where the last riser is, metres along the flight.
    pub fn last_riser(&self) -> f32 {
        (self.steps as f32 - 1.0) * self.tread
    }
}

/// Moves a kinematic body along an exact function of the time since it was spawned, seconds.
#[derive(Component)]
pub struct Mover {
    /// Number of ticks so far.
    pub ticks: u64,
    path: Box<dyn Fn(f64) -> Transform + Send + Sync>,
}

/// Remembers that the system that moves [`Mover`]s is there.
#[derive(Resource)]
struct MoversRun;

fn move_movers(time: Res<Time<Fixed>>, mut movers: Query<(&mut Mover, &mut Transform)>) {
    for (mut mover, mut transform) in &mut movers {
        mover.ticks += 1;
        let seconds = mover.ticks as f64 * time.timestep().as_secs_f64();
        *transform = (mover.path)(seconds);
    }
}

impl Sim {
    /// Spawns a level floor over the rectangle from `corner` (its top) to `corner + size` in x and z.
    /// `size` should be whole metres.
    pub fn floor_of(&mut self, kind: FloorKind, corner: Vec3, size: Vec2) {
        let at = Transform::from_translation(corner);
        match kind {
            FloorKind::Box => {
                self.block(
                    corner + Vec3::new(size.x * 0.5, -0.5, size.y * 0.5),
                    Vec3::new(size.x, 1.0, size.y),
                );
            }
            FloorKind::Triangles => {
                let mesh = Patch::new(
                    Vec3::ZERO,
                    Vec3::Z * size.y,
                    Vec3::X * size.x,
                    (size.y * 2.0) as u32,
                    (size.x * 2.0) as u32,
                );
                self.fixed(mesh.collider(), at);
            }
            FloorKind::Tiles => {
                for x in 0..size.x as i32 {
                    for z in 0..size.y as i32 {
                        let center = corner + Vec3::new(x as f32 + 0.5, -0.5, z as f32 + 0.5);
                        self.block(center, Vec3::ONE);
                    }
                }
            }
            FloorKind::Voxels => {
                let mut cells = Vec::new();
                for x in 0..(size.x * 2.0) as i32 {
                    for z in 0..(size.y * 2.0) as i32 {
                        cells.extend([IVec3::new(x, -1, z), IVec3::new(x, -2, z)]);
                    }
                }
                self.fixed(Collider::voxels(Vec3::splat(0.5), &cells), at);
            }
            FloorKind::HeightField => {
                let (rows, columns) = ((size.y * 2.0) as usize + 1, (size.x * 2.0) as usize + 1);
                self.fixed(
                    Collider::heightfield(
                        vec![0.0; rows * columns],
                        rows,
                        columns,
                        Vec3::new(size.x, 1.0, size.y),
                    ),
                    Transform::from_translation(
                        corner + Vec3::new(size.x * 0.5, 0.0, size.y * 0.5),
                    ),
                );
            }
        }
    }

    /// Spawns a straight vertical wall, 1 m thick as boxes, none as a mesh of 0.5 m squares.
    /// It starts at `start`, runs `length` along `along` (level, unit) and rises `height`; its face
    /// looks to the side of `along × up` (the right hand of one who looks along it).
    pub fn wall(
        &mut self,
        make: Make,
        start: Vec3,
        along: Vec3,
        length: f32,
        height: f32,
    ) -> Entity {
        let face = along.cross(Vec3::Y);
        match make {
            Make::Boxes => {
                let rotation = Quat::from_mat3(&Mat3::from_cols(along, Vec3::Y, face));
                let center = start + along * (length * 0.5) + Vec3::Y * (height * 0.5) - face * 0.5;
                self.fixed(
                    Collider::cuboid(length * 0.5, height * 0.5, 0.5),
                    Transform::from_translation(center).with_rotation(rotation),
                )
            }
            Make::Mesh => {
                let patch = Patch::new(
                    Vec3::ZERO,
                    along * length,
                    Vec3::Y * height,
                    (length * 2.0).round() as u32,
                    (height * 2.0).round() as u32,
                );
                self.fixed(patch.collider(), Transform::from_translation(start))
            }
        }
    }

    /// Spawns a corner of two walls, 4 m long and 3 m high, that meet in a vertical line at `apex`
    /// and enclose `angle` radians; it opens towards `-X`.
    pub fn corner(&mut self, make: Make, apex: Vec3, angle: f32) {
        let half = angle * 0.5;
        let left = Vec3::new(-ops::cos(half), 0.0, -ops::sin(half));
        let right = Vec3::new(-ops::cos(half), 0.0, ops::sin(half));
        // Each faces the inside of the corner.
        self.wall(make, apex + left * 4.0, -left, 4.0, 3.0);
        self.wall(make, apex, right, 4.0, 3.0);
    }

    /// Spawns a flight of stairs with its foot at `base`.
    pub fn stairs(&mut self, stairs: &Stairs, base: Transform) {
        let place = |center: Vec3| base * Transform::from_translation(center);
        let (w, n) = (stairs.width, stairs.steps as i32);
        match stairs.make {
            Make::Boxes => {
                for i in -1..n {
                    let (start, end, top) = stairs.tread(i);
                    self.fixed(
                        Collider::cuboid((end - start) * 0.5, (top + 1.0) * 0.5, w * 0.5),
                        place(Vec3::new((start + end) * 0.5, (top - 1.0) * 0.5, 0.0)),
                    );
                }
            }
            Make::Mesh => {
                let mut mesh = Patch::default();
                let z = Vec3::Z * w;
                for i in -1..n {
                    let (start, end, top) = stairs.tread(i);
                    let left = Vec3::new(start, top, w * -0.5);
                    mesh.add(left, z, Vec3::X * (end - start), 4, 1);
                    if i < n - 1 {
                        let riser = Vec3::new(end, top, w * -0.5);
                        mesh.add(riser, z, Vec3::Y * stairs.rise, 4, 1);
                    }
                }
                self.fixed(mesh.collider(), base);
            }
        }
        let Some(ceiling) = stairs.ceiling else {
            return;
        };
        for i in -1..n {
            let low = (i + 1) as f32 * stairs.rise + ceiling.free;
            let thick = stairs.rise + 0.2;
            let start = if i < 0 {
                -stairs.landing
            } else {
                i as f32 * stairs.tread
            } - ceiling.lead;
            let end = if i == n - 1 {
                stairs.last_riser() + stairs.landing
            } else {
                (i + 1) as f32 * stairs.tread
            } - ceiling.lead;
            self.fixed(
                Collider::cuboid((end - start) * 0.5, thick * 0.5, w * 0.5),
                place(Vec3::new((start + end) * 0.5, low + thick * 0.5, 0.0)),
            );
        }
    }

    /// Spawns a ramp that rises along `+X` at `angle` radians through the point `through`, `length`
    /// long (half of it before that point) and `width` wide.
    pub fn ramp(
        &mut self,
        make: Make,
        through: Vec3,
        angle: f32,
        length: f32,
        width: f32,
    ) -> Entity {
        let rotation = Quat::from_rotation_z(angle);
        let at = Transform::from_translation(through).with_rotation(rotation);
        match make {
            Make::Boxes => self.fixed(
                Collider::cuboid(length * 0.5, 0.5, width * 0.5),
                at * Transform::from_xyz(0.0, -0.5, 0.0),
            ),
            Make::Mesh => {
                let patch = Patch::new(
                    Vec3::new(length * -0.5, 0.0, width * -0.5),
                    Vec3::Z * width,
                    Vec3::X * length,
                    (width * 2.0).round() as u32,
                    (length * 2.0).round() as u32,
                );
                self.fixed(patch.collider(), at)
            }
        }
    }

    /// Spawns a kinematic body that follows `path`, an exact function of the time since now, seconds.
    pub fn mover(
        &mut self,
        collider: Collider,
        path: impl Fn(f64) -> Transform + Send + Sync + 'static,
    ) -> Entity {
        let start = path(0.0);
        let mover = self.moving(path);
        self.spawn((RigidBody::KinematicPositionBased, collider, start, mover))
    }

    /// A [`Mover`] to put on an entity of one's own; makes sure that movers move.
    pub fn moving(&mut self, path: impl Fn(f64) -> Transform + Send + Sync + 'static) -> Mover {
        if self.app.world().get_resource::<MoversRun>().is_none() {
            self.app
                .insert_resource(MoversRun)
                .add_systems(FixedUpdate, move_movers);
        }
        Mover {
            ticks: 0,
            path: Box::new(path),
        }
    }
}

/// Flat rectangles of triangles, joined in one mesh.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    /// Corners, metres.
    pub points: Vec<Vec3>,
    /// Triangles, anticlockwise seen from the side they face.
    pub triangles: Vec<[u32; 3]>,
}

impl Patch {
    /// A parallelogram from `origin` over `u` and `v`, cut in `nu` by `nv` cells; faces `u × v`.
    pub fn new(origin: Vec3, u: Vec3, v: Vec3, nu: u32, nv: u32) -> Self {
        let mut patch = Self::default();
        patch.add(origin, u, v, nu, nv);
        patch
    }

    /// A height map: `height(x, z)` over `cells` squares of this size, from the origin on.
    pub fn terrain(cells: u32, size: f32, height: impl Fn(f32, f32) -> f32) -> Self {
        let side = size * cells as f32;
        let mut patch = Self::new(Vec3::ZERO, Vec3::Z * side, Vec3::X * side, cells, cells);
        for point in &mut patch.points {
            point.y = height(point.x, point.z);
        }
        patch
    }

    /// Adds another parallelogram; shares no corners with what is there.
    pub fn add(&mut self, origin: Vec3, u: Vec3, v: Vec3, nu: u32, nv: u32) {
        let first = self.points.len() as u32;
        for i in 0..=nu {
            for j in 0..=nv {
                let (a, b) = (i as f32 / nu as f32, j as f32 / nv as f32);
                self.points.push(origin + u * a + v * b);
            }
        }
        for i in 0..nu {
            for j in 0..nv {
                let p = first + i * (nv + 1) + j;
                let (pu, pv, puv) = (p + nv + 1, p + 1, p + nv + 2);
                self.triangles.extend([[p, pu, puv], [p, puv, pv]]);
            }
        }
    }

    /// Adds the six faces of a box, looking outward, each face two triangles.
    pub fn add_box(&mut self, center: Vec3, size: Vec3) {
        let h = size * 0.5;
        for (axis, u, v) in [
            (Vec3::X, Vec3::Y, Vec3::Z),
            (Vec3::Y, Vec3::Z, Vec3::X),
            (Vec3::Z, Vec3::X, Vec3::Y),
        ] {
            for (side, u, v) in [(axis, u, v), (-axis, v, u)] {
                let corner = center + (side - u - v) * h;
                self.add(corner, u * size, v * size, 1, 1);
            }
        }
    }

    /// The mesh as a collider.
    ///
    /// # Panics
    /// When it has no triangle: a broken scene should stop its test.
    pub fn collider(&self) -> Collider {
        match Collider::trimesh(self.points.clone(), self.triangles.clone()) {
            Ok(collider) => collider,
            Err(error) => panic!("mesh: {error}"),
        }
    }
}
