//! Ground that moves.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::reference::{HEIGHT, Plan};

use super::{Case, Stage, nothing};

pub const CASES: &[Case] = &[
    nothing(
        "vehicle A18",
        "momentum from nothing, car on a slab on ice, of the drive",
        "",
        0.005,
        momentum,
    ),
    nothing(
        "vehicle A19",
        "slip of a braked car on a ferry that moves aside at 2 m/s",
        "m/s",
        0.02,
        ferry,
    ),
];

/// A platform below the car, carried along by the game.
#[derive(Component)]
struct Carried(Vec3);

/// A car at rest on a platform that moves.
pub fn platform(s: &mut Stage, velocity: Vec3) {
    s.sim.spawn((
        RigidBody::KinematicPositionBased,
        Collider::cuboid(20.0, 0.5, 20.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Carried(velocity),
    ));
    let carry = |time: Res<Time>, mut all: Query<(&Carried, &mut Transform)>| {
        for (carried, mut at) in &mut all {
            at.translation += carried.0 * time.delta_secs();
        }
    };
    s.sim.app.add_systems(FixedUpdate, carry);
    s.spawn(
        &Plan::reference(),
        0.0,
        Transform::from_xyz(0.0, HEIGHT, 0.0),
    );
    s.ask(0.0, 1.0, 0.0);
    s.roll(velocity);
}

fn ferry(mut s: Stage) -> f64 {
    platform(&mut s, Vec3::X * 2.0);
    s.roll(Vec3::ZERO);
    s.sim.seconds(3.0);
    (s.velocity().linear.with_y(0.0) - Vec3::X * 2.0)
        .length()
        .into()
}

fn momentum(mut s: Stage) -> f64 {
    let slippery = Friction {
        coefficient: 0.0,
        combine_rule: CoefficientCombineRule::Min,
    };
    s.sim.spawn((
        RigidBody::Fixed,
        Collider::cuboid(200.0, 0.5, 200.0),
        slippery,
        Transform::from_xyz(0.0, -1.5, 0.0),
    ));
    let slab = s.sim.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(20.0, 0.5, 20.0),
        slippery,
        ColliderMassProperties::Mass(3000.0),
        Velocity::default(),
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    let plan = Plan::reference().direct(500.0, |_| true);
    s.spawn(&plan, 2000.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    s.sim.seconds(3.0);
    let total = |s: &Stage| {
        let slab = s.sim.get::<Velocity>(slab).linear * 3000.0;
        (s.momentum() + slab).with_y(0.0)
    };
    let before = total(&s);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(2.0);
    f64::from((total(&s) - before).length()) / 4000.0
}
