//! Odd circumstances: rates, masses, gravities, places and orders of things that nobody meant, but that
//! happen.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::Sim;

use super::support::*;
use crate::character::warnings;

/// Rates that no game should run at, hertz.
const ODD_RATES: [f64; 2] = [7.0, 500.0];

#[test]
fn at_odd_rates_a_figure_falls_lies_and_holds_its_pose() {
    let mut findings = Findings::new();
    for hz in ODD_RATES {
        let mode = RagdollMode::Limp;
        let (mut sim, entity) = above_ground(hz, HumanoidDetail::Bodies19, mode, 0.3);
        let mut low = f32::MAX;
        for _ in 0..(hz * 6.0) as usize {
            sim.ticks(1);
            for part in bones(&sim, entity) {
                low = low.min(sim.position(part).y);
            }
        }
        findings.holds(format!("{hz} Hz: finite"), finite(&sim, entity));
        findings.at_least(format!("{hz} Hz: lowest joint ever, m"), low, -0.1);
        let head = sim.position(bone(&sim, entity, "head")).y;
        findings.at_most(format!("{hz} Hz: it lies: head, m"), head, 0.6);
        let speed = worst(&sim, entity, |o| o.velocity.length());
        findings.at_most(format!("{hz} Hz: speed at rest, m/s"), speed, 0.1);
        let gap = worst(&sim, entity, |o| o.gap);
        findings.at_most(format!("{hz} Hz: gap at rest, m"), gap, 0.002);
        let off = worst(&sim, entity, |o| o.violation.to_degrees());
        findings.at_most(format!("{hz} Hz: violation at rest, degrees"), off, 1.0);

        let mode = RagdollMode::Powered;
        let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies19, mode, Vec3::Y * 3.0);
        sim.ticks(1);
        let pelvis = bone(&sim, entity, "pelvis");
        edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
        sim.seconds(4.0);
        let error = worst(&sim, entity, |o| o.error.to_degrees());
        findings.at_most(format!("{hz} Hz: error of the pose, degrees"), error, 3.0);
    }
}

#[test]
fn a_clock_that_stands_changes_nothing_whatever_the_drive() {
    let mut findings = Findings::new();
    for mode in [
        RagdollMode::Powered,
        RagdollMode::Limp,
        RagdollMode::HitBoxes,
        RagdollMode::Keyframed,
        RagdollMode::GettingUp,
    ] {
        let run = |pauses: bool| {
            let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies15, mode, Vec3::Y * 9.0);
            edit::<Ragdoll>(&mut sim, entity, |r| {
                r.drive.torque = f32::INFINITY;
                for bone in &mut r.profile.bones {
                    bone.joint.max_torque = f32::INFINITY;
                }
            });
            let clock = |sim: &mut Sim, stands: bool| {
                let mut time = sim.app.world_mut().resource_mut::<Time<Virtual>>();
                if stands { time.pause() } else { time.unpause() }
            };
            let mut seen = Vec::new();
            for tick in 0..40 {
                sim.ticks(1);
                seen.push(sim.get::<RagdollState>(entity));
                if pauses && tick % 10 == 5 {
                    clock(&mut sim, true);
                    sim.ticks(3);
                    seen.push(sim.get::<RagdollState>(entity));
                    seen.dedup();
                    clock(&mut sim, false);
                }
            }
            (seen, finite(&sim, entity))
        };
        let ((running, _), (paused, sound)) = (run(false), run(true));
        findings.holds(format!("{mode:?}: finite"), sound);
        findings.same(format!("{mode:?}: states"), &running, &paused);
    }
}

#[test]
fn a_paused_physics_world_leaves_a_figure_as_it_was() {
    let mut findings = Findings::new();
    let mode = RagdollMode::Powered;
    let (mut sim, entity) = above_ground(60.0, HumanoidDetail::Bodies15, mode, 1.0);
    sim.seconds(0.3);
    let places = |sim: &Sim| -> Vec<Transform> {
        let all = bones(sim, entity);
        all.iter().map(|b| sim.get::<Transform>(*b)).collect()
    };
    let running = |sim: &mut Sim, on: bool| {
        let world = sim.app.world_mut();
        let mut worlds = world.query::<&mut RapierConfiguration>();
        for mut config in worlds.iter_mut(world) {
            config.physics_pipeline_active = on;
        }
    };
    running(&mut sim, false);
    let before = places(&sim);
    for mode in [
        RagdollMode::Limp,
        RagdollMode::HitBoxes,
        RagdollMode::Powered,
    ] {
        ask(&mut sim, entity, mode);
        sim.ticks(10);
        findings.same(format!("physics off, {mode:?}"), &before, &places(&sim));
    }
    running(&mut sim, true);
    sim.seconds(2.0);
    findings.holds("finite", finite(&sim, entity));
    let moved = places(&sim);
    findings.holds("it goes on", moved != before);
}

