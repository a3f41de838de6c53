//! Standing by joint torques alone.
//!
//! From the centre of mass and its velocity follows the capture point; from that, where the ground must
//! bear the figure ([`pressure`]); from that, what every joint of the legs must bear for the ground to do
//! so. All of it are torques between two bones: nothing pushes the figure from outside, unless
//! [`RagdollBalance::assist`] says so.

mod check;
mod pendulum;
mod stand;
mod support;

use bevy::prelude::*;

pub(super) use check::{check, forget};
pub use pendulum::Pendulum;
pub(super) use stand::stand;
use support::Support;

/// On a [`Ragdoll`](super::Ragdoll) in [`Powered`](super::RagdollMode::Powered) mode, without pins: keeps it
/// on its feet by the torques of its legs. For worlds whose up is `+Y`.
///
/// The feet stay where they are: it makes no steps, and does not swing its trunk. A push that takes the
/// capture point off the feet then throws it down, however strong it is: [`Pendulum::greatest_push`] says
/// which those are, about 30 N·s for 75 kg. What it takes in fact without assistance is about a third of
/// that; [`BalanceState::margin`] tells how near it is to falling.
#[derive(Component, Reflect, Clone, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(BalanceState)]
pub struct RagdollBalance {
    /// Names of the bones that it stands on; what they bear, such as toes, belongs to them. Figures of 10
    /// bodies have no feet.
    pub feet: [String; 2],
    /// How fast the capture point is brought back over the middle of the feet, as a multiple of the rate
    /// of the fall, above 0; with another it does not stand by itself.
    pub gain: f32,
    /// A torque of the world, not of the joints, that holds the root upright, `0..=1`: 0 is none, 1 bears
    /// one and a half times what its weight tips it with.
    pub assist: f32,
}

impl Default for RagdollBalance {
    fn default() -> Self {
        Self {
            feet: ["foot_l".into(), "foot_r".into()],
            gain: 4.0,
            assist: 0.0,
        }
    }
}

/// How a figure stands, as of the last tick; positions in the world, at the height of its feet.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct BalanceState {
    /// Where it would have to be supported to come to rest.
    pub capture: Vec3,
    /// Where the ground is asked to bear it.
    pub pressure: Vec3,
    /// How far the capture point is inside the area of the feet, metres; negative outside, where feet that
    /// stay in place are not enough.
    pub margin: f32,
    /// Whether something bears it, its feet are lowest, and its torques are at work.
    pub stands: bool,
}

/// Where the ground must bear a figure for its capture point to come back to `rest`: beyond the capture
/// point, as far as the feet reach.
fn pressure(capture: Vec2, rest: Vec2, gain: f32, support: &Support) -> Vec2 {
    support.clamp(capture + (capture - rest) * gain)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest way of the capture point from the middle and the last, after a push, metres.
    fn pushed(push: f32, hz: f32) -> (f32, f32) {
        let body = Pendulum {
            height: 0.95,
            gravity: 9.81,
        };
        let corners = [-0.13f32, 0.13].map(|x| [-0.2f32, 0.2].map(|z| Vec2::new(x, z)));
        let feet = Support::around(corners.into_iter().flatten());
        let (mut x, mut v) = (Vec2::ZERO, Vec2::X * (push / 75.0));
        let (mut most, mut last) = (0.0f32, 0.0);
        for _ in 0..(4.0 * hz) as usize {
            let capture = body.capture_point(x, v);
            last = capture.length();
            most = most.max(last);
            let at = pressure(capture, Vec2::ZERO, 2.0, &feet);
            (x, v) = body.after(x, v, at, 1.0 / hz);
        }
        (most, last)
    }

    #[test]
    fn pushes_up_to_the_bound_of_the_feet_are_taken_and_none_beyond() {
        let body = Pendulum {
            height: 0.95,
            gravity: 9.81,
        };
        let bound = body.greatest_push(75.0, 0.13);
        for hz in [30.0, 60.0, 240.0] {
            for part in [0.2, 0.6, 0.98] {
                let (most, last) = pushed(part * bound, hz);
                assert!(
                    most < 0.131 && last < 1e-3,
                    "{hz} Hz, {part}: {most} {last}"
                );
            }
            let (_, last) = pushed(1.02 * bound, hz);
            assert!(last > 1.0, "{hz} Hz: {last}");
        }
    }
}
