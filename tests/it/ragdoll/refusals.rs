//! Input that cannot work: one warning that names entity, bone, field and value, and nothing else is
//! disturbed.

use bevy::prelude::*;
use bevy_embody::{prelude::*, ragdoll::RagdollSystems};
use embody_scenes::Sim;

use super::support::*;
use crate::character::warnings;

const FAR: Vec3 = Vec3::new(6.0, 1.0, 0.0);

/// A world that listens, with a figure that falls some metres away.
fn listening() -> (Sim, Entity) {
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    warnings::unique_entities(&mut sim);
    let other = human(&mut sim, HumanoidDetail::Bodies10, RagdollMode::Limp, FAR);
    (sim, other)
}

/// Places of the bones of a figure over a second.
fn path(sim: &mut Sim, ragdoll: Entity) -> Vec<Vec<(String, Transform)>> {
    let mut seen = Vec::new();
    for _ in 0..60 {
        sim.ticks(1);
        let all = bones(sim, ragdoll);
        let place = |b: &Entity| (sim.get::<Name>(*b).to_string(), sim.get::<Transform>(*b));
        seen.push(all.iter().map(place).collect());
    }
    seen
}

/// Exactly one warning, with all of these words.
fn once(findings: &mut Findings, what: &str, entity: Entity, words: &[&str]) {
    let told = warnings::about(entity);
    let named = |line: &String| words.iter().all(|word| line.contains(word));
    findings.holds(
        format!("{what}: one warning with {words:?}: {told:#?}"),
        told.len() == 1 && told.iter().all(named),
    );
}

#[test]
fn a_skeleton_that_cannot_work_is_told_once_and_left_without_bones() {
    type Fault = (&'static str, fn(&mut RagdollProfile), [&'static str; 2]);
    let faults: [Fault; 6] = [
        (
            "cycle",
            |p| p.bone_mut("pelvis").unwrap().parent = Some("forearm_l".into()),
            ["hangs on itself", "bone"],
        ),
        (
            "missing parent",
            |p| p.bone_mut("shin_r").unwrap().parent = Some("tail".into()),
            ["\"shin_r\"", "\"tail\""],
        ),
        (
            "no length",
            |p| {
                p.bone_mut("shin_l").unwrap().shape = BoneShape::Capsule {
                    from: Vec3::ZERO,
                    to: Vec3::ZERO,
                    radius: 1.0e-4,
                };
            },
            ["\"shin_l\"", "no length"],
        ),
        (
            "NaN",
            |p| p.bone_mut("head").unwrap().position.y = f32::NAN,
            ["\"head\"", "NaN"],
        ),
        (
            "scaled",
            |p| p.bone_mut("pelvis").unwrap().rotation = Quat::IDENTITY * 2.0,
            ["\"pelvis\"", "mirrored"],
        ),
        (
            "limits",
            |p| p.bone_mut("thigh_l").unwrap().joint.kind = JointKind::Hinge { min: 1.0, max: 0.0 },
            ["\"thigh_l\"", "limits"],
        ),
    ];
    let mut findings = Findings::new();
    let (mut sim, other) = listening();
    let undisturbed = path(&mut sim, other);
    for (what, fault, words) in faults {
        let (mut sim, other) = listening();
        let mut profile = RagdollProfile::humanoid(HumanoidDetail::Bodies10, 1.75);
        fault(&mut profile);
        let ragdoll = Ragdoll::new(profile, 75.0);
        let entity = figure(&mut sim, ragdoll, RagdollMode::Limp, Vec3::Y);
        let seen = path(&mut sim, other);
        // Who writes it again and again is not told again and again.
        for _ in 0..3 {
            edit::<Ragdoll>(&mut sim, entity, |_| ());
            sim.ticks(1);
        }
        once(&mut findings, what, entity, &words);
        findings.holds(format!("{what}: no bones"), bones(&sim, entity).is_empty());
        findings.same(format!("{what}: the other"), &undisturbed, &seen);
    }
}

