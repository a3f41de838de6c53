//! One axis of a tyre at its present load: force and slope against slip.

use bevy::math::ops;

use super::config::TireModel;

/// A curve whose force is in parts of `µ N`.
#[derive(Clone, Copy)]
pub(crate) struct AxisCurve<'a> {
    model: &'a TireModel,
    /// Slope at no slip, 1.
    slope: f32,
}

impl<'a> AxisCurve<'a> {
    /// `limit` is `µ N` (newtons), `stiffening` the factor on the nominal stiffness.
    pub fn new(model: &'a TireModel, limit: f32, stiffening: f32) -> Self {
        let limit = limit.max(1.0e-6);
        let slope = match model {
            TireModel::Linear { stiffness } | TireModel::Brush { stiffness } => {
                stiffness * stiffening / limit
            }
            TireModel::Magic { b, c, .. } => b * c,
            TireModel::Curve { points } => points.first().map_or(1.0, |p| p.force / p.slip),
        };
        Self {
            model,
            slope: slope.max(1.0e-3),
        }
    }

    /// Slope at no slip, in parts of `µ N` per unit of slip.
    pub fn slope(&self) -> f32 {
        self.slope
    }

    /// Force (parts of `µ N`) and its slope at a slip of at least 0.
    pub fn at(&self, slip: f32) -> (f32, f32) {
        match self.model {
            TireModel::Linear { .. } => {
                let x = self.slope * slip;
                if x < 1.0 { (x, self.slope) } else { (1.0, 0.0) }
            }
            TireModel::Brush { .. } => {
                let x = self.slope * slip / 3.0;
                if x < 1.0 {
                    let rest = 1.0 - x;
                    (x * (3.0 - x * (3.0 - x)), self.slope * rest * rest)
                } else {
                    (1.0, 0.0)
                }
            }
            TireModel::Magic { b, c, e } => {
                let x = b * slip;
                let bent = x - e * (x - ops::atan(x));
                let (sin, cos) = ops::sin_cos(c * ops::atan(bent));
                let inner = b * (1.0 - e * (1.0 - 1.0 / (1.0 + x * x)));
                (sin.max(0.0), cos * c * inner / (1.0 + bent * bent))
            }
            TireModel::Curve { points } => {
                let (mut x0, mut y0) = (0.0, 0.0);
                for p in points {
                    if slip < p.slip {
                        let slope = (p.force - y0) / (p.slip - x0).max(1.0e-6);
                        return (y0 + (slip - x0) * slope, slope);
                    }
                    (x0, y0) = (p.slip, p.force);
                }
                (y0, 0.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::tire::SlipPoint;

    fn near(a: f32, b: f32, tolerance: f32) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b} ± {tolerance}");
    }

    #[test]
    fn a_brush_starts_with_its_stiffness_and_slides_at_three_times_the_linear_slip() {
        let brush = TireModel::Brush { stiffness: 80.0e3 };
        let curve = AxisCurve::new(&brush, 4000.0, 1.0);
        let (force, slope) = curve.at(1.0e-4);
        near(force * 4000.0 / 1.0e-4, 80.0e3, 200.0);
        near(slope * 4000.0, 80.0e3, 200.0);
        // Slides at C s = 3 µN: s = 0.15.
        near(curve.at(0.15).0, 1.0, 1.0e-6);
        assert!(curve.at(0.149).0 < 1.0 && curve.at(0.149).0 > 0.999);
        // Half way: 1 − (1 − ½)³ = 0.875.
        near(curve.at(0.075).0, 0.875, 1.0e-5);
    }

    #[test]
    fn a_magic_formula_has_its_published_peak_and_tail() {
        let magic = TireModel::Magic {
            b: 10.0,
            c: 1.9,
            e: 0.97,
        };
        let curve = AxisCurve::new(&magic, 1.0, 1.0);
        near(curve.at(0.18).0, 1.0, 0.001);
        near(curve.at(1.0).0, 0.9145, 0.001);
        near(curve.slope(), 19.0, 1.0e-5);
    }

    /// A peak at a slip of 0.1, four fifths of it from 0.5 on.
    fn free() -> TireModel {
        let point = |slip, force| SlipPoint { slip, force };
        TireModel::Curve {
            points: vec![point(0.1, 1.0), point(0.5, 0.8)],
        }
    }

    #[test]
    fn every_slope_is_the_derivative_of_its_force() {
        let models = [
            TireModel::Linear { stiffness: 10.0 },
            TireModel::Brush { stiffness: 10.0 },
            TireModel::Magic {
                b: 8.0,
                c: 1.6,
                e: 0.5,
            },
            free(),
        ];
        for model in &models {
            let curve = AxisCurve::new(model, 1.0, 1.0);
            for i in 1..40 {
                let s = i as f32 * 0.0237;
                let h = 1.0e-3;
                let slope = (curve.at(s + h).0 - curve.at(s - h).0) / (2.0 * h);
                // Corners of the straight lines are not differentiable.
                let smooth = !matches!(model, TireModel::Curve { .. }) || (s - 0.1).abs() > 0.01;
                let corner = matches!(model, TireModel::Linear { .. }) && (s - 0.1).abs() < 0.01;
                if smooth && !corner {
                    near(curve.at(s).1, slope, 0.03);
                }
            }
        }
    }

    #[test]
    fn a_free_curve_goes_through_its_points_and_stays_at_the_last() {
        let free = free();
        let curve = AxisCurve::new(&free, 1.0, 1.0);
        near(curve.at(0.05).0, 0.5, 1.0e-6);
        near(curve.at(0.1).0, 1.0, 1.0e-6);
        near(curve.at(0.3).0, 0.9, 1.0e-6);
        near(curve.at(9.0).0, 0.8, 1.0e-6);
    }
}
