//! What bodies and wheels are made of.

use bevy::prelude::*;

use crate::{
    mesh::{Mesh, sin_cos},
    paint::Paint,
};

/// A cross-section: right half of the outline, from below upwards.
pub struct Section {
    pub z: f32,
    pub half: Vec<Vec2>,
}

/// A symmetric body through cross-sections from front to back. `paint` is asked for each piece
/// between two sections and each strip of the outline; the last strip is the top.
pub fn loft(mesh: &mut Mesh, sections: &[Section], paint: impl Fn(usize, usize) -> Paint) {
    let right = |s: &Section, k: usize| Vec3::new(s.half[k].x, s.half[k].y, s.z);
    let left = |s: &Section, k: usize| Vec3::new(-s.half[k].x, s.half[k].y, s.z);
    for (i, pair) in sections.windows(2).enumerate() {
        let (a, b) = (&pair[0], &pair[1]);
        let last = a.half.len() - 1;
        for k in 0..last {
            let j = k + 1;
            mesh.quad(
                paint(i, k),
                [right(b, k), right(a, k), right(a, j), right(b, j)],
            )
            .quad(
                paint(i, k),
                [left(a, k), left(b, k), left(b, j), left(a, j)],
            );
        }
        mesh.quad(
            paint(i, last),
            [right(b, last), right(a, last), left(a, last), left(b, last)],
        )
        .quad(
            Paint::Rubber,
            [left(b, 0), left(a, 0), right(a, 0), right(b, 0)],
        );
    }
    let outline = |s: &Section| -> Vec<Vec3> {
        let n = s.half.len();
        (0..n)
            .map(|k| right(s, k))
            .chain((0..n).rev().map(|k| left(s, k)))
            .collect()
    };
    if let (Some(first), Some(end)) = (sections.first(), sections.last()) {
        let mut front = outline(first);
        front.reverse();
        mesh.polygon(paint(0, 0), &front);
        mesh.polygon(paint(sections.len() - 2, 0), &outline(end));
    }
}

/// The lower part of a car with its wheel arches.
pub struct Shell<'a> {
    pub paint: Paint,
    pub half_width: f32,
    /// Height of the underside.
    pub sill: f32,
    /// The line of bonnet, waist and boot from front to back: (z, y).
    pub top: &'a [(f32, f32)],
    /// Axles along the car, and radius of the arches about `hub`.
    pub axles: &'a [f32],
    pub arch: f32,
    pub hub: f32,
    /// How much narrower the ends are, as a part.
    pub taper: f32,
}

impl Shell<'_> {
    /// Height of the top line.
    pub fn top_at(&self, z: f32) -> f32 {
        let mut before = self.top[0];
        for &point in self.top {
            if z <= point.0 {
                let length = (point.0 - before.0).max(1e-6);
                return before.1 + (point.1 - before.1) * ((z - before.0) / length).clamp(0.0, 1.0);
            }
            before = point;
        }
        before.1
    }

    fn bottom_at(&self, z: f32) -> f32 {
        self.axles
            .iter()
            .filter_map(|axle| {
                let off = (z - axle).abs();
                (off < self.arch).then(|| self.hub + (self.arch * self.arch - off * off).sqrt())
            })
            .fold(self.sill, f32::max)
    }

    pub fn half_at(&self, z: f32) -> f32 {
        let (front, back) = (self.top[0].0, self.top[self.top.len() - 1].0);
        let middle = 0.5 * (front + back);
        let out = ((z - middle).abs() / (back - middle)).clamp(0.0, 1.0);
        let bend = ((out - 0.65) / 0.35).max(0.0);
        self.half_width * (1.0 - self.taper * bend * bend)
    }

    pub fn build(&self, mesh: &mut Mesh) {
        let mut zs: Vec<f32> = self.top.iter().map(|point| point.0).collect();
        let (front, back) = (zs[0], zs[zs.len() - 1]);
        for axle in self.axles {
            for i in 0..=8 {
                let (_, cos) = sin_cos(180.0 * f64::from(i) / 8.0);
                zs.push(axle + self.arch * 0.999 * cos);
            }
            zs.extend([axle - self.arch * 1.001, axle + self.arch * 1.001]);
        }
        let length = back - front;
        zs.extend([0.06, 0.12, 0.88, 0.94].map(|part| front + part * length));
        zs.retain(|z| (front..=back).contains(z));
        zs.sort_by(f32::total_cmp);
        zs.dedup_by(|a, b| (*a - *b).abs() < 4e-4);
        let sections: Vec<Section> = zs
            .into_iter()
            .map(|z| {
                let (top, w) = (self.top_at(z), self.half_at(z));
                let low = self.bottom_at(z).min(top - 0.09);
                let middle = (low + 0.06).max(self.sill + 0.2).min(top - 0.07);
                Section {
                    z,
                    half: vec![
                        Vec2::new(w - 0.05, low),
                        Vec2::new(w, middle),
                        Vec2::new(w - 0.015, top - 0.06),
                        Vec2::new(w - 0.1, top),
                    ],
                }
            })
            .collect();
        loft(mesh, &sections, |_, _| self.paint);
    }
}