#[test]
fn a_pose_that_is_none_is_told_once_and_leaves_the_other_bones_alone() {
    let mut findings = Findings::new();
    let run = |bad: Option<BonePose>| {
        let (mut sim, _) = listening();
        let mode = RagdollMode::HitBoxes;
        let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y);
        sim.ticks(2);
        let profile = sim.get::<Ragdoll>(entity).profile;
        let mut pose = RagdollPose::from_turns(&profile, [("head", Quat::from_rotation_x(0.3))]);
        let hand = profile.index("forearm_l").unwrap();
        if let Some(bad) = bad {
            pose.bones[hand] = bad;
        }
        insert(&mut sim, entity, pose);
        let mut seen = path(&mut sim, entity);
        for bones in &mut seen {
            bones.retain(|(name, _)| name != "forearm_l");
        }
        (seen, warnings::about(entity), entity, finite(&sim, entity))
    };
    let (good, told, ..) = run(None);
    findings.holds(
        format!("nothing is told of a sound pose: {told:?}"),
        told.is_empty(),
    );
    let nowhere = BonePose {
        position: Vec3::new(0.0, f32::NAN, 0.0),
        rotation: Quat::IDENTITY,
    };
    let long = BonePose {
        position: Vec3::Y,
        rotation: Quat::IDENTITY * 2.0,
    };
    for (what, bad, value) in [("NaN", nowhere, "NaN"), ("no unit", long, "2")] {
        let (seen, _, entity, sound) = run(Some(bad));
        let words = ["\"forearm_l\"", "RagdollPose::bones", value];
        once(&mut findings, what, entity, &words);
        findings.same(format!("{what}: other bones"), &good, &seen);
        findings.holds(format!("{what}: finite"), sound);
    }
}

#[test]
fn a_mirrored_skeleton_is_told_with_its_scale_and_not_followed() {
    let mut findings = Findings::new();
    let (mut sim, _) = listening();
    let mode = RagdollMode::HitBoxes;
    let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y);
    sim.ticks(2);
    let mirrored = Transform::from_xyz(3.0, 2.0, 0.0).with_scale(Vec3::new(-1.0, 1.0, 1.0));
    let source = sim.spawn(mirrored);
    let joint = sim.spawn(mirrored);
    let (head, thigh) = (bone(&sim, entity, "head"), bone(&sim, entity, "thigh_l"));
    let before = [sim.position(head), sim.position(thigh)];
    insert(&mut sim, head, BoneSource(source));
    sim.ticks(10);
    once(
        &mut findings,
        "source",
        entity,
        &["\"head\"", "BoneSource", "-1"],
    );
    insert(&mut sim, thigh, BoneJoint::new(joint));
    sim.ticks(10);
    let told = warnings::about(entity);
    let named = told
        .iter()
        .filter(|t| t.contains("BoneJoint") && t.contains("\"thigh_l\""));
    findings.near("of the joint", named.count() as f32, 1.0, 0.0);
    for (bone, before) in [head, thigh].into_iter().zip(before) {
        let off = sim.position(bone).distance(before);
        findings.at_most("it stays, m", off, 1.0e-4);
    }
}

#[test]
fn a_figure_with_a_scale_is_told_of_it_once() {
    let mut findings = Findings::new();
    let (mut sim, _) = listening();
    let ragdoll = Ragdoll::new(
        RagdollProfile::humanoid(HumanoidDetail::Bodies10, 1.75),
        75.0,
    );
    let at = Transform::from_xyz(0.0, 1.0, 0.0).with_scale(Vec3::new(1.0, -2.0, 1.0));
    let entity = sim.spawn((ragdoll, at));
    sim.ticks(30);
    once(&mut findings, "scale", entity, &["scale is [1, -2, 1]"]);
    findings.holds("finite", finite(&sim, entity));
    let gap = worst(&sim, entity, |o| o.gap);
    findings.at_most("gap, m", gap, 0.005);
}

#[test]
fn a_bone_despawned_in_flight_is_told_once_and_the_others_follow_on() {
    let mut findings = Findings::new();
    let run = |gone: bool| {
        let (mut sim, _) = listening();
        let mode = RagdollMode::HitBoxes;
        let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y);
        sim.ticks(5);
        if gone {
            let arm = bone(&sim, entity, "upper_arm_r");
            sim.app.world_mut().despawn(arm);
        }
        edit::<Transform>(&mut sim, entity, |t| t.translation.x += 0.2);
        let mut seen = path(&mut sim, entity);
        for bones in &mut seen {
            bones.retain(|(name, _)| name != "upper_arm_r");
        }
        (seen, entity, warnings::about(entity).len())
    };
    let ((all, _, none), (others, entity, _)) = (run(false), run(true));
    findings.near("warnings without", none as f32, 0.0, 0.0);
    once(
        &mut findings,
        "gone",
        entity,
        &["\"upper_arm_r\"", "is gone"],
    );
    findings.same("other bones", &all, &others);
}

