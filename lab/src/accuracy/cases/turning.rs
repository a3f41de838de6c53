//! Turning: Ackermann's circle and the bicycle model.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::reference::{MASS, Plan};

use super::{Case, Stage, case};

pub const CASES: &[Case] = &[
    case(
        "vehicle A10",
        "radius of a turn at 2 m/s, asked 10 m",
        "m",
        10.0,
        0.01,
        turn_radius,
    ),
    case(
        "vehicle A11",
        "yaw rate of a neutral car",
        "rad/s",
        0.2143,
        0.03,
        |s| yaw_rate(s, 0.0),
    ),
    case(
        "vehicle A11",
        "yaw rate of an understeering car",
        "rad/s",
        0.1550,
        0.03,
        |s| yaw_rate(s, 0.2),
    ),
];

fn turn_radius(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(2.0);
    let angle = ops::atan(0.28);
    s.ask(0.0, 0.0, angle);
    s.sim.seconds(1.0);
    s.roll(Vec3::NEG_Z * 2.0);
    s.sim.seconds(2.0);
    // Of the middle of the rear axle, which the angle is about.
    let velocity = s.velocity();
    let rear = s.pose().rotation * Vec3::new(0.0, 0.0, 1.4);
    let there = velocity.linear + velocity.angular.cross(rear);
    (there.with_y(0.0).length() / velocity.angular.y.abs()).into()
}

/// Linear bicycle at 20 m/s and 0.03 rad, 80 kN/rad on each axle.
fn yaw_rate(mut s: Stage, ahead: f32) -> f64 {
    let mut plan = Plan::reference().tire(|tire| {
        tire.across = TireModel::Linear { stiffness: 40.0e3 };
        tire.relaxation_length = Vec2::splat(0.1);
        tire.friction = Vec2::splat(2.0);
    });
    plan.mass.center.z = -ahead;
    s.park(&plan, 0.0, Quat::IDENTITY);
    s.sim.seconds(2.0);
    s.roll(Vec3::NEG_Z * 20.0);
    s.ask(0.0, 0.0, 0.03);
    s.sim.seconds(2.0);
    let yaw = f64::from(s.velocity().angular.y.abs());
    // The car loses a little speed on the way: the formula's rate at what is left, in that at 20 m/s.
    let (a, b) = (1.4 - f64::from(ahead), 1.4 + f64::from(ahead));
    let k = f64::from(MASS) / 2.8 * (b - a) / 80.0e3;
    let formula = |v: f64| v * 0.03 / (2.8 + k * v * v);
    yaw * formula(20.0) / formula(s.speed())
}
