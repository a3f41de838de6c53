use super::*;
use crate::{
    backend::neighbourhood::{Geometry, break_down},
    math::triangle::Triangle,
};

/// Numbers from -1 to 1, the same in every run.
struct Dice(u32);

impl Dice {
    fn roll(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / 8_388_608.0 - 1.0
    }

    fn vec(&mut self) -> Vec3 {
        Vec3::new(self.roll(), self.roll(), self.roll())
    }

    /// Whether an event of this probability happens.
    fn happens(&mut self, part: f32) -> bool {
        (self.roll() + 1.0) * 0.5 < part
    }

    fn pose(&mut self, spread: f32) -> Pose {
        Pose::from_parts(
            self.vec() * spread,
            Quat::from_scaled_axis(self.vec() * 3.0),
        )
    }
}

/// A hilly square of `cells²` squares of this width around 0.
fn terrain(cells: u32, width: f32, dice: &mut Dice) -> SharedShape {
    let row = cells + 1;
    let start = -0.5 * cells as f32 * width;
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..row {
        for j in 0..row {
            let (x, z) = (start + i as f32 * width, start + j as f32 * width);
            points.push(Vec3::new(x, dice.roll() * 0.3 * width, z));
        }
    }
    for i in 0..cells {
        for j in 0..cells {
            let at = i * row + j;
            triangles.push([at, at + 1, at + row]);
            triangles.push([at + row, at + 1, at + row + 1]);
        }
    }
    SharedShape::trimesh(points, triangles).unwrap()
}

struct Tile {
    handle: ColliderHandle,
    shape: SharedShape,
    pose: Pose,
    /// By how much it moves and turns in a tick.
    velocity: Vec3,
    spin: Vec3,
}

impl Tile {
    fn new(id: u32, shape: &SharedShape, pose: Pose) -> Self {
        Self {
            handle: ColliderHandle::from_raw_parts(id, 0),
            shape: shape.clone(),
            pose,
            velocity: Vec3::ZERO,
            spin: Vec3::ZERO,
        }
    }
}

type Bits = [u32; 9];

fn bits(t: &Triangle) -> Bits {
    let mut out = [0; 9];
    for (i, p) in [t.a, t.b, t.c].iter().enumerate() {
        for axis in 0..3 {
            out[i * 3 + axis] = p[axis].to_bits();
        }
    }
    out
}

/// Four boxes as of wheels, relative to the origin.
fn boxes(turn: Quat) -> [(Vec3, Vec3); 4] {
    [(-0.8, -1.4), (0.8, -1.4), (-0.8, 1.4), (0.8, 1.4)].map(|(x, z)| {
        let at = turn * Vec3::new(x, 0.0, z);
        (
            at - Vec3::new(0.35, 0.9, 0.35),
            at + Vec3::new(0.35, 0.5, 0.35),
        )
    })
}

/// One tick: what the memory hands out of every tile is, bit by bit, what a search finds. Tells how much
/// that is.
fn tick(
    memory: &mut MeshMemory,
    tiles: &[Tile],
    origin: Vec3,
    boxes: &[(Vec3, Vec3)],
    way: Vec3,
) -> usize {
    let area = Area {
        origin,
        boxes,
        grow: 0.0,
    };
    memory.begin();
    let mut all = 0;
    for tile in tiles {
        let (mut recalled, mut found) = (Vec::new(), Vec::new());
        let mesh = tile.shape.as_trimesh().unwrap();
        let take = &mut |t: Triangle| recalled.push(bits(&t));
        area.recall(
            memory,
            way,
            tile.handle,
            &tile.shape,
            mesh,
            &tile.pose,
            take,
        );
        break_down(&area, &tile.shape, &tile.pose, &mut |piece, _| {
            if let Geometry::Triangle(t) = piece {
                found.push(bits(&t));
            }
        });
        recalled.sort_unstable();
        found.sort_unstable();
        assert!(
            recalled == found,
            "{:?}: {} of {}",
            tile.handle,
            recalled.len(),
            found.len()
        );
        all += found.len();
    }
    all
}

