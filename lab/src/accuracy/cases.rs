//! The cases, by the car of [`embody_scenes::reference`]: 1500 kg, wheelbase 2.8 m, track 1.6 m, centre
//! of mass 0.55 m up, 1.5 Hz at half of critical damping, friction 1.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::reference::{G, HEIGHT, MASS, Plan, SAG, plane, side_on, uphill};

use super::{Case, stage::Stage};

const fn case(
    name: &'static str,
    what: &'static str,
    unit: &'static str,
    asked: f64,
    run: fn(Stage) -> f64,
) -> Case {
    Case {
        name,
        what,
        unit,
        asked,
        scale: Some(asked),
        peer: true,
        run,
    }
}

/// One that is asked for nothing: its errors are in its unit.
const fn nothing(
    name: &'static str,
    what: &'static str,
    unit: &'static str,
    run: fn(Stage) -> f64,
) -> Case {
    Case {
        scale: None,
        ..case(name, what, unit, 0.0, run)
    }
}

/// One that Rapier's controller has no means for.
const fn alone(case: Case) -> Case {
    Case {
        peer: false,
        ..case
    }
}

/// All cases.
pub const CASES: &[Case] = &[
    case("vehicle A1", "static sag", "m", 0.110_44, sag),
    case(
        "vehicle A1",
        "load of a front wheel, centre 0.2 m ahead",
        "N",
        4204.3,
        front_load,
    ),
    case(
        "vehicle A1",
        "sum of loads on 20 degrees",
        "N",
        13_827.6,
        slope_loads,
    ),
    case(
        "vehicle A1",
        "sag on a lift that rises at 2 m/s",
        "m",
        0.110_44,
        |s| lift(s, 2.0),
    ),
    case(
        "vehicle A1",
        "sag on a lift that sinks at 2 m/s",
        "m",
        0.110_44,
        |s| lift(s, -2.0),
    ),
    case(
        "vehicle A2",
        "overshoot of a quarter car",
        "",
        0.163,
        overshoot,
    ),
    case("vehicle A2", "time of its peak", "s", 0.385, peak_time),
    case(
        "vehicle A4",
        "weight transfer at 5 m/s², of m a h / L",
        "",
        1.0,
        transfer,
    ),
    case(
        "vehicle A6",
        "launch, all-wheel drive",
        "m/s²",
        9.81,
        |s| launch(s, 9.81, |_| true),
    ),
    case("vehicle A6", "launch, rear drive", "m/s²", 6.104, |s| {
        launch(s, 6.104, |i| i > 1)
    }),
    case("vehicle A6", "launch, front drive", "m/s²", 4.100, |s| {
        launch(s, 4.100, |i| i < 2)
    }),
    case(
        "vehicle A7",
        "stopping distance from 20 m/s",
        "m",
        20.387,
        stop,
    ),
    nothing(
        "vehicle A8",
        "creep in 10 s, braked nose up on 20 degrees",
        "mm",
        |s| creep(s, uphill(20.0)),
    ),
    nothing(
        "vehicle A8",
        "creep in 10 s, braked across 20 degrees",
        "mm",
        |s| creep(s, side_on(20.0)),
    ),
    case(
        "vehicle A8",
        "slide, braked, 32 degrees at friction 0.6",
        "m/s²",
        0.207,
        slide,
    ),
    nothing("vehicle A9", "drift at rest in 20 s", "mm", drift),
    case(
        "vehicle A10",
        "radius of a turn at 2 m/s, asked 10 m",
        "m",
        10.0,
        turn_radius,
    ),
    case(
        "vehicle A11",
        "yaw rate of a neutral car",
        "rad/s",
        0.2143,
        |s| yaw_rate(s, 0.0),
    ),
    case(
        "vehicle A11",
        "yaw rate of an understeering car",
        "rad/s",
        0.1550,
        |s| yaw_rate(s, 0.2),
    ),
    Case {
        scale: Some(1.0),
        ..case(
            "vehicle A12",
            "greatest grip, braking and steering, of µ N",
            "",
            1.0,
            ellipse,
        )
    },
    alone(case(
        "vehicle A13",
        "terminal speed at 2000 N",
        "m/s",
        67.16,
        terminal,
    )),
    alone(case(
        "vehicle A14",
        "speed after coasting 10 s from 30 m/s",
        "m/s",
        26.75,
        coast,
    )),
    nothing(
        "vehicle A18",
        "momentum from nothing, car on a slab on ice, of the drive",
        "",
        momentum,
    ),
    nothing(
        "vehicle A19",
        "slip of a braked car on a ferry that moves aside at 2 m/s",
        "m/s",
        ferry,
    ),
];

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn sag(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    mean(&s.compressions())
}

