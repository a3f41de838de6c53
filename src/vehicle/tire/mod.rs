//! Tyres: how much force a slipping contact patch gives.
//!
//! A patch that slips against the ground with the velocity `s` (metres per second, along and across
//! the wheel), while the wheel travels with the speed `V`, gives a force that depends on `s / V`:
//! the slip ratio along, the sine of the slip angle across. Each axis has its own curve
//! ([`TireModel`]); together they lie on the friction ellipse: with the combined slip
//! `ρ = |(C_x s_x, C_y s_y)| / (µ N V)` each axis gives its curve's value at `ρ`, in the proportion of
//! its share of `ρ`. A patch in full slide is pushed against its velocity.
//!
//! In series with the patch sits the carcass, a spring of `C / σ` with the relaxation length `σ`:
//! force builds up over the distance `σ`, whatever the speed; at a standstill the spring holds the
//! car where it is. The two are solved together, implicitly, in [`super::solve`].
//!
//! Limits: no aligning moment, no turn slip, no temperature, no pressure.

mod combined;
mod config;
mod curve;

pub(crate) use combined::{Patch, Secant};
pub use config::{SlipPoint, Tire, TireModel};