/// A point of a cabin's line.
#[derive(Clone, Copy)]
pub struct Pane {
    pub z: f32,
    pub low: f32,
    pub high: f32,
    /// Whether what follows behind it is glass at the side and at the top.
    pub glass: (bool, bool),
}

/// The upper part of a car: glass between pillars under a roof.
pub fn cabin(mesh: &mut Mesh, paint: Paint, [low, high]: [f32; 2], panes: &[Pane]) {
    let sections: Vec<Section> = panes
        .iter()
        .map(|pane| {
            let rise = pane.high - pane.low;
            let edge = (0.07f32).min(0.3 * rise);
            let lean = |part: f32| low + (high - low) * part;
            // Full height is that of the highest pane.
            let top = panes.iter().map(|p| p.high - p.low).fold(0.01, f32::max);
            Section {
                z: pane.z,
                half: vec![
                    Vec2::new(low, pane.low - 0.03),
                    Vec2::new(low, pane.low),
                    Vec2::new(lean((rise - edge) / top), pane.high - edge),
                    Vec2::new(lean(rise / top) - 0.04, pane.high),
                ],
            }
        })
        .collect();
    loft(mesh, &sections, |i, strip| match (strip, panes[i].glass) {
        (1, (true, _)) | (3, (_, true)) | (2, (true, true)) => Paint::Glass,
        _ => paint,
    });
}

/// A round body along `X` through (x, radius) points.
pub fn lathe(mesh: &mut Mesh, paint: Paint, center: Vec3, profile: &[(f32, f32)], pieces: usize) {
    let rings: Vec<Vec<Vec3>> = profile
        .iter()
        .map(|&(x, r)| {
            (0..pieces)
                .map(|i| {
                    let (sin, cos) = sin_cos(360.0 * i as f64 / pieces as f64);
                    center + Vec3::new(x, r * cos, r * sin)
                })
                .collect()
        })
        .collect();
    mesh.tube(paint, &rings);
}

