//! Vehicles, measured against closed forms, conservation laws and invariants.

mod support;

mod assists;
mod braking;
mod carried;
mod changes;
mod cornering;
mod determinism;
mod energy;
mod filters;
mod ground;
mod handling;
mod hills;
mod life;
mod obstacles;
mod odd;
mod places;
mod presets;
mod refusals;
mod relaxation;
mod resistance;
mod robust;
mod saving;
mod spoilt;
mod springs;
mod statics;
mod traction;
mod transfer;
mod washboard;
