//! The edges of a convex hull, for drawing.

use bevy::prelude::*;

/// More points than this are drawn without their edges: the search below is quartic.
const MOST_POINTS: usize = 32;

/// Pairs of points between which the hull of all points has a real edge; edges between coplanar
/// faces are left out.
pub(super) fn hull_edges(points: &[Vec3]) -> Vec<(usize, usize)> {
    let n = points.len();
    if n > MOST_POINTS {
        return Vec::new();
    }
    let mut edges = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            if is_edge(points, i, j) {
                edges.push((i, j));
            }
        }
    }
    edges
}

/// Whether two faces that are not coplanar meet between two points, and nothing lies between them.
fn is_edge(points: &[Vec3], i: usize, j: usize) -> bool {
    let (a, b) = (points[i], points[j]);
    let along = b - a;
    let size = points
        .iter()
        .map(|p| p.distance(a))
        .fold(0.0f32, f32::max)
        .max(f32::MIN_POSITIVE);
    let thin = 1e-4 * size;
    let mut faces: Vec<Vec3> = Vec::new();
    for &c in points {
        let normal = along.cross(c - a);
        if normal.length() <= thin * along.length() {
            // On the line: strictly between the two means that the edge is made of shorter ones.
            let t = (c - a).dot(along) / along.length_squared();
            if t > 1e-4 && t < 1.0 - 1e-4 {
                return false;
            }
            continue;
        }
        let normal = normal.normalize();
        let (low, high) = points
            .iter()
            .map(|p| (*p - a).dot(normal))
            .fold((0.0f32, 0.0f32), |(low, high), d| (low.min(d), high.max(d)));
        let outward = if high <= thin {
            normal
        } else if low >= -thin {
            -normal
        } else {
            continue;
        };
        if faces.iter().all(|face| face.dot(outward) < 0.9999) {
            faces.push(outward);
        }
    }
    faces.len() >= 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> Vec<Vec3> {
        (0..8u8)
            .map(|i| {
                Vec3::new(
                    f32::from(i & 1),
                    f32::from((i >> 1) & 1),
                    f32::from((i >> 2) & 1),
                )
            })
            .collect()
    }

    #[test]
    fn a_cube_has_twelve_edges_and_no_diagonals() {
        let points = cube();
        let edges = hull_edges(&points);
        assert_eq!(edges.len(), 12);
        for (i, j) in edges {
            assert!((points[i].distance(points[j]) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn points_inside_and_in_the_middle_of_edges_add_nothing_wrong() {
        let mut points = cube();
        points.push(Vec3::splat(0.5));
        points.push(Vec3::new(0.5, 0.0, 0.0));
        // The edge with a point on it is drawn as its two halves.
        assert_eq!(hull_edges(&points).len(), 13);
    }

    #[test]
    fn a_tetrahedron_has_six_edges() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        assert_eq!(hull_edges(&points).len(), 6);
    }
}
