//! Configs and states survive being written down.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// What is read of what was written.
macro_rules! again {
    ($value:expr) => {
        serde_json::from_str(&serde_json::to_string($value).expect("it can be written"))
            .expect("and read")
    };
}

#[test]
fn every_preset_is_read_as_it_was_written() {
    for (name, preset) in VehiclePreset::all() {
        let read: VehiclePreset = again!(&preset);
        assert_eq!(read, preset, "{name}");
    }
}

#[test]
fn a_state_is_read_as_it_was_written() {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let car = Plan::reference().park(&mut sim, Quat::IDENTITY);
    let read: VehicleState = again!(&VehicleState::default());
    assert_eq!(read, VehicleState::default());
    sim.seconds(1.0);
    let state = car.state(&sim);
    let read: VehicleState = again!(&state);
    assert_eq!(read, state);
    let intent = sim.get::<VehicleIntent>(car.body);
    let read: VehicleIntent = again!(&intent);
    assert_eq!(read, intent);
}
