//! Ragdolls: ours beside the same bodies and joints set up with Rapier's defaults.
//!
//! Sixteen piles of ten, 4 m apart, each figure 0.6 m above the next, fall on a flat floor: 23 bodies each.
//! What is timed is the whole tick from before the first of our systems to behind the last, the physics
//! step included, because what a ragdoll costs is mostly what it asks of the solver.

mod joints;
mod peer;

use bevy::{math::ops, prelude::*};
use bevy_embody::{prelude::*, ragdoll::RagdollSystems};
use bevy_rapier3d::prelude::*;
use embody_scenes::{Sim, terrain::StableId};

pub use joints::{Joints, joints};
use peer::{Pelvis, peer};

use super::{Bounds, Compared, Seen, Subject, Variant};
use crate::{
    probe::{begin, end},
    scene::Scene,
    side::Side,
};

pub const SUBJECT: Subject = Subject {
    name: "ragdolls",
    one: "ragdoll",
    scenes: &[
        Scene {
            name: "ragdolls",
            about: "sixteen piles of ragdolls of 23 bodies, limp",
            warm_up: 2,
            build: |sim, side, count| piles(sim, side, count, RagdollMode::Limp),
        },
        Scene {
            name: "ragdolls_powered",
            about: "the same, driven to the pose they lie in",
            warm_up: 2,
            build: |sim, side, count| piles(sim, side, count, RagdollMode::Powered),
        },
        Scene {
            name: "ragdolls_freezing",
            about: "sixteen piles, limp, each figure frozen once it has lain still for half a second",
            warm_up: 2,
            build: |sim, side, count| {
                let mut ragdoll = ragdoll();
                ragdoll.rest.freeze_after = Some(0.5);
                pile_up(sim, side, count, RagdollMode::Limp, &ragdoll);
            },
        },
        Scene {
            name: "ragdolls_awake",
            about: "powered ragdolls far from each other, whose pose never rests",
            warm_up: 60,
            build: awake,
        },
        Scene {
            name: "ragdolls_frozen",
            about: "ragdolls that lie frozen",
            warm_up: 200,
            build: frozen,
        },
    ],
    compared: &[
        Compared {
            scene: "ragdolls",
            tag: "mode=limp",
            label: "limp",
            ratio: Some(0.6),
            most: None,
        },
        Compared {
            scene: "ragdolls_powered",
            tag: "mode=powered",
            label: "powered",
            ratio: Some(0.6),
            most: None,
        },
        Compared {
            scene: "ragdolls_freezing",
            tag: "mode=freezing",
            label: "limp, frozen after half a second at rest",
            ratio: Some(0.6),
            most: None,
        },
    ],
    plugin: add_plugin,
    watch,
    level: -0.3..40.0,
    count: 160,
    steps: 500,
    variants: &[
        Variant {
            scene: "ragdolls_awake",
            name: "one awake powered",
            label: "one awake and powered",
            count: 1,
            most: 150.0,
        },
        Variant {
            scene: "ragdolls_frozen",
            name: "frozen",
            label: "frozen",
            count: 160,
            most: 1.0,
        },
    ],
    bounds: Bounds {
        speed_up: 1.5,
        growth: 1.2,
    },
    together: true,
    counted: "What is timed is the whole tick, physics step included; Rapier's side has the same bodies with\n\
              the masses of anatomy, tied by its own joints with limits and motors, all else as it comes.",
};

fn add_plugin(app: &mut App, side: Side) {
    if side == Side::Ours {
        app.add_plugins(RagdollPlugin);
    }
    app.add_systems(
        FixedPostUpdate,
        (
            begin
                .before(EmbodySystems::Prepare)
                .before(PhysicsSet::SyncBackend),
            end.after(RagdollSystems::React)
                .after(EmbodySystems::React)
                .after(PhysicsSet::Writeback),
        ),
    );
}

fn ragdoll() -> Ragdoll {
    let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies23, 1.75);
    Ragdoll::new(profile, 75.0)
}

fn floor(sim: &mut Sim) {
    // Not a box of hundreds of metres: between one and a capsule the engine loses contacts for single ticks.
    let ground = Collider::halfspace(Vec3::Y).expect("the unit of an axis");
    sim.fixed(ground, Transform::IDENTITY);
}

/// Where a figure of a pile begins: as in the scene that is measured in the literature, every figure
/// lies on its back above the next, turned a little further.
fn start(i: u32) -> Transform {
    let (pile, layer) = (i / 10, i % 10);
    let at = Vec3::new(
        4.0 * ((pile % 4) as f32 - 1.5),
        1.0 + 0.6 * layer as f32,
        4.0 * ((pile / 4) as f32 - 1.5),
    );
    let turn = Quat::from_rotation_y(0.37 * i as f32) * Quat::from_rotation_x(1.4);
    Transform::from_translation(at - turn * Vec3::Y * 0.9).with_rotation(turn)
}