#[test]
fn a_figure_that_lost_a_bone_as_it_was_made_is_tied_together_without_it() {
    let (mut sim, _) = listening();
    let lose = |bones: Query<(Entity, &Name), With<RagdollBone>>, mut commands: Commands| {
        for (bone, name) in &bones {
            if name.as_str() == "forearm_l" {
                commands.entity(bone).despawn();
            }
        }
    };
    // Before the physics world has heard of it.
    let early = lose
        .after(RagdollSystems::Prepare)
        .before(bevy_rapier3d::prelude::PhysicsSet::SyncBackend);
    sim.app.add_systems(FixedPostUpdate, early);
    let mode = RagdollMode::Limp;
    let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y);
    sim.seconds(1.5);
    let mut findings = Findings::new();
    findings.near("bones", bones(&sim, entity).len() as f32, 9.0, 0.0);
    let head = sim.position(bone(&sim, entity, "head")).y;
    findings.at_most("it has fallen: head, m", head, 1.2);
    let gap = worst(&sim, entity, |o| o.gap);
    findings.at_most("gap, m", gap, 0.01);
    once(&mut findings, "gone", entity, &["\"forearm_l\"", "is gone"]);
}

#[test]
fn a_time_to_rise_that_is_none_is_told_once_and_it_rises_all_the_same() {
    let mut findings = Findings::new();
    for bad in [f32::NAN, f32::INFINITY, -1.0] {
        let (mut sim, _) = listening();
        let mode = RagdollMode::Limp;
        let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y * 0.2);
        sim.seconds(2.0);
        ask(&mut sim, entity, RagdollMode::GettingUp);
        // Written again and again.
        for _ in 0..60 {
            edit::<RagdollState>(&mut sim, entity, |s| s.rise_time = bad);
            sim.ticks(1);
        }
        let words = ["RagdollState::rise_time", "at least 0"];
        once(&mut findings, &format!("{bad}"), entity, &words);
        let head = sim.position(bone(&sim, entity, "head")).y;
        findings.at_least(format!("{bad}: it stands: head, m"), head, 1.3);
    }
}

#[test]
fn an_up_that_is_no_direction_is_told_once_and_is_above() {
    let mut findings = Findings::new();
    for bad in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
        let (mut sim, _) = listening();
        let mode = RagdollMode::Limp;
        let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y * 0.2);
        insert(&mut sim, entity, FollowRoot);
        for _ in 0..60 {
            insert(&mut sim, entity, RagdollUp(bad));
            sim.ticks(1);
        }
        once(&mut findings, &format!("{bad}"), entity, &["RagdollUp"]);
        findings.holds("finite", finite(&sim, entity));
        let up = sim.get::<Transform>(entity).rotation * Vec3::Y;
        findings.at_most("up, off", up.distance(Vec3::Y), 1.0e-3);
    }
}

#[test]
fn a_joint_that_two_bones_would_show_is_shown_by_the_first_and_told() {
    let mut findings = Findings::new();
    let (mut sim, _) = listening();
    let mode = RagdollMode::HitBoxes;
    let [a, b] = [1.0, 4.0].map(|x| {
        human(
            &mut sim,
            HumanoidDetail::Bodies10,
            mode,
            Vec3::new(x, 1.0, 0.0),
        )
    });
    sim.ticks(2);
    let joint = sim.spawn(Transform::from_xyz(1.0, 2.6, 0.0));
    let [of_a, of_b] = [a, b].map(|who| bone(&sim, who, "head"));
    insert(&mut sim, of_a, BoneJoint::new(joint));
    sim.ticks(2);
    insert(&mut sim, of_b, BoneJoint::new(joint));
    sim.ticks(5);
    let words = ["\"head\"", "BoneJoint::joint", &a.to_string()];
    once(&mut findings, "shared", b, &words);
    findings.holds(
        "the first shows it",
        sim.app.world().get::<BoneJoint>(of_a).is_some(),
    );
    findings.holds(
        "the second shows none",
        sim.app.world().get::<BoneJoint>(of_b).is_none(),
    );
    findings.holds("finite", finite(&sim, a) && finite(&sim, b));
}
