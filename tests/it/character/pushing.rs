//! Pushing bodies: force balances, caps, where a push acts.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// A floor and on it a crate of 1 m with this mass, friction and damping, ahead of a pusher.
struct Push {
    sim: Sim,
    pusher: Entity,
    crate_: Entity,
}

fn pushing(hz: f64, mass: f32, friction: f32, damping: f32, strength: f32) -> Push {
    let mut sim = Sim::new(hz);
    let floor = sim.floor(0.0);
    insert(&mut sim, floor, Friction::coefficient(friction));
    let crate_ = sim.dynamic(
        Collider::cuboid(0.5, 0.5, 0.5),
        Transform::from_xyz(1.0, 0.5, 0.0),
        mass,
    );
    insert(
        &mut sim,
        crate_,
        (
            Friction::coefficient(friction),
            Damping {
                linear_damping: damping,
                angular_damping: 0.0,
            },
            // It slides and does not tip: the balance of forces is then exact.
            LockedAxes::ROTATION_LOCKED,
        ),
    );
    let pusher = runner_with(
        &mut sim,
        Character {
            push_strength: strength,
            ..default()
        },
        Vec3::new(0.1, 0.0, 0.0),
    );
    sim.seconds(0.5);
    sim.walk(pusher, Vec3::X);
    Push {
        sim,
        pusher,
        crate_,
    }
}

impl Push {
    /// Mean speeds of crate and pusher over the next second.
    fn speeds(&mut self) -> (f32, f32) {
        let start = [self.crate_, self.pusher].map(|e| self.sim.position(e).x);
        self.sim.seconds(1.0);
        let end = [self.crate_, self.pusher].map(|e| self.sim.position(e).x);
        (end[0] - start[0], end[1] - start[1])
    }
}

#[test]
fn a_pushed_crate_reaches_the_speed_of_its_force_balance() {
    // Strength = friction + damping × mass × speed, as long as that is below the walking speed.
    let mut found = Findings::new();
    for hz in RATES {
        for (mass, friction, damping, strength) in [
            (1.0, 0.3, 1.0, 5.0),
            (10.0, 0.3, 1.0, 50.0),
            (100.0, 0.3, 1.0, 500.0),
            (1000.0, 0.3, 1.0, 5000.0),
            (100.0, 0.0, 2.0, 500.0),
            (1000.0, 0.0, 0.5, 500.0),
            (10.0, 0.8, 0.5, 100.0),
        ] {
            let mut push = pushing(hz, mass, friction, damping, strength);
            push.sim.seconds(f64::from(6.0 / damping));
            let (crate_, pusher) = push.speeds();
            let wanted = ((strength - friction * mass * G) / (damping * mass)).clamp(0.0, SPEED);
            let case =
                format!("{hz} Hz {mass} kg µ {friction} damping {damping} strength {strength}");
            found.within(format!("{case}: crate"), crate_, wanted, 0.05);
            found.within(format!("{case}: pusher"), pusher, wanted, 0.05);
        }
    }
}

#[test]
fn crates_of_one_to_a_hundred_kilograms_are_pushed_at_walking_speed_and_a_tonne_stays() {
    let mut found = Findings::new();
    for hz in RATES {
        for (mass, wanted) in [(1.0, SPEED), (10.0, SPEED), (100.0, SPEED), (1000.0, 0.0)] {
            // 500 N against friction of 2.9 N to 2.9 kN.
            let mut push = pushing(hz, mass, 0.3, 0.0, 500.0);
            let mut fastest: f32 = 0.0;
            for _ in 0..(5.0 * hz) as usize {
                push.sim.ticks(1);
                fastest = fastest.max(push.sim.get::<Velocity>(push.crate_).linear.length());
            }
            let (crate_, pusher) = push.speeds();
            let case = format!("{hz} Hz {mass} kg");
            found.near(
                format!("{case}: crate"),
                crate_,
                wanted,
                wanted * 0.05 + 0.001,
            );
            found.near(
                format!("{case}: pusher"),
                pusher,
                wanted,
                wanted * 0.05 + 0.001,
            );
            // No crate is shot away.
            found.at_most(format!("{case}: fastest"), fastest, SPEED * 1.05);
            if wanted == 0.0 {
                found.near(
                    format!("{case}: moved"),
                    push.sim.position(push.crate_).x,
                    1.0,
                    0.002,
                );
            }
        }
    }
}

#[test]
fn a_crate_is_accelerated_by_no_more_than_the_strength() {
    // Without friction and damping 500 N give 100 kg 5 m/s².
    let mut found = Findings::new();
    for hz in RATES {
        let mut push = pushing(hz, 100.0, 0.0, 0.0, 500.0);
        push.sim.seconds(0.2);
        let before = push.sim.get::<Velocity>(push.crate_).linear.x;
        push.sim.seconds(0.5);
        let after = push.sim.get::<Velocity>(push.crate_).linear.x;
        found.within(format!("{hz} Hz"), (after - before) / 0.5, 5.0, 0.05);
    }
}

