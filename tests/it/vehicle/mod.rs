//! Vehicles, measured against closed forms, conservation laws and invariants.

mod support;

mod assists;
mod braking;
mod cornering;
mod determinism;
mod ground;
mod hills;
mod life;
mod places;
mod presets;
mod resistance;
mod robust;
mod saving;
mod springs;
mod statics;
mod traction;
mod transfer;
