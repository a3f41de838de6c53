//! The ground that every system stands on.

mod ambiguity;
mod defaults;
mod frame_rate;
mod interpolation;
mod setup;
mod traps;