#[test]
fn a_mode_asked_before_there_are_bones_is_taken_up_when_they_come() {
    let mut findings = Findings::new();
    for mode in [
        RagdollMode::Limp,
        RagdollMode::Powered,
        RagdollMode::Partial,
        RagdollMode::Keyframed,
        RagdollMode::Frozen,
        RagdollMode::GettingUp,
        RagdollMode::HitBoxes,
        RagdollMode::Animated,
    ] {
        let mut sim = Sim::new(60.0);
        let intent = RagdollIntent { mode, ..default() };
        let entity = sim.spawn((intent, Transform::from_xyz(0.0, 5.0, 0.0)));
        sim.ticks(2);
        // A hit, a cut and a teleport of what is not there yet.
        hit(&mut sim, entity, Vec3::Y, Vec3::X);
        sim.app.world_mut().trigger(Dismember { entity });
        sim.app.world_mut().trigger(Teleported { entity });
        let ragdoll = Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.75),
            75.0,
        );
        insert(&mut sim, entity, ragdoll);
        hit(&mut sim, entity, Vec3::Y, Vec3::X);
        sim.ticks(3);
        let state = sim.get::<RagdollState>(entity);
        findings.holds(format!("{mode:?}: {:?}", state.mode), state.mode == mode);
        let near = |b: &Entity| (4.5..7.5).contains(&sim.position(*b).y);
        let all = bones(&sim, entity);
        findings.holds(format!("{mode:?}: in its place"), all.iter().all(near));
        findings.holds(format!("{mode:?}: finite"), finite(&sim, entity));
        findings.at_most(
            format!("{mode:?}: speed, m/s"),
            worst(&sim, entity, |o| o.velocity.length()),
            1.0,
        );
    }
}

#[test]
fn a_bone_given_to_another_figure_disturbs_neither() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    warnings::unique_entities(&mut sim);
    let mode = RagdollMode::Powered;
    let [a, b] = [0.0, 4.0].map(|x| {
        human(
            &mut sim,
            HumanoidDetail::Bodies15,
            mode,
            Vec3::new(x, 0.3, 0.0),
        )
    });
    sim.ticks(5);
    let stolen = bone(&sim, a, "forearm_l");
    insert(&mut sim, stolen, BoneOf(b));
    for mode in [RagdollMode::Limp, RagdollMode::HitBoxes, RagdollMode::Limp] {
        for who in [a, b] {
            ask(&mut sim, who, mode);
        }
        sim.seconds(1.0);
        for who in [a, b] {
            findings.holds(format!("{mode:?}: finite"), finite(&sim, who));
        }
        let other = bones(&sim, b).into_iter().filter(|part| *part != stolen);
        let far = other.map(|part| sim.position(part).distance(Vec3::new(4.0, 0.5, 0.0)));
        findings.at_most(
            format!("{mode:?}: it stays, m"),
            far.fold(0.0, f32::max),
            2.5,
        );
    }
    for (who, what) in [(a, "is gone"), (b, "is there twice")] {
        let told = warnings::about(who);
        let named = |line: &&String| line.contains(what) && line.contains("forearm_l");
        let count = told.iter().filter(named).count();
        findings.near(format!("{what}, in {told:#?}"), count as f32, 1.0, 0.0);
    }
}

#[test]
fn a_figure_of_ten_grams_and_one_of_ten_tonnes_fall_and_hold_their_pose() {
    let mut findings = Findings::new();
    for hz in [60.0, 240.0] {
        for mass in [0.01f32, 10_000.0] {
            let mut ragdoll = Ragdoll::new(
                RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75),
                mass,
            );
            ragdoll.drive.torque = f32::INFINITY;
            // That of people is for people.
            for bone in &mut ragdoll.profile.bones {
                bone.joint.friction *= mass / 75.0;
            }
            let what = format!("{hz} Hz, {mass} kg");
            let mut sim = Sim::new(hz);
            ground(&mut sim);
            let mode = RagdollMode::Limp;
            let entity = figure(&mut sim, ragdoll.clone(), mode, Vec3::Y * 0.5);
            sim.seconds(6.0);
            findings.holds(format!("{what}: finite"), finite(&sim, entity));
            let gap = worst(&sim, entity, |o| o.gap);
            findings.at_most(format!("{what}: gap at rest, m"), gap, 0.005);
            let off = worst(&sim, entity, |o| o.violation.to_degrees());
            findings.at_most(format!("{what}: violation at rest, degrees"), off, 1.0);
            let speed = worst(&sim, entity, |o| o.velocity.length());
            findings.at_most(format!("{what}: speed at rest, m/s"), speed, 0.1);
            let (_, sum) = momentum(&sim, entity);
            findings.within(format!("{what}: mass, kg"), sum, mass, 1.0e-3);

            let mut sim = Sim::new(hz);
            let mode = RagdollMode::Powered;
            let entity = figure(&mut sim, ragdoll, mode, Vec3::Y * 3.0);
            sim.ticks(1);
            let pelvis = bone(&sim, entity, "pelvis");
            edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
            let start = sim.position(pelvis);
            sim.seconds(3.0);
            let error = worst(&sim, entity, |o| o.error.to_degrees());
            findings.at_most(format!("{what}: error of the pose, degrees"), error, 3.0);
            let way = sim.position(pelvis).distance(start);
            findings.at_most(format!("{what}: way of the pelvis, m"), way, 0.01);
        }
    }
}

