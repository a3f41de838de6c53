//! What ragdolls of other engines are known to get wrong.

use core::f32::consts::{FRAC_PI_2, PI};

use bevy::{math::ops, prelude::*};
use bevy_embody::{prelude::*, ragdoll::BoneBody};
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

/// Gravity about which nothing hangs.
fn weightless(sim: &mut Sim) {
    gravity(sim, Vec3::ZERO);
}

#[test]
fn a_hinge_of_three_quarters_of_a_turn_reaches_both_ends_and_its_motor_beyond_a_right_angle() {
    let mut findings = Findings::new();
    let joint = JointProfile {
        kind: JointKind::Hinge {
            min: 0.0,
            max: 1.5 * PI,
        },
        friction: 0.0,
        max_torque: f32::INFINITY,
        ..default()
    };
    // The axis is upright: gravity turns nothing.
    let at = Transform::from_rotation(Quat::from_rotation_z(FRAC_PI_2));
    for hz in RATES {
        let (mut sim, _, limb) = hung(hz, joint, 0.0, at);
        let turned = |sim: &Sim| {
            let q = at.rotation.inverse() * sim.get::<Transform>(limb).rotation;
            (2.0 * ops::atan2(q.x, q.w)).rem_euclid(2.0 * PI)
        };
        for (torque, end) in [(0.3, 270.0f32), (-0.3, 0.0)] {
            let torque = Vec3::Y * torque;
            let push = ExternalForce {
                force: Vec3::ZERO,
                torque,
            };
            insert(&mut sim, limb, push);
            let mut worst = 0.0f32;
            for _ in 0..(hz * 4.0) as usize {
                sim.ticks(1);
                worst = worst.max(sim.get::<BoneOutput>(limb).violation.to_degrees());
            }
            let off = (turned(&sim).to_degrees() - end + 180.0).rem_euclid(360.0) - 180.0;
            findings.near(format!("{hz} Hz, {end}: end, degrees off"), off, 0.0, 1.0);
            findings.at_most(format!("{hz} Hz, {end}: violation, degrees"), worst, 5.0);
        }
        let (mut sim, entity, limb) = hung(hz, joint, 1.0, at);
        let profile = sim.get::<Ragdoll>(entity).profile;
        let pose = RagdollPose::from_turns(&profile, [("arm", Quat::from_rotation_x(0.75 * PI))]);
        insert(&mut sim, entity, pose);
        sim.seconds(2.0);
        let error = sim.get::<BoneOutput>(limb).error.to_degrees();
        findings.at_most(format!("{hz} Hz: motor to 135 degrees, error"), error, 0.5);
    }
}

#[test]
fn no_figure_is_made_of_reduced_coordinates_whose_limits_the_engine_ignores() {
    let mut findings = Findings::new();
    let (mut sim, entity) = alone(
        60.0,
        HumanoidDetail::Bodies23,
        RagdollMode::Powered,
        Vec3::Y,
    );
    sim.ticks(3);
    let world = sim.app.world_mut();
    let mut sets = world.query::<&RapierContextJoints>();
    let joints = sets.single(world).unwrap();
    let multibodies = joints.multibody_joints.iter().count();
    findings.near("multibody joints", multibodies as f32, 0.0, 0.0);
    let tied = (bones(&sim, entity).len() - 1) * 2;
    let world = sim.app.world_mut();
    let impulse = sets.single(world).unwrap().impulse_joints.len();
    findings.at_least("impulse joints", impulse as f32, tied as f32);
}

#[test]
fn a_figure_that_begins_in_any_pose_within_its_limits_stays_in_it_without_gravity() {
    let mut findings = Findings::new();
    for hz in RATES {
        for seed in 0..6 {
            let mut sim = Sim::new(hz);
            weightless(&mut sim);
            let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
            let pose = random_pose(&profile, &mut Dice::new(seed), 0.6);
            let ragdoll = Ragdoll {
                // Limbs that lie in each other would part, as they should.
                groups: BoneGroups {
                    memberships: 0,
                    filters: 0,
                },
                ..Ragdoll::new(profile, 75.0)
            };
            let entity = sim.spawn((ragdoll, pose, RagdollIntent::default()));
            sim.ticks(2);
            let mut fastest = 0.0f32;
            for _ in 0..hz as usize {
                sim.ticks(1);
                fastest = fastest.max(worst(&sim, entity, |o| o.spin.length()));
            }
            findings.at_most(format!("{hz} Hz, {seed}: spin, rad/s"), fastest, 0.05);
            let off = worst(&sim, entity, |o| o.violation.to_degrees());
            findings.at_most(format!("{hz} Hz, {seed}: violation, degrees"), off, 0.1);
        }
    }
}

