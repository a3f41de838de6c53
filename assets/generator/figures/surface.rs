//! The closed surface of a field, by surface nets: a corner in every cell that the surface
//! crosses, a quad about every edge that it crosses.

use std::collections::HashMap;

use bevy::math::DVec3;

use super::field::Field;

/// A closed surface of one colour.
#[derive(Clone, Debug)]
pub struct Shell {
    pub points: Vec<DVec3>,
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    /// Linear red, green and blue.
    pub color: [f64; 3],
}

/// The surface of a field inside a box, from cells of a size in metres.
pub fn shell(field: &Field, [low, high]: [DVec3; 2], cell: f64, color: [f64; 3]) -> Shell {
    let (low, high) = (low - 2.0 * cell, high + 2.0 * cell);
    let count = ((high - low) / cell).ceil().as_ivec3() + 1;
    let corner =
        |i: i32, j: i32, k: i32| low + DVec3::new(f64::from(i), f64::from(j), f64::from(k)) * cell;
    let slot = |i: i32, j: i32, k: i32| ((k * count.y + j) * count.x + i) as usize;
    let mut values = Vec::with_capacity((count.x * count.y * count.z) as usize);
    for k in 0..count.z {
        for j in 0..count.y {
            for i in 0..count.x {
                values.push(field.at(corner(i, j, k)));
            }
        }
    }
    let mut made = Shell {
        points: Vec::new(),
        normals: Vec::new(),
        triangles: Vec::new(),
        color,
    };
    let mut cells = HashMap::new();
    for k in 0..count.z - 1 {
        for j in 0..count.y - 1 {
            for i in 0..count.x - 1 {
                let at = |n: usize| {
                    let n = n as i32;
                    (i + (n & 1), j + (n >> 1 & 1), k + (n >> 2))
                };
                let corners: [f64; 8] = std::array::from_fn(|n| {
                    let (i, j, k) = at(n);
                    values[slot(i, j, k)]
                });
                if corners.iter().all(|v| *v < 0.0) || corners.iter().all(|v| *v >= 0.0) {
                    continue;
                }
                let mut sums = [(DVec3::ZERO, 0.0); EDGES];
                let patches = patches(&corners);
                for a in 0..8 {
                    for axis in 0..3 {
                        let b = a | 1 << axis;
                        if b == a || (corners[a] < 0.0) == (corners[b] < 0.0) {
                            continue;
                        }
                        let place = |n: usize| {
                            let (i, j, k) = at(n);
                            corner(i, j, k)
                        };
                        let t = corners[a] / (corners[a] - corners[b]);
                        let sum = &mut sums[patches[3 * a + axis]];
                        sum.0 += place(a).lerp(place(b), t);
                        sum.1 += 1.0;
                    }
                }
                let mut points = [0; EDGES];
                for (point, (sum, crossed)) in points.iter_mut().zip(sums) {
                    if crossed > 0.0 {
                        *point = made.points.len() as u32;
                        made.points.push(settle(field, sum / crossed, cell));
                    }
                }
                cells.insert([i, j, k], patches.map(|patch| points[patch]));
            }
        }
    }
    made.normals = made
        .points
        .iter()
        .map(|&p| field.slope(p).normalize())
        .collect();
    for k in 1..count.z - 1 {
        for j in 1..count.y - 1 {
            for i in 1..count.x - 1 {
                for axis in 0..3 {
                    let mut end = [i, j, k];
                    end[axis] += 1;
                    let from = values[slot(i, j, k)] < 0.0;
                    let to = values[slot(end[0], end[1], end[2])] < 0.0;
                    if from == to {
                        continue;
                    }
                    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                    let quad = [[1, 1], [0, 1], [0, 0], [1, 0]].map(|[a, b]| {
                        let mut at = [i, j, k];
                        at[u] -= a;
                        at[v] -= b;
                        // The corner of that cell at which the edge starts.
                        let start = (a as usize) << u | (b as usize) << v;
                        cells[&at][3 * start + axis]
                    });
                    made.quad(if from {
                        quad
                    } else {
                        [quad[3], quad[2], quad[1], quad[0]]
                    });
                }
            }
        }
    }
    made
}

impl Shell {
    /// The same at the other side of the body.
    pub fn mirrored(&self) -> Self {
        let flip = |v: &DVec3| DVec3::new(-v.x, v.y, v.z);
        Self {
            points: self.points.iter().map(flip).collect(),
            normals: self.normals.iter().map(flip).collect(),
            triangles: self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
            color: self.color,
        }
    }

    /// Two triangles along the shorter diagonal.
    fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        let gap = |i: u32, j: u32| self.points[i as usize].distance(self.points[j as usize]);
        if gap(a, c) <= gap(b, d) {
            self.triangles.extend([[a, b, c], [a, c, d]]);
        } else {
            self.triangles.extend([[a, b, d], [b, c, d]]);
        }
    }
}

/// Edges of a cell: three times the corner that they start at and the axis that they follow.
const EDGES: usize = 24;

/// Which piece of the surface crosses each edge of a cell: pieces are apart where they do not meet
/// on a face, so that thin walls and creases stay closed surfaces.
fn patches(corners: &[f64; 8]) -> [usize; EDGES] {
    let mut piece: [usize; EDGES] = std::array::from_fn(|edge| edge);
    let mut join = |a: usize, b: usize| {
        let (a, b) = (piece[a], piece[b]);
        for p in &mut piece {
            if *p == b {
                *p = a;
            }
        }
    };
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for side in [0, 1 << axis] {
            let around = [side, side | 1 << u, side | 1 << u | 1 << v, side | 1 << v];
            let edges = [
                3 * around[0] + u,
                3 * around[1] + v,
                3 * around[3] + u,
                3 * around[0] + v,
            ];
            let inside = around.map(|n| corners[n] < 0.0);
            let crossed: Vec<usize> = (0..4)
                .filter(|&e| inside[e] != inside[(e + 1) % 4])
                .collect();
            match crossed[..] {
                [a, b] => join(edges[a], edges[b]),
                // Two corners inside at a diagonal: about each one its own piece.
                [_, _, _, _] => {
                    let shift = if inside[0] { 3 } else { 0 };
                    join(edges[shift % 4], edges[(shift + 1) % 4]);
                    join(edges[(shift + 2) % 4], edges[(shift + 3) % 4]);
                }
                _ => {}
            }
        }
    }
    piece
}

/// Draws a corner onto the surface, by less than half a cell.
fn settle(field: &Field, start: DVec3, cell: f64) -> DVec3 {
    let mut p = start;
    for _ in 0..4 {
        let slope = field.slope(p);
        p -= slope * (field.at(p) / slope.length_squared().max(0.05));
        p = start + (p - start).clamp_length_max(0.45 * cell);
    }
    p
}
