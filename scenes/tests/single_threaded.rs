//! The library's tests of Rapier's traps, in a build without Bevy's multithreaded executor when
//! this package is built alone and without its features.

#[path = "../../tests/it/foundation/traps.rs"]
mod traps;

#[path = "../../tests/it/foundation/frame_rate.rs"]
mod frame_rate;
