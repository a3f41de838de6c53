//! Bones come, rest, go, and are refused.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_embody::ragdoll::BoneState;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[test]
fn a_limp_figure_falls_and_sleeps_within_four_seconds_of_the_impact() {
    let mut findings = Findings::new();
    for detail in [HumanoidDetail::Bodies15, HumanoidDetail::Bodies23] {
        for hz in RATES {
            let mut slowest = 0.0f32;
            for start in 0..6 {
                let mut sim = Sim::new(hz);
                ground(&mut sim);
                let ragdoll = Ragdoll::new(RagdollProfile::humanoid(detail, 1.75), 75.0);
                // Upright, and turned any way.
                let (turn, height) = match start {
                    0 => (Quat::IDENTITY, 0.3),
                    _ => (Dice::new(start).rotation(3.0), 0.6),
                };
                let pose = RagdollPose::from_turns(&ragdoll.profile, [("pelvis", turn)]);
                let intent = RagdollIntent::default();
                let at = Transform::from_xyz(0.0, height, 0.0);
                let entity = sim.spawn((ragdoll, intent, pose, at));
                sim.ticks(2);
                // The impact: something is no longer as fast as the free fall makes it.
                let (mut impact, mut slept) = (None, f32::MAX);
                for tick in 0..(hz * 6.0) as usize {
                    sim.ticks(1);
                    let out = outputs(&sim, entity);
                    let time = (tick + 3) as f32 * sim.dt();
                    let falls = |o: &BoneOutput| (o.velocity.y + G * time).abs() < 0.4;
                    if impact.is_none() && !out.iter().all(falls) {
                        impact = Some(time);
                    }
                    if out.iter().all(|o| o.asleep) {
                        slept = time - impact.unwrap_or(0.0);
                        break;
                    }
                }
                slowest = slowest.max(slept);
                let what = format!("{detail:?}, {hz} Hz, {start}");
                let gap = worst(&sim, entity, |o| o.gap);
                findings.at_most(format!("{what}: gap at rest, m"), gap, 0.002);
                for part in bones(&sim, entity) {
                    let off = sim.get::<BoneOutput>(part).violation.to_degrees();
                    let name = sim.get::<Name>(part);
                    findings.at_most(
                        format!("{what}: {name} at rest beyond its limits, degrees"),
                        off,
                        1.0,
                    );
                }
                let mut low = f32::MAX;
                for part in bones(&sim, entity) {
                    low = low.min(sim.position(part).y);
                }
                findings.at_least(format!("{what}: lowest joint, m"), low, -0.02);
            }
            let what = format!("{detail:?}, {hz} Hz: asleep after, s");
            findings.at_most(what, slowest, 4.0);
        }
    }
}

#[test]
fn a_figure_in_free_flight_keeps_its_momentum() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Limp;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 50.0);
        let damping_off = |sim: &mut Sim| {
            for part in bones(sim, entity) {
                insert(sim, part, Damping::default());
            }
        };
        sim.ticks(2);
        damping_off(&mut sim);
        let foot = bone(&sim, entity, "foot_l");
        insert(
            &mut sim,
            foot,
            ExternalImpulse {
                impulse: Vec3::new(30.0, 10.0, 0.0),
                torque_impulse: Vec3::ZERO,
            },
        );
        sim.ticks(1);
        let (start, mass) = momentum(&sim, entity);
        sim.seconds(1.0);
        let (end, _) = momentum(&sim, entity);
        let expected = start - Vec3::Y * G * mass;
        findings.at_most(
            format!("{hz} Hz: off, kg m/s of {}", expected.length()),
            end.distance(expected),
            0.005 * expected.length(),
        );
    }
}

#[test]
fn despawned_ragdolls_take_their_bones_and_joints_with_them() {
    let mut sim = Sim::new(60.0);
    sim.ticks(1);
    let counts = |sim: &mut Sim| {
        let bodies = sim
            .app
            .world_mut()
            .query::<&RigidBody>()
            .iter(sim.app.world())
            .count();
        let mut sets = sim
            .app
            .world_mut()
            .query::<(&RapierContextJoints, &RapierRigidBodySet)>();
        let (joints, set) = sets.single(sim.app.world()).unwrap();
        (bodies, joints.impulse_joints.len(), set.bodies.len())
    };
    let before = counts(&mut sim);
    for n in 0..200 {
        let entity = human(
            &mut sim,
            HumanoidDetail::Bodies10,
            RagdollMode::Limp,
            Vec3::new(n as f32, 1.0, 0.0),
        );
        sim.ticks(1);
        sim.app.world_mut().despawn(entity);
    }
    sim.ticks(2);
    let mut findings = Findings::new();
    findings.holds(
        format!("{before:?} is {:?}", counts(&mut sim)),
        before == counts(&mut sim),
    );
}

