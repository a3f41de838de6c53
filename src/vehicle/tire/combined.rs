//! Both axes of a tyre together, on the friction ellipse.

use bevy::math::{Vec2, ops};

use super::{config::Tire, curve::AxisCurve};

/// A contact patch at its present load.
#[derive(Clone, Copy)]
pub(crate) struct Patch<'a> {
    along: AxisCurve<'a>,
    across: AxisCurve<'a>,
    /// Newtons.
    pub load: f32,
    /// `µ N` along and across, newtons.
    pub limit: Vec2,
    /// Stiffness of the carcass, newtons per metre.
    pub carcass: Vec2,
}

/// What a slipping patch does: see [`Patch::secant`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Secant {
    /// Slip velocity for each newton of force, along and across, metres per second per newton.
    pub compliance: Vec2,
    /// Greatest slope of the force in the combined slip velocity, newton-seconds per metre.
    pub slope: f32,
}

/// Combined slips behind this many linear ones are full slides.
const SLIDE: f32 = 3.0;

impl<'a> Patch<'a> {
    /// `load` in newtons, `surface` the friction of the ground, dimensionless.
    pub fn new(tire: &'a Tire, load: f32, surface: f32) -> Self {
        let relative = load / tire.nominal_load;
        // Below a fifth of its friction no tyre falls, however loaded.
        let sensitivity = (1.0 - tire.load_sensitivity * (relative - 1.0)).clamp(0.2, 2.0);
        let limit = tire.friction * (surface * sensitivity * load);
        let stiffening = if tire.stiffness_exponent == 1.0 {
            relative
        } else if tire.stiffness_exponent == 0.0 {
            1.0
        } else {
            ops::powf(relative.max(1.0e-6), tire.stiffness_exponent)
        };
        let along = AxisCurve::new(&tire.along, limit.x, stiffening);
        let across = AxisCurve::new(&tire.across, limit.y, stiffening);
        let nominal = tire.friction * tire.nominal_load;
        let carcass = Vec2::new(
            AxisCurve::new(&tire.along, nominal.x, 1.0).slope() * nominal.x,
            AxisCurve::new(&tire.across, nominal.y, 1.0).slope() * nominal.y,
        ) / tire.relaxation_length;
        Self {
            along,
            across,
            load,
            limit,
            // On perfect ice the carcass has nothing to hold on to, but stays a spring.
            carcass: carcass.max(Vec2::splat(1.0)),
        }
    }

    /// Combined slip velocity, metres per second along the wheel: a slip across counts in the
    /// proportion of the stiffnesses while the patch holds, as it is when it slides.
    pub fn combined(&self, slip: Vec2, speed: f32) -> f32 {
        let weight = self.weight(slip.length(), speed);
        Vec2::new(slip.x, slip.y * weight).length()
    }

    fn weight(&self, slip: f32, speed: f32) -> f32 {
        let relative = self.across.slope() / self.along.slope();
        let rho = self.along.slope() * slip / speed.max(1.0e-9);
        let held = SLIDE / rho.max(SLIDE);
        let held = held * held * held * held;
        relative * held + (1.0 - held)
    }

    /// How far a combined slip velocity is towards a full slide: 1 where a bristle tyre slides.
    pub fn slide(&self, combined: f32, speed: f32) -> f32 {
        self.along.slope() * combined / (SLIDE * speed.max(1.0e-3))
    }

    /// The line from the origin to the curve at a combined slip velocity: force is slip divided by
    /// compliance. It never bends downward, so a solve by it is stable behind the peak, too.
    pub fn secant(&self, combined: f32, speed: f32) -> Secant {
        let speed = speed.max(1.0e-9);
        let weight = self.weight(combined, speed);
        // The slope at no slip, without dividing nothing by nothing.
        let s = combined.max(1.0e-6 * speed).max(1.0e-12);
        let (x, slope_x) = self.along.at(s / speed);
        // The same combined slip, seen along the other axis.
        let (y, slope_y) = self.across.at(s / (speed * weight));
        let limit = self.limit.max(Vec2::splat(1.0e-6));
        // Force across is its curve times its share `weight · s_y / s`.
        Secant {
            compliance: Vec2::new(
                s / (limit.x * x.max(1.0e-9)),
                s / (limit.y * y.max(1.0e-9) * weight),
            ),
            slope: (limit.x * slope_x).max(limit.y * slope_y / weight) / speed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(patch: &Patch, slip: Vec2, speed: f32) -> Vec2 {
        slip / patch.secant(patch.combined(slip, speed), speed).compliance
    }

    #[test]
    fn combined_forces_stay_on_the_ellipse_and_slides_oppose_the_slip() {
        let tire = Tire {
            friction: Vec2::new(1.2, 0.9),
            ..Tire::default()
        };
        let patch = Patch::new(&tire, 4000.0, 1.0);
        for i in 0..64 {
            let angle = i as f32 * 0.1;
            for size in [0.001, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0] {
                let (sin, cos) = ops::sin_cos(angle);
                let f = force(&patch, Vec2::new(cos, sin) * size * 20.0, 20.0);
                assert!((f / patch.limit).length() < 1.0 + 1.0e-4, "{angle} {size}");
            }
        }
        let round = Tire::default();
        let patch = Patch::new(&round, 4000.0, 1.0);
        for angle in [0.2, 0.7, 1.2] {
            let (sin, cos) = ops::sin_cos(angle);
            let f = force(&patch, Vec2::new(cos, sin) * 20.0, 20.0);
            let off = ops::atan2(f.y, f.x) - angle;
            assert!(off.abs() < 1.0f32.to_radians(), "{angle}: {off}");
            assert!((f.length() / 4000.0 - 1.0).abs() < 0.001);
        }
    }

    #[test]
    fn small_slips_give_each_axis_its_own_stiffness() {
        let tire = Tire::default();
        let patch = Patch::new(&tire, 4000.0, 1.0);
        let f = force(&patch, Vec2::new(2.0e-4, 1.0e-4) * 20.0, 20.0);
        assert!((f.x / 18.0 - 1.0).abs() < 0.01, "{f}");
        assert!((f.y / 7.0 - 1.0).abs() < 0.01, "{f}");
    }

    #[test]
    fn a_doubled_load_costs_the_configured_part_of_the_friction() {
        let tire = Tire {
            load_sensitivity: 0.1,
            ..Tire::default()
        };
        let single = Patch::new(&tire, 4000.0, 1.0).limit.x / 4000.0;
        let double = Patch::new(&tire, 8000.0, 1.0).limit.x / 8000.0;
        assert!((double / single - 0.9).abs() < 1.0e-6);
    }

    #[test]
    fn the_slip_stiffness_follows_load_with_its_exponent() {
        let tire = Tire {
            stiffness_exponent: 0.5,
            ..Tire::default()
        };
        let f = |load| force(&Patch::new(&tire, load, 1.0), Vec2::new(2.0e-3, 0.0), 20.0).x;
        assert!((f(8000.0) / f(2000.0) - 2.0).abs() < 0.01);
    }
}
