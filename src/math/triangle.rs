//! Distance of a segment and a triangle, both sides of which are solid.
//!
//! If both ends of the segment lie on one side of the plane and the nearer end projects into the
//! triangle, its height is the distance: no other pair can be closer. Otherwise the closest pair
//! holds an edge or the other end. A segment that passes through is pushed out along the face
//! normal, to the side that needs less.

use bevy::math::Vec3;

use super::{Closest, direction_or, segment};

/// A triangle with its unit normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub a: Vec3,
    pub b: Vec3,
    pub c: Vec3,
    pub normal: Vec3,
}

impl Triangle {
    /// The triangle, or `None` when it has no area.
    pub fn new(a: Vec3, b: Vec3, c: Vec3) -> Option<Self> {
        let cross = (b - a).cross(c - a);
        let length = cross.length();
        let longest = (b - a)
            .length_squared()
            .max((c - a).length_squared())
            .max((c - b).length_squared());
        // Thinner than a millionth of its length: no usable normal.
        if !(length > 1.0e-6 * longest) {
            return None;
        }
        Some(Self {
            a,
            b,
            c,
            normal: cross / length,
        })
    }

    /// Whether the projection of `p` along the normal falls inside.
    pub fn covers(&self, p: Vec3) -> bool {
        let n = self.normal;
        (self.b - self.a).cross(p - self.a).dot(n) >= 0.0
            && (self.c - self.b).cross(p - self.b).dot(n) >= 0.0
            && (self.a - self.c).cross(p - self.c).dot(n) >= 0.0
    }

    /// Closest pair with the segment `p0 p1`.
    pub fn closest_to_segment(&self, p0: Vec3, p1: Vec3) -> Closest {
        let n = self.normal;
        let h0 = (p0 - self.a).dot(n);
        let h1 = (p1 - self.a).dot(n);
        // On the side where the segment is, the face looks at it.
        let face = if h0 + h1 >= 0.0 { n } else { -n };
        let edges = [(self.a, self.b), (self.b, self.c), (self.c, self.a)];
        // How far inside each edge the ends project, times the edge's length.
        let inward = edges.map(|(q0, q1)| n.cross(q1 - q0));
        let inside0 = [0, 1, 2].map(|i| inward[i].dot(p0 - edges[i].0));
        let inside1 = [0, 1, 2].map(|i| inward[i].dot(p1 - edges[i].0));
        let covers = |inside: &[f32; 3]| inside.iter().all(|i| *i >= 0.0);

        if h0 * h1 <= 0.0 && (h0 != 0.0 || h1 != 0.0) {
            let t = h0 / (h0 - h1);
            let crossing = p0 + (p1 - p0) * t;
            if self.covers(crossing) {
                let depth = if h0 + h1 >= 0.0 {
                    -h0.min(h1)
                } else {
                    h0.max(h1)
                };
                return Closest {
                    distance: -depth,
                    normal: face,
                    point: crossing,
                    on_face: true,
                    surface: face,
                };
            }
        }

        let (near, height, over) = if h0.abs() <= h1.abs() {
            (p0, h0, &inside0)
        } else {
            (p1, h1, &inside1)
        };
        if h0 * h1 > 0.0 && covers(over) {
            return Closest {
                distance: height.abs(),
                normal: face,
                point: near - n * height,
                on_face: true,
                surface: face,
            };
        }

        let mut best = f32::MAX;
        let mut on_segment = p0;
        let mut on_triangle = self.a;
        for (i, (q0, q1)) in edges.into_iter().enumerate() {
            // The closest point is on an edge only if the segment reaches outside of that edge, and
            // no closer than it is outside as a whole.
            let most = inside0[i].max(inside1[i]);
            let outside = most.min(0.0);
            if inside0[i].min(inside1[i]) > 0.0
                || outside * outside > best * inward[i].length_squared()
            {
                continue;
            }
            let (s, t) = segment::closest_parameters(p0, p1, q0, q1);
            let x = p0 + (p1 - p0) * s;
            let y = q0 + (q1 - q0) * t;
            let d = x.distance_squared(y);
            if d < best {
                best = d;
                on_segment = x;
                on_triangle = y;
            }
        }
        for (p, h, inside) in [(p0, h0, &inside0), (p1, h1, &inside1)] {
            if h * h < best && covers(inside) {
                return Closest {
                    distance: h.abs(),
                    normal: if h >= 0.0 { n } else { -n },
                    point: p - n * h,
                    on_face: true,
                    surface: face,
                };
            }
        }
        let normal = direction_or(on_segment - on_triangle, face);
        Closest {
            distance: (on_segment - on_triangle).length(),
            normal,
            point: on_triangle,
            on_face: normal.dot(face) > 0.999_99,
            surface: face,
        }
    }

