//! Ten thousand random scripts on random junk: never inside static geometry, always finite, never
//! faster than asked. Eight scripts share a world, so that characters meet each other too.

use bevy::{math::ops, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Patch, Sim};
use proptest::{
    prelude::*,
    test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner},
};

use super::support::*;

/// Scripts in a world, and ticks that each lasts.
const SCRIPTS: usize = 8;
const TICKS: usize = 60;
/// Worlds at each of the four tick rates: 4 × 313 × 8 = 10 016 scripts.
const WORLDS: u32 = 313;

/// A part of the junk: where, how large, how turned.
#[derive(Clone, Copy, Debug)]
struct Part {
    at: Vec3,
    size: Vec3,
    turn: Quat,
}

impl Part {
    fn pose(self) -> Transform {
        Transform::from_translation(self.at).with_rotation(self.turn)
    }

    fn collider(self) -> Collider {
        Collider::cuboid(self.size.x * 0.5, self.size.y * 0.5, self.size.z * 0.5)
    }
}

/// What a character is asked during a quarter of the script.
#[derive(Clone, Copy, Debug)]
struct Leg {
    degrees: f32,
    part: f32,
    jump: bool,
    sprint: bool,
    crouch: bool,
}

#[derive(Clone, Debug)]
struct Junk {
    boxes: Vec<Part>,
    meshes: Vec<Part>,
    hills: Option<(f32, f32)>,
    /// Kinematic: amplitude of the way and angular speed.
    movers: Vec<(Part, Vec3, f32)>,
    dynamics: Vec<(Part, f32)>,
    scripts: Vec<[Leg; 4]>,
}

fn between(low: f32, high: f32) -> impl Strategy<Value = f32> {
    low..high
}

fn part(largest: f32) -> impl Strategy<Value = Part> {
    (
        (between(-7.0, 7.0), between(0.0, 2.5), between(-7.0, 7.0)),
        (
            between(0.1, largest),
            between(0.1, largest),
            between(0.1, largest),
        ),
        (
            between(-1.0, 1.0),
            between(-1.0, 1.0),
            between(-1.0, 1.0),
            prop_oneof![Just(0.0f32), between(0.0, 3.0)],
        ),
    )
        .prop_map(|(at, size, turn)| Part {
            at: at.into(),
            size: size.into(),
            turn: Quat::from_axis_angle(
                Vec3::new(turn.0, turn.1, turn.2)
                    .try_normalize()
                    .unwrap_or(Vec3::Y),
                turn.3,
            ),
        })
}

fn leg() -> impl Strategy<Value = Leg> {
    (
        between(0.0, 360.0),
        between(0.2, 1.0),
        any::<bool>(),
        any::<bool>(),
        prop::bool::weighted(0.2),
    )
        .prop_map(|(degrees, part, jump, sprint, crouch)| Leg {
            degrees,
            part,
            jump,
            sprint,
            crouch,
        })
}

fn junk() -> impl Strategy<Value = Junk> {
    let mover = (
        part(2.5),
        (between(-1.5, 1.5), between(-0.7, 0.7), between(-1.5, 1.5)),
        between(-1.0, 1.0),
    );
    (
        prop::collection::vec(part(4.0), 0..12),
        prop::collection::vec(part(4.0), 0..4),
        prop::option::of((between(0.1, 1.2), between(0.3, 1.5))),
        // Half of the worlds are static.
        prop_oneof![
            Just(Vec::new()).boxed(),
            prop::collection::vec(mover, 1..4).boxed()
        ],
        prop_oneof![
            Just(Vec::new()).boxed(),
            prop::collection::vec((part(1.0), between(1.0, 300.0)), 1..4).boxed()
        ],
        prop::collection::vec([leg(), leg(), leg(), leg()], SCRIPTS),
    )
        .prop_map(|(boxes, meshes, hills, movers, dynamics, scripts)| Junk {
            boxes,
            meshes,
            hills,
            movers: movers
                .into_iter()
                .map(|(part, way, turn): (Part, (f32, f32, f32), f32)| (part, way.into(), turn))
                .collect(),
            dynamics,
            scripts,
        })
}

