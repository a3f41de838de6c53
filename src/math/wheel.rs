//! A wheel, moved along a line, against a flat face: where it first touches, in closed form.
//!
//! In the wheel's plane its tread is a circle. What of the face lies within the wheel's width is a
//! polygon, and seen along the axle the polygon is a flat convex figure; the circle meets that at a
//! vertex or an edge. A cast that leans along the axle (camber) shifts the width as it goes; the width
//! is taken where the lowest point of the tread is then.
//!
//! Faces are triangles, and the sides of boxes that look against the way: what comes from outside
//! touches no other side first.

use arrayvec::ArrayVec;
use bevy::math::{Mat3, Vec2, Vec3};

use super::{cuboid::Cuboid, triangle::Triangle};

/// A wheel at the start of its way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelCast {
    pub center: Vec3,
    /// Unit length.
    pub axle: Vec3,
    /// Metres.
    pub radius: f32,
    /// Half the width, metres.
    pub half: f32,
    /// The way in the wheel's plane, unit length, and across it.
    along: Vec3,
    across: Vec3,
    /// Parts of the way along and along the axle, for each metre of it.
    pace: f32,
    drift: f32,
}

/// Where a wheel touched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WheelTouch {
    /// Metres of way.
    pub distance: f32,
    /// In the plane through the middle of the wheel.
    pub point: Vec3,
    /// Towards the wheel, unit length.
    pub normal: Vec3,
}

/// A corner of what lies within the width: place along the axle, along the way and across.
#[derive(Clone, Copy)]
struct Corner {
    aside: f32,
    at: Vec2,
    /// Which rim cut it off: 0 for none.
    rim: i8,
    /// Direction of the edge that the rim cut, in the same coordinates.
    edge: Vec3,
}

/// What of a face the tread touches.
#[derive(Clone, Copy)]
enum Feature {
    /// An edge or a corner, with the tread.
    Edge,
    /// Its face, with a rim.
    Face,
    /// An edge of this direction, with a rim.
    Cut(Vec3),
}

/// How far the wheel goes, where it touches in its plane, and what.
type First = (f32, Vec2, Feature);

type Corners = ArrayVec<Corner, 8>;

impl WheelCast {
    /// A wheel that moves along `direction` (unit length); `None` when that is rather its axle.
    pub fn new(center: Vec3, axle: Vec3, radius: f32, half: f32, direction: Vec3) -> Option<Self> {
        let drift = direction.dot(axle);
        let flat = direction - axle * drift;
        let pace = flat.length();
        if !(pace > 0.5) {
            return None;
        }
        let along = flat / pace;
        Some(Self {
            center,
            axle,
            radius,
            half,
            along,
            across: axle.cross(along),
            pace,
            drift,
        })
    }

    /// Where the wheel first touches a triangle within `reach` metres of way. One that it starts in is
    /// touched at once if the wheel moves farther in, else not at all.
    pub fn cast(&self, triangle: &Triangle, reach: f32) -> Option<WheelTouch> {
        let corners = [triangle.a, triangle.b, triangle.c].map(|p| p - self.center);
        self.cast_face(corners, triangle.normal, reach)
    }

