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
    let count = ((high - low) / cell).ceil().as_ivec3() + 1;
    let corner = |i: i32, j: i32, k: i32| {
        low + DVec3::new(f64::from(i), f64::from(j), f64::from(k)) * cell
    };
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
                if let Some(point) = crossing(&values, slot, corner, [i, j, k]) {
                    cells.insert([i, j, k], made.points.len() as u32);
                    made.points.push(settle(field, point, cell));
                }
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
                        cells[&at]
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

/// The middle of where the surface crosses the edges of a cell.
fn crossing(
    values: &[f64],
    slot: impl Fn(i32, i32, i32) -> usize,
    corner: impl Fn(i32, i32, i32) -> DVec3,
    [i, j, k]: [i32; 3],
) -> Option<DVec3> {
    let mut sum = DVec3::ZERO;
    let mut crossed = 0.0;
    for a in 0..8 {
        for axis in [1, 2, 4] {
            let b = a | axis;
            if b == a {
                continue;
            }
            let at = |n: i32| (i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
            let ((ai, aj, ak), (bi, bj, bk)) = (at(a), at(b));
            let (va, vb) = (values[slot(ai, aj, ak)], values[slot(bi, bj, bk)]);
            if (va < 0.0) != (vb < 0.0) {
                sum += corner(ai, aj, ak).lerp(corner(bi, bj, bk), va / (va - vb));
                crossed += 1.0;
            }
        }
    }
    (crossed > 0.0).then(|| sum / crossed)
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
