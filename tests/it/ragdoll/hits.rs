//! Hits push by all their momentum, weaken what they hit, and are got over.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

fn floating(hz: f64, mode: RagdollMode, reaction: Option<HitReaction>) -> (Sim, Entity) {
    let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 20.0);
    if let Some(reaction) = reaction {
        insert(&mut sim, entity, reaction);
    }
    sim.ticks(2);
    for part in bones(&sim, entity) {
        insert(&mut sim, part, (Damping::default(), GravityScale(0.0)));
    }
    sim.ticks(1);
    (sim, entity)
}

#[test]
fn the_momentum_of_a_hit_arrives_whole_also_at_a_bone_that_is_too_light_for_it() {
    let mut findings = Findings::new();
    for hz in RATES {
        for mode in [RagdollMode::Limp, RagdollMode::Powered] {
            for (name, impulse) in [("chest", 60.0), ("hand_l", 60.0), ("foot_r", 8.0)] {
                let (mut sim, entity) = floating(hz, mode, Some(HitReaction::default()));
                edit::<Ragdoll>(&mut sim, entity, |r| r.drive.gravity = 0.0);
                sim.ticks(2);
                for part in bones(&sim, entity) {
                    insert(&mut sim, part, (Damping::default(), GravityScale(0.0)));
                }
                sim.ticks(1);
                let (before, _) = momentum(&sim, entity);
                let part = bone(&sim, entity, name);
                let impulse = Vec3::new(0.6, 0.0, -0.8) * impulse;
                let point = sim.position(part) + Vec3::Y * 0.02;
                hit(&mut sim, part, point, impulse);
                sim.ticks(1);
                let (after, _) = momentum(&sim, entity);
                findings.at_most(
                    format!("{hz} Hz, {mode:?}, {name}: missing, N·s"),
                    (after - before).distance(impulse),
                    0.01 * impulse.length(),
                );
                sim.seconds(0.5);
                let (later, _) = momentum(&sim, entity);
                findings.at_most(
                    format!("{hz} Hz, {mode:?}, {name}: missing later, N·s"),
                    (later - before).distance(impulse),
                    0.02 * impulse.length(),
                );
            }
        }
    }
}

fn hurt(sim: &Sim, entity: Entity, name: &str) -> f32 {
    let part = bone(sim, entity, name);
    let order = sim.get::<RagdollBone>(part).order;
    sim.get::<RagdollState>(entity).bones[order].hurt
}

#[test]
fn a_hit_takes_strength_with_a_falloff_and_it_comes_back_in_time() {
    let mut findings = Findings::new();
    let reaction = HitReaction {
        loss: 0.8,
        full_impulse: 20.0,
        to_parents: 0.5,
        to_children: 0.25,
        hold: 0.2,
        recovery: 1.0,
    };
    for hz in RATES {
        let (mut sim, entity) = floating(hz, RagdollMode::Powered, Some(reaction));
        let part = bone(&sim, entity, "forearm_l");
        let point = sim.position(part);
        // Half of a full hit.
        hit(&mut sim, part, point, Vec3::X * 10.0);
        sim.ticks(1);
        for (name, expected) in [
            ("forearm_l", 0.4),
            ("hand_l", 0.1),
            ("upper_arm_l", 0.2),
            ("clavicle_l", 0.1),
            ("chest", 0.05),
            // Down again from the chest, and from the pelvis.
            ("neck", 0.0125),
            ("thigh_r", 0.00625 * 0.5),
        ] {
            let what = format!("{hz} Hz: {name}: loss");
            findings.near(what, hurt(&sim, entity, name), expected, 1.0e-4);
        }
        let strength = |sim: &Sim| {
            let order = sim.get::<RagdollBone>(part).order;
            sim.get::<RagdollState>(entity).bones[order].strength
        };
        findings.near(format!("{hz} Hz: strength"), strength(&sim), 0.6, 1.0e-4);
        // Nothing comes back during the hold; then all of it in a second.
        let dt = sim.dt();
        for (time, expected) in [(0.2f32, 0.4f32), (0.4, 0.2), (0.55, 0.05), (0.7, 0.0)] {
            let (mut again, entity) = floating(hz, RagdollMode::Powered, Some(reaction));
            let part = bone(&again, entity, "forearm_l");
            let point = again.position(part);
            hit(&mut again, part, point, Vec3::X * 10.0);
            again.ticks(1);
            again.seconds(f64::from(time));
            let found = hurt(&again, entity, "forearm_l");
            findings.near(
                format!("{hz} Hz: after {time} s"),
                found,
                expected,
                dt * 0.51 + 1.0e-4,
            );
        }
    }
}