    /// The same with a box, which has an inside, but no face that looks along the way.
    pub fn cast_box(&self, cuboid: &Cuboid, reach: f32) -> Option<WheelTouch> {
        let turn = Mat3::from_quat(cuboid.rotation);
        let center = turn.transpose() * (self.center - cuboid.center);
        let way = turn.transpose() * self.direction();
        // Of a face only what is near: huge boxes have corners of few digits.
        let far = Vec3::splat(reach + self.radius + self.half);
        let low = (-cuboid.half).max(center - far) - center;
        let high = cuboid.half.min(center + far) - center;
        let mut first: Option<WheelTouch> = None;
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let near = low[u] < high[u] && low[v] < high[v];
            if !(near && way[axis].abs() > 1.0e-6) {
                continue;
            }
            let side = -way[axis].signum();
            let height = side * cuboid.half[axis] - center[axis];
            let corner = |a: f32, b: f32| {
                let mut at = Vec3::ZERO;
                (at[axis], at[u], at[v]) = (height, a, b);
                turn * at
            };
            let corners = [
                corner(low[u], low[v]),
                corner(high[u], low[v]),
                corner(high[u], high[v]),
                corner(low[u], high[v]),
            ];
            let reach = first.map_or(reach, |touch| touch.distance);
            if let Some(touch) = self.cast_face(corners, turn.col(axis) * side, reach)
                && first.is_none_or(|first| touch.distance < first.distance)
            {
                first = Some(touch);
            }
        }
        first
    }

    fn direction(&self) -> Vec3 {
        self.along * self.pace + self.axle * self.drift
    }

    /// The same with a convex face; its corners in order, relative to the wheel's start.
    fn cast_face<const N: usize>(
        &self,
        corners: [Vec3; N],
        normal: Vec3,
        reach: f32,
    ) -> Option<WheelTouch> {
        let lean = self.drift / self.pace;
        let corners = corners.map(|p| {
            let s = p.dot(self.along);
            Corner {
                aside: p.dot(self.axle) - lean * (s - self.radius),
                at: Vec2::new(s, p.dot(self.across)),
                rim: 0,
                edge: Vec3::ZERO,
            }
        });
        // Quickly out: beside, behind or beyond.
        let all = |out: &dyn Fn(&Corner) -> bool| corners.iter().all(out);
        let (r, far) = (self.radius, self.radius + reach * self.pace);
        if all(&|c| c.aside > self.half)
            || all(&|c| c.aside < -self.half)
            || all(&|c| c.at.y > r)
            || all(&|c| c.at.y < -r)
            || all(&|c| c.at.x < -r)
            || all(&|c| c.at.x > far)
        {
            return None;
        }
        let mut inside: Corners = corners.into_iter().collect();
        inside = clip(&inside, 1, |c| self.half - c.aside);
        inside = clip(&inside, -1, |c| self.half + c.aside);
        let mut touch = first_touch(&inside, r)?;
        if touch.0 < 0.0 {
            touch = nearest(&inside)?;
            if touch.1.length_squared() > r * r || touch.1.x <= 0.0 {
                return None;
            }
        }
        let (way, at, feature) = touch;
        let distance = way / self.pace;
        if !(distance <= reach) {
            return None;
        }
        let arm = at - Vec2::new(way, 0.0);
        let radial = self.along * arm.x + self.across * arm.y;
        let face = normal * -normal.dot(radial).signum();
        let normal = match feature {
            Feature::Edge => -radial.normalize_or(self.along),
            Feature::Face => face,
            Feature::Cut(edge) => {
                let edge = self.axle * (edge.x + lean * edge.y)
                    + self.along * edge.y
                    + self.across * edge.z;
                let tangent = self.across * arm.x - self.along * arm.y;
                let normal = edge.cross(tangent).normalize_or(face);
                normal * -normal.dot(radial).signum()
            }
        };
        Some(WheelTouch {
            distance,
            point: self.center + self.direction() * distance + radial,
            normal,
        })
    }
}

/// What of a polygon is where `depth` is not negative.
fn clip(polygon: &Corners, rim: i8, depth: impl Fn(&Corner) -> f32) -> Corners {
    let mut out = Corners::new();
    for (i, from) in polygon.iter().enumerate() {
        let to = &polygon[(i + 1) % polygon.len()];
        let (d0, d1) = (depth(from), depth(to));
        if d0 >= 0.0 {
            let _ = out.try_push(*from);
        }
        if (d0 < 0.0) != (d1 < 0.0) {
            let t = d0 / (d0 - d1);
            let (aside, way) = (to.aside - from.aside, to.at - from.at);
            let _ = out.try_push(Corner {
                aside: from.aside + aside * t,
                at: from.at + way * t,
                rim,
                edge: Vec3::new(aside, way.x, way.y),
            });
        }
    }
    out
}

impl Corner {
    fn feature(&self) -> Feature {
        if self.rim == 0 {
            Feature::Edge
        } else {
            Feature::Cut(self.edge)
        }
    }

    /// What lies between this corner and the next.
    fn feature_to(&self, next: &Self) -> Feature {
        if self.rim != 0 && self.rim == next.rim {
            Feature::Face
        } else {
            Feature::Edge
        }
    }
}

