//! Getting up: from where it lies, by the clip that fits, without a jump.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;
use bevy_embody::{prelude::*, ragdoll::Lying};
use bevy_rapier3d::prelude::Collider;
use embody_scenes::Sim;

use super::support::*;

#[derive(Resource, Default)]
struct Told(Vec<(Entity, usize)>);

/// Lying poses of a figure, low above the ground, and how they lie.
fn clips(profile: &RagdollProfile) -> GetUp {
    let clip = |name: &str, turn: Quat| {
        let turns = [
            ("pelvis", turn),
            ("upper_arm_l", Quat::from_rotation_x(0.5)),
        ];
        let mut start = RagdollPose::from_turns(profile, turns);
        // Down to the ground, and not about the origin.
        let by = Vec3::new(0.1, -0.8, 0.3);
        for bone in &mut start.bones {
            bone.position += by;
        }
        GetUpClip {
            name: name.into(),
            start,
        }
    };
    GetUp {
        clips: vec![
            clip("front", Quat::from_rotation_x(-FRAC_PI_2)),
            clip("back", Quat::from_rotation_x(FRAC_PI_2)),
            clip("left", Quat::from_rotation_z(FRAC_PI_2)),
            clip("right", Quat::from_rotation_z(-FRAC_PI_2)),
        ],
    }
}

fn lying(sim: &Sim, entity: Entity) -> Lying {
    let profile = sim.get::<Ragdoll>(entity).profile;
    let bind = profile.bone("pelvis").unwrap().rotation;
    Lying::of(
        sim.get::<Transform>(bone(sim, entity, "pelvis")).rotation,
        bind,
        Vec3::Y,
    )
}

/// A figure thrown down, from this turn, and left until it lies.
fn thrown(hz: f64, turn: Quat, ground: impl Fn(&mut Sim)) -> (Sim, Entity, GetUp) {
    let mut sim = Sim::new(hz);
    ground(&mut sim);
    sim.app.init_resource::<Told>();
    sim.app
        .add_observer(|told: On<GetsUp>, mut all: ResMut<Told>| {
            all.0.push((told.entity, told.clip));
        });
    let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
    let ways = clips(&profile);
    let pose = RagdollPose::from_turns(&profile, [("pelvis", turn)]);
    let intent = RagdollIntent {
        mode: RagdollMode::Limp,
        ..default()
    };
    let at = Transform::from_xyz(2.0, 0.0, -1.0).with_rotation(Quat::from_rotation_y(0.8));
    let ragdoll = Ragdoll::new(profile, 75.0);
    let entity = sim.spawn((ragdoll, intent, pose, ways.clone(), at));
    sim.seconds(4.0);
    insert(&mut sim, entity, RagdollPose::default());
    (sim, entity, ways)
}

/// Greatest acceleration of a bone over three ticks, metres per second squared. A jump of `x` metres is one of
/// `x` over the square of a tick.
fn acceleration(states: &[RagdollState], dt: f32) -> f32 {
    let mut most = 0.0f32;
    for three in states.windows(3) {
        let place = |n: usize, b: usize| three[n].bones[b].place.position;
        for b in 0..three[0].bones.len() {
            let change = place(2, b) - place(1, b) * 2.0 + place(0, b);
            most = most.max(change.length() / (dt * dt));
        }
    }
    most
}

#[test]
fn who_lies_on_the_front_the_back_or_a_side_gets_up_by_the_clip_for_it_without_a_jump() {
    let mut findings = Findings::new();
    for hz in [60.0, 240.0] {
        for (n, turn) in [
            Quat::from_rotation_x(-1.4),
            Quat::from_rotation_x(1.4),
            Quat::from_rotation_z(1.5),
            Quat::from_rotation_z(-1.5),
        ]
        .into_iter()
        .enumerate()
        {
            let (mut sim, entity, ways) = thrown(hz, turn, |sim| {
                sim.floor(0.0);
            });
            let expected = match lying(&sim, entity) {
                Lying::Front => 0,
                Lying::Back => 1,
                Lying::Left => 2,
                Lying::Right => 3,
                other => panic!("it lies {other:?}"),
            };
            let what = format!("{hz} Hz, {n}");
            let start = sim.get::<RagdollState>(entity);
            ask(&mut sim, entity, RagdollMode::GettingUp);
            sim.ticks(1);
            let told = sim.app.world().resource::<Told>().0.clone();
            findings.holds(
                format!("{what}: told {told:?}, lies as {expected}"),
                told == [(entity, expected)],
            );
            let lies = start.bones[0].place.position;
            let asked = sim.get::<RagdollState>(entity).bones[0].target.unwrap();
            let beside = (asked.position - lies).with_y(0.0).length();
            findings.at_most(format!("{what}: clip beside the figure, m"), beside, 0.15);
            findings.near(
                format!("{what}: on the floor"),
                sim.position(entity).y,
                0.0,
                0.01,
            );
            let mut states = vec![start.clone(), sim.get::<RagdollState>(entity)];
            for tick in 0..(hz * 1.6) as usize {
                // The game's animation begins late, lies, and stands up.
                if tick == 4 {
                    let clip = ways.clips[expected].start.clone();
                    insert(&mut sim, entity, clip);
                }
                sim.ticks(1);
                states.push(sim.get::<RagdollState>(entity));
            }
            let most = acceleration(&states, sim.dt());
            findings.at_most(format!("{what}: acceleration, m/s²"), most, 20.0);
            let last = states.last().unwrap();
            let off = last.bones.iter().map(|b| {
                b.target
                    .map_or(f32::MAX, |t| t.position.distance(b.place.position))
            });
            findings.at_most(
                format!("{what}: off in the end, m"),
                off.fold(0.0, f32::max),
                1.0e-3,
            );
        }
    }
}