#[test]
fn two_thousand_figures_come_and_go_and_leave_nothing() {
    let mut sim = Sim::new(60.0);
    sim.ticks(1);
    let counts = |sim: &mut Sim| {
        let world = sim.app.world_mut();
        let entities = world.query::<()>().iter(world).count();
        let mut sets = world.query::<(
            &RapierContextJoints,
            &RapierRigidBodySet,
            &RapierContextColliders,
        )>();
        let (joints, set, colliders) = sets.single(world).unwrap();
        let (joints, bodies) = (joints.impulse_joints.len(), set.bodies.len());
        (entities, joints, bodies, colliders.colliders.len())
    };
    // The first pinned bone makes the anchor that all later ones share.
    let mut findings = Findings::new();
    let mut first = None;
    for round in 0..100 {
        let all: Vec<Entity> = (0..20)
            .map(|n| {
                let at = Vec3::new(n as f32 * 2.0, 1.0, 0.0);
                human(&mut sim, HumanoidDetail::Bodies10, RagdollMode::Powered, at)
            })
            .collect();
        sim.ticks(1);
        for entity in &all {
            let pelvis = bone(&sim, *entity, "pelvis");
            edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
        }
        sim.ticks(1);
        if round == 50 {
            // Still built whole, with every joint.
            let (_, joints, bodies, _) = counts(&mut sim);
            findings.near("bodies of 20 figures", bodies as f32, 201.0, 0.0);
            findings.at_least(
                "joints of 20 figures",
                joints as f32,
                20.0 * (9.0 * 2.0 + 1.0),
            );
        }
        for entity in all {
            sim.app.world_mut().despawn(entity);
        }
        sim.ticks(2);
        let now = counts(&mut sim);
        let first = *first.get_or_insert(now);
        if round % 10 == 9 {
            findings.holds(format!("{round}: {first:?} is {now:?}"), first == now);
        }
    }
}

#[test]
fn a_state_written_to_a_file_goes_on_in_another_world() {
    let mut findings = Findings::new();
    for hz in RATES {
        for mode in [RagdollMode::Limp, RagdollMode::Powered] {
            let at = Vec3::Y * 40.0;
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, at);
            sim.ticks(2);
            let foot = bone(&sim, entity, "foot_l");
            push(&mut sim, foot, Vec3::new(20.0, 5.0, 0.0));
            sim.seconds(0.5);
            let saved = serde_json::to_string(&sim.get::<RagdollState>(entity)).unwrap();
            sim.seconds(0.5);
            let (mut other, again) = alone(hz, HumanoidDetail::Bodies19, mode, at);
            // Elsewhere, and otherwise on its way, before it is restored.
            other.ticks(7);
            let state: RagdollState = serde_json::from_str(&saved).unwrap();
            insert(&mut other, again, state.to_restore());
            other.seconds(0.5);
            let (a, b) = (
                sim.get::<RagdollState>(entity),
                other.get::<RagdollState>(again),
            );
            let off = a
                .bones
                .iter()
                .zip(&b.bones)
                .map(|(a, b)| a.place.position.distance(b.place.position));
            let what = format!("{hz} Hz, {mode:?}: off after half a second, m");
            findings.at_most(what, off.fold(0.0, f32::max), 0.01);
        }
    }
}

#[test]
fn a_bone_despawned_in_flight_disturbs_nothing_else() {
    let mode = RagdollMode::Powered;
    let (mut sim, entity) = above_ground(60.0, HumanoidDetail::Bodies19, mode, 1.0);
    sim.seconds(0.2);
    let arm = bone(&sim, entity, "upper_arm_r");
    sim.app.world_mut().despawn(arm);
    sim.seconds(2.0);
    let mut findings = Findings::new();
    findings.holds("the others are finite", finite(&sim, entity));
    findings.near("bones", bones(&sim, entity).len() as f32, 18.0, 0.0);
}

#[test]
fn a_refused_ragdoll_has_no_bones_until_it_is_mended() {
    let mut sim = Sim::new(60.0);
    let mut ragdoll = Ragdoll::default();
    let good = ragdoll.clone();
    ragdoll.profile.bones[4].parent = Some("nowhere".into());
    let entity = figure(&mut sim, ragdoll, RagdollMode::Limp, Vec3::Y);
    sim.ticks(3);
    let mut findings = Findings::new();
    findings.holds("no bones", bones(&sim, entity).is_empty());
    insert(&mut sim, entity, good);
    sim.ticks(3);
    findings.near("bones", bones(&sim, entity).len() as f32, 19.0, 0.0);
}

