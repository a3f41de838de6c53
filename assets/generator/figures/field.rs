//! Rounded solids melted into each other: a signed field, negative inside.

use bevy::math::{DQuat, DVec3};

#[derive(Clone, Debug)]
enum Shape {
    /// Two balls and the cone that wraps them.
    Cone { ends: [DVec3; 2], radii: [f64; 2] },
    Ball {
        center: DVec3,
        radii: DVec3,
        turn: DQuat,
    },
}

/// A solid, how it is flattened, cut and melted into those before it.
#[derive(Clone, Debug)]
pub struct Blob {
    shape: Shape,
    squash: Option<(DVec3, f64)>,
    cut: Option<(DVec3, DVec3)>,
    blend: f64,
}

impl Blob {
    fn of(shape: Shape) -> Self {
        Self {
            shape,
            squash: None,
            cut: None,
            blend: 0.03,
        }
    }

    pub fn cone(ends: [DVec3; 2], radii: [f64; 2]) -> Self {
        Self::of(Shape::Cone { ends, radii })
    }

    pub fn ball(center: DVec3, radii: DVec3) -> Self {
        Self::turned_ball(center, radii, DQuat::IDENTITY)
    }

    pub fn turned_ball(center: DVec3, radii: DVec3, turn: DQuat) -> Self {
        Self::of(Shape::Ball {
            center,
            radii,
            turn,
        })
    }

    /// Thinner along an axis, by a factor below one.
    pub fn squash(mut self, axis: DVec3, factor: f64) -> Self {
        self.squash = Some((axis.normalize(), factor));
        self
    }

    /// Ends at a plane; what lies on the side of the normal is taken away.
    pub fn cut(mut self, point: DVec3, normal: DVec3) -> Self {
        self.cut = Some((point, normal.normalize()));
        self
    }

    /// Metres over which it melts into those before it.
    pub fn blend(mut self, blend: f64) -> Self {
        self.blend = blend;
        self
    }

    /// The same at the other side of the body.
    pub fn mirrored(&self) -> Self {
        let flip = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
        Self {
            shape: match &self.shape {
                Shape::Cone { ends, radii } => Shape::Cone {
                    ends: ends.map(flip),
                    radii: *radii,
                },
                Shape::Ball {
                    center,
                    radii,
                    turn,
                } => Shape::Ball {
                    center: flip(*center),
                    radii: *radii,
                    turn: super::skeleton::mirror(*turn),
                },
            },
            squash: self.squash.map(|(axis, factor)| (flip(axis), factor)),
            cut: self.cut.map(|(point, normal)| (flip(point), flip(normal))),
            blend: self.blend,
        }
    }

    fn at(&self, point: DVec3) -> f64 {
        let mut p = point;
        if let Some((axis, factor)) = self.squash {
            let pivot = match &self.shape {
                Shape::Cone { ends, .. } => ends[0],
                Shape::Ball { center, .. } => *center,
            };
            p += axis * (axis.dot(p - pivot) * (1.0 / factor - 1.0));
        }
        let distance = match &self.shape {
            Shape::Cone { ends, radii } => cone(p, *ends, *radii),
            Shape::Ball {
                center,
                radii,
                turn,
            } => {
                let q = turn.inverse() * (p - *center);
                let near = (q / *radii).length();
                let slope = (q / (*radii * *radii)).length();
                if slope < 1e-9 {
                    -radii.min_element()
                } else {
                    near * (near - 1.0) / slope
                }
            }
        };
        match self.cut {
            None => distance,
            Some((at, normal)) => -melt(-distance, -normal.dot(point - at), 0.016),
        }
    }
}

/// Distance from a cone with round ends.
fn cone(p: DVec3, [a, b]: [DVec3; 2], [ra, rb]: [f64; 2]) -> f64 {
    let along = b - a;
    let length = along.length();
    let axis = along / length;
    let y = axis.dot(p - a);
    let x = (p - a - axis * y).length();
    // Slope of the wall against the axis.
    let sin = (ra - rb) / length;
    let cos = (1.0 - sin * sin).max(0.0).sqrt();
    let foot = y - x * sin / cos.max(1e-9);
    if foot < 0.0 {
        (x * x + y * y).sqrt() - ra
    } else if foot > length {
        (x * x + (y - length) * (y - length)).sqrt() - rb
    } else {
        x * cos + y * sin - ra
    }
}

/// The smaller of two, rounded where they meet.
fn melt(a: f64, b: f64, blend: f64) -> f64 {
    let near = (blend - (a - b).abs()).max(0.0);
    a.min(b) - near * near / (4.0 * blend)
}

/// Solids melted into each other, in order.
#[derive(Clone, Debug, Default)]
pub struct Field(Vec<Blob>);

impl Field {
    pub fn add(&mut self, blob: Blob) -> &mut Self {
        self.0.push(blob);
        self
    }

    /// On both sides of the body.
    pub fn pair(&mut self, blob: Blob) -> &mut Self {
        let other = blob.mirrored();
        self.add(blob).add(other)
    }

    pub fn at(&self, p: DVec3) -> f64 {
        let mut blobs = self.0.iter();
        let first = blobs.next().map_or(f64::INFINITY, |blob| blob.at(p));
        blobs.fold(first, |d, blob| melt(d, blob.at(p), blob.blend))
    }

    /// Direction in which it grows.
    pub fn slope(&self, p: DVec3) -> DVec3 {
        let step = 5e-4;
        DVec3::new(
            self.at(p + DVec3::X * step) - self.at(p - DVec3::X * step),
            self.at(p + DVec3::Y * step) - self.at(p - DVec3::Y * step),
            self.at(p + DVec3::Z * step) - self.at(p - DVec3::Z * step),
        ) / (2.0 * step)
    }
}
