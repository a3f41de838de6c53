//! Springs, dampers, bump stops.
//!
//! A wheel's compression `x` is 0 at full droop and [`Suspension::travel`] at full bump. The force is
//! `F = preload + k x (1 + p x / travel) + c x'`, and from the bump stop on `k_stop` for each further
//! metre; at the end of the travel the wheel is blocked. A suspension pushes, it never pulls.
//!
//! How one tick integrates it is in [`scheme`].

mod config;
mod law;
mod scheme;

pub use config::{Damper, SpringRate, Suspension};
pub(crate) use law::{Law, Piece};
pub(crate) use scheme::Scheme;