#[test]
fn a_crate_that_may_tip_is_pushed_along_and_a_light_one_does_not_fly() {
    let mut found = Findings::new();
    for hz in RATES {
        for mass in [1.0, 10.0, 50.0] {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let crate_ = sim.dynamic(
                Collider::cuboid(0.3, 0.3, 0.3),
                Transform::from_xyz(1.0, 0.3, 0.05),
                mass,
            );
            let pusher = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.5);
            sim.walk(pusher, Vec3::X);
            let (mut fastest, mut highest): (f32, f32) = (0.0, 0.0);
            for _ in 0..(3.0 * hz) as usize {
                sim.ticks(1);
                fastest = fastest.max(sim.get::<Velocity>(crate_).linear.length());
                highest = highest.max(sim.position(crate_).y);
            }
            let case = format!("{hz} Hz {mass} kg");
            found.at_most(format!("{case}: fastest"), fastest, SPEED * 1.3);
            found.at_most(format!("{case}: highest"), highest, 1.0);
            found.holds(format!("{case}: finite"), finite(&sim, pusher));
            found.at_least(
                format!("{case}: pusher came forward"),
                sim.position(pusher).x,
                2.0,
            );
        }
    }
}

#[test]
fn without_strength_every_body_is_a_wall() {
    let mut found = Findings::new();
    for hz in RATES {
        for opted_out in [false, true] {
            let strength = if opted_out { 500.0 } else { 0.0 };
            let mut push = pushing(hz, 1.0, 0.0, 0.0, strength);
            if opted_out {
                let crate_ = push.crate_;
                insert(&mut push.sim, crate_, NotPushable);
            }
            push.sim.seconds(2.0);
            let case = format!("{hz} Hz opted out {opted_out}");
            let crate_ = push.sim.position(push.crate_);
            found.near(format!("{case}: crate"), crate_.x, 1.0, 0.001);
            found.near(
                format!("{case}: pusher"),
                push.sim.position(push.pusher).x,
                0.2,
                0.022,
            );
        }
    }
}

#[test]
fn an_impulse_acts_at_the_same_place_wherever_the_body_has_its_origin() {
    // The same box as a body at y = 3 and as a collider offset by 3 m. It hangs clear of the floor:
    // a corner that turns into it is Rapier's affair.
    let mut found = Findings::new();
    for hz in RATES {
        let run = |offset: bool| {
            let mut sim = Sim::new(hz);
            sim.floor(0.0);
            let shape = Collider::cuboid(0.5, 3.5, 0.5);
            let body = if offset {
                let body = sim.spawn((
                    RigidBody::Dynamic,
                    Transform::from_xyz(1.0, 0.8, 0.0),
                    Velocity::default(),
                    GravityScale(0.0),
                ));
                let child = (
                    shape,
                    ColliderMassProperties::Mass(200.0),
                    Transform::from_xyz(0.0, 3.0, 0.0),
                    ChildOf(body),
                );
                sim.spawn(child);
                body
            } else {
                let body = sim.dynamic(shape, Transform::from_xyz(1.0, 3.8, 0.0), 200.0);
                insert(&mut sim, body, GravityScale(0.0));
                body
            };
            let pusher = runner(&mut sim, Vec3::ZERO);
            sim.ticks(3);
            sim.walk(pusher, Vec3::X);
            sim.seconds(0.3);
            sim.get::<Velocity>(body)
        };
        let (plain, offset) = (run(false), run(true));
        // Rapier's velocities are those of the centre of mass.
        found.holds(format!("{hz} Hz: turns"), plain.angular.length() > 1e-4);
        found.at_most(
            format!("{hz} Hz: turn differs"),
            plain.angular.distance(offset.angular),
            2e-3,
        );
        found.at_most(
            format!("{hz} Hz: speed differs"),
            plain.linear.distance(offset.linear),
            5e-3,
        );
    }
}

#[test]
fn a_crate_of_two_halves_is_pushed_like_a_whole_one() {
    let mut found = Findings::new();
    for hz in RATES {
        let run = |halves: bool| {
            let mut sim = Sim::new(hz);
            let floor = sim.floor(0.0);
            insert(&mut sim, floor, Friction::coefficient(0.0));
            let body = sim.spawn((
                RigidBody::Dynamic,
                Transform::from_xyz(1.0, 0.5, 0.0),
                LockedAxes::ROTATION_LOCKED,
                Velocity::default(),
            ));
            // The pusher meets the seam at z = 0.
            let parts = if halves {
                vec![(0.25, -0.25), (0.25, 0.25)]
            } else {
                vec![(0.5, 0.0)]
            };
            for (half, z) in parts {
                sim.spawn((
                    Collider::cuboid(0.5, 0.5, half),
                    ColliderMassProperties::Mass(400.0 * half),
                    Friction::coefficient(0.0),
                    Transform::from_xyz(0.0, 0.0, z),
                    ChildOf(body),
                ));
            }
            let pusher = runner(&mut sim, Vec3::ZERO);
            sim.seconds(0.3);
            sim.walk(pusher, Vec3::X);
            sim.seconds(0.5);
            sim.get::<Velocity>(body).linear.x
        };
        let (whole, halves) = (run(false), run(true));
        found.at_least(format!("{hz} Hz: moves"), whole, 0.3);
        found.within(format!("{hz} Hz: halves"), halves, whole, 0.02);
    }
}