#[test]
fn the_same_figure_falls_the_same_way_twice() {
    let fall = || {
        let mode = RagdollMode::Limp;
        let (mut sim, entity) = above_ground(60.0, HumanoidDetail::Bodies19, mode, 0.4);
        let mut seen = Vec::new();
        for _ in 0..120 {
            sim.ticks(1);
            seen.push(sim.get::<RagdollState>(entity));
        }
        seen
    };
    let mut findings = Findings::new();
    findings.same("states", &fall(), &fall());
}

#[test]
fn interpolation_between_ticks_does_not_disturb_the_fall() {
    let fall = |mut sim: Sim| {
        ground(&mut sim);
        let at = Vec3::Y * 0.4;
        let entity = human(
            &mut sim,
            HumanoidDetail::Bodies15,
            RagdollMode::HitBoxes,
            at,
        );
        insert(&mut sim, entity, FollowRoot);
        let mut seen = Vec::new();
        for tick in 0..120 {
            if tick == 20 {
                ask(&mut sim, entity, RagdollMode::Limp);
            }
            sim.ticks(1);
            seen.push(sim.get::<RagdollState>(entity));
        }
        seen
    };
    let mut findings = Findings::new();
    let with = fall(Sim::with(60.0, EmbodyPlugins));
    let without = fall(Sim::new(60.0));
    // In flight to the bit. On the ground the engine meets bodies in another order once their transforms
    // were written.
    findings.same("states in flight", &without[..36], &with[..36]);
    let (a, b) = (&without[119].bones[0].place, &with[119].bones[0].place);
    findings.at_most(
        "pelvis off in the end, m",
        a.position.distance(b.position),
        0.1,
    );
}

#[test]
fn nobody_wakes_a_figure_that_sleeps_in_its_pose() {
    let mode = RagdollMode::Limp;
    let (mut sim, entity) = above_ground(60.0, HumanoidDetail::Bodies19, mode, 0.1);
    sim.seconds(6.0);
    let mut findings = Findings::new();
    let asleep = |sim: &Sim| outputs(sim, entity).iter().all(|o| o.asleep);
    findings.holds("asleep", asleep(&sim));
    sim.seconds(1.0);
    findings.holds("still asleep", asleep(&sim));
    ask(&mut sim, entity, RagdollMode::Powered);
    sim.ticks(2);
    findings.holds("woken by its muscles", !asleep(&sim));
}

#[test]
fn a_state_restored_into_animation_leaves_no_body_behind() {
    let mut findings = Findings::new();
    let mode = RagdollMode::Animated;
    let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies10, mode, Vec3::Y * 5.0);
    sim.ticks(3);
    let saved = sim.get::<RagdollState>(entity);
    ask(&mut sim, entity, RagdollMode::Limp);
    sim.ticks(10);
    findings.holds(
        "simulated",
        outputs(&sim, entity).iter().all(|o| o.simulated),
    );
    ask(&mut sim, entity, RagdollMode::Animated);
    insert(&mut sim, entity, saved.to_restore());
    sim.ticks(2);
    for part in bones(&sim, entity) {
        let off = sim.app.world().get::<RigidBodyDisabled>(part).is_some();
        findings.holds(format!("{} is off", sim.get::<Name>(part)), off);
    }
}

#[test]
fn a_figure_spawned_with_a_saved_state_goes_on_from_there() {
    let mut findings = Findings::new();
    for hz in RATES {
        let at = Vec3::Y * 40.0;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, RagdollMode::Limp, at);
        sim.seconds(0.5);
        let saved = sim.get::<RagdollState>(entity);
        let ragdoll = sim.get::<Ragdoll>(entity);
        sim.seconds(0.5);
        let mut other = Sim::new(hz);
        let at = Transform::from_translation(at);
        let again = other.spawn((ragdoll, saved, RagdollIntent::default(), at));
        other.seconds(0.5);
        let (a, b) = (
            sim.get::<RagdollState>(entity),
            other.get::<RagdollState>(again),
        );
        let apart = |(a, b): (&BoneState, &BoneState)| a.place.position.distance(b.place.position);
        let off = a.bones.iter().zip(&b.bones).map(apart).fold(0.0, f32::max);
        findings.at_most(format!("{hz} Hz: off after half a second, m"), off, 0.01);
    }
}