/// Greatest speed of any point of the movers, metres per second: amplitude times 2 rad/s, plus turning.
fn platform_speed(junk: &Junk) -> f32 {
    junk.movers
        .iter()
        .map(|(part, way, turn)| way.length() * 2.0 + turn.abs() * part.size.length() * 0.5)
        .fold(0.0, f32::max)
}

fn build(hz: f64, junk: &Junk) -> (Sim, Vec<Entity>, Vec<Entity>) {
    let mut sim = Sim::new(hz);
    let mut fixed = vec![sim.block(Vec3::NEG_Y * 0.5, Vec3::new(20.0, 1.0, 20.0))];
    for (x, z) in [(10.0, 0.0), (-10.0, 0.0), (0.0, 10.0), (0.0, -10.0)] {
        let long = Vec3::new(
            if x == 0.0 { 21.0 } else { 1.0 },
            12.0,
            if z == 0.0 { 21.0 } else { 1.0 },
        );
        fixed.push(sim.block(Vec3::new(x, 6.0, z), long));
    }
    for part in &junk.boxes {
        fixed.push(sim.fixed(part.collider(), part.pose()));
    }
    for part in &junk.meshes {
        let mut mesh = Patch::default();
        mesh.add_box(Vec3::ZERO, part.size);
        fixed.push(sim.fixed(mesh.collider(), part.pose()));
    }
    if let Some((height, wave)) = junk.hills {
        let mesh = Patch::terrain(40, 0.5, |x, z| {
            height * ops::sin(x * wave) * ops::cos(z * wave)
        });
        fixed.push(sim.fixed(mesh.collider(), Transform::from_xyz(-10.0, 0.3, -10.0)));
    }
    for &(part, way, turn) in &junk.movers {
        sim.mover(part.collider(), move |t| {
            let t = t as f32;
            Transform::from_translation(part.at + way * ops::sin(2.0 * t))
                .with_rotation(part.turn * Quat::from_rotation_y(turn * t))
        });
    }
    for &(part, mass) in &junk.dynamics {
        sim.dynamic(part.collider(), part.pose(), mass);
    }
    let crowd = (0..SCRIPTS)
        .map(|i| {
            let cell = Vec3::new((i % 4) as f32 * 4.0 - 6.0, 0.0, (i / 4) as f32 * 6.0 - 3.0);
            let who = sim.character(Character::default(), cell);
            // The lowest free place above the cell; not that of another.
            edit::<CharacterState>(&mut sim, who, |state| state.height = 1.8);
            let mut foot = cell + Vec3::Y * 0.02;
            while foot.y < 9.0 {
                sim.place(who, foot);
                if fixed
                    .iter()
                    .all(|&other| depth_in(&sim, who, other) < -0.01)
                {
                    break;
                }
                foot.y += 0.25;
            }
            // A closed mesh has an inside that counts as free; above all of them it is not needed.
            if foot.y < 9.0 && junk.meshes.iter().any(|part| inside(*part, foot)) {
                sim.place(who, foot.with_y(8.0));
            }
            sim.app
                .world_mut()
                .entity_mut(who)
                .insert(CharacterState::default());
            who
        })
        .collect();
    (sim, fixed, crowd)
}

fn inside(part: Part, point: Vec3) -> bool {
    let local = part.turn.inverse() * (point + Vec3::Y * 0.9 - part.at);
    local.abs().cmple(part.size * 0.5 + 1.0).all()
}

/// Whether two characters are close enough to push each other.
fn near(sim: &Sim, a: Entity, b: Entity) -> bool {
    let apart = sim.position(a) - sim.position(b);
    apart.with_y(0.0).length() < 0.8 && apart.y.abs() < 2.0
}

