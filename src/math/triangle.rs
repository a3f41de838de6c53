//! Distance of a segment and a triangle, both sides of which are solid.
//!
//! If both ends of the segment lie on one side of the plane and the nearer end projects into the
//! triangle, its height is the distance: no other pair can be closer. Otherwise the closest pair
//! holds an edge or the other end. A segment that passes through is pushed out along the face
//! normal, to the side that needs less.

use bevy::math::{Vec3, Vec4};

use super::{Closest, RAY_SLACK, direction_or, lanes::Lanes, segment};

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
    #[inline]
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

    /// The edges, one to a lane; the fourth lane repeats the third.
    #[inline]
    fn edges(&self) -> (Lanes, Lanes) {
        let from = Lanes::new(self.a, self.b, self.c);
        let to = Lanes::new(self.b, self.c, self.a);
        (from, to.sub(&from))
    }

    /// Closest pair with the segment `p0 p1`. All three edges at once, a lane each.
    #[inline]
    pub fn closest_to_segment(&self, p0: Vec3, p1: Vec3) -> Closest {
        let n = self.normal;
        let h0 = (p0 - self.a).dot(n);
        let h1 = (p1 - self.a).dot(n);
        // On the side where the segment is, the face looks at it.
        let face = if h0 + h1 >= 0.0 { n } else { -n };
        let (from, along) = self.edges();
        // How far inside each edge the ends project, times the edge's length.
        let inward = Lanes::splat(n).cross(&along);
        let r0 = Lanes::splat(p0).sub(&from);
        let inside0 = inward.dot(&r0);
        let d = Lanes::splat(p1 - p0);
        let change = inward.dot(&d);
        let inside1 = inside0 + change;
        let covers = |inside: Vec4| inside.cmpge(Vec4::ZERO).all();

        if h0 * h1 <= 0.0 && (h0 != 0.0 || h1 != 0.0) {
            let t = h0 / (h0 - h1);
            if covers(inside0 + change * t) {
                let depth = if h0 + h1 >= 0.0 {
                    -h0.min(h1)
                } else {
                    h0.max(h1)
                };
                return Closest {
                    distance: -depth,
                    normal: face,
                    point: p0 + (p1 - p0) * t,
                    on_face: true,
                    surface: face,
                };
            }
        }

        let (near, height, over) = if h0.abs() <= h1.abs() {
            (p0, h0, inside0)
        } else {
            (p1, h1, inside1)
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

        let (s, t) = segment::closest_parameters_of_four(p1 - p0, &along, &r0);
        let gap = r0.add(&d.scaled(s)).sub(&along.scaled(t));
        let squares = gap.dot(&gap).to_array();
        let mut i = 0;
        for other in 1..3 {
            if squares[other] < squares[i] {
                i = other;
            }
        }
        for (p, h, inside) in [(p0, h0, inside0), (p1, h1, inside1)] {
            if h * h < squares[i] && covers(inside) {
                return Closest {
                    distance: h.abs(),
                    normal: if h >= 0.0 { n } else { -n },
                    point: p - n * h,
                    on_face: true,
                    surface: face,
                };
            }
        }
        let (q0, q1) = match i {
            0 => (self.a, self.b),
            1 => (self.b, self.c),
            _ => (self.c, self.a),
        };
        let on_triangle = q0 + (q1 - q0) * t.to_array()[i];
        let offset = p0 + (p1 - p0) * s.to_array()[i] - on_triangle;
        let normal = direction_or(offset, face);
        // Just outside of an edge it is the face still: its exact normal, not one tilted by rounding.
        let on_face = normal.dot(face) > 0.999_99;
        Closest {
            distance: offset.length(),
            normal: if on_face { face } else { normal },
            point: on_triangle,
            on_face,
            surface: face,
        }
    }

    /// Whether the segment `p0 p1` is farther than `distance` from the triangle for certain: on one
    /// side of its plane, or outside of one of its edges. Cheap, and may miss.
    #[inline]
    pub fn is_beyond(&self, p0: Vec3, p1: Vec3, distance: f32) -> bool {
        let n = self.normal;
        let h0 = (p0 - self.a).dot(n);
        let h1 = (p1 - self.a).dot(n);
        if h0.min(h1) > distance || h0.max(h1) < -distance {
            return true;
        }
        let (from, along) = self.edges();
        let inward = Lanes::splat(n).cross(&along);
        let most = inward
            .dot(&Lanes::splat(p0).sub(&from))
            .max(inward.dot(&Lanes::splat(p1).sub(&from)));
        let outside = most.min(Vec4::ZERO);
        (outside * outside)
            .cmpgt(inward.dot(&inward) * (distance * distance))
            .any()
    }

    /// Distance along `dir` at which a ray meets either side, at most `max`. Edges are wider than
    /// they are by a tenth of a millimetre, so that no ray slips between two triangles.
    pub fn cast_ray(&self, origin: Vec3, dir: Vec3, max: f32) -> Option<f32> {
        let approach = self.normal.dot(dir);
        if approach.abs() < 1.0e-8 {
            return None;
        }
        let t = (self.a - origin).dot(self.normal) / approach;
        if !(t >= 0.0 && t <= max) {
            return None;
        }
        let p = origin + dir * t;
        let (from, along) = self.edges();
        let inside = Lanes::splat(self.normal)
            .cross(&along)
            .dot(&Lanes::splat(p).sub(&from));
        let outside = inside.min(Vec4::ZERO);
        (outside * outside)
            .cmple(along.dot(&along) * (RAY_SLACK * RAY_SLACK))
            .all()
            .then_some(t)
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
            let Some(triangle) = Triangle::new(a, b, c) else {
                continue;
            };
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
