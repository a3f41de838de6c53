//! Joints that part and are made again.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[derive(Resource, Default)]
struct Broken(Vec<(Entity, f32)>);

#[test]
fn what_is_cut_off_keeps_place_and_velocity_and_falls_limp() {
    let mut findings = Findings::new();
    for hz in RATES {
        for mode in [
            RagdollMode::Limp,
            RagdollMode::Powered,
            RagdollMode::HitBoxes,
        ] {
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 20.0);
            let step = |sim: &mut Sim| stride(sim, entity, Vec3::NEG_Z * 3.0);
            for _ in 0..10 {
                step(&mut sim);
            }
            let arm = bone(&sim, entity, "upper_arm_l");
            let hand = bone(&sim, entity, "hand_l");
            let before = sim.get::<RagdollState>(entity);
            sim.app.world_mut().trigger(Dismember { entity: arm });
            step(&mut sim);
            let after = sim.get::<RagdollState>(entity);
            let what = format!("{hz} Hz, {mode:?}");
            for (a, b) in before.bones.iter().zip(&after.bones) {
                let fall = G * sim.dt();
                let change = a.velocity.distance(b.velocity);
                findings.at_most(
                    format!("{what}: change of velocity, m/s"),
                    change,
                    1.1 * fall + 0.02,
                );
                let way = a.place.position.distance(b.place.position);
                let fastest = a.velocity.length().max(b.velocity.length()) * sim.dt();
                findings.at_most(format!("{what}: way, m"), way, fastest + 1.0e-3);
            }
            for _ in 0..(hz * 0.5) as usize {
                step(&mut sim);
            }
            let out = |part: Entity| sim.get::<BoneOutput>(part);
            findings.holds(format!("{what}: the arm is simulated"), out(arm).simulated);
            findings.holds(format!("{what}: the hand too"), out(hand).simulated);
            // The limb is still one piece, and apart from the trunk when that does not fall.
            findings.at_most(format!("{what}: wrist gap, m"), out(hand).gap, 2.0e-3);
            if mode == RagdollMode::HitBoxes {
                let chest = bone(&sim, entity, "clavicle_l");
                findings.holds(
                    format!("{what}: the rest follows the pose"),
                    !out(chest).simulated,
                );
                let fallen = sim.position(chest).y - sim.position(arm).y;
                let time = ((hz * 0.5) as usize + 1) as f32 * sim.dt();
                let expected = 0.5 * G * time * time;
                findings.near(format!("{what}: fallen, m"), fallen, expected, 0.06);
            }
        }
    }
}

#[test]
fn what_is_put_on_again_is_at_its_joint_and_stays_there() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Limp;
        let (mut sim, entity) = above_ground(hz, HumanoidDetail::Bodies19, mode, 0.2);
        sim.seconds(0.5);
        let thigh = bone(&sim, entity, "thigh_r");
        let shin = bone(&sim, entity, "shin_r");
        sim.app.world_mut().trigger(Dismember { entity: thigh });
        sim.ticks(1);
        push(&mut sim, shin, Vec3::new(60.0, 30.0, 0.0));
        sim.seconds(1.5);
        let apart = sim
            .position(thigh)
            .distance(sim.position(bone(&sim, entity, "pelvis")));
        findings.at_least(format!("{hz} Hz: apart, m"), apart, 0.4);
        sim.app.world_mut().trigger(Reattach { entity: thigh });
        sim.ticks(2);
        let out = sim.get::<BoneOutput>(thigh);
        findings.at_most(format!("{hz} Hz: gap at once, m"), out.gap, 0.01);
        let mut fastest = 0.0f32;
        for _ in 0..(hz * 2.0) as usize {
            sim.ticks(1);
            fastest = fastest.max(worst(&sim, entity, |o| o.velocity.length()));
        }
        findings.at_most(
            format!("{hz} Hz: gap at rest, m"),
            sim.get::<BoneOutput>(thigh).gap,
            5.0e-3,
        );
        findings.at_most(format!("{hz} Hz: fastest bone, m/s"), fastest, 6.0);
    }
}

#[test]
fn a_joint_bears_what_it_can_and_parts_under_what_it_cannot_when_it_lasts() {
    let mut findings = Findings::new();
    for hz in RATES {
        // Two kilograms hang on it: 19.6 newtons.
        for (force, time, push, parts) in [
            (25.0, 0.1, None, false),
            (15.0, 0.1, None, true),
            // A blow of a tick is far more than it bears, but does not last.
            (60.0, 0.1, Some(4.0), false),
        ] {
            let joint = JointProfile {
                breaks: Some(JointBreak { force, time }),
                ..default()
            };
            let at = Transform::from_xyz(0.0, 50.0, 0.0);
            let (mut sim, _, limb) = hung(hz, joint, 1.0, at);
            sim.app.init_resource::<Broken>();
            sim.app
                .add_observer(|broke: On<JointBroke>, mut all: ResMut<Broken>| {
                    all.0.push((broke.entity, broke.force));
                });
            if let Some(push) = push {
                sim.seconds(0.5);
                let point = sim.position(limb) + Vec3::NEG_Y * 0.15;
                hit(&mut sim, limb, point, Vec3::NEG_Y * push);
            }
            sim.seconds(1.0);
            let broken = sim.app.world().resource::<Broken>().0.clone();
            let what = format!("{hz} Hz, {force} N for {time} s, push {push:?}");
            findings.holds(
                format!("{what}: parts {parts}, {broken:?}"),
                broken.is_empty() != parts,
            );
            let depth = 50.0 - sim.position(limb).y;
            findings.holds(
                format!("{what}: it falls {depth} m"),
                (depth > 2.0) == parts,
            );
            if push.is_none() && parts {
                findings.near(format!("{what}: load, N"), broken[0].1, 2.0 * G, 1.5);
            }
        }
    }
}

#[test]
fn the_root_cannot_be_cut_off_and_a_stranger_not_at_all() {
    let mode = RagdollMode::Limp;
    let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies10, mode, Vec3::Y * 5.0);
    sim.ticks(2);
    let pelvis = bone(&sim, entity, "pelvis");
    let stranger = sim.spawn(());
    for entity in [pelvis, stranger] {
        sim.app.world_mut().trigger(Dismember { entity });
    }
    sim.seconds(0.2);
    let mut findings = Findings::new();
    let gap = worst(&sim, entity, |o| o.gap);
    findings.at_most("gap, m", gap, 2.0e-3);
}

#[test]
fn what_was_cut_off_from_a_limb_stays_where_it_is_when_the_limb_is_put_on() {
    let mut findings = Findings::new();
    let mode = RagdollMode::Limp;
    let (mut sim, entity) = above_ground(60.0, HumanoidDetail::Bodies19, mode, 0.2);
    sim.seconds(0.5);
    let [thigh, foot] = ["thigh_r", "foot_r"].map(|n| bone(&sim, entity, n));
    for entity in [thigh, foot] {
        sim.app.world_mut().trigger(Dismember { entity });
    }
    sim.ticks(1);
    for (part, way) in [(thigh, Vec3::X), (foot, Vec3::Z)] {
        push(&mut sim, part, way * 12.0);
    }
    sim.seconds(3.0);
    let lay = sim.position(foot);
    sim.app.world_mut().trigger(Reattach { entity: thigh });
    sim.ticks(3);
    let gap = sim.get::<BoneOutput>(thigh).gap;
    findings.at_most("the thigh is on: gap, m", gap, 0.01);
    findings.at_most("way of the foot, m", sim.position(foot).distance(lay), 0.02);
}