#[test]
fn a_walking_figure_flinches_where_it_is_hit_and_nowhere_else() {
    let mut findings = Findings::new();
    let walk = |hz: f64, shot: bool| {
        let mode = RagdollMode::HitBoxes;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y);
        insert(
            &mut sim,
            entity,
            HitReaction {
                // No muscle is left in what is hit.
                loss: 1.0,
                full_impulse: 12.0,
                to_parents: 0.0,
                recovery: 0.3,
                ..default()
            },
        );
        let step = |sim: &mut Sim| stride(sim, entity, Vec3::NEG_Z * 1.4);
        for _ in 0..5 {
            step(&mut sim);
        }
        if shot {
            let arm = bone(&sim, entity, "upper_arm_r");
            let point = sim.position(arm) + Vec3::NEG_Y * 0.15;
            hit(&mut sim, arm, point, Vec3::Z * 12.0);
        }
        let (mut places, mut farthest, mut simulated) = (Vec::new(), 0.0f32, Vec::new());
        for tick in 0..(hz * 1.5) as usize {
            step(&mut sim);
            for part in bones(&sim, entity) {
                let name = sim.get::<Name>(part).to_string();
                let arm = ["upper_arm_r", "forearm_r", "hand_r"].contains(&name.as_str());
                if !arm {
                    places.push(sim.get::<Transform>(part));
                }
                let out = sim.get::<BoneOutput>(part);
                if out.simulated && tick == 0 {
                    simulated.push(name.clone());
                }
                if name == "upper_arm_r" && out.simulated {
                    farthest = farthest.max(out.spin.length());
                }
            }
        }
        let error = outputs(&sim, entity)
            .iter()
            .map(|o| o.error)
            .fold(0.0, f32::max);
        let back = outputs(&sim, entity).iter().all(|o| !o.simulated);
        simulated.sort();
        (places, farthest, simulated, error, back)
    };
    for hz in RATES {
        let (others, ..) = walk(hz, false);
        let (same, farthest, simulated, error, back) = walk(hz, true);
        findings.same(format!("{hz} Hz: other bones"), &others, &same);
        findings.holds(
            format!("{hz} Hz: simulated {simulated:?}"),
            simulated == ["forearm_r", "hand_r", "upper_arm_r"],
        );
        findings.at_least(format!("{hz} Hz: the arm is thrown, rad/s"), farthest, 2.0);
        findings.holds(format!("{hz} Hz: it is over"), back);
        findings.at_most(format!("{hz} Hz: error left, rad"), error, 0.01);
    }
}

#[test]
fn of_a_figure_the_bone_nearest_to_the_point_is_hit() {
    let (mut sim, entity) = floating(60.0, RagdollMode::Powered, Some(HitReaction::default()));
    let mut findings = Findings::new();
    let head = sim.position(bone(&sim, entity, "head")) + Vec3::new(0.0, 0.1, -0.3);
    hit(&mut sim, entity, head, Vec3::Z * 20.0);
    sim.ticks(1);
    findings.near("head", hurt(&sim, entity, "head"), 0.9, 1.0e-4);
    findings.at_most("thigh", hurt(&sim, entity, "thigh_l"), 0.3);
    // Nowhere, and nobody: told, and nothing else.
    hit(&mut sim, entity, Vec3::NAN, Vec3::Z);
    let nobody = sim.spawn(());
    hit(&mut sim, nobody, Vec3::ZERO, Vec3::Z);
    sim.ticks(2);
    findings.holds("finite", finite(&sim, entity));
}