#[test]
fn what_is_recalled_is_what_a_search_finds() {
    let mut most = 0;
    for seed in 0..40 {
        let mut dice = Dice(seed * 7919 + 1);
        // Coarse, as of a road, and so fine that a wheel is over more than are remembered.
        let shapes = [
            terrain(16, 1.0, &mut dice),
            terrain(40, 0.2, &mut dice),
            terrain(60, 0.06, &mut dice),
        ];
        let pick = |dice: &mut Dice| {
            let i = ((dice.roll() + 1.0) * 1.5) as usize;
            shapes[i.min(2)].clone()
        };
        let mut tiles: Vec<Tile> = Vec::new();
        let mut next = 0;
        let mut memory = MeshMemory::default();
        let (mut origin, mut velocity) = (Vec3::ZERO, Vec3::X * 0.2);
        let mut turn = Quat::IDENTITY;
        for _ in 0..120 {
            // Often two of one shape, and often more than are remembered.
            if tiles.len() < 7 && dice.happens(0.2) {
                let pose = dice.pose(1.0);
                tiles.push(Tile::new(next, &pick(&mut dice), pose));
                next += 1;
            }
            if tiles.len() > 1 && dice.happens(0.05) {
                tiles.swap_remove(0);
            }
            for tile in &mut tiles {
                if dice.happens(0.1) {
                    tile.velocity = dice.vec() * 0.3;
                    tile.spin = dice.vec() * 0.2;
                }
                if dice.happens(0.1) {
                    (tile.velocity, tile.spin) = (Vec3::ZERO, Vec3::ZERO);
                }
                if dice.happens(0.02) {
                    tile.pose = dice.pose(1.0);
                }
                if dice.happens(0.05) {
                    tile.shape = pick(&mut dice);
                }
                let at = tile.pose.translation + tile.velocity;
                let turned = Quat::from_scaled_axis(tile.spin) * tile.pose.rotation;
                tile.pose = Pose::from_parts(at, turned.normalize());
            }
            if dice.happens(0.1) {
                velocity = dice.vec() * 0.5;
            }
            origin += velocity;
            turn = Quat::from_scaled_axis(dice.vec() * 0.05) * turn;
            // Put back, lifted off all ground or far away.
            if dice.happens(0.1) {
                origin = dice.vec() * 2.0;
            }
            if dice.happens(0.03) {
                origin = Vec3::Y * 50.0;
            }
            let boxes = boxes(turn);
            let count = if dice.happens(0.1) { 2 } else { 4 };
            let way = velocity * 8.0;
            most = most.max(tick(&mut memory, &tiles, origin, &boxes[..count], way));
        }
    }
    assert!(most > 4 * MOST_TRIANGLES, "{most}");
}

/// Tiles of one shape in a row along `X`, 4 m wide each.
fn road(tiles: u32) -> Vec<Tile> {
    let shape = terrain(4, 1.0, &mut Dice(3));
    (0..tiles)
        .map(|i| Tile::new(i, &shape, Pose::from_translation(Vec3::X * 4.0 * i as f32)))
        .collect()
}

#[test]
fn tiles_of_one_shape_are_remembered_side_by_side() {
    let tiles = road(2);
    let mut memory = MeshMemory::default();
    // On the seam.
    let at = Vec3::X * 2.0;
    let searched = |memory: &MeshMemory| memory.0.iter().filter(|near| near.of.is_some()).count();
    let boxes = boxes(Quat::IDENTITY);
    assert!(tick(&mut memory, &tiles, at, &boxes, Vec3::ZERO) > 0);
    assert_eq!(searched(&memory), 2);
    // What was found is not looked for again: it is still there when it is no longer true.
    for near in &mut memory.0 {
        near.triangles.clear();
    }
    memory.begin();
    let area = Area {
        origin: at,
        boxes: &boxes,
        grow: 0.0,
    };
    for Tile {
        handle,
        shape,
        pose,
        ..
    } in &tiles
    {
        let mesh = shape.as_trimesh().unwrap();
        area.recall(
            &mut memory,
            Vec3::ZERO,
            *handle,
            shape,
            mesh,
            pose,
            &mut |t| panic!("searched for {t:?}"),
        );
    }
}

#[test]
fn a_way_over_many_tiles_uses_the_same_buffers() {
    let tiles = road(40);
    let mut memory = MeshMemory::default();
    let mut buffers = std::collections::BTreeSet::new();
    let velocity = Vec3::X * 0.4;
    for i in 0..380 {
        let at = Vec3::X * 0.4 * i as f32;
        let near: Vec<Tile> = tiles
            .iter()
            .filter(|tile| (tile.pose.translation.x - at.x).abs() < 3.5)
            .map(|tile| Tile::new(tile.handle.into_raw_parts().0, &tile.shape, tile.pose))
            .collect();
        tick(
            &mut memory,
            &near,
            at,
            &boxes(Quat::IDENTITY),
            velocity * 8.0,
        );
        let kept = memory.0.iter().filter(|near| near.of.is_some());
        buffers.extend(kept.map(|near| near.triangles.as_ptr() as usize));
    }
    assert!(buffers.len() <= MOST_MESHES, "{}", buffers.len());
}