#[test]
fn a_component_that_is_written_every_tick_builds_nothing_anew() {
    let mut findings = Findings::new();
    let run = |writes: bool| {
        let mode = RagdollMode::Powered;
        let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies15, mode, Vec3::Y * 5.0);
        sim.ticks(2);
        let built = bones(&sim, entity);
        let mut seen = Vec::new();
        for tick in 0..30 {
            if writes {
                edit::<Ragdoll>(&mut sim, entity, |_| ());
            }
            // What is no part of the bodies acts at once.
            if tick == 10 {
                edit::<Ragdoll>(&mut sim, entity, |r| r.drive.frequency = 3.0);
            }
            sim.ticks(1);
            seen.push(sim.get::<RagdollState>(entity));
        }
        (built == bones(&sim, entity), seen, sim, entity)
    };
    let ((kept, still, ..), (kept_too, written, mut sim, entity)) = (run(false), run(true));
    findings.holds("the bones are the same", kept && kept_too);
    findings.same("states", &still, &written);
    let before = bones(&sim, entity);
    edit::<Ragdoll>(&mut sim, entity, |r| r.mass = 90.0);
    sim.ticks(2);
    let (now, (_, mass)) = (bones(&sim, entity), momentum(&sim, entity));
    findings.holds("another mass builds anew", before != now);
    findings.near("mass, kg", mass, 90.0, 0.01);
}

#[test]
fn another_tick_rate_gets_its_substeps() {
    let mut findings = Findings::new();
    let mode = RagdollMode::Limp;
    let (mut sim, entity) = alone(120.0, HumanoidDetail::Bodies10, mode, Vec3::Y * 5.0);
    sim.ticks(3);
    let extra = |sim: &Sim| {
        let all = bones(sim, entity);
        all.iter()
            .map(|b| sim.get::<AdditionalSolverIterations>(*b).0)
            .max()
    };
    findings.holds(format!("{:?}", extra(&sim)), extra(&sim) == Some(0));
    sim.app
        .world_mut()
        .resource_mut::<Time<Fixed>>()
        .set_timestep_hz(30.0);
    sim.ticks(12);
    // 30 ticks of 8 substeps are 240.
    findings.holds(format!("{:?}", extra(&sim)), extra(&sim) == Some(4));
}

#[test]
fn the_solver_is_as_it_was_when_the_last_figure_is_gone() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    sim.ticks(1);
    let iterations = |sim: &mut Sim| {
        let mut worlds = sim.app.world_mut().query::<&RapierContextSimulation>();
        let world = worlds.single(sim.app.world()).unwrap();
        world.integration_parameters.num_internal_pgs_iterations as f32
    };
    let own = iterations(&mut sim);
    let mut all = Vec::new();
    for most in [6, 3] {
        let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies10, 1.75);
        let ragdoll = Ragdoll {
            iterations: most,
            ..Ragdoll::new(profile, 75.0)
        };
        all.push(figure(
            &mut sim,
            ragdoll,
            RagdollMode::Limp,
            Vec3::Y * f32::from(most),
        ));
    }
    sim.ticks(3);
    for (what, wanted) in [("both", 6.0), ("the other", 3.0), ("none", own)] {
        findings.near(what, iterations(&mut sim), wanted, 0.0);
        if !all.is_empty() {
            sim.app.world_mut().despawn(all.remove(0));
        }
        sim.ticks(3);
    }
}

#[test]
fn energy_of_a_limp_figure_never_rises() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mode = RagdollMode::Limp;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 20.0);
        sim.ticks(2);
        let mut dice = Dice::new(5);
        for name in ["foot_l", "hand_r", "head"] {
            let part = bone(&sim, entity, name);
            push(&mut sim, part, dice.direction() * 12.0);
        }
        sim.ticks(2);
        let energy = |sim: &Sim| -> f32 {
            let mut sum = 0.0;
            for part in bones(sim, entity) {
                let AdditionalMassProperties::MassProperties(p) = sim.get(part) else {
                    continue;
                };
                let (out, pose) = (sim.get::<BoneOutput>(part), sim.get::<Transform>(part));
                let arm = pose.rotation * p.local_center_of_mass;
                let velocity = out.velocity + out.spin.cross(arm);
                let axes = pose.rotation * p.principal_inertia_local_frame;
                let spin = axes.inverse() * out.spin;
                let height = (pose.translation + arm).y - 20.0;
                sum += p.mass * (0.5 * velocity.length_squared() + G * height)
                    + 0.5 * (spin * spin).dot(p.principal_inertia);
            }
            sum
        };
        let start = energy(&sim);
        let mut least = start;
        let mut rise = 0.0f32;
        for _ in 0..(hz * 1.2) as usize {
            sim.ticks(1);
            let now = energy(&sim);
            rise = rise.max(now - least);
            least = least.min(now);
        }
        findings.at_most(
            format!("{hz} Hz: rise, J of {start}"),
            rise,
            0.01 * start.abs(),
        );
    }
}
