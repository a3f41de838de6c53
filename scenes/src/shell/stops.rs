//! The stations to go to, and the keys that go there.

use bevy::prelude::*;

use crate::{driving::drive_stations, falling::fall_stations, stations::stations};

/// The stations and which of them the player is at.
#[derive(Resource, Debug)]
pub struct Visit {
    /// Name, description and start of each, in the order of a walk.
    pub stops: Vec<Stop>,
    /// The one the player was last put at.
    pub current: usize,
}

/// A station to go to.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Its name.
    pub name: String,
    /// What it shows.
    pub describe: String,
    /// Pose of the foot, or of the ground below the vehicle, facing `-Z`.
    pub start: Transform,
    /// Whether one drives there.
    pub drive: bool,
}

impl Default for Visit {
    fn default() -> Self {
        let stops = stations()
            .into_iter()
            .map(|station| Stop {
                name: station.name,
                describe: station.describe,
                start: station.start,
                drive: false,
            })
            .chain(drive_stations().into_iter().map(|station| Stop {
                start: station.start(),
                name: station.name,
                describe: station.describe,
                drive: true,
            }))
            .chain(fall_stations().into_iter().map(|station| Stop {
                start: station.start(),
                name: station.name.into(),
                describe: station.describe.into(),
                drive: false,
            }))
            .collect();
        Self { stops, current: 0 }
    }
}

impl Visit {
    /// The place of the station of this name, else of the first whose name contains it.
    pub fn find(&self, name: &str) -> Option<usize> {
        let exact = self.stops.iter().position(|stop| stop.name == name);
        exact.or_else(|| self.stops.iter().position(|stop| stop.name.contains(name)))
    }

    /// The one the player was last put at.
    pub(super) fn stop(&self) -> Option<&Stop> {
        self.stops.get(self.current)
    }
}

/// Which key means which of ten stations.
const DIGITS: [KeyCode; 10] = [
    KeyCode::Digit1,
    KeyCode::Digit2,
    KeyCode::Digit3,
    KeyCode::Digit4,
    KeyCode::Digit5,
    KeyCode::Digit6,
    KeyCode::Digit7,
    KeyCode::Digit8,
    KeyCode::Digit9,
    KeyCode::Digit0,
];

/// The station that the keys ask for, if they ask for one.
pub(super) fn asked(keys: &ButtonInput<KeyCode>, current: usize, count: usize) -> Option<usize> {
    if count == 0 {
        return None;
    }
    if keys.just_pressed(KeyCode::PageDown) {
        return Some((current + 1) % count);
    }
    if keys.just_pressed(KeyCode::PageUp) {
        return Some((current + count - 1) % count);
    }
    if keys.just_pressed(KeyCode::KeyR) {
        return Some(current);
    }
    // With Shift the second ten, with Alt the third, with both the fourth.
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let alt = keys.any_pressed([KeyCode::AltLeft, KeyCode::AltRight]);
    let tens = 10 * usize::from(shift) + 20 * usize::from(alt);
    let digit = DIGITS.iter().position(|key| keys.just_pressed(*key))?;
    Some(tens + digit).filter(|station| *station < count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_go_round_the_stations_and_never_beyond() {
        let press = |key| {
            let mut keys = ButtonInput::default();
            keys.press(key);
            keys
        };
        assert_eq!(asked(&press(KeyCode::PageDown), 4, 5), Some(0));
        assert_eq!(asked(&press(KeyCode::PageUp), 0, 5), Some(4));
        assert_eq!(asked(&press(KeyCode::Digit1), 3, 5), Some(0));
        assert_eq!(asked(&press(KeyCode::Digit9), 3, 5), None);
        assert_eq!(asked(&press(KeyCode::PageDown), 0, 0), None);
        let mut keys = press(KeyCode::ShiftLeft);
        keys.press(KeyCode::Digit2);
        assert_eq!(asked(&keys, 0, 20), Some(11));
    }
}
