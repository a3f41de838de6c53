//! Two bones and a hinge between them, reaching for a point.

use bevy::math::{DMat3, DQuat, DVec3};

/// Upper and lower bone in the bind pose, along the model's axes, slightly bent.
#[derive(Clone, Copy, Debug)]
pub struct Limb {
    pub upper: DVec3,
    pub lower: DVec3,
    /// Most that the hinge bends, radians.
    pub most: f64,
}

impl Limb {
    /// Axis of the hinge: a turn about it bends the limb further.
    pub fn hinge(&self) -> DVec3 {
        self.upper.cross(self.lower).normalize()
    }

    /// Bend in the bind pose, radians.
    pub fn rest(&self) -> f64 {
        self.upper.angle_between(self.lower)
    }

    /// Turn of the upper bone in the model, and of the lower against it, so that the limb from
    /// `from` ends at `to` with its hinge pointing towards `pole`.
    #[expect(
        clippy::disallowed_methods,
        reason = "in double precision and rounded to single right away"
    )]
    pub fn reach(&self, from: DVec3, to: DVec3, pole: DVec3) -> [DQuat; 2] {
        let (a, b) = (self.upper.length(), self.lower.length());
        let gap = to - from;
        let length = gap.length().clamp(1e-3, (a + b) * 0.9995);
        let cos = ((length * length - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0);
        let bend = cos.acos().min(self.most);
        let h = self.hinge();
        let lower = DQuat::from_axis_angle(h, bend - self.rest());
        let e = (self.upper + lower * self.lower).normalize();
        let t = gap.normalize();
        let out = (pole - t * pole.dot(t)).normalize();
        let n = out.cross(t);
        let here = DMat3::from_cols(e, h, e.cross(h));
        let there = DMat3::from_cols(t, n, t.cross(n));
        let upper = DQuat::from_mat3(&(there * here.transpose())).normalize();
        [upper, lower]
    }
}
