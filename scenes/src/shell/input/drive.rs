//! How the controls drive a vehicle: forward and back, steering that takes its time.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use super::intent::Controls;
use crate::shell::Player;

/// How fast keys turn the steering wheel and let it come back, per second.
const TURN: f32 = 2.2;
const RETURN: f32 = 5.0;
/// Speed below which back means reverse and not brake, metres per second.
const STANDSTILL: f32 = 0.6;

/// What the driver's hands do between ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldWheel {
    steer: f32,
    reverse: bool,
}

impl HeldWheel {
    /// Turns the wheel towards what is asked.
    fn turn(&mut self, asked: f32, dt: f32) {
        let back = asked == 0.0 || asked * self.steer < 0.0;
        let most = if back { RETURN } else { TURN } * dt;
        self.steer += (asked - self.steer).clamp(-most, most);
    }

    /// Accelerator and brake from forward and back: back brakes first, then reverses.
    fn pedals(&mut self, forward: f32, back: f32, speed: f32) -> (f32, f32) {
        if back > forward && speed < STANDSTILL {
            self.reverse = true;
        } else if forward > back && speed > -STANDSTILL {
            self.reverse = false;
        }
        if self.reverse {
            (back, forward)
        } else {
            (forward, back)
        }
    }
}

/// Turns what was asked into the intent of the tick that begins.
pub(super) fn write_drive(
    time: Res<Time>,
    mut players: Query<(&mut Controls, &mut VehicleIntent, &VehicleTelemetry), With<Player>>,
) {
    for (mut controls, mut intent, telemetry) in &mut players {
        let asked = controls.movement;
        let forward = asked.y.max(controls.throttle);
        let back = (-asked.y).max(controls.brake);
        let (throttle, brake) = controls.held.pedals(forward, back, telemetry.speed);
        controls.held.turn(asked.x, time.delta_secs());
        *intent = VehicleIntent {
            throttle,
            brake,
            handbrake: f32::from(controls.jump.next_tick()),
            steer: controls.held.steer,
            gear: if controls.held.reverse {
                Gear::Reverse
            } else {
                Gear::Drive
            },
            starter: forward > 0.0,
            air: Vec3::new(-asked.y, asked.x, 0.0),
            ..default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn back_brakes_while_rolling_forward_and_reverses_at_a_standstill() {
        let mut held = HeldWheel::default();
        assert_eq!(held.pedals(0.0, 1.0, 20.0), (0.0, 1.0));
        assert!(!held.reverse);
        assert_eq!(held.pedals(0.0, 1.0, 0.1), (1.0, 0.0));
        assert!(held.reverse);
        // Forward again brakes first, then drives.
        assert_eq!(held.pedals(1.0, 0.0, -5.0), (0.0, 1.0));
        assert_eq!(held.pedals(1.0, 0.0, -0.1), (1.0, 0.0));
    }

    #[test]
    fn keys_turn_the_wheel_by_and_by_and_let_it_come_back_faster() {
        let mut held = HeldWheel::default();
        held.turn(1.0, 0.1);
        assert!((held.steer - 0.22).abs() < 1e-6);
        for _ in 0..100 {
            held.turn(1.0, 0.1);
        }
        assert_eq!(held.steer, 1.0);
        held.turn(0.0, 0.1);
        assert!((held.steer - 0.5).abs() < 1e-6);
    }
}