fn front_load(mut s: Stage) -> f64 {
    let mut plan = Plan::reference();
    plan.mass.center.z = -0.2;
    s.park(&plan, 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    mean(&s.loads()[..2])
}

fn slope_loads(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, uphill(20.0));
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(5.0);
    s.loads().iter().sum()
}

/// A platform below the car, carried along by the game.
#[derive(Component)]
struct Carried(Vec3);

fn platform(s: &mut Stage, velocity: Vec3) {
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

fn lift(mut s: Stage, speed: f32) -> f64 {
    platform(&mut s, Vec3::Y * speed);
    s.sim.seconds(5.0);
    mean(&s.compressions())
}

fn ferry(mut s: Stage) -> f64 {
    platform(&mut s, Vec3::X * 2.0);
    s.roll(Vec3::ZERO);
    s.sim.seconds(3.0);
    (s.velocity().linear.with_y(0.0) - Vec3::X * 2.0)
        .length()
        .into()
}

/// The path of the compression after the car is let go with slack springs.
fn step_response(s: &mut Stage) -> Vec<f64> {
    let plan = Plan::reference().suspension(|spring| spring.stop_stiffness = 0.0);
    plane(&mut s.sim, Quat::IDENTITY);
    // A little above the ground the wheels would still fall; so exactly at it.
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT + SAG, 0.0));
    let start = f64::from(s.pose().translation.y);
    let fallen = f64::from(HEIGHT + SAG) - start;
    let ticks = (1.2 / f64::from(s.sim.dt())) as usize;
    let mut path = vec![fallen];
    for _ in 0..ticks {
        s.sim.ticks(1);
        path.push(f64::from(HEIGHT + SAG - s.pose().translation.y));
    }
    path
}

/// Value and place of the greatest of a path, by the parabola through it and its neighbours; in ticks.
fn peak(path: &[f64]) -> (f64, f64) {
    let mut top = 1;
    for i in 1..path.len() - 1 {
        if path[i] > path[top] {
            top = i;
        }
    }
    let (a, b, c) = (path[top - 1], path[top], path[top + 1]);
    let bend = a - 2.0 * b + c;
    if bend.abs() < 1.0e-12 {
        return (b, top as f64);
    }
    let off = 0.5 * (a - c) / bend;
    (b - 0.25 * (a - c) * off, top as f64 + off)
}

fn overshoot(mut s: Stage) -> f64 {
    let path = step_response(&mut s);
    peak(&path).0 / f64::from(SAG) - 1.0
}

fn peak_time(mut s: Stage) -> f64 {
    let path = step_response(&mut s);
    // The first value of the path is that after one tick.
    (peak(&path).1 + 1.0) * f64::from(s.sim.dt())
}

/// The same car on springs of 5 Hz, so that its pitch does not shift the wheels under it.
fn stiff() -> Plan {
    let sag = SAG * (1.5 / 5.0) * (1.5 / 5.0);
    Plan::reference().wheel(|_, wheel| {
        wheel.suspension.spring = SpringRate::RideFrequency(5.0);
        wheel.attachment.y += SAG - sag;
    })
}

fn transfer(mut s: Stage) -> f64 {
    let force = 5.0 * MASS;
    let plan = stiff().direct(force / 4.0, |_| true);
    s.park(&plan, force, Quat::IDENTITY);
    s.sim.seconds(3.0);
    let before: f64 = s.loads()[..2].iter().sum();
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(2.5);
    let (v0, span) = (s.speed(), 0.5);
    s.sim.seconds(span);
    let a = (s.speed() - v0) / span;
    let after: f64 = s.loads()[..2].iter().sum();
    (before - after) / (f64::from(MASS * HEIGHT) * a / 2.8)
}

