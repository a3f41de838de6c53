//! The character controller, measured against closed forms, invariants and symmetries.

mod support;
pub mod warnings;

mod bad_input;
mod between;
mod corners;
mod crowd;
mod determinism;
mod events;
mod extremes;
mod filters;
mod floor;
mod fuzz;
mod half_space;
mod jolt_course;
mod leaving;
mod motor;
mod platforms;
mod pushed;
mod pushing;
mod removal;
mod rest;
mod rollback;
mod slopes;
mod stairs;
mod stance;
mod turning;
mod upward;
mod volumes;
mod walls;
mod weight;
