//! Which gear is in, and when it changes.

use super::config::{Gearbox, Shifting};
use crate::vehicle::intent::Gear;

/// Where a gearbox is: its part of the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Box {
    /// −1 reverse, 0 neutral, from 1 on the forward gears. The gear that is going in during a shift.
    pub gear: i8,
    /// Time left without traction, seconds.
    pub shifting: f32,
    /// Time since the last shift of an automatic ended, seconds.
    pub settled: f32,
}

/// A change of gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shift {
    pub from: i8,
    pub to: i8,
}

/// How long an automatic keeps a gear at least, seconds.
const KEEP: f32 = 0.5;

impl Box {
    /// The ratio that is in, negative in reverse, 0 in neutral and while shifting.
    pub fn ratio(&self, config: &Gearbox) -> f32 {
        if self.shifting > 0.0 {
            return 0.0;
        }
        Self::ratio_of(config, self.gear)
    }

    fn ratio_of(config: &Gearbox, gear: i8) -> f32 {
        match gear {
            0 => 0.0,
            g if g < 0 => -config.reverse,
            g => config.forward.get(g as usize - 1).copied().unwrap_or(0.0),
        }
    }

    /// One tick: `shaft_rpm` is the speed that the wheels give the gearbox's input in the present
    /// gear, `speed` the vehicle's own along itself (metres per second).
    pub fn tick(
        &mut self,
        config: &Gearbox,
        asked: Gear,
        engine_rpm: f32,
        shaft_rpm: f32,
        speed: f32,
        slipping: bool,
        dt: f32,
    ) -> Option<Shift> {
        // A gear that a change of the config took away.
        self.gear = self.gear.clamp(-1, config.forward.len().min(100) as i8);
        if self.shifting > 0.0 {
            self.shifting = (self.shifting - dt).max(0.0);
            // What is left of less than half a tick is rounding.
            if self.shifting < 0.5 * dt {
                self.shifting = 0.0;
            }
            self.settled = 0.0;
            return None;
        }
        self.settled += dt;
        let top = config.forward.len().min(100) as i8;
        let automatic = matches!(config.shifting, Shifting::Automatic { .. });
        let wanted = match asked {
            Gear::Number(n) => n.clamp(-1, top),
            Gear::Neutral => 0,
            // No box takes the opposite gear at speed.
            Gear::Reverse if speed < 1.0 => -1,
            Gear::Reverse => self.gear,
            Gear::Drive if self.gear <= 0 && speed > -1.0 => 1,
            Gear::Drive => match config.shifting {
                Shifting::Automatic { up, down } if self.gear > 0 && self.settled > KEEP => {
                    let lower = Self::ratio_of(config, self.gear - 1)
                        / Self::ratio_of(config, self.gear).max(1.0e-6);
                    if engine_rpm > up && shaft_rpm > 0.8 * up && !slipping && self.gear < top {
                        self.gear + 1
                    } else if shaft_rpm < down && self.gear > 1 && shaft_rpm * lower < up {
                        self.gear - 1
                    } else {
                        self.gear
                    }
                }
                _ => self.gear,
            },
        };
        if wanted == self.gear {
            return None;
        }
        let shift = Shift {
            from: self.gear,
            to: wanted,
        };
        // Out of neutral an automatic is in gear at once.
        let at_once = automatic && (self.gear == 0 || wanted == 0);
        self.gear = wanted;
        self.shifting = if at_once { 0.0 } else { config.shift_time };
        self.settled = 0.0;
        Some(shift)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fresh(gear: i8) -> Box {
        Box {
            gear,
            shifting: 0.0,
            settled: 10.0,
        }
    }

    #[test]
    fn a_shift_cuts_traction_for_the_shift_time_at_every_rate() {
        let config = Gearbox::default();
        for hz in [30.0f32, 60.0, 120.0, 240.0] {
            let dt = 1.0 / hz;
            let mut gearbox = fresh(1);
            let n = Gear::Number(2);
            assert!(
                gearbox
                    .tick(&config, n, 3000.0, 3000.0, 10.0, false, dt)
                    .is_some()
            );
            let mut cut = 0;
            while gearbox.ratio(&config) == 0.0 {
                cut += 1;
                gearbox.tick(&config, n, 3000.0, 3000.0, 10.0, false, dt);
            }
            let time = cut as f32 * dt;
            assert!((time - 0.25).abs() <= 0.51 * dt, "{hz}: {time}");
        }
    }

    #[test]
    fn an_automatic_does_not_shift_up_while_the_wheels_spin() {
        let config = Gearbox::default();
        let shift =
            |slipping| fresh(1).tick(&config, Gear::Drive, 6000.0, 6000.0, 5.0, slipping, 0.016);
        assert_eq!(shift(true), None);
        assert_eq!(shift(false), Some(Shift { from: 1, to: 2 }));
    }

    #[test]
    fn reverse_is_refused_at_speed() {
        let config = Gearbox::default();
        let shift =
            |speed| fresh(3).tick(&config, Gear::Reverse, 2500.0, 2500.0, speed, false, 0.016);
        assert_eq!(shift(10.0), None);
        assert_eq!(shift(0.1), Some(Shift { from: 3, to: -1 }));
    }
}
