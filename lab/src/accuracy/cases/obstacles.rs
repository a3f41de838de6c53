//! What lies in the way: hills, kerbs, seams, walls, a loop, the air.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use embody_scenes::{
    Patch,
    reference::{G, HEIGHT, MASS, Plan, RADIUS, plane, uphill},
};

use super::{Case, Stage, alone, case, drive::stiff, nothing};

pub const CASES: &[Case] = &[
    nothing(
        "vehicle A18",
        "dip of a car that drives over bricks of 5 kg",
        "mm",
        20.0,
        rubble,
    ),
    case(
        "vehicle A20",
        "acceleration up 30 degrees, of (F − m g sin) / (m + Σ I / R²)",
        "",
        1.0,
        0.02,
        climb,
    ),
    nothing(
        "vehicle A20",
        "speed upward at a kerb of 15 cm, rays",
        "m/s",
        2.0,
        |s| kerb(s, WheelProbe::Ray).thrown,
    ),
    case(
        "vehicle A20",
        "height behind a kerb of 15 cm, rays",
        "m",
        0.70,
        0.01,
        |s| kerb(s, WheelProbe::Ray).height,
    ),
    alone(nothing(
        "vehicle A20",
        "speed upward at a kerb of 15 cm, cylinders",
        "m/s",
        2.0,
        |s| kerb(s, WheelProbe::Cylinder).thrown,
    )),
    nothing(
        "vehicle A20",
        "change of load on the seams of a flat mesh at 20 m/s, rays",
        "",
        0.01,
        |s| seams(s, WheelProbe::Ray),
    ),
    alone(nothing(
        "vehicle A20",
        "change of load on the seams of a flat mesh at 20 m/s, cylinders",
        "",
        0.01,
        |s| seams(s, WheelProbe::Cylinder),
    )),
    case(
        "vehicle A20",
        "height between two walls that touch the tyres, rays",
        "m",
        0.55,
        0.01,
        |s| between_walls(s, WheelProbe::Ray),
    ),
    alone(case(
        "vehicle A20",
        "height between two walls that touch the tyres, cylinders",
        "m",
        0.55,
        0.01,
        |s| between_walls(s, WheelProbe::Cylinder),
    )),
    nothing(
        "vehicle A20",
        "load of a wheel of a car that lies upside down",
        "N",
        0.0,
        upside_down,
    ),
    case(
        "vehicle A20",
        "speed at the top of a loop of 20 m from 34 m/s, of its energy's",
        "",
        1.0,
        0.02,
        top_of_loop,
    ),
    alone(case(
        "vehicle A20",
        "spin of a wheel after 0.5 s of throttle in the air, of F R t / I",
        "",
        1.0,
        0.01,
        spin_in_air,
    )),
];

fn climb(mut s: Stage) -> f64 {
    let force = 8400.0;
    let plan = Plan::reference().direct(force / 4.0, |_| true);
    s.park(&plan, force, uphill(30.0));
    s.ask(0.0, 1.0, 0.0);
    s.sim.seconds(4.0);
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(2.0);
    let along = |s: &Stage| f64::from(s.velocity().linear.length());
    let (v0, span) = (along(&s), 2.0);
    s.sim.seconds(span);
    let radius = f64::from(RADIUS);
    let mass = f64::from(MASS) + 4.0 * s.wheel_inertia() / (radius * radius);
    let pull = f64::from(force) - 0.5 * f64::from(MASS * G);
    (along(&s) - v0) / span / (pull / mass)
}

fn rubble(mut s: Stage) -> f64 {
    plane(&mut s.sim, Quat::IDENTITY);
    for i in 0..20 {
        let side = if i % 2 == 0 { -0.8 } else { 0.8 };
        let at = Vec3::new(side, 0.04, -8.0 - 0.5 * i as f32);
        let brick = bevy_rapier3d::prelude::Collider::cuboid(0.1, 0.04, 0.06);
        s.sim.dynamic(brick, Transform::from_translation(at), 5.0);
    }
    let at = Transform::from_xyz(0.0, HEIGHT, 0.0);
    s.spawn(&Plan::reference(), 0.0, at);
    s.sim.seconds(1.0);
    s.roll(Vec3::NEG_Z * 6.0);
    let mut dip = 0.0f32;
    for _ in 0..(4.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        dip = dip.max(HEIGHT - s.pose().translation.y);
    }
    1000.0 * f64::from(dip)
}

/// What a kerb did.
struct Climbed {
    /// Greatest speed upward, metres per second.
    thrown: f64,
    /// Where the car then stood, metres.
    height: f64,
}

