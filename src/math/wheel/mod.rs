//! A wheel, moved along a line, against a flat face: where it first touches, in closed form.
//!
//! In the wheel's plane its tread is a circle. What of the face lies within the wheel's width is a
//! polygon, and seen along the axle the polygon is a flat convex figure; the circle meets that at a
//! vertex or an edge. A cast that leans along the axle (camber) shifts the width as it goes; the width
//! is taken where the lowest point of the tread is then.
//!
//! Faces are triangles, and the sides of boxes that look against the way: what comes from outside
//! touches no other side first.

mod outline;
#[cfg(test)]
mod tests;

use bevy::math::{Mat3, Vec2, Vec3};

use super::{cuboid::Cuboid, triangle::Triangle};
use outline::{Corner, Corners, Feature, clip, first_touch, nearest};

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
            // A plate without thickness has edges, too.
            let near = low[u] <= high[u] && low[v] <= high[v];
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
            let aside = p.dot(self.axle) - lean * (s - self.radius);
            Corner::new(aside, Vec2::new(s, p.dot(self.across)))
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
