//! Launches at the limit of grip.
//!
//! Where a force is more than an axle holds, its wheels spin and it gives `µ N`. With equal forces on
//! both axles the front one, which loses load, does so long before the rear: all-wheel drive reaches
//! `µ g` only where the rear is given what it can carry. What spins wheels up turns the body the other
//! way, and wheels that are not driven are spun up by the ground.

use bevy::prelude::*;

use super::{Case, Stage, alone, case, drive::stiff};

pub const CASES: &[Case] = &[
    case(
        "vehicle A6",
        "launch, all-wheel drive, all wheels spinning: µ g",
        "m/s²",
        9.81,
        0.03,
        |s| launch(s, ALL_SPIN, |_| true),
    ),
    case(
        "vehicle A6",
        "launch, rear drive: µ g (a/L) / (1 − µ h/L)",
        "m/s²",
        6.104,
        0.03,
        |s| launch(s, REAR, |i| i > 1),
    ),
    case(
        "vehicle A6",
        "launch, front drive: µ g (b/L) / (1 + µ h/L)",
        "m/s²",
        4.100,
        0.03,
        |s| launch(s, FRONT, |i| i < 2),
    ),
    alone(case(
        "vehicle A6",
        "launch, rear drive, with the wheels' inertia",
        "m/s²",
        6.0383,
        0.005,
        |s| launch(s, REAR, |i| i > 1),
    )),
    alone(case(
        "vehicle A6",
        "launch, front drive, with the wheels' inertia",
        "m/s²",
        4.0267,
        0.005,
        |s| launch(s, FRONT, |i| i < 2),
    )),
    alone(case(
        "vehicle A6",
        "launch, equal forces on all wheels, the front ones spinning",
        "m/s²",
        8.1443,
        0.005,
        |s| launch(s, EQUAL, |_| true),
    )),
];

// Forces on each driven wheel, newtons. Much more than the tyres hold would turn the car about its
// spinning wheels.
const REAR: f32 = 4785.2;
const FRONT: f32 = 3214.2;
/// Three hundredths more than `µ g` of all takes.
const EQUAL: f32 = 3901.3;
const ALL_SPIN: f32 = 5800.0;

fn launch(mut s: Stage, force: f32, driven: fn(usize) -> bool) -> f64 {
    let count = (0..4).filter(|i| driven(*i)).count() as f32;
    let plan = stiff().direct(force, driven);
    s.park(&plan, force * count, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(1.0);
    let (v0, span) = (s.speed(), 1.0);
    s.sim.seconds(span);
    (s.speed() - v0) / span
}

#[cfg(test)]
mod tests {
    use super::*;
    use embody_scenes::reference::{G, HALF_BASE, HEIGHT, MASS, RADIUS};

    /// Acceleration of a car without springs on Coulomb friction 1, whose axles are driven with these
    /// forces (newtons); `inertia` of each wheel. By iteration: loads follow from the acceleration,
    /// forces from the loads, the acceleration from the forces.
    fn rigid_car(front: f64, rear: f64, inertia: f64) -> f64 {
        let [mass, g, height, base, radius] =
            [MASS, G, HEIGHT, 2.0 * HALF_BASE, RADIUS].map(f64::from);
        let spun_along = 2.0 * inertia / (radius * radius);
        let (mut a, mut given) = (0.0, 0.0);
        for _ in 0..1000 {
            let spun_up = (front + rear - given) * radius;
            let moved = (mass * a * height + spun_up) / base;
            let grip = |drive: f64, load: f64| (drive - spun_along * a).clamp(-load, load);
            let static_load = 0.5 * mass * g;
            given = grip(front, static_load - moved) + grip(rear, static_load + moved);
            a += 0.3 * (given / mass - a);
        }
        a
    }

    #[test]
    fn a_rigid_car_launches_as_the_cases_ask() {
        let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 3.0e-4, "{a} is not {b}");
        let pair = |force: f32| 2.0 * f64::from(force);
        // Without wheels of their own inertia, the textbook's.
        let rear = 9.81 * 0.5 / (1.0 - 0.55 / 2.8);
        near(rigid_car(0.0, 1500.1 * rear, 0.0), rear);
        let front = 9.81 * 0.5 / (1.0 + 0.55 / 2.8);
        near(rigid_car(1500.1 * front, 0.0, 0.0), front);
        near(rigid_car(pair(ALL_SPIN), pair(ALL_SPIN), 1.0), 9.81);
        near(rigid_car(0.0, pair(REAR), 1.0), 6.0383);
        near(rigid_car(pair(FRONT), 0.0, 1.0), 4.0267);
        near(rigid_car(pair(EQUAL), pair(EQUAL), 1.0), 8.1443);
    }
}
