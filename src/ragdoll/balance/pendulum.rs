//! The linear inverted pendulum: a mass at a constant height above the point through which the ground
//! bears it. Its motion, and where it could be brought to rest, have closed forms.

use bevy::{math::ops, prelude::*};

/// A standing figure, reduced to its centre of mass. Positions are level: along `X` and `Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// Of the centre of mass above the ground, metres, above 0.
    pub height: f32,
    /// Metres per second squared, above 0.
    pub gravity: f32,
}

impl Pendulum {
    /// How fast it falls away from its support: `1/s`, the rate of its exponential.
    pub fn rate(&self) -> f32 {
        ops::sqrt(self.gravity / self.height)
    }

    /// Where the support must be for it to come to rest just above it, from this position and velocity:
    /// the capture point, or extrapolated centre of mass.
    pub fn capture_point(&self, position: Vec2, velocity: Vec2) -> Vec2 {
        position + velocity / self.rate()
    }

    /// Position and velocity after a time, seconds, over a support that stays where it is.
    pub fn after(&self, position: Vec2, velocity: Vec2, support: Vec2, time: f32) -> (Vec2, Vec2) {
        let rate = self.rate();
        let (grows, dies) = (ops::exp(rate * time), ops::exp(-rate * time));
        let (cosh, sinh) = (0.5 * (grows + dies), 0.5 * (grows - dies));
        let off = position - support;
        (
            support + off * cosh + velocity * (sinh / rate),
            off * (rate * sinh) + velocity * cosh,
        )
    }

    /// The greatest push, newton-seconds, that a figure of this mass, kilograms, at rest takes without a
    /// step and without turning its trunk, when its feet reach this far in the direction of the push,
    /// metres from below its centre of mass.
    pub fn greatest_push(&self, mass: f32, reach: f32) -> f32 {
        mass * reach * self.rate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: Pendulum = Pendulum {
        height: 0.95,
        gravity: 9.81,
    };

    #[test]
    fn the_closed_form_solves_the_equation_of_motion() {
        let (position, velocity) = (Vec2::new(0.05, -0.02), Vec2::new(-0.4, 0.3));
        let support = Vec2::new(0.1, 0.04);
        // Small steps of the mid-point rule in double precision.
        let (n, time) = (20_000, 0.7);
        let dt = time / f64::from(n);
        let rate = 9.81 / 0.95;
        for axis in 0..2 {
            let (mut x, mut v) = (f64::from(position[axis]), f64::from(velocity[axis]));
            let c = f64::from(support[axis]);
            for _ in 0..n {
                let middle = (x + 0.5 * dt * v, v + 0.5 * dt * rate * (x - c));
                (x, v) = (x + dt * middle.1, v + dt * rate * (middle.0 - c));
            }
            let (p, u) = BODY.after(position, velocity, support, time as f32);
            assert!((f64::from(p[axis]) - x).abs() < 1e-5, "{axis}: {p} {x}");
            assert!((f64::from(u[axis]) - v).abs() < 1e-5, "{axis}: {u} {v}");
        }
    }

    #[test]
    fn over_its_capture_point_it_comes_to_rest_and_beside_it_never() {
        let (position, velocity) = (Vec2::new(0.02, 0.1), Vec2::new(0.5, -0.3));
        let at = BODY.capture_point(position, velocity);
        let (end, left) = BODY.after(position, velocity, at, 3.0);
        assert!(
            end.distance(at) < 1e-3 && left.length() < 3e-3,
            "{end} {left}"
        );
        let (end, left) = BODY.after(position, velocity, at + Vec2::X * 0.01, 3.0);
        assert!(
            end.distance(at) > 1.0 && left.length() > 1.0,
            "{end} {left}"
        );
    }

    #[test]
    fn the_greatest_push_is_where_the_capture_point_leaves_the_feet() {
        let (mass, reach) = (75.0, 0.13);
        let push = BODY.greatest_push(mass, reach);
        // About 31 N·s: a push of 60 N·s, at 0.8 m/s, reaches 0.25 m, twice as far as a foot.
        assert!((push - 31.3).abs() < 0.1, "{push}");
        for (part, stays) in [(0.99, true), (1.01, false)] {
            let velocity = Vec2::X * (part * push / mass);
            // As far out as the feet allow, for as long as it takes.
            let (_, left) = BODY.after(Vec2::ZERO, velocity, Vec2::X * reach, 2.0);
            assert_eq!(left.x < 0.0, stays, "{part}: {left}");
        }
    }
}