#[test]
fn bones_lie_flat_in_the_world_and_a_parent_of_the_figure_neither_drags_nor_delays_them() {
    let mut findings = Findings::new();
    for hz in RATES {
        let run = |mode: RagdollMode, moves: bool| {
            let mut sim = Sim::new(hz);
            let tilt = Quat::from_euler(EulerRot::XYZ, 0.2, 1.1, -0.1);
            let from = Transform::from_xyz(2.0, 3.0, -1.0).with_rotation(tilt);
            let parent = sim.spawn(from);
            let at = Vec3::new(0.5, 0.1, 0.0);
            let entity = human(&mut sim, HumanoidDetail::Bodies15, mode, at);
            insert(&mut sim, entity, ChildOf(parent));
            sim.ticks(3);
            let profile = sim.get::<Ragdoll>(entity).profile;
            let (mut off, mut seen) = (0.0f32, Vec::new());
            for _ in 0..(hz * 0.5) as usize {
                if moves {
                    let (step, turn) = (1.5 * sim.dt(), Quat::from_rotation_y(sim.dt()));
                    edit::<Transform>(&mut sim, parent, |t| {
                        t.translation.x += step;
                        t.rotation = (turn * t.rotation).normalize();
                    });
                }
                sim.ticks(1);
                let root = sim.get::<Transform>(parent) * sim.get::<Transform>(entity);
                for part in bones(&sim, entity) {
                    let free = sim.app.world().get::<ChildOf>(part).is_none();
                    assert!(free, "a bone hangs on something");
                    let pose = sim.get::<Transform>(part);
                    let name = sim.get::<Name>(part);
                    let planned = profile.bone(name.as_str()).unwrap().position;
                    off = off.max(pose.translation.distance(root.transform_point(planned)));
                    seen.push(pose);
                }
            }
            (off, seen)
        };
        let (off, _) = run(RagdollMode::HitBoxes, true);
        findings.at_most(format!("{hz} Hz: hit boxes behind, m"), off, 1.0e-4);
        let ((_, still), (_, moved)) =
            (run(RagdollMode::Limp, false), run(RagdollMode::Limp, true));
        findings.same(format!("{hz} Hz: limp bones"), &still, &moved);
    }
}

#[test]
fn a_figure_that_lets_go_in_the_middle_of_a_sprint_goes_on_from_its_pose() {
    let mut findings = Findings::new();
    let cases = [
        (RagdollMode::HitBoxes, RagdollMode::Limp),
        (RagdollMode::Animated, RagdollMode::Limp),
        (RagdollMode::HitBoxes, RagdollMode::Powered),
        (RagdollMode::Keyframed, RagdollMode::Limp),
    ];
    for hz in RATES {
        for (from, to) in cases {
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, from, Vec3::Y * 5.0);
            let speed = Vec3::NEG_Z * 6.0;
            for tick in 0..(hz * 0.4) as usize {
                sprint(&mut sim, entity, tick);
                stride(&mut sim, entity, speed);
            }
            let before = sim.get::<RagdollState>(entity);
            ask(&mut sim, entity, to);
            sprint(&mut sim, entity, (hz * 0.4) as usize);
            stride(&mut sim, entity, speed);
            let after = sim.get::<RagdollState>(entity);
            let what = format!("{hz} Hz, {from:?} to {to:?}");
            for (a, b) in before.bones.iter().zip(&after.bones) {
                assert!(b.body == BoneBody::Dynamic);
                // Off every way that leads from its velocity before to that after, and from its pose.
                let went = b.place.position - a.place.position;
                let dt = sim.dt();
                let (first, change) = (a.velocity * dt, (b.velocity - a.velocity) * dt);
                let part = (went - first).dot(change) / change.length_squared().max(1.0e-12);
                let way = first + change * part.clamp(0.0, 1.0);
                let target = b.target.map_or(Vec3::MAX, |pose| pose.position);
                let snap = went.distance(way).min(target.distance(b.place.position));
                // Muscles bend the way within the tick.
                let most = if to == RagdollMode::Powered {
                    0.03
                } else {
                    0.01
                };
                findings.at_most(format!("{what}: snap, m"), snap, most);
            }
            let gap = worst(&sim, entity, |o| o.gap);
            findings.at_most(format!("{what}: gap, m"), gap, 0.01);
        }
    }
}

#[test]
fn a_figure_whose_animation_is_beyond_its_limits_comes_back_gently() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        weightless(&mut sim);
        let mode = RagdollMode::HitBoxes;
        let entity = human(&mut sim, HumanoidDetail::Bodies19, mode, Vec3::Y * 5.0);
        let profile = sim.get::<Ragdoll>(entity).profile;
        // Knees and elbows bent the wrong way by 40 degrees.
        let wrong = ["shin_l", "shin_r", "forearm_l", "forearm_r"].map(|name| {
            let axis = profile.bone(name).unwrap().joint.frame * Vec3::X;
            (name, Quat::from_axis_angle(axis, -0.7))
        });
        insert(&mut sim, entity, RagdollPose::from_turns(&profile, wrong));
        sim.seconds(0.2);
        ask(&mut sim, entity, RagdollMode::Limp);
        let (mut fastest, mut widest) = (0.0f32, 0.0f32);
        for _ in 0..(hz * 1.5) as usize {
            sim.ticks(1);
            fastest = fastest.max(worst(&sim, entity, |o| o.spin.length()));
            widest = widest.max(worst(&sim, entity, |o| o.gap));
        }
        findings.at_most(format!("{hz} Hz: spin, rad/s"), fastest, 6.0);
        findings.at_most(format!("{hz} Hz: gap, m"), widest, 0.005);
        let off = worst(&sim, entity, |o| o.violation.to_degrees());
        findings.at_most(format!("{hz} Hz: violation left, degrees"), off, 1.0);
    }
}
