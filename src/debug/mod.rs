//! Seeing and tuning: gizmos (feature `debug`), the egui panel and its plots (feature `egui`).

mod explain;
#[cfg(feature = "debug")]
mod gizmos;
#[cfg(feature = "debug")]
mod hull;
#[cfg(feature = "egui")]
mod inspector;
#[cfg(feature = "debug")]
mod trail;

pub use explain::Explain;
#[cfg(feature = "debug")]
pub use gizmos::{CharacterGizmos, EmbodyDebugPlugin};
#[cfg(feature = "egui")]
pub use inspector::{EmbodyInspectorPlugin, InspectorPanel, TuningEdits};
#[cfg(feature = "debug")]
pub use trail::{MarkedStep, StepTrail};
