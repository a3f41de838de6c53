//! Ragdolls: joints and limits, modes, drive to a pose, life of bones.

mod hold;
mod life;
mod limits;
mod modes;
mod support;