/// The pose that the powered ones hold: bent as one who lies.
fn bent(profile: &RagdollProfile) -> RagdollPose {
    let x = Quat::from_rotation_x;
    let turns = [
        ("upper_arm_l", x(0.5)),
        ("upper_arm_r", x(0.3)),
        ("forearm_l", x(0.9)),
        ("forearm_r", x(0.6)),
        ("thigh_l", x(0.7)),
        ("thigh_r", x(0.4)),
        ("shin_l", x(-1.0)),
        ("shin_r", x(-0.7)),
    ];
    RagdollPose::from_turns(profile, turns)
}

fn piles(sim: &mut Sim, side: Side, count: u32, mode: RagdollMode) {
    let mut ragdoll = ragdoll();
    if mode == RagdollMode::Powered {
        // Muscles at odds with what lies on them take more turns to solve.
        ragdoll.iterations = 8;
    }
    pile_up(sim, side, count, mode, &ragdoll);
}

fn pile_up(sim: &mut Sim, side: Side, count: u32, mode: RagdollMode, ragdoll: &Ragdoll) {
    floor(sim);
    let pose = bent(&ragdoll.profile);
    for i in 0..count {
        spawn(sim, side, ragdoll, mode, &pose, i, start(i));
    }
}

fn spawn(
    sim: &mut Sim,
    side: Side,
    ragdoll: &Ragdoll,
    mode: RagdollMode,
    pose: &RagdollPose,
    i: u32,
    at: Transform,
) {
    let powered = mode == RagdollMode::Powered;
    match side {
        Side::Ours => {
            let intent = RagdollIntent { mode, ..default() };
            let id = (StableId(i), FollowRoot);
            let pose = pose.clone();
            sim.spawn((ragdoll.clone(), intent, pose, id, at));
        }
        Side::Rapier => peer(sim, ragdoll, powered.then_some(pose), i, at),
    }
}

fn apart(i: u32) -> Transform {
    Transform::from_xyz(4.0 * (i % 32) as f32, 0.0, 4.0 * (i / 32) as f32)
}

/// Powered ones that wave.
fn awake(sim: &mut Sim, side: Side, count: u32) {
    floor(sim);
    let ragdoll = ragdoll();
    let pose = RagdollPose::default();
    for i in 0..count {
        spawn(
            sim,
            side,
            &ragdoll,
            RagdollMode::Powered,
            &pose,
            i,
            apart(i),
        );
    }
    let wave = move |time: Res<Time>, mut all: Query<(&Ragdoll, &mut RagdollPose)>| {
        let angle = 0.6 * ops::sin(4.0 * time.elapsed_secs());
        for (ragdoll, mut pose) in &mut all {
            let x = Quat::from_rotation_x;
            let turns = [
                ("upper_arm_l", x(angle)),
                ("upper_arm_r", x(-angle)),
                ("thigh_l", x(0.4 * angle)),
                ("thigh_r", x(-0.4 * angle)),
                ("spine", x(0.2 * angle)),
            ];
            *pose = RagdollPose::from_turns(&ragdoll.profile, turns);
        }
    };
    sim.app.add_systems(FixedUpdate, wave);
}

/// Limp ones that are frozen while they lie.
fn frozen(sim: &mut Sim, side: Side, count: u32) {
    floor(sim);
    let mut ragdoll = ragdoll();
    ragdoll.rest.freeze_after = Some(0.0);
    let pose = RagdollPose::default();
    for i in 0..count {
        let lies = Quat::from_rotation_x(1.5);
        let at = apart(i).with_rotation(lies) * Transform::from_xyz(0.0, 0.0, -0.3);
        spawn(sim, side, &ragdoll, RagdollMode::Limp, &pose, i, at);
    }
    // Those that have not yet come to rest by themselves are frozen as they lie.
    let freeze = |time: Res<Time>, mut all: Query<&mut RagdollIntent>| {
        if time.elapsed_secs() > 3.0 {
            for mut intent in &mut all {
                if intent.mode != RagdollMode::Frozen {
                    intent.mode = RagdollMode::Frozen;
                }
            }
        }
    };
    sim.app.add_systems(FixedUpdate, freeze);
}

fn watch(world: &mut World) -> Vec<Seen> {
    let mut all =
        world.query_filtered::<(&StableId, &Transform), Or<(With<Ragdoll>, With<Pelvis>)>>();
    all.iter(world)
        .map(|(id, transform)| Seen {
            id: *id,
            at: transform.translation,
            wished: 0.0,
            upright: true,
        })
        .collect()
}