/// How far a circle of radius `r` around 0 moves along `x` until it touches a polygon.
fn first_touch(polygon: &Corners, r: f32) -> Option<First> {
    let mut first: Option<First> = None;
    let mut offer = |way: f32, at: Vec2, feature: Feature| {
        if first.is_none_or(|(least, ..)| way < least) {
            first = Some((way, at, feature));
        }
    };
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        if a.at.y.abs() <= r {
            let way = a.at.x - (r * r - a.at.y * a.at.y).sqrt();
            offer(way, a.at, a.feature());
        }
        let edge = b.at - a.at;
        let length = edge.length();
        if !(length > 1.0e-7) {
            continue;
        }
        // The edge's normal against the way.
        let mut n = edge.perp() / length;
        if n.x > 0.0 {
            n = -n;
        }
        if n.x > -1.0e-6 {
            continue;
        }
        let way = (r + a.at.dot(n)) / n.x;
        let at = Vec2::new(way, 0.0) - n * r;
        let t = (at - a.at).dot(edge);
        if t >= 0.0 && t <= length * length {
            offer(way, at, a.feature_to(b));
        }
    }
    first
}

/// The point of a polygon's outline nearest to 0, without any way.
fn nearest(polygon: &Corners) -> Option<First> {
    let mut found: Option<First> = None;
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let edge = b.at - a.at;
        let t = (-a.at.dot(edge) / edge.length_squared().max(1.0e-12)).clamp(0.0, 1.0);
        let at = a.at + edge * t;
        if found.is_none_or(|(_, least, _)| at.length_squared() < least.length_squared()) {
            found = Some((0.0, at, a.feature_to(b)));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use bevy::math::Quat;

    use super::*;

    fn down(center: Vec3) -> WheelCast {
        WheelCast::new(center, Vec3::X, 0.3, 0.1, Vec3::NEG_Y).unwrap()
    }

    fn triangle(a: Vec3, b: Vec3, c: Vec3) -> Triangle {
        Triangle::new(a, b, c).unwrap()
    }

    #[test]
    fn on_a_floor_the_wheel_comes_down_to_its_radius() {
        let floor = triangle(
            Vec3::new(-5.0, 0.0, -5.0),
            Vec3::new(0.0, 0.0, 5.0),
            Vec3::new(5.0, 0.0, -5.0),
        );
        let hit = down(Vec3::Y).cast(&floor, 2.0).unwrap();
        assert!((hit.distance - 0.7).abs() < 1.0e-6, "{hit:?}");
        assert!(hit.normal.distance(Vec3::Y) < 1.0e-6 && hit.point.length() < 1.0e-6);
        assert!(down(Vec3::Y).cast(&floor, 0.6).is_none());
    }

    #[test]
    fn on_a_slope_across_the_rim_stands_on_the_face() {
        let slope = triangle(
            Vec3::new(-5.0, -1.0, -5.0),
            Vec3::new(-5.0, -1.0, 5.0),
            Vec3::new(5.0, 1.0, 0.0),
        );
        let hit = down(Vec3::Y).cast(&slope, 2.0).unwrap();
        // The higher rim is 0.1 m aside, where the slope is 0.02 m up.
        assert!((hit.distance - 0.68).abs() < 1.0e-5, "{hit:?}");
        let up = Vec3::new(-0.2, 1.0, 0.0).normalize();
        assert!(hit.normal.distance(up) < 1.0e-5, "{hit:?}");
    }

    #[test]
    fn a_kerb_is_met_by_the_tread_along_its_radius() {
        // The edge of a step 0.18 m before the hub: 0.24 m of the radius are above it.
        let kerb = triangle(
            Vec3::new(-5.0, 0.1, -0.18),
            Vec3::new(5.0, 0.1, -0.18),
            Vec3::new(0.0, 0.1, -9.0),
        );
        let hit = down(Vec3::Y).cast(&kerb, 2.0).unwrap();
        assert!((hit.distance - (0.9 - 0.24)).abs() < 1.0e-5, "{hit:?}");
        let radial = Vec3::new(0.0, 0.24, 0.18) / 0.3;
        assert!(hit.normal.distance(radial) < 1.0e-5, "{hit:?}");
    }

    #[test]
    fn a_face_in_the_way_of_the_start_counts_only_if_the_wheel_moves_into_it() {
        let at = |y: f32| {
            triangle(
                Vec3::new(-5.0, y, -5.0),
                Vec3::new(0.0, y, 5.0),
                Vec3::new(5.0, y, -5.0),
            )
        };
        assert!(down(Vec3::ZERO).cast(&at(0.1), 1.0).is_none());
        let hit = down(Vec3::ZERO).cast(&at(-0.1), 1.0).unwrap();
        assert!(hit.distance == 0.0 && hit.normal.distance(Vec3::Y) < 1.0e-6);
        assert!(down(Vec3::ZERO).cast(&at(0.5), 1.0).is_none());
    }

    #[test]
    fn no_sampled_point_of_the_triangle_is_inside_the_wheel_before_it_touches() {
        let mut seed = 11u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let mut hits = 0;
        for _ in 0..3000 {
            let mut v = || Vec3::new(next(), next(), next());
            let (a, b, c) = (v(), v(), v());
            let Some(t) = Triangle::new(a, b, c) else {
                continue;
            };
            let wheel = down(Vec3::Y * 2.0);
            let mut least = f32::MAX;
            for i in 0..=60 {
                for j in 0..=(60 - i) {
                    let q = a + (b - a) * (i as f32 / 60.0) + (c - a) * (j as f32 / 60.0);
                    if q.x.abs() <= 0.1 && q.z.abs() <= 0.3 {
                        least = least.min(2.0 - q.y - (0.09 - q.z * q.z).sqrt());
                    }
                }
            }
            match wheel.cast(&t, 4.0) {
                Some(hit) => {
                    hits += 1;
                    assert!(hit.distance <= least + 1.0e-4, "{t:?} {hit:?} {least}");
                    // A steep face may come between two samples.
                    let steep = t.normal.y.abs() < 0.3;
                    assert!(steep || least == f32::MAX || hit.distance > least - 0.3);
                }
                None => assert!(least == f32::MAX, "{t:?} {least}"),
            }
        }
        assert!(hits > 300, "{hits}");
    }

    #[test]
    fn a_box_is_touched_as_the_triangles_of_its_surface_are() {
        let mut seed = 5u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let mut hits = 0;
        for _ in 0..2000 {
            let mut v = || Vec3::new(next(), next(), next());
            let cuboid = Cuboid {
                center: v() * 0.6,
                rotation: Quat::from_scaled_axis(v() * 2.0),
                half: v().abs() * 0.5 + 0.05,
            };
            let wheel = down(Vec3::Y * 2.5);
            let corner = |x: f32, y: f32, z: f32| {
                cuboid.center + cuboid.rotation * (cuboid.half * Vec3::new(x, y, z))
            };
            let mut least = f32::MAX;
            for axis in 0..3 {
                for side in [-1.0, 1.0] {
                    let at = |u: f32, v: f32| {
                        let mut p = [side; 3];
                        (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
                        corner(p[0], p[1], p[2])
                    };
                    let (a, b, c, d) = (at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0));
                    for t in [triangle(a, b, c), triangle(a, c, d)] {
                        if let Some(touch) = wheel.cast(&t, 5.0) {
                            least = least.min(touch.distance);
                        }
                    }
                }
            }
            match wheel.cast_box(&cuboid, 5.0) {
                Some(touch) => {
                    hits += 1;
                    assert!((touch.distance - least).abs() < 1.0e-4, "{touch:?} {least}");
                    assert!(touch.normal.y > 0.0, "{touch:?}");
                }
                None => assert!(least == f32::MAX, "{cuboid:?} {least}"),
            }
        }
        assert!(hits > 500, "{hits}");
    }

    #[test]
    fn a_huge_floor_is_as_exact_as_a_small_one() {
        let turned = Quat::from_rotation_y(0.7);
        for half in [1.0, 5000.0] {
            let floor = Cuboid {
                center: Vec3::NEG_Y * 0.5,
                rotation: turned,
                half: Vec3::new(half, 0.5, half),
            };
            let hit = down(Vec3::Y).cast_box(&floor, 2.0).unwrap();
            assert!((hit.distance - 0.7).abs() < 1.0e-6, "{half}: {hit:?}");
        }
    }
}