    /// Whether the segment `p0 p1` is farther than `distance` from the triangle for certain: on one
    /// side of its plane, or outside of one of its edges. Cheap, and may miss.
    pub fn is_beyond(&self, p0: Vec3, p1: Vec3, distance: f32) -> bool {
        let n = self.normal;
        let h0 = (p0 - self.a).dot(n);
        let h1 = (p1 - self.a).dot(n);
        if h0.min(h1) > distance || h0.max(h1) < -distance {
            return true;
        }
        [(self.a, self.b), (self.b, self.c), (self.c, self.a)]
            .into_iter()
            .any(|(q0, q1)| {
                let inward = n.cross(q1 - q0);
                let most = inward.dot(p0 - q0).max(inward.dot(p1 - q0));
                most < 0.0 && most * most > distance * distance * inward.length_squared()
            })
    }

    /// Distance along `dir` at which a ray meets either side, at most `max`.
    pub fn cast_ray(&self, origin: Vec3, dir: Vec3, max: f32) -> Option<f32> {
        let approach = self.normal.dot(dir);
        if approach.abs() < 1.0e-8 {
            return None;
        }
        let t = (self.a - origin).dot(self.normal) / approach;
        (t >= 0.0 && t <= max && self.covers(origin + dir * t)).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn floor() -> Triangle {
        Triangle::new(
            Vec3::ZERO,
            Vec3::new(0.0, 0.0, 4.0),
            Vec3::new(4.0, 0.0, 0.0),
        )
        .unwrap()
    }

    #[test]
    fn a_segment_above_a_face_is_as_far_as_its_lower_end() {
        let c = floor().closest_to_segment(Vec3::new(1.0, 0.5, 1.0), Vec3::new(1.0, 2.0, 1.0));
        assert!((c.distance - 0.5).abs() < 1e-6 && c.normal.distance(Vec3::Y) < 1e-6);
        assert!(c.on_face);
    }

    #[test]
    fn a_segment_beside_an_edge_is_as_far_as_the_edge() {
        let c = floor().closest_to_segment(Vec3::new(-0.3, 0.4, 1.0), Vec3::new(-0.3, 2.0, 1.0));
        assert!((c.distance - 0.5).abs() < 1e-6, "{c:?}");
        assert!(c.normal.distance(Vec3::new(-0.6, 0.8, 0.0)) < 1e-6 && !c.on_face);
    }

    #[test]
    fn a_segment_through_a_face_leaves_by_the_shorter_way() {
        let c = floor().closest_to_segment(Vec3::new(1.0, -0.2, 1.0), Vec3::new(1.0, 1.0, 1.0));
        assert!((c.distance + 0.2).abs() < 1e-6 && c.normal.distance(Vec3::Y) < 1e-6);
        let c = floor().closest_to_segment(Vec3::new(1.0, -1.0, 1.0), Vec3::new(1.0, 0.2, 1.0));
        assert!((c.distance + 0.2).abs() < 1e-6 && c.normal.distance(Vec3::NEG_Y) < 1e-6);
    }

    #[test]
    fn no_sampled_pair_is_closer_than_the_closest_pair() {
        let mut seed = 7u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for _ in 0..500 {
            let mut v = || Vec3::new(next(), next(), next());
            let (a, b, c, p0, p1) = (v(), v(), v(), v(), v());
            let Some(triangle) = Triangle::new(a, b, c) else {
                continue;
            };
            let found = triangle.closest_to_segment(p0, p1);
            let mut least = f32::MAX;
            for i in 0..=12 {
                for j in 0..=(12 - i) {
                    let (u, w) = (i as f32 / 12.0, j as f32 / 12.0);
                    let q = a + (b - a) * u + (c - a) * w;
                    for k in 0..=24 {
                        least = least.min(p0.lerp(p1, k as f32 / 24.0).distance(q));
                    }
                }
            }
            assert!(found.distance <= least + 1e-5, "{found:?} {least}");
            assert!(
                found.distance < 0.0 || found.distance > least - 0.2,
                "{found:?} {least}"
            );
        }
    }

    #[test]
    fn what_is_called_beyond_a_distance_is() {
        let mut seed = 3u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let mut beyond = 0;
        for _ in 0..2000 {
            let mut v = || Vec3::new(next(), next(), next());
            let (a, b, c, p0, p1) = (v(), v(), v(), v(), v());
            let Some(triangle) = Triangle::new(a, b, c) else { continue };
            let distance = next().abs();
            if triangle.is_beyond(p0, p1, distance) {
                beyond += 1;
                let found = triangle.closest_to_segment(p0, p1).distance;
                assert!(found > distance - 1e-5, "{found} {distance}");
            }
        }
        assert!(beyond > 200, "{beyond}");
    }

    #[test]
    fn slivers_are_refused() {
        assert!(Triangle::new(Vec3::ZERO, Vec3::X, Vec3::X * 2.0).is_none());
        assert!(Triangle::new(Vec3::ZERO, Vec3::NAN, Vec3::X).is_none());
    }
}
