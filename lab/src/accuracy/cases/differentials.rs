//! Differentials. Rapier's controller has none.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::{
    drivelines::{corvette, rear_motor, split_road},
    reference::HEIGHT,
};

use super::{
    Case, Stage, alone, case,
    gears::{parked, ratio, set_rolling},
};

pub const CASES: &[Case] = &[
    alone(case(
        "vehicle A16",
        "open differential on ice and asphalt: torque right by left",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, _| {
                ratio(wheels[3].drive_torque, wheels[2].drive_torque)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "open differential: force on ice, of µ N",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, _| {
                ratio(wheels[2].force.x, 0.1 * wheels[2].load)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "open differential: input speed by the mean of its wheels",
        "",
        1.0,
        0.001,
        |s| {
            of_split(s, Differential::Open, 400.0, |wheels, shaft| {
                ratio(shaft, 0.5 * (wheels[2].spin + wheels[3].spin))
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "torque bias 3: torque right by left",
        "",
        3.0,
        0.01,
        |s| {
            of_split(s, BIAS, 600.0, |wheels, _| {
                ratio(wheels[3].drive_torque, wheels[2].drive_torque)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "locked differential: speed right by left",
        "",
        1.0,
        0.001,
        |s| {
            of_split(s, Differential::Locked, 3000.0, |wheels, _| {
                ratio(wheels[3].spin, wheels[2].spin)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "locked differential: both forces, of µ N of both",
        "",
        1.0,
        0.01,
        |s| {
            of_split(s, Differential::Locked, 3000.0, |wheels, _| {
                let limit = 0.1 * wheels[2].load + wheels[3].load;
                ratio(wheels[2].force.x + wheels[3].force.x, limit)
            })
        },
    )),
    alone(case(
        "vehicle A16",
        "torque of the front axle of a centre differential of 0.3 to 0.7",
        "",
        0.3,
        0.01,
        |s| front_share(s, 0.3),
    )),
];

const BIAS: Differential = Differential::LimitedSlip {
    bias: 3.0,
    preload: 0.0,
};

/// A car with this differential between its rear wheels, ice to the left and asphalt to the right,
/// after a second of such a torque; `read` is given its wheels and the speed of the input shaft.
fn of_split(
    mut s: Stage,
    differential: Differential,
    torque: f32,
    read: fn(&[WheelState], f32) -> f64,
) -> f64 {
    split_road(&mut s.sim);
    let plan = rear_motor(torque, differential);
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 100.0));
    s.sim.seconds(1.0);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(1.0);
    let Some(car) = s.own() else { return f64::NAN };
    read(&car.all(&s.sim), car.state(&s.sim).engine_speed)
}

fn axle(axle: u8, share: f32, differential: Differential) -> DrivenAxle {
    DrivenAxle {
        axle,
        share,
        differential,
    }
}

fn front_share(s: Stage, front: f32) -> f64 {
    let mut plan = corvette(0.1).wheel(|_, wheel| wheel.driven = true);
    if let Some(drivetrain) = &mut plan.vehicle.drivetrain {
        let open = Differential::Open;
        drivetrain.axles = vec![axle(0, front, open), axle(1, 1.0 - front, open)];
    }
    let Some((mut s, car)) = parked(s, &plan) else {
        return f64::NAN;
    };
    set_rolling(&mut s, &car, 8.0);
    s.ask(0.5, 0.0, 0.0);
    s.sim.seconds(0.5);
    let wheels = car.all(&s.sim);
    let of = |wheels: &[WheelState]| wheels.iter().map(|w| w.drive_torque).sum::<f32>();
    ratio(of(&wheels[..2]), of(&wheels))
}
