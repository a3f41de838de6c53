//! Joints bound what they should and nothing else.

use core::f32::consts::PI;

use bevy::math::Vec2;
use bevy_rapier3d::prelude::ExternalForce;

use super::support::*;
use bevy::prelude::*;
use bevy_embody::prelude::*;

/// Seven kinds of joints of the [`arm`], each with its axes.
pub fn kinds() -> [(&'static str, JointKind, Quat); 7] {
    let across = Quat::IDENTITY;
    [
        (
            "ball, round",
            JointKind::Ball {
                swing: Vec2::splat(0.785),
                center: Vec2::ZERO,
                twist: Vec2::new(-0.52, 0.52),
            },
            along_arm(),
        ),
        (
            "ball, elliptic and off centre",
            JointKind::Ball {
                swing: Vec2::new(1.1, 0.5),
                center: Vec2::new(0.5, 0.2),
                twist: Vec2::new(-0.3, 0.9),
            },
            along_arm(),
        ),
        (
            "hinge",
            JointKind::Hinge {
                min: -0.1,
                max: 2.5,
            },
            across,
        ),
        (
            "pivot",
            JointKind::Pivot {
                min: -1.0,
                max: 1.4,
            },
            along_arm(),
        ),
        (
            "saddle",
            JointKind::Saddle {
                y: Vec2::new(-0.4, 0.9),
                z: Vec2::new(-0.6, 0.3),
            },
            along_arm(),
        ),
        (
            "condyloid",
            JointKind::Condyloid {
                swing: Vec2::new(1.2, 0.5),
                center: Vec2::ZERO,
            },
            along_arm(),
        ),
        ("fixed", JointKind::Fixed, across),
    ]
}

/// The block is held in some attitude, the arm is left to gravity or pushed by a torque.
fn worst_of(
    hz: f64,
    kind: JointKind,
    frame: Quat,
    attitude: Quat,
    spin: Vec3,
    torque: Vec3,
) -> (f32, f32) {
    let joint = JointProfile {
        kind,
        frame,
        friction: 0.0,
        ..default()
    };
    let (mut sim, _, limb) = hung(hz, joint, 0.0, Transform::from_rotation(attitude));
    sim.ticks(1);
    // Not in the tick of the switch, which keeps the velocity that it had: none.
    if spin != Vec3::ZERO {
        let velocity = bevy_rapier3d::prelude::Velocity::angular(spin);
        insert(&mut sim, limb, velocity);
    }
    insert(
        &mut sim,
        limb,
        ExternalForce {
            force: Vec3::ZERO,
            torque,
        },
    );
    let (mut worst, mut gap) = (0.0f32, 0.0f32);
    for _ in 0..(hz * 2.0) as usize {
        sim.ticks(1);
        let out = sim.get::<BoneOutput>(limb);
        worst = worst.max(out.violation);
        gap = gap.max(out.gap);
    }
    assert!(sim.get::<BoneOutput>(limb).simulated);
    (worst.to_degrees(), gap)
}

#[test]
fn limits_hold_within_a_degree_under_gravity() {
    let mut findings = Findings::new();
    for (name, kind, frame) in kinds() {
        for hz in RATES {
            let mut dice = Dice::new(7);
            let mut worst = 0.0f32;
            for _ in 0..8 {
                let attitude = dice.rotation(PI);
                let (v, gap) = worst_of(hz, kind, frame, attitude, Vec3::ZERO, Vec3::ZERO);
                worst = worst.max(v);
                // In motion, blows against the limits included; at rest it is measured elsewhere.
                findings.at_most(format!("{name}, {hz} Hz: gap, m"), gap, 0.015);
            }
            findings.at_most(format!("{name}, {hz} Hz: violation, degrees"), worst, 1.0);
        }
    }
}

#[test]
fn limits_hold_from_two_hundred_starts_and_torques() {
    let mut findings = Findings::new();
    let rates = RATES.map(|hz| (hz, if hz == 60.0 { 200 } else { 40 }));
    let all = kinds()
        .into_iter()
        .flat_map(|kind| rates.map(|rate| (kind, rate)));
    for ((name, kind, frame), (hz, starts)) in all {
        let mut dice = Dice::new(11);
        let mut worst = 0.0f32;
        for _ in 0..starts {
            let attitude = dice.rotation(PI);
            // Up to half a turn a second, and two thirds of the torque of the arm's weight about its joint.
            let spin = dice.vec() * 2.0;
            let torque = dice.vec() * 2.0;
            let (v, _) = worst_of(hz, kind, frame, attitude, spin, torque);
            worst = worst.max(v);
        }
        findings.at_most(
            format!("{name}, {hz} Hz: worst of {starts}, degrees"),
            worst,
            5.0,
        );
    }
}

#[test]
fn a_thigh_pushed_by_fifty_newton_metres_stays_within_five_degrees() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mut dice = Dice::new(3);
        let mut worst_of_all = 0.0f32;
        for _ in 0..12 {
            let mode = RagdollMode::Partial;
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 2.0);
            edit::<RagdollIntent>(&mut sim, entity, |i| i.strength = 0.0);
            sim.ticks(1);
            simulate(&mut sim, entity, ["thigh_l", "shin_l", "foot_l"]);
            let thigh = bone(&sim, entity, "thigh_l");
            let torque = dice.direction() * 50.0;
            insert(
                &mut sim,
                thigh,
                ExternalForce {
                    force: Vec3::ZERO,
                    torque,
                },
            );
            for _ in 0..(hz * 1.5) as usize {
                sim.ticks(1);
                let out = sim.get::<BoneOutput>(thigh);
                worst_of_all = worst_of_all.max(out.violation.to_degrees());
            }
        }
        findings.at_most(format!("{hz} Hz: violation, degrees"), worst_of_all, 5.0);
    }
}