/// A wheel with its axle along `X`.
pub fn wheel(mesh: &mut Mesh, radius: f32, width: f32, rim: Paint) {
    let (h, r) = (0.5 * width, radius);
    let inner = 0.66 * r;
    lathe(
        mesh,
        Paint::Rubber,
        Vec3::ZERO,
        &[
            (-h, inner),
            (-h, 0.9 * r),
            (-0.7 * h, r),
            (0.7 * h, r),
            (h, 0.9 * r),
            (h, inner),
        ],
        24,
    );
    for side in [-1.0, 1.0] {
        let x = side * (h + 0.004);
        let at = |degrees: f64, r: f32| {
            let (sin, cos) = sin_cos(degrees);
            Vec3::new(x, r * cos, r * sin)
        };
        let face = |mesh: &mut Mesh, paint: Paint, mut points: Vec<Vec3>, lift: f32| {
            for point in &mut points {
                point.x += side * lift;
            }
            if side < 0.0 {
                points.reverse();
            }
            mesh.polygon(paint, &points);
        };
        let ring = |r: f32, count: usize| -> Vec<Vec3> {
            (0..count)
                .map(|i| at(360.0 * i as f64 / count as f64, r))
                .collect()
        };
        face(mesh, Paint::Ink, ring(inner, 24), 0.0);
        // The rim's edge.
        for i in 0..24 {
            let (a, b) = (15.0 * f64::from(i), 15.0 * f64::from(i + 1));
            face(
                mesh,
                rim,
                vec![
                    at(a, 0.88 * inner),
                    at(a, inner),
                    at(b, inner),
                    at(b, 0.88 * inner),
                ],
                0.003,
            );
        }
        for i in 0..5 {
            let a = 72.0 * f64::from(i);
            face(
                mesh,
                rim,
                vec![
                    at(a - 30.0, 0.18 * r),
                    at(a - 9.0, 0.92 * inner),
                    at(a + 9.0, 0.92 * inner),
                    at(a + 30.0, 0.18 * r),
                ],
                0.006,
            );
        }
        face(mesh, Paint::Slate, ring(0.12 * r, 10), 0.012);
    }
}

/// A pair of boxes, mirrored.
pub fn pair(mesh: &mut Mesh, paint: Paint, center: Vec3, size: Vec3) {
    for x in [-center.x, center.x] {
        mesh.cuboid(paint, Vec3::new(x, center.y, center.z), size);
    }
}

/// A bar with a square section from one point to another.
pub fn bar(mesh: &mut Mesh, paint: Paint, from: Vec3, to: Vec3, thick: f32) {
    let way = (to - from).normalize_or(Vec3::Z);
    let side = way
        .cross(if way.y.abs() > 0.9 { Vec3::X } else { Vec3::Y })
        .normalize();
    let up = side.cross(way);
    let h = 0.5 * thick;
    // Clockwise along the way.
    let ring = |at: Vec3| {
        [(-h, h), (h, h), (h, -h), (-h, -h)]
            .map(|(s, u)| at + side * s + up * u)
            .to_vec()
    };
    mesh.tube(paint, &[ring(from), ring(to)]);
}

/// Someone who sits, hips at this point.
pub fn driver(mesh: &mut Mesh, hips: Vec3, cloth: Paint, lean: f32, hands: Vec3) {
    let shoulders = hips + Vec3::new(0.0, 0.48, -lean);
    bar(mesh, cloth, hips + Vec3::Y * 0.02, shoulders, 0.3);
    let head = shoulders + Vec3::new(0.0, 0.2, -0.04);
    lathe(
        mesh,
        Paint::White,
        head,
        &[
            (-0.13, 0.07),
            (-0.09, 0.125),
            (0.0, 0.145),
            (0.09, 0.125),
            (0.13, 0.07),
        ],
        12,
    );
    mesh.cuboid(
        Paint::Glass,
        head + Vec3::new(0.0, 0.0, -0.09),
        Vec3::new(0.2, 0.09, 0.12),
    );
    for side in [-1.0, 1.0] {
        let x = Vec3::X * (0.19 * side);
        bar(mesh, cloth, shoulders + x - Vec3::Y * 0.04, hands + x, 0.1);
        let knee = hips + Vec3::new(0.16 * side, 0.14, -0.42);
        bar(mesh, Paint::Slate, hips + x * 0.5, knee, 0.15);
        bar(
            mesh,
            Paint::Slate,
            knee,
            knee + Vec3::new(0.02 * side, -0.3, -0.12),
            0.13,
        );
    }
}