#[test]
fn an_animation_that_never_comes_is_waited_for_and_then_done_without() {
    let (mut sim, entity, _) = thrown(240.0, Quat::from_rotation_x(-1.4), |sim| {
        sim.floor(0.0);
    });
    ask(&mut sim, entity, RagdollMode::GettingUp);
    let mut states = vec![sim.get::<RagdollState>(entity)];
    for _ in 0..480 {
        sim.ticks(1);
        states.push(sim.get::<RagdollState>(entity));
    }
    let mut findings = Findings::new();
    findings.at_most("acceleration, m/s²", acceleration(&states, sim.dt()), 60.0);
    let head = sim.position(bone(&sim, entity, "head"));
    findings.at_least(
        "it stands in the pose that is asked for: head, m",
        head.y,
        1.5,
    );
}

#[test]
fn a_figure_gets_up_on_the_step_or_the_slope_that_it_lies_on() {
    let mut findings = Findings::new();
    let (mut sim, entity, _) = thrown(60.0, Quat::from_rotation_x(1.4), |sim| {
        // A deck of 5 m × 5 m, 3 m up: the figure is spawned on it below.
        sim.block(Vec3::new(2.0, -0.5, -1.0), Vec3::new(5.0, 1.0, 5.0));
        sim.floor(-3.0);
    });
    ask(&mut sim, entity, RagdollMode::GettingUp);
    sim.ticks(1);
    findings.near("on the deck", sim.position(entity).y, 0.0, 0.01);
    let tilt = 0.15f32;
    let (mut sim, entity, _) = thrown(60.0, Quat::from_rotation_x(1.4), |sim| {
        let turn = Quat::from_rotation_x(tilt);
        let deck = Collider::cuboid(50.0, 0.5, 50.0);
        let at = Transform::from_translation(turn * Vec3::NEG_Y * 0.5).with_rotation(turn);
        sim.fixed(deck, at);
    });
    ask(&mut sim, entity, RagdollMode::GettingUp);
    sim.ticks(1);
    let at = sim.position(entity);
    findings.near("on the slope", at.y, -at.z * tilt.tan(), 0.01);
}

#[test]
fn where_up_is_another_way_a_figure_lies_follows_and_gets_up_along_it() {
    let mut findings = Findings::new();
    for up in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, -0.48, 0.64)] {
        let mut sim = Sim::new(60.0);
        gravity(&mut sim, up * -G);
        let upright = Quat::from_rotation_arc(Vec3::Y, up);
        sim.fixed(
            Collider::cuboid(10.0, 0.5, 10.0),
            Transform::from_translation(up * -0.5).with_rotation(upright),
        );
        let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
        let ways = clips(&profile);
        let at = Transform::from_translation(up * 0.2)
            .with_rotation(Quat::from_axis_angle(up, 0.7) * upright);
        let ragdoll = Ragdoll::new(profile, 75.0);
        let entity = sim.spawn((ragdoll, ways, RagdollUp(up), FollowRoot, at));
        sim.seconds(4.0);
        let figure = sim.get::<Transform>(entity);
        let what = format!("up {up}");
        let tilt = (figure.rotation * Vec3::Y).distance(up);
        findings.at_most(format!("{what}: the figure's up, off"), tilt, 1.0e-3);
        let height = figure.translation.dot(up);
        findings.near(format!("{what}: on the floor, m"), height, 0.0, 0.03);
        ask(&mut sim, entity, RagdollMode::GettingUp);
        sim.seconds(1.5);
        let figure = sim.get::<Transform>(entity);
        let tilt = (figure.rotation * Vec3::Y).distance(up);
        findings.at_most(format!("{what}: stands along up, off"), tilt, 1.0e-3);
        let height = figure.translation.dot(up);
        findings.near(format!("{what}: feet, m"), height, 0.0, 0.01);
        let head = sim.position(bone(&sim, entity, "head")).dot(up);
        findings.near(format!("{what}: head, m"), head, 1.52, 0.1);
    }
}
