//! A suspension at its present masses: force and slopes against compression.

use core::f32::consts::TAU;

use super::config::{Damper, SpringRate, Suspension};

/// Force law of one wheel in newtons, metres and seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Law {
    pub stiffness: f32,
    pub bump: f32,
    pub rebound: f32,
    preload: f32,
    travel: f32,
    progression: f32,
    stop_at: f32,
    stop_stiffness: f32,
}

/// The straight line that replaces the law near a compression: `F = force + stiffness (x − at)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Piece {
    pub force: f32,
    pub stiffness: f32,
    pub damping: f32,
}

impl Law {
    /// `share` is the mass that rests on the wheel in static balance, kilograms.
    pub fn new(config: &Suspension, share: f32) -> Self {
        let stiffness = match config.spring {
            SpringRate::RideFrequency(hz) => share * (TAU * hz) * (TAU * hz),
            SpringRate::Stiffness(k) => k,
        };
        let (bump, rebound) = match config.damping {
            Damper::Ratio { bump, rebound } => {
                let critical = 2.0 * (stiffness * share).sqrt();
                (bump * critical, rebound * critical)
            }
            Damper::Coefficient { bump, rebound } => (bump, rebound),
        };
        Self {
            stiffness,
            bump,
            rebound,
            preload: config.preload,
            travel: config.travel,
            progression: config.progression,
            stop_at: config.travel - config.stop_length,
            stop_stiffness: config.stop_stiffness,
        }
    }

    /// Force of spring and bump stop at a compression, newtons. Beyond the travel it does not grow: there
    /// the block takes over.
    pub fn force(&self, x: f32) -> f32 {
        let x = x.min(self.travel);
        let spring =
            self.preload + self.stiffness * x * (1.0 + self.progression * x.max(0.0) / self.travel);
        spring + self.stop_stiffness * (x - self.stop_at).max(0.0)
    }

    /// The line through the present compression `x` and the one expected at the end of the tick, so
    /// that a corner between the two is not missed. `block` is the stiffness of a wheel at the end of
    /// its travel, newtons per metre, and `recovery` how far it is pushed out of the ground in a tick,
    /// metres.
    pub fn piece(&self, x: f32, expected: f32, bumping: bool, block: f32, recovery: f32) -> Piece {
        let damping = if bumping { self.bump } else { self.rebound };
        let tangent =
            |x: f32| self.stiffness * (1.0 + 2.0 * self.progression * x.max(0.0) / self.travel);
        let end = x.max(expected);
        let mut force = self.force(x);
        let mut stiffness = if (expected - x).abs() > 1.0e-3 && self.progression > 0.0 {
            let spring =
                |x: f32| self.stiffness * x * (1.0 + self.progression * x.max(0.0) / self.travel);
            (spring(expected) - spring(x)) / (expected - x)
        } else {
            tangent(x)
        };
        if end > self.stop_at && self.stop_stiffness > 0.0 {
            stiffness += self.stop_stiffness;
            // A stop that is not reached yet takes its force from where it begins.
            force += self.stop_stiffness * (x - self.stop_at).min(0.0);
        }
        let mut damping = damping;
        if end > self.travel {
            stiffness += block;
            force += block * (x - self.travel).min(recovery);
            damping = damping.max(self.bump);
        }
        Piece {
            force,
            stiffness,
            damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(config: Suspension) -> Law {
        Law::new(&config, 375.0)
    }

    #[test]
    fn a_ride_frequency_gives_the_stiffness_and_damping_of_the_reference_car() {
        let law = law(Suspension {
            damping: Damper::Ratio {
                bump: 0.5,
                rebound: 0.5,
            },
            ..Suspension::default()
        });
        assert!((law.stiffness - 33_310.0).abs() < 5.0, "{}", law.stiffness);
        assert!((law.bump - 3534.0).abs() < 1.0, "{}", law.bump);
        assert!((law.force(0.1104) - 375.0 * 9.81).abs() < 3.0);
    }

    #[test]
    fn a_progressive_spring_is_stiffer_at_bump_by_its_part() {
        let law = law(Suspension {
            spring: SpringRate::Stiffness(10_000.0),
            progression: 0.5,
            stop_stiffness: 0.0,
            ..Suspension::default()
        });
        assert!((law.force(0.25) - 10_000.0 * 0.25 * 1.5).abs() < 0.01);
        assert!((law.force(0.125) - 10_000.0 * 0.125 * 1.25).abs() < 0.01);
    }

    #[test]
    fn the_line_of_a_tick_meets_the_law_at_both_ends_on_each_side_of_a_corner() {
        let config = Suspension {
            spring: SpringRate::Stiffness(10_000.0),
            progression: 0.3,
            ..Suspension::default()
        };
        let law = law(config);
        for (x, end) in [(0.05, 0.1), (0.1, 0.05), (0.215, 0.24), (0.23, 0.24)] {
            let piece = law.piece(x, end, true, 0.0, 0.0);
            let at_end = piece.force + piece.stiffness * (end - x);
            assert!((at_end - law.force(end)).abs() < 1.0, "{x} {end}: {at_end}");
        }
        // Below the stop its line starts below the spring's force and meets the law behind it.
        let piece = law.piece(0.2, 0.23, true, 0.0, 0.0);
        let at_end = piece.force + piece.stiffness * 0.03;
        assert!((at_end - law.force(0.23)).abs() < 1.0);
    }
}