#[test]
fn another_character_pushes_the_crate_one_stands_on() {
    let mut found = Findings::new();
    for hz in RATES {
        let mut push = pushing(hz, 100.0, 0.1, 2.0, 800.0);
        let rider = runner(&mut push.sim, Vec3::new(1.0, 1.0, 0.0));
        push.sim.seconds(3.0);
        let on = push.sim.position(rider) - push.sim.position(push.crate_);
        found.near(
            format!("{hz} Hz: rider carried along"),
            on.x,
            0.0,
            0.05 + 4.0 / hz as f32,
        );
        found.near(format!("{hz} Hz: rider on top"), on.y, 0.5, 0.01);
        found.at_least(
            format!("{hz} Hz: crate moved"),
            push.sim.position(push.crate_).x,
            2.0,
        );
    }
}

/// Deepest that a character is in a crate within the next seconds, metres, and how fast it believes to
/// be at the end.
fn deepest(sim: &mut Sim, who: Entity, crate_: Entity, seconds: f64) -> (f32, f32) {
    let ticks = (seconds / f64::from(sim.dt())).round() as usize;
    let deep = (0..ticks).fold(f32::MIN, |deep, _| {
        sim.ticks(1);
        let now = depth_in(sim, who, crate_);
        if now.is_nan() { now } else { deep.max(now) }
    });
    (deep, sim.state(who).velocity.length())
}

#[test]
fn a_crate_that_cannot_move_stops_its_pusher_however_light_it_is() {
    let mut found = Findings::new();
    for hz in RATES {
        for mass in [0.2, 1.0, 5.0, 10.0, 50.0] {
            for other in ["wall", "character", "corner"] {
                let mut push = pushing(hz, mass, 0.5, 0.0, 500.0);
                match other {
                    "wall" => {
                        push.sim
                            .block(Vec3::new(2.5, 1.0, 0.0), Vec3::new(2.0, 2.0, 6.0));
                    }
                    "corner" => {
                        push.sim
                            .block(Vec3::new(2.5, 1.0, 0.0), Vec3::new(2.0, 2.0, 6.0));
                        push.sim
                            .block(Vec3::new(1.0, 1.0, 1.6), Vec3::new(6.0, 2.0, 2.0));
                        push.sim.walk(push.pusher, Vec3::new(1.0, 0.0, 0.2));
                    }
                    _ => {
                        let other = runner(&mut push.sim, Vec3::new(3.0, 0.0, 0.0));
                        push.sim.walk(other, Vec3::NEG_X);
                    }
                }
                if other == "character" {
                    // Both run the same crate down at once: what counts is how they stand then.
                    push.sim.seconds(1.0);
                }
                let (deep, speed) = deepest(&mut push.sim, push.pusher, push.crate_, 3.0);
                let case = format!("{hz} Hz, {mass} kg against a {other}");
                // What friction may hold it up by in a tick, and what the engine lets it be pressed in; what
                // is nearly weightless goes as deep as the bodies, which are that much smaller.
                let most = 0.012 + G / (hz * hz) as f32;
                let most = if mass < 1.0 { most.max(0.0205) } else { most };
                found.at_most(format!("{case}: inside"), deep, most);
                if other == "wall" {
                    found.at_most(format!("{case}: believes to walk at"), speed, 0.5);
                }
            }
        }
    }
}

#[test]
fn who_lands_on_a_light_crate_stops_on_it() {
    let mut found = Findings::new();
    for hz in RATES {
        // Lighter ones are pressed into the floor: the engine's contacts are as soft as bodies are light.
        for mass in [1.0, 10.0, 100.0] {
            let mut push = pushing(hz, mass, 0.5, 0.0, 500.0);
            push.sim.walk(push.pusher, Vec3::ZERO);
            let jumper = runner(&mut push.sim, Vec3::new(1.0, 4.0, 0.0));
            let (deep, _) = deepest(&mut push.sim, jumper, push.crate_, 3.0);
            let case = format!("{hz} Hz, {mass} kg");
            found.at_most(
                format!("{case}: inside"),
                deep,
                0.012 + G / (hz * hz) as f32,
            );
            found.near(
                format!("{case}: stands on it"),
                push.sim.position(jumper).y,
                1.0,
                0.01,
            );
        }
    }
}
