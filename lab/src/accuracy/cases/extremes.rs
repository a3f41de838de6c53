//! Vehicles and ticks by chance and beyond reason.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{
    reference::{G, HEIGHT, Plan, plane},
    terrain::unit,
};

use super::{Case, Stage, alone, nothing, slow};

/// How many vehicles are drawn by lot.
const DRAWN: u32 = 30;

pub const CASES: &[Case] = &[
    slow(nothing(
        "vehicle A22",
        "of 30 vehicles by chance, that do not stay finite",
        "",
        0.0,
        |s| by_chance(&s, Lot::is_lost),
    )),
    slow(nothing(
        "vehicle A22",
        "of 30 vehicles by chance, that gain more than 0.001 % of energy",
        "",
        0.0,
        |s| by_chance(&s, |lot| lot.gained > 1.0e-5),
    )),
    nothing(
        "vehicle A22",
        "greatest height above its rest, ticks of 0.1 s among others",
        "mm",
        100.0,
        spikes,
    ),
    alone(nothing(
        "vehicle A22",
        "speed after a second of asking for what is no number",
        "m/s",
        0.001,
        no_number,
    )),
];

/// What became of a vehicle.
struct Lot {
    /// Greatest energy of the body beyond its first, in parts of that.
    gained: f64,
}

impl Lot {
    fn is_lost(&self) -> bool {
        self.gained.is_nan()
    }
}

/// Numbers by chance, the same in every run.
struct Dice {
    seed: u32,
    rolled: u32,
}

impl Dice {
    fn between(&mut self, low: f32, high: f32) -> f32 {
        self.rolled += 1;
        low + (high - low) * unit(self.seed, self.rolled, 22)
    }

    /// Evenly over the orders of magnitude.
    fn scale(&mut self, low: f32, high: f32) -> f32 {
        ops::exp(self.between(ops::ln(low), ops::ln(high)))
    }
}

/// How many of the vehicles something holds for.
fn by_chance(s: &Stage, holds: fn(&Lot) -> bool) -> f64 {
    let found = (0..DRAWN).filter(|seed| holds(&draw(s, *seed)));
    found.count() as f64
}

/// 2 to 16 wheels, 20 kg to 40 t, damping 0 to 5, friction 0 to 5, ticks of 1/20 to 1/500 s at the
/// ends of the ladder of rates; let go a little askew with up to 30 m/s in any direction.
fn draw(s: &Stage, seed: u32) -> Lot {
    let mut dice = Dice { seed, rolled: 0 };
    let mut s = s.again(s.hz() * f64::from(dice.scale(0.667, 2.08)));
    let mass = dice.scale(20.0, 40_000.0);
    let count = 2 + dice.between(0.0, 14.99) as usize;
    let size = dice.between(0.5, 4.0);
    let mut plan = Plan::reference();
    plan.mass = VehicleMass::of_box(mass, Vec3::new(size, 0.5 * size, 2.0 * size), Vec3::ZERO);
    let stiffness = (mass * dice.scale(10.0, 2000.0) / count as f32).min(1.0e6);
    let ratio = dice.between(0.0, 5.0);
    let friction = dice.between(0.0, 5.0);
    let model = match seed % 3 {
        0 => TireModel::Brush {
            stiffness: dice.scale(1.0e3, 1.0e6),
        },
        1 => TireModel::Linear {
            stiffness: dice.scale(1.0e3, 1.0e6),
        },
        _ => TireModel::Magic {
            b: dice.between(4.0, 20.0),
            c: dice.between(1.0, 2.0),
            e: dice.between(-2.0, 1.0),
        },
    };
    let sample = plan.wheels[0].clone();
    plan.wheels = (0..count)
        .map(|i| {
            let mut wheel = sample.clone();
            let side = if i % 2 == 0 { -0.5 } else { 0.5 };
            wheel.attachment = Vec3::new(side, 0.0, dice.between(-1.0, 1.0)) * size;
            wheel.axle = (i / 2) as u8;
            wheel.suspension.spring = SpringRate::Stiffness(stiffness);
            wheel.suspension.damping = Damper::Ratio {
                bump: ratio,
                rebound: ratio,
            };
            wheel.tire.friction = Vec2::splat(friction);
            wheel.tire.along = model.clone();
            wheel.tire.across = model.clone();
            wheel
        })
        .collect();
    plan.vehicle.anti_roll = vec![dice.between(0.0, 2.0) * stiffness; 8];
    plan.hull = Collider::cuboid(0.5 * size, 0.1, size);
    plane(&mut s.sim, Quat::IDENTITY);
    let askew = Quat::from_rotation_z(dice.between(-0.4, 0.4));
    // Clear of the ground, so that no spring holds energy when it is let go.
    let at = Transform::from_xyz(0.0, 0.75 + 0.2 * size, 0.0).with_rotation(askew);
    s.spawn(&plan, 0.0, at);
    s.sim.ticks(1);
    let heading = Quat::from_rotation_y(dice.between(-3.0, 3.0)) * Vec3::NEG_Z;
    s.push(heading * dice.between(0.0, 30.0));
    s.sim.ticks(1);
    let start = energy(&s, &plan.mass);
    let mut gained = 0.0f64;
    for _ in 0..(3.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        let now = energy(&s, &plan.mass);
        if !now.is_finite() {
            return Lot { gained: f64::NAN };
        }
        // A joule is rounding.
        gained = gained.max((now - start - 1.0) / start);
    }
    Lot { gained }
}

/// Kinetic and potential energy of the body, joules.
fn energy(s: &Stage, mass: &VehicleMass) -> f64 {
    let (pose, velocity) = (s.pose(), s.velocity());
    let spin = pose.rotation.inverse() * velocity.angular;
    let moving = 0.5 * mass.mass * velocity.linear.length_squared();
    let turning = 0.5 * (spin * spin).dot(mass.inertia);
    f64::from(moving + turning + mass.mass * G * pose.translation.y)
}

fn spikes(mut s: Stage) -> f64 {
    let hz = s.hz();
    let force = 6000.0;
    let plan = Plan::reference().direct(force / 4.0, |_| true);
    s.park(&plan, force, Quat::IDENTITY);
    s.ask(1.0, 0.0, 0.1);
    s.sim.seconds(2.0);
    let mut most = 0.0f32;
    for _ in 0..5 {
        s.sim.set_hz(10.0);
        s.sim.ticks(1);
        s.sim.set_hz(hz);
        for _ in 0..20 {
            s.sim.ticks(1);
            most = most.max(s.pose().translation.y - HEIGHT);
        }
    }
    1000.0 * f64::from(most)
}

fn no_number(mut s: Stage) -> f64 {
    s.park(
        &Plan::reference().direct(500.0, |_| true),
        0.0,
        Quat::IDENTITY,
    );
    s.ask(f32::NAN, f32::NAN, f32::NAN);
    s.sim.seconds(1.0);
    s.velocity().linear.length().into()
}