#[test]
fn without_gravity_a_figure_floats_where_it_is_and_sideways_it_falls_to_the_side() {
    let mut findings = Findings::new();
    for hz in RATES {
        let mut sim = Sim::new(hz);
        gravity(&mut sim, Vec3::ZERO);
        let mode = RagdollMode::Limp;
        let entity = human(&mut sim, HumanoidDetail::Bodies19, mode, Vec3::Y * 2.0);
        sim.ticks(2);
        let before = sim.get::<RagdollState>(entity);
        sim.seconds(3.0);
        let after = sim.get::<RagdollState>(entity);
        for (a, b) in before.bones.iter().zip(&after.bones) {
            let off = a.place.position.distance(b.place.position);
            findings.at_most(format!("{hz} Hz: floats, m"), off, 1.0e-3);
        }

        let mut sim = Sim::new(hz);
        gravity(&mut sim, Vec3::NEG_X * G);
        sim.block(Vec3::NEG_X * 0.5, Vec3::new(1.0, 20.0, 20.0));
        let at = Vec3::new(1.5, 0.0, 0.0);
        let entity = human(&mut sim, HumanoidDetail::Bodies19, mode, at);
        let flight = 0.3;
        sim.seconds(flight);
        let (momentum, mass) = momentum(&sim, entity);
        let expected = -G * flight as f32;
        let speed = momentum.x / mass;
        findings.near(format!("{hz} Hz: falls, m/s"), speed, expected, 0.15);
        sim.seconds(6.0);
        let awake = outputs(&sim, entity).iter().any(|o| !o.asleep);
        findings.holds(format!("{hz} Hz: it sleeps on the wall"), !awake);
        let low = bones(&sim, entity)
            .iter()
            .map(|b| sim.position(*b).x)
            .fold(f32::MAX, f32::min);
        findings.near(format!("{hz} Hz: lowest joint, m"), low, 0.1, 0.1);
    }
}

#[test]
fn a_kilometre_from_the_origin_a_figure_falls_sleeps_and_holds_its_pose() {
    let mut findings = Findings::new();
    let far = Vec3::new(800.0, 0.0, -600.0);
    for hz in [60.0, 240.0] {
        let mut sim = Sim::new(hz);
        sim.block(far - Vec3::Y * 0.5, Vec3::new(20.0, 1.0, 20.0));
        let mode = RagdollMode::Limp;
        let at = far + Vec3::Y * 0.3;
        let entity = human(&mut sim, HumanoidDetail::Bodies19, mode, at);
        sim.seconds(6.0);
        let awake = outputs(&sim, entity).iter().any(|o| !o.asleep);
        findings.holds(format!("{hz} Hz: it sleeps"), !awake);
        let gap = worst(&sim, entity, |o| o.gap);
        findings.at_most(format!("{hz} Hz: gap at rest, m"), gap, 0.002);
        let mut sim = Sim::new(hz);
        let mode = RagdollMode::Powered;
        let at = far + Vec3::Y * 3.0;
        let entity = human(&mut sim, HumanoidDetail::Bodies19, mode, at);
        sim.ticks(1);
        let pelvis = bone(&sim, entity, "pelvis");
        edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
        sim.seconds(3.0);
        let error = worst(&sim, entity, |o| o.error.to_degrees());
        findings.at_most(format!("{hz} Hz: error of the pose, degrees"), error, 3.0);
        let gap = worst(&sim, entity, |o| o.gap);
        findings.at_most(format!("{hz} Hz: gap of the pose, m"), gap, 0.002);
    }
}

#[test]
fn bones_meet_only_the_groups_that_they_are_told_to() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    let floor = ground(&mut sim);
    insert(
        &mut sim,
        floor,
        CollisionGroups::new(Group::GROUP_1, Group::ALL),
    );
    let through = BoneGroups {
        memberships: Group::GROUP_2.bits(),
        filters: (!Group::GROUP_1).bits(),
    };
    let ragdoll = Ragdoll {
        groups: through,
        ..Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies10, 1.75),
            75.0,
        )
    };
    let mode = RagdollMode::Limp;
    let entity = figure(&mut sim, ragdoll.clone(), mode, Vec3::Y * 0.3);
    let other = figure(&mut sim, ragdoll, mode, Vec3::new(4.0, 2.0, 0.0));
    sim.seconds(0.2);
    let built = bones(&sim, other);
    edit::<Ragdoll>(&mut sim, other, |r| r.groups = BoneGroups::default());
    sim.seconds(2.8);
    findings.holds("the same bones", built == bones(&sim, other));
    let low = |who: Entity| sim.position(bone(&sim, who, "pelvis")).y;
    findings.at_most("through the floor, m", low(entity), -5.0);
    findings.at_least("it meets the floor again, m", low(other), 0.0);
}