fn kerb(mut s: Stage, probe: WheelProbe) -> Climbed {
    s.sim.floor(0.0);
    s.sim
        .block(Vec3::new(0.0, 0.075, -30.0), Vec3::new(20.0, 0.15, 40.0));
    let plan = Plan::reference().wheel(|_, wheel| wheel.probe = probe);
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    s.sim.seconds(1.0);
    s.roll(Vec3::NEG_Z * 6.0);
    let mut thrown = 0.0f32;
    for _ in 0..(3.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        thrown = thrown.max(s.velocity().linear.y);
    }
    let at = s.pose().translation;
    Climbed {
        thrown: thrown.into(),
        // Who did not get there stands nowhere.
        height: if at.z < -11.0 { at.y.into() } else { f64::NAN },
    }
}

/// Greatest change of a wheel's load, in parts of it, on a plane of triangles of 0.7 m that are shifted
/// against the wheels.
fn seams(mut s: Stage, probe: WheelProbe) -> f64 {
    let corner = Vec3::new(-3.3, 0.0, -62.9);
    let mesh = Patch::new(corner, Vec3::Z * 70.0, Vec3::X * 7.0, 100, 10);
    s.sim.fixed(mesh.collider(), Transform::default());
    let plan = Plan::reference().wheel(|_, wheel| wheel.probe = probe);
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    s.sim.seconds(3.0);
    let still = s.loads();
    s.roll(Vec3::NEG_Z * 20.0);
    let mut most = 0.0f64;
    for _ in 0..(2.5 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        for (now, still) in s.loads().iter().zip(&still) {
            most = most.max((now / still - 1.0).abs());
        }
    }
    most
}

fn between_walls(mut s: Stage, probe: WheelProbe) -> f64 {
    s.sim.floor(0.0);
    for x in [-1.45, 1.45] {
        s.sim
            .block(Vec3::new(x, 1.0, 0.0), Vec3::new(1.0, 2.0, 20.0));
    }
    let plan = Plan::reference().wheel(|_, wheel| wheel.probe = probe);
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    s.sim.seconds(4.0);
    s.pose().translation.y.into()
}

fn upside_down(mut s: Stage) -> f64 {
    s.sim.floor(0.0);
    let turned = Quat::from_rotation_z(core::f32::consts::PI);
    let at = Transform::from_xyz(0.0, 1.5, 0.0).with_rotation(turned);
    s.spawn(&Plan::reference(), 0.0, at);
    let mut most = 0.0f64;
    for _ in 0..(3.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        most = s.loads().into_iter().fold(most, f64::max);
    }
    most
}

/// Drives into a loop up to its top without drive.
fn top_of_loop(mut s: Stage) -> f64 {
    let (radius, speed, start) = (20.0f32, 34.0f32, 30.0f32);
    let point = |degrees: f32| {
        let (sin, cos) = ops::sin_cos(degrees.to_radians());
        Vec3::new(-5.0, radius * (1.0 - cos), -start - radius * sin)
    };
    let mut band = Patch::new(
        Vec3::new(-5.0, 0.0, 10.0),
        Vec3::X * 10.0,
        Vec3::NEG_Z * (start + 10.0),
        1,
        1,
    );
    for degree in 0..220u8 {
        let (from, to) = (point(degree.into()), point(f32::from(degree) + 1.0));
        band.add(from, Vec3::X * 10.0, to - from, 1, 1);
    }
    s.sim.fixed(band.collider(), Transform::default());
    s.spawn(&stiff(), 0.0, Transform::from_xyz(0.0, HEIGHT, 0.0));
    s.sim.seconds(1.0);
    s.roll(Vec3::NEG_Z * speed);
    let mut top = (0.0f32, f64::NAN);
    for _ in 0..(4.0 / s.sim.dt()) as usize {
        s.sim.ticks(1);
        let y = s.pose().translation.y;
        if y > top.0 {
            top = (y, s.velocity().linear.length().into());
        }
    }
    if top.0 < 1.8 * radius {
        // It fell off.
        return f64::NAN;
    }
    // About the middle of the loop turn the body, its pitch and, by what they roll, the wheels.
    let arm = f64::from(radius - HEIGHT);
    let mass = f64::from(MASS);
    let wheels = 4.0 * s.wheel_inertia() / f64::from(RADIUS * RADIUS);
    let inertia = mass * arm * arm + 2400.0 + wheels * f64::from(radius * radius);
    let speed = f64::from(speed);
    let left = (mass + wheels) * speed * speed - 4.0 * mass * f64::from(G) * arm;
    top.1 / ((left / inertia).sqrt() * arm)
}

fn spin_in_air(mut s: Stage) -> f64 {
    let (force, time) = (500.0, 0.5);
    let plan = Plan::reference().direct(force, |_| true);
    s.spawn(&plan, 0.0, Transform::from_xyz(0.0, 30.0, 0.0));
    s.sim.seconds(0.5);
    let Some(car) = s.own() else { return f64::NAN };
    let before = car.wheel(&s.sim, 0).spin;
    s.ask(1.0, 0.0, 0.0);
    s.sim.seconds(time);
    let spun = f64::from(car.wheel(&s.sim, 0).spin - before);
    spun / (f64::from(force * RADIUS) * time)
}
