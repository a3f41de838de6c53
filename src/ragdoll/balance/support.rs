//! The area that feet stand on: the convex hull of their soles, seen from above.

use arrayvec::ArrayVec;
use bevy::prelude::*;

/// More corners than the soles of two feet have.
const MOST: usize = 48;

/// A convex area, corner by corner.
#[derive(Clone, Debug, Default)]
pub(super) struct Support {
    corners: ArrayVec<Vec2, MOST>,
}

/// Twice the area of a triangle, positive when it turns from the first axis to the second.
fn turn(a: Vec2, b: Vec2, c: Vec2) -> f32 {
    (b - a).perp_dot(c - a)
}

/// The point of an edge that is nearest to a point.
fn on_edge(a: Vec2, b: Vec2, point: Vec2) -> Vec2 {
    let way = b - a;
    let length = way.length_squared();
    if length <= 0.0 {
        return a;
    }
    a + way * ((point - a).dot(way) / length).clamp(0.0, 1.0)
}

impl Support {
    /// The smallest convex area with these points in it; points beyond the most are left out.
    pub fn around(points: impl IntoIterator<Item = Vec2>) -> Self {
        let mut all: ArrayVec<Vec2, MOST> = points.into_iter().take(MOST).collect();
        all.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        if all.len() < 3 {
            return Self { corners: all };
        }
        // Along the lower side, then back along the upper one.
        let mut corners: ArrayVec<Vec2, MOST> = ArrayVec::new();
        let mut side = |points: &mut dyn Iterator<Item = Vec2>| {
            let first = corners.len();
            for point in points {
                while corners.len() >= first + 2
                    && turn(
                        corners[corners.len() - 2],
                        corners[corners.len() - 1],
                        point,
                    ) <= 0.0
                {
                    corners.pop();
                }
                if corners.try_push(point).is_err() {
                    break;
                }
            }
            // The next side begins with it.
            corners.pop();
        };
        side(&mut all.iter().copied());
        side(&mut all.iter().rev().copied());
        Self { corners }
    }

    /// Whether there is nothing to stand on.
    pub fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    fn edges(&self) -> impl Iterator<Item = (Vec2, Vec2)> {
        let n = self.corners.len();
        (0..n).map(move |i| (self.corners[i], self.corners[(i + 1) % n]))
    }

    /// How far inside a point is, metres; negative outside.
    pub fn margin(&self, point: Vec2) -> f32 {
        let inside = self.corners.len() > 2 && self.edges().all(|(a, b)| turn(a, b, point) >= 0.0);
        let edge = self
            .edges()
            .map(|(a, b)| on_edge(a, b, point).distance(point));
        let edge = edge.fold(f32::INFINITY, f32::min);
        if inside { edge } else { -edge }
    }

    /// The point of the area that is nearest to a point.
    pub fn clamp(&self, point: Vec2) -> Vec2 {
        if self.is_empty() || self.margin(point) >= 0.0 {
            return point;
        }
        let near = self.edges().map(|(a, b)| on_edge(a, b, point));
        near.min_by(|a, b| {
            a.distance_squared(point)
                .total_cmp(&b.distance_squared(point))
        })
        .unwrap_or(point)
    }

    /// The mean of its corners.
    pub fn middle(&self) -> Vec2 {
        self.corners.iter().sum::<Vec2>() / (self.corners.len() as f32).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn feet() -> Vec<Vec2> {
        let mut points = Vec::new();
        for x in [-0.15f32, 0.15] {
            for z in [-0.18f32, -0.05, 0.0, 0.08] {
                points.extend([Vec2::new(x - 0.04, z), Vec2::new(x + 0.04, z)]);
            }
        }
        points
    }

    #[test]
    fn the_hull_of_two_soles_is_the_rectangle_around_both() {
        let support = Support::around(feet());
        assert_eq!(support.corners.len(), 4);
        for i in -20..=20 {
            for j in -20..=20 {
                let point = Vec2::new(i as f32, j as f32) * 0.02;
                let out = (point.x.abs() - 0.19).max((point.y + 0.05).abs() - 0.13);
                let near = point.clamp(Vec2::new(-0.19, -0.18), Vec2::new(0.19, 0.08));
                assert!(support.clamp(point).distance(near) < 1e-6, "{point}");
                let margin = support.margin(point);
                if out < 0.0 {
                    assert!((margin + out).abs() < 1e-6, "{point}: {margin}");
                } else {
                    let off = near.distance(point);
                    assert!((margin + off).abs() < 1e-6, "{point}: {margin}");
                }
            }
        }
    }

    #[test]
    fn one_point_two_points_and_none_are_no_area_but_do_no_harm() {
        let point = Vec2::new(0.3, 0.4);
        assert!(Support::default().is_empty());
        assert_eq!(Support::default().clamp(point), point);
        let one = Support::around([Vec2::ZERO]);
        assert!((one.margin(point) + 0.5).abs() < 1e-6);
        assert_eq!(one.clamp(point), Vec2::ZERO);
        let two = Support::around([Vec2::ZERO, Vec2::X]);
        assert!(two.clamp(point).distance(Vec2::new(0.3, 0.0)) < 1e-6);
    }
}
