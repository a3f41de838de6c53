//! Seeing and tuning: gizmos (feature `debug`), the egui panel and its plots (feature `egui`).

#[cfg(all(feature = "ragdoll", feature = "debug"))]
mod bones;
#[cfg(feature = "character")]
mod explain;
#[cfg(all(feature = "character", feature = "debug"))]
mod gizmos;
#[cfg(all(feature = "character", feature = "debug"))]
mod hull;
#[cfg(all(feature = "character", feature = "egui"))]
mod inspector;
#[cfg(all(feature = "character", feature = "debug"))]
mod trail;
#[cfg(all(feature = "vehicle", feature = "debug"))]
mod wheels;

#[cfg(all(feature = "ragdoll", feature = "debug"))]
pub use bones::{RagdollDebugPlugin, RagdollGizmos};
#[cfg(feature = "character")]
pub use explain::Explain;
#[cfg(all(feature = "character", feature = "debug"))]
pub use gizmos::{CharacterGizmos, EmbodyDebugPlugin};
#[cfg(all(feature = "character", feature = "egui"))]
pub use inspector::{EmbodyInspectorPlugin, InspectorPanel, TuningEdits};
#[cfg(all(feature = "character", feature = "debug"))]
pub use trail::{MarkedStep, StepTrail};
#[cfg(all(feature = "vehicle", feature = "debug"))]
pub use wheels::{VehicleDebugPlugin, VehicleGizmos};
