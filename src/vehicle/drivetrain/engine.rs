//! Torque of an engine or motor at its present speed.

use super::{
    config::{ElectricMotor, Engine, TorquePoint},
    from_rpm,
};

/// Torque as a line in shaft speed: `torque − damping · w`, newton-metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Power {
    pub torque: f32,
    /// Newton-metre-seconds per radian, at least 0: taken implicitly.
    pub damping: f32,
}

/// Torque on a curve, straight lines between its points.
pub(crate) fn on_curve(points: &[TorquePoint], rpm: f32) -> f32 {
    let Some(first) = points.first() else {
        return 0.0;
    };
    let mut before = *first;
    for p in points {
        if rpm < p.rpm {
            let t = (rpm - before.rpm) / (p.rpm - before.rpm).max(1.0e-6);
            return before.torque + (p.torque - before.torque) * t.max(0.0);
        }
        before = *p;
    }
    before.torque
}

/// Torque of a running engine at `w` rad/s over a tick of `dt`; `cut` interrupts the fuel, `free` tells
/// that nothing but its own inertia is in the way.
pub(crate) fn power(
    engine: &Engine,
    w: f32,
    throttle: f32,
    cut: bool,
    free: bool,
    dt: f32,
) -> Power {
    let rpm = w / from_rpm(1.0);
    let drive = if cut {
        0.0
    } else {
        throttle * on_curve(&engine.torque, rpm)
    };
    let closed = 1.0 - throttle;
    let mut power = Power {
        torque: drive - closed * engine.friction * (w / from_rpm(50.0)).clamp(-1.0, 1.0),
        damping: closed * engine.viscosity,
    };
    // Idle control: as much torque as brings the shaft to idle speed within a few hundredths of a
    // second, up to what the engine has.
    let idle = from_rpm(engine.idle);
    if !cut {
        let gain = engine.inertia / dt.max(0.03);
        let most = on_curve(&engine.torque, engine.idle.max(rpm));
        // What the closed throttle brakes with is made up for.
        let held = closed
            * (engine.friction * (w / from_rpm(50.0)).clamp(0.0, 1.0) + engine.viscosity * idle);
        let wanted = gain * (idle - w) + held;
        power.torque += wanted.min(most).max(0.0) * closed;
    }
    if free {
        // The limiter cuts before the shaft overshoots within the tick.
        let room = (from_rpm(engine.redline) - w) * engine.inertia / dt;
        power.torque = power.torque.min(room.max(0.0));
    }
    power
}

/// Torque of a motor at `w` rad/s; `direction` is that of the gear, 1 or −1.
pub(crate) fn motor_power(motor: &ElectricMotor, w: f32, throttle: f32, direction: f32) -> Power {
    let speed = w.abs();
    let most = if speed * motor.torque > motor.power {
        motor.power / speed
    } else {
        motor.torque
    };
    let cut = w * direction > from_rpm(motor.redline);
    let drive = if cut {
        0.0
    } else {
        throttle * most * direction
    };
    let brake = if throttle > 0.0 {
        0.0
    } else {
        motor.recuperation.min(most)
    };
    Power {
        torque: drive,
        // Full recuperation from walking pace on; below it fades out, so that it never pushes.
        damping: brake / speed.max(20.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn torque_follows_its_curve_and_the_fuel_is_cut_at_the_redline() {
        let engine = Engine::default();
        let at = |rpm: f32| power(&engine, from_rpm(rpm), 1.0, false, true, 1.0 / 60.0).torque;
        assert!((at(2750.0) - 160.0).abs() < 0.1, "{}", at(2750.0));
        assert!(at(6501.0) <= 0.0);
    }

    #[test]
    fn idle_is_held_from_below_and_left_alone_above() {
        let engine = Engine::default();
        for dt in [1.0f32 / 30.0, 1.0 / 240.0] {
            let mut w = from_rpm(500.0);
            for _ in 0..(3.0 / dt) as usize {
                let p = power(&engine, w, 0.0, false, true, dt);
                w = (w * engine.inertia + dt * p.torque) / (engine.inertia + dt * p.damping);
            }
            let rpm = w / from_rpm(1.0);
            assert!((rpm - 850.0).abs() < 20.0, "{dt}: {rpm}");
        }
    }

    #[test]
    fn a_motor_gives_its_torque_up_to_its_power() {
        let motor = ElectricMotor::default();
        assert_eq!(motor_power(&motor, 0.0, 1.0, 1.0).torque, 310.0);
        assert_eq!(motor_power(&motor, 0.0, 1.0, -1.0).torque, -310.0);
        let fast = motor_power(&motor, 1000.0, 1.0, 1.0).torque;
        assert!((fast * 1000.0 - 150.0e3).abs() < 1.0);
    }
}
