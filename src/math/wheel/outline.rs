//! A circle that moves along a line until it touches a flat polygon, and the polygon cut to a width.

use arrayvec::ArrayVec;
use bevy::math::{Vec2, Vec3};

/// A corner of what lies within the width: place along the axle, along the way and across.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub aside: f32,
    pub at: Vec2,
    /// Which rim cut it off: 0 for none.
    rim: i8,
    /// Direction of the edge that the rim cut, in the same coordinates.
    edge: Vec3,
}

/// What of a face the tread touches.
#[derive(Clone, Copy)]
pub(super) enum Feature {
    /// An edge or a corner, with the tread.
    Edge,
    /// Its face, with a rim.
    Face,
    /// An edge of this direction, with a rim.
    Cut(Vec3),
}

/// How far the wheel goes, where it touches in its plane, and what.
pub(super) type First = (f32, Vec2, Feature);

pub(super) type Corners = ArrayVec<Corner, 8>;

/// What of a polygon is where `depth` is not negative.
pub(super) fn clip(polygon: &Corners, rim: i8, depth: impl Fn(&Corner) -> f32) -> Corners {
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
    /// One that no rim cut.
    pub fn new(aside: f32, at: Vec2) -> Self {
        Self {
            aside,
            at,
            rim: 0,
            edge: Vec3::ZERO,
        }
    }

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
pub(super) fn first_touch(polygon: &Corners, r: f32) -> Option<First> {
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
pub(super) fn nearest(polygon: &Corners) -> Option<First> {
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
