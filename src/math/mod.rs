//! Small pure helpers: distances between simple shapes, nearest points of constraint sets.

pub(crate) mod cuboid;
pub(crate) mod lanes;
pub(crate) mod planes;
pub(crate) mod segment;
pub(crate) mod triangle;
#[cfg(feature = "vehicle")]
pub(crate) mod wheel;

use bevy::math::Vec3;

/// How far beside an edge a ray still hits, metres.
pub(crate) const RAY_SLACK: f32 = 1.0e-4;

/// The closest pair of a segment and a solid, as seen from the segment.
///
/// `distance` is measured from the segment itself, so it keeps its direction however deep a
/// rounded shape around the segment is pressed in; only when the segment itself is inside is it
/// negative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    /// Signed distance, metres.
    pub distance: f32,
    /// From the solid to the segment, unit length.
    pub normal: Vec3,
    /// The closest point of the solid.
    pub point: Vec3,
    /// Whether that point is inside a face, so that `normal` is the face's own.
    pub on_face: bool,
    /// Normal of the most upward face that holds the point.
    pub surface: Vec3,
}

/// Unit vector along `v`, or `or` when `v` has no direction.
#[inline]
pub(crate) fn direction_or(v: Vec3, or: Vec3) -> Vec3 {
    let length = v.length();
    if length > 1.0e-12 && length.is_finite() {
        v / length
    } else {
        or
    }
}