#[test]
fn a_gliding_joint_slides_as_far_as_it_may_and_does_not_turn() {
    let mut findings = Findings::new();
    let kind = JointKind::Gliding {
        reach: Vec2::new(0.02, 0.0),
    };
    for (direction, way) in [(Vec3::X, 0.02), (Vec3::Z, 0.0), (Vec3::Y, 0.0)] {
        let joint = JointProfile {
            kind,
            frame: along_arm(),
            friction: 0.0,
            ..default()
        };
        let (mut sim, _, limb) = hung(60.0, joint, 1.0, Transform::IDENTITY);
        insert(
            &mut sim,
            limb,
            ExternalForce {
                force: direction * 40.0,
                torque: Vec3::ZERO,
            },
        );
        sim.seconds(1.0);
        let out = sim.get::<BoneOutput>(limb);
        findings.near(format!("{direction}: way, m"), out.gap, way, 0.001);
        findings.at_most(
            format!("{direction}: turn, degrees"),
            out.violation.to_degrees(),
            0.5,
        );
    }
}

#[test]
fn a_gliding_joint_keeps_within_its_reach_from_two_hundred_starts_and_pushes() {
    let mut findings = Findings::new();
    let reach = Vec2::new(0.02, 0.01);
    let joint = JointProfile {
        kind: JointKind::Gliding { reach },
        frame: along_arm(),
        friction: 0.0,
        ..default()
    };
    for hz in RATES {
        let mut dice = Dice::new(23);
        let (mut beyond, mut turned) = (0.0f32, 0.0f32);
        for _ in 0..50 {
            let at = Transform::from_rotation(dice.rotation(PI));
            let (mut sim, entity, limb) = hung(hz, joint, 0.0, at);
            let push = ExternalForce {
                force: dice.vec() * 40.0,
                torque: dice.vec() * 2.0,
            };
            insert(&mut sim, limb, push);
            let block = bone(&sim, entity, "block");
            for _ in 0..hz as usize {
                sim.ticks(1);
                let frame = sim.get::<Transform>(block);
                let way = sim.position(limb) - frame.translation;
                // In the axes of the joint: X is along the arm.
                let way = along_arm().inverse() * (frame.rotation.inverse() * way);
                let out = (way.abs() - Vec3::new(0.0, reach.x, reach.y)).max_element();
                beyond = beyond.max(out);
                turned = turned.max(sim.get::<BoneOutput>(limb).violation.to_degrees());
            }
        }
        // What it gains in a tick of 30 Hz takes it so far in a substep.
        findings.at_most(format!("{hz} Hz: beyond its reach, m"), beyond, 0.003);
        findings.at_most(format!("{hz} Hz: turned, degrees"), turned, 1.0);
    }
}

#[test]
fn a_soft_limit_gives_by_its_spring_and_comes_back() {
    let mut findings = Findings::new();
    let lean = |softness: Option<JointSoftness>| {
        let joint = JointProfile {
            kind: JointKind::Hinge {
                min: -0.2,
                max: 0.2,
            },
            frame: Quat::IDENTITY,
            friction: 0.0,
            softness,
            ..default()
        };
        let (mut sim, _, limb) = hung(60.0, joint, 0.0, Transform::IDENTITY);
        insert(
            &mut sim,
            limb,
            ExternalForce {
                force: Vec3::ZERO,
                torque: Vec3::X * 4.0,
            },
        );
        sim.seconds(4.0);
        let out = sim.get::<BoneOutput>(limb);
        (out.violation.to_degrees(), out.spin.length())
    };
    let (hard, _) = lean(None);
    let (soft, spin) = lean(Some(JointSoftness {
        frequency: 3.0,
        damping_ratio: 1.0,
    }));
    findings.at_most("hard, degrees", hard, 0.2);
    findings.at_least("soft, degrees", soft, 2.0);
    findings.at_most("soft at rest, rad/s", spin, 0.05);
}
