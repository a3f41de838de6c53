//! After the physics step: what each wheel did, and events.

use bevy::prelude::*;

use super::{
    events::{
        BottomedOut, EngineStalled, GearShifted, SlipEnded, SlipStarted, WheelLanded,
        WheelLeftGround,
    },
    output::WheelState,
    report::{VehicleReport, WheelEvent},
    wheel::Wheels,
};

/// Hands every wheel its part of what the tick found.
pub(super) fn write_wheels(
    vehicles: Query<(&VehicleReport, &Wheels)>,
    mut wheels: Query<&mut WheelState>,
) {
    for (report, tied) in &vehicles {
        if report.solved {
            for (wheel, out) in report.wheels.iter().zip(&report.outputs) {
                if let Ok(mut state) = wheels.get_mut(*wheel) {
                    *state = *out;
                }
            }
        } else if report.bare {
            // They touch nothing and carry nothing.
            for wheel in tied.iter() {
                if let Ok(mut state) = wheels.get_mut(wheel) {
                    state.set_if_neq(WheelState::default());
                }
            }
        }
    }
}

/// Triggers what happened in the tick.
pub(super) fn trigger_events(
    mut commands: Commands,
    mut vehicles: Query<(Entity, &mut VehicleReport)>,
) {
    for (entity, mut report) in &mut vehicles {
        if !report.solved {
            continue;
        }
        let report = report.bypass_change_detection();
        // What is not solved in the next tick, for whatever reason, must not act or happen again.
        report.solved = false;
        if let Some(shift) = report.shift {
            commands.trigger(GearShifted {
                entity,
                from: shift.from,
                to: shift.to,
            });
        }
        if report.stalled {
            commands.trigger(EngineStalled { entity });
        }
        for (index, event) in &report.events {
            let Some(&wheel) = report.wheels.get(*index) else {
                continue;
            };
            match *event {
                WheelEvent::Landed(ground, speed, air_time) => commands.trigger(WheelLanded {
                    entity,
                    wheel,
                    ground,
                    speed,
                    air_time,
                }),
                WheelEvent::LeftGround => commands.trigger(WheelLeftGround { entity, wheel }),
                WheelEvent::BottomedOut(force) => commands.trigger(BottomedOut {
                    entity,
                    wheel,
                    force,
                }),
                WheelEvent::SlipStarted(speed) => commands.trigger(SlipStarted {
                    entity,
                    wheel,
                    speed,
                }),
                WheelEvent::SlipEnded => commands.trigger(SlipEnded { entity, wheel }),
            }
        }
    }
}