/// Runs one world; says what is wrong first.
fn run(hz: f64, junk: &Junk) -> Result<(), String> {
    let (mut sim, fixed, crowd) = build(hz, junk);
    let platform = platform_speed(junk);
    let moving = !junk.movers.is_empty() || !junk.dynamics.is_empty();
    let (walk, sprint) = (5.0, 8.0);
    for tick in 0..TICKS {
        let before: Vec<(Vec3, CharacterState)> = crowd
            .iter()
            .map(|&who| (sim.position(who), sim.state(who)))
            .collect();
        for (&who, script) in crowd.iter().zip(&junk.scripts) {
            let leg = script[tick * 4 / TICKS];
            sim.intent(who, |intent| {
                intent.movement = heading(leg.degrees) * leg.part;
                intent.jump = leg.jump;
                intent.sprint = leg.sprint;
                intent.stance = if leg.crouch {
                    Stance::Crouch
                } else {
                    Stance::Stand
                };
            });
        }
        sim.ticks(1);
        for (i, &who) in crowd.iter().enumerate() {
            let name = format!("character {i}, tick {tick}, {hz} Hz");
            let foot = sim.position(who);
            if !finite(&sim, who) {
                return Err(format!("{name}: not finite: {:?}", sim.state(who)));
            }
            if !(foot.x.abs() < 9.6 && foot.z.abs() < 9.6 && foot.y > -0.01) {
                return Err(format!("{name}: outside of the arena at {foot}"));
            }
            if tick < 10 {
                continue;
            }
            for &other in &fixed {
                let deep = depth_in(&sim, who, other);
                if deep > 0.001 {
                    return Err(format!("{name}: {deep} m deep in {other} at {foot}"));
                }
            }
            let leg = junk.scripts[i][tick * 4 / TICKS];
            let asked = if leg.sprint { sprint } else { walk } * leg.part;
            let level = (foot - before[i].0).with_y(0.0).length() * hz as f32;
            // What it had may turn from a fall into a run down a slope; gravity adds its share.
            let mut bound = asked.max(before[i].1.world_velocity().length()) + G / hz as f32 + 0.05;
            if moving {
                // What moves may carry, push and be recovered from.
                bound += platform.max(8.0) + Character::default().recovery_speed;
            }
            // Whoever stands on somebody's head or is shoved by him is on a platform as well.
            let company = crowd
                .iter()
                .zip(&before)
                .filter(|&(&other, _)| other != who && near(&sim, who, other))
                .map(|(&other, old)| (sim.position(other) - old.0).length() * hz as f32)
                .fold(0.0, f32::max);
            if company > 0.0 {
                bound += company + Character::default().recovery_speed;
            }
            if level > bound {
                return Err(format!(
                    "{name}: {level} m/s on the map, bound {bound}, asked {asked}, had {}",
                    before[i].1.velocity
                ));
            }
        }
    }
    Ok(())
}

fn fuzz(hz: f64) {
    let config = Config {
        cases: WORLDS,
        failure_persistence: None,
        max_shrink_iters: 300,
        ..Config::default()
    };
    // The same worlds in every run, other ones at each rate.
    let seed = [hz as u8; 32];
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let result = runner.run(&junk(), |junk| run(hz, &junk).map_err(TestCaseError::fail));
    match result {
        Ok(()) => {}
        Err(TestError::Fail(reason, junk)) => panic!("{reason}\nsmallest world: {junk:#?}"),
        Err(TestError::Abort(reason)) => panic!("{reason}"),
    }
}

#[test]
fn random_scripts_at_30_hertz_never_end_inside_anything() {
    fuzz(30.0);
}

#[test]
fn random_scripts_at_60_hertz_never_end_inside_anything() {
    fuzz(60.0);
}

#[test]
fn random_scripts_at_120_hertz_never_end_inside_anything() {
    fuzz(120.0);
}

#[test]
fn random_scripts_at_240_hertz_never_end_inside_anything() {
    fuzz(240.0);
}