/// `limit` is what the tyres hold, metres per second squared: the drive gives a little more. Much more
/// would turn the car about its spinning wheels.
fn launch(mut s: Stage, limit: f32, driven: fn(usize) -> bool) -> f64 {
    let count = (0..4).filter(|i| driven(*i)).count() as f32;
    let force = 1.03 * limit * (MASS + count / 0.09);
    let plan = stiff().direct(force / count, driven);
    s.park(&plan, force, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(1.0);
    let (v0, span) = (s.speed(), 1.0);
    s.sim.seconds(span);
    (s.speed() - v0) / span
}

fn stop(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 20.0);
    let from = s.pose().translation;
    s.ask(0.0, 1.0, 0.0);
    let stopped = s.time_until(20.0, |s| s.speed() < 0.01);
    if stopped.is_infinite() {
        return f64::NAN;
    }
    s.pose().translation.distance(from).into()
}

fn creep(mut s: Stage, rotation: Quat) -> f64 {
    s.park(&Plan::reference(), 0.0, rotation);
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(5.0);
    let from = s.pose().translation;
    s.sim.seconds(10.0);
    1000.0 * f64::from(s.pose().translation.distance(from))
}

fn slide(mut s: Stage) -> f64 {
    let plan = Plan::reference().tire(|tire| tire.friction = Vec2::splat(0.6));
    s.park(&plan, 0.0, uphill(32.0));
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(4.0);
    let along = |s: &Stage| f64::from(s.velocity().linear.length());
    let (v0, span) = (along(&s), 4.0);
    s.sim.seconds(span);
    (along(&s) - v0) / span
}

fn drift(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(5.0);
    let from = s.pose().translation;
    s.sim.seconds(20.0);
    1000.0 * f64::from(s.pose().translation.distance(from))
}

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

fn ellipse(mut s: Stage) -> f64 {
    s.park(&Plan::reference(), 0.0, Quat::IDENTITY);
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 20.0);
    s.ask(0.0, 0.3, 0.2);
    let mut most = 0.0f64;
    for _ in 0..(1.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        most = s.grips().into_iter().fold(most, f64::max);
    }
    most
}

fn windy() -> Plan {
    let mut plan = Plan::reference().tire(|tire| tire.rolling_resistance = 0.012);
    plan.vehicle.aero = Some(Aero {
        drag_area: 0.66,
        ..default()
    });
    plan
}

fn terminal(mut s: Stage) -> f64 {
    let plan = windy().direct(500.0, |_| true);
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(&plan, 2000.0, Transform::from_xyz(0.0, HEIGHT, 1900.0));
    s.sim.seconds(2.0);
    // The way to a speed that is reached in minutes is cut short: it must be where the pull on both
    // sides of it is the same.
    let pull = |s: &mut Stage, from: f32| {
        s.roll(Vec3::NEG_Z * from);
        s.sim.seconds(2.0);
        let v0 = s.speed();
        s.sim.seconds(4.0);
        (0.5 * (v0 + s.speed()), (s.speed() - v0) / 4.0)
    };
    s.ask(1.0, 0.0, 0.0);
    let (v1, a1) = pull(&mut s, 65.0);
    let (v2, a2) = pull(&mut s, 70.0);
    v1 + (v2 - v1) * a1 / (a1 - a2)
}

fn coast(mut s: Stage) -> f64 {
    plane(&mut s.sim, Quat::IDENTITY);
    s.spawn(&windy(), 0.0, Transform::from_xyz(0.0, HEIGHT, 500.0));
    s.sim.seconds(3.0);
    s.roll(Vec3::NEG_Z * 30.0);
    s.sim.seconds(10.0);
    s.speed()
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

// What the formulas above are of.
const _: () = assert!(G > 9.8 && G < 9.82 && MASS == 1500.0);
