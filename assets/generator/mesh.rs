//! Triangles, by paint.

use std::collections::{BTreeMap, HashMap};

use bevy::math::{Vec2, Vec3};

use crate::paint::Paint;

/// Triangles of one paint.
#[derive(Clone, Debug, Default)]
pub struct Part {
    pub positions: Vec<Vec3>,
    pub normals: Vec<Vec3>,
    /// Linear brightness of the paint per corner, 255 is all of it.
    pub tints: Vec<[u8; 3]>,
    pub indices: Vec<u32>,
    /// Corners by all that they are, so that equal ones are written once.
    known: HashMap<([u32; 6], [u8; 3]), u32>,
}

/// What a node looks like.
#[derive(Clone, Debug)]
pub struct Mesh {
    pub parts: BTreeMap<Paint, Part>,
    tint: [u8; 3],
}

impl Default for Mesh {
    fn default() -> Self {
        Self {
            parts: BTreeMap::new(),
            tint: [255; 3],
        }
    }
}

/// Sine and cosine of an angle in degrees, exact at right angles; from double precision, so that
/// rounding gives the same bits on every machine.
#[expect(
    clippy::disallowed_methods,
    reason = "rounded to single precision right away"
)]
pub fn sin_cos(degrees: f64) -> (f32, f32) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let clean = |v: f64| if v.abs() < 1e-12 { 0.0 } else { v as f32 };
    (clean(sin), clean(cos))
}

impl Mesh {
    pub fn triangles(&self) -> usize {
        self.parts.values().map(|part| part.indices.len() / 3).sum()
    }

    /// Whether two meshes are the same triangles.
    pub fn same(&self, other: &Self) -> bool {
        self.parts.len() == other.parts.len()
            && self.parts.iter().zip(&other.parts).all(|((p, a), (q, b))| {
                p == q
                    && a.positions == b.positions
                    && a.normals == b.normals
                    && a.tints == b.tints
                    && a.indices == b.indices
            })
    }

    /// Shades what follows, 255 is the paint as it is.
    pub fn tint(&mut self, tint: u8) -> &mut Self {
        self.tint = [tint; 3];
        self
    }

    fn corner(&mut self, paint: Paint, position: Vec3, normal: Vec3) -> u32 {
        let tint = self.tint;
        let part = self.parts.entry(paint).or_default();
        let [px, py, pz] = position.to_array().map(f32::to_bits);
        let [nx, ny, nz] = normal.to_array().map(f32::to_bits);
        *part
            .known
            .entry(([px, py, pz, nx, ny, nz], tint))
            .or_insert_with(|| {
                part.positions.push(position);
                part.normals.push(normal);
                part.tints.push(tint);
                (part.positions.len() - 1) as u32
            })
    }

    fn index(&mut self, paint: Paint, corners: [u32; 3]) {
        self.parts.entry(paint).or_default().indices.extend(corners);
    }

    /// A flat triangle, counter-clockwise.
    pub fn triangle(&mut self, paint: Paint, [a, b, c]: [Vec3; 3]) -> &mut Self {
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let corners = [a, b, c].map(|p| self.corner(paint, p, normal));
        self.index(paint, corners);
        self
    }

    /// A flat convex polygon, counter-clockwise.
    pub fn polygon(&mut self, paint: Paint, points: &[Vec3]) -> &mut Self {
        let normal = (points[1] - points[0])
            .cross(points[2] - points[0])
            .normalize_or_zero();
        let corners: Vec<u32> = points
            .iter()
            .map(|&p| self.corner(paint, p, normal))
            .collect();
        for pair in corners[1..].windows(2) {
            self.index(paint, [corners[0], pair[0], pair[1]]);
        }
        self
    }

    /// A triangle with a normal per corner.
    pub fn smooth(&mut self, paint: Paint, corners: [(Vec3, Vec3); 3]) -> &mut Self {
        let corners = corners.map(|(p, n)| self.corner(paint, p, n));
        self.index(paint, corners);
        self
    }

    /// A grid of points with normals, `columns` to a row; rows follow each other along `+Z`,
    /// columns along `+X`.
    pub fn grid(&mut self, paint: Paint, columns: usize, points: &[(Vec3, Vec3)]) -> &mut Self {
        let corners: Vec<u32> = points
            .iter()
            .map(|&(p, n)| self.corner(paint, p, n))
            .collect();
        for row in 0..points.len() / columns - 1 {
            for column in 0..columns - 1 {
                let at = row * columns + column;
                let [a, b, c, d] = [at, at + 1, at + columns, at + columns + 1].map(|i| corners[i]);
                self.index(paint, [a, c, b]);
                self.index(paint, [b, c, d]);
            }
        }
        self
    }

    /// A body between rings of equally many points; each ring is clockwise, seen along the way from
    /// the first to the last.
    pub fn tube(&mut self, paint: Paint, rings: &[Vec<Vec3>]) -> &mut Self {
        for pair in rings.windows(2) {
            let count = pair[0].len();
            for i in 0..count {
                let j = (i + 1) % count;
                self.quad(paint, [pair[0][i], pair[0][j], pair[1][j], pair[1][i]]);
            }
        }
        if let (Some(first), Some(last)) = (rings.first(), rings.last()) {
            let mut back = first.clone();
            back.reverse();
            self.polygon(paint, &back).polygon(paint, last);
        }
        self
    }

    /// Two triangles; the corners need not lie in a plane, some may be equal.
    pub fn quad(&mut self, paint: Paint, [a, b, c, d]: [Vec3; 4]) -> &mut Self {
        for triangle in [[a, b, c], [a, c, d]] {
            let [p, q, r] = triangle;
            if (q - p).cross(r - p).length_squared() > 1e-12 {
                self.triangle(paint, triangle);
            }
        }
        self
    }

    /// A level rectangle seen from above, by its corners on the map.
    pub fn patch(&mut self, paint: Paint, min: Vec2, max: Vec2, y: f32) -> &mut Self {
        self.polygon(
            paint,
            &[
                Vec3::new(min.x, y, max.y),
                Vec3::new(max.x, y, max.y),
                Vec3::new(max.x, y, min.y),
                Vec3::new(min.x, y, min.y),
            ],
        )
    }

    /// A box by its middle and full size.
    pub fn cuboid(&mut self, paint: Paint, center: Vec3, size: Vec3) -> &mut Self {
        let h = size * 0.5;
        let outline = [
            Vec2::new(center.x - h.x, center.z + h.z),
            Vec2::new(center.x + h.x, center.z + h.z),
            Vec2::new(center.x + h.x, center.z - h.z),
            Vec2::new(center.x - h.x, center.z - h.z),
        ];
        self.prism(paint, paint, &outline, center.y - h.y, center.y + h.y)
    }

    /// An upright prism over a convex outline of (x, z), counter-clockwise seen from above.
    pub fn prism(
        &mut self,
        side: Paint,
        top: Paint,
        outline: &[Vec2],
        low: f32,
        high: f32,
    ) -> &mut Self {
        let at = |p: Vec2, y: f32| Vec3::new(p.x, y, p.y);
        for (i, &a) in outline.iter().enumerate() {
            let b = outline[(i + 1) % outline.len()];
            self.polygon(side, &[at(a, low), at(b, low), at(b, high), at(a, high)]);
        }
        let upper: Vec<Vec3> = outline.iter().map(|&p| at(p, high)).collect();
        let lower: Vec<Vec3> = outline.iter().rev().map(|&p| at(p, low)).collect();
        self.polygon(top, &upper).polygon(side, &lower)
    }

    /// An upright round body: radius `r0` at `low`, `r1` at `high`, about the axis through `foot`.
    pub fn round(
        &mut self,
        paint: Paint,
        foot: Vec3,
        [r0, r1]: [f32; 2],
        height: f32,
        segments: usize,
    ) -> &mut Self {
        let direction = |i: usize| {
            let (sin, cos) = sin_cos(360.0 * (i % segments) as f64 / segments as f64);
            Vec3::new(cos, 0.0, -sin)
        };
        let up = Vec3::Y * height;
        let slope = Vec3::Y * ((r0 - r1) / height);
        for i in 0..segments {
            let (a, b) = (direction(i), direction(i + 1));
            let (na, nb) = ((a + slope).normalize(), (b + slope).normalize());
            let low = [foot + a * r0, foot + b * r0];
            let high = [foot + up + a * r1, foot + up + b * r1];
            self.smooth(paint, [(low[0], na), (low[1], nb), (high[1], nb)]);
            if r1 > 0.0 {
                self.smooth(paint, [(low[0], na), (high[1], nb), (high[0], na)]);
            }
        }
        let ring = |r: f32, y: f32| -> Vec<Vec3> {
            (0..segments)
                .map(|i| foot + Vec3::Y * y + direction(i) * r)
                .collect()
        };
        if r1 > 0.0 {
            self.polygon(paint, &ring(r1, height));
        }
        let mut bottom = ring(r0, 0.0);
        bottom.reverse();
        self.polygon(paint, &bottom)
    }

    /// A piece of a ring, from one angle to another (degrees, counter-clockwise from `+X` seen
    /// from above).
    pub fn sector(
        &mut self,
        [side, top]: [Paint; 2],
        center: Vec3,
        [inner, outer]: [f32; 2],
        [from, to]: [f32; 2],
        [low, high]: [f32; 2],
        pieces: usize,
    ) -> &mut Self {
        let at = |i: usize, r: f32, y: f32| {
            let part = i as f64 / pieces as f64;
            let degrees = f64::from(from) + (f64::from(to) - f64::from(from)) * part;
            let (sin, cos) = sin_cos(degrees);
            Vec3::new(center.x + r * cos, y, center.z - r * sin)
        };
        for i in 0..pieces {
            let j = i + 1;
            self.polygon(
                top,
                &[
                    at(i, inner, high),
                    at(i, outer, high),
                    at(j, outer, high),
                    at(j, inner, high),
                ],
            );
            self.polygon(
                side,
                &[
                    at(j, inner, low),
                    at(j, outer, low),
                    at(i, outer, low),
                    at(i, inner, low),
                ],
            );
            self.polygon(
                side,
                &[
                    at(i, outer, low),
                    at(j, outer, low),
                    at(j, outer, high),
                    at(i, outer, high),
                ],
            );
            self.polygon(
                side,
                &[
                    at(j, inner, low),
                    at(i, inner, low),
                    at(i, inner, high),
                    at(j, inner, high),
                ],
            );
        }
        self.polygon(
            side,
            &[
                at(0, inner, low),
                at(0, outer, low),
                at(0, outer, high),
                at(0, inner, high),
            ],
        );
        let n = pieces;
        self.polygon(
            side,
            &[
                at(n, outer, low),
                at(n, inner, low),
                at(n, inner, high),
                at(n, outer, high),
            ],
        )
    }
}
