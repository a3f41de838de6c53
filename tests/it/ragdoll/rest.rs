//! Lying still is noticed, and frozen where that is asked.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use embody_scenes::Sim;

use super::support::*;

#[derive(Resource, Default)]
struct Rests(Vec<Entity>);

fn fallen(hz: f64, rest: RagdollRest) -> (Sim, Entity) {
    let mut sim = Sim::new(hz);
    ground(&mut sim);
    sim.app.init_resource::<Rests>();
    sim.app
        .add_observer(|rest: On<CameToRest>, mut rests: ResMut<Rests>| rests.0.push(rest.entity));
    let ragdoll = Ragdoll {
        rest,
        ..Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.75),
            75.0,
        )
    };
    let entity = figure(&mut sim, ragdoll, RagdollMode::Limp, Vec3::Y * 0.2);
    (sim, entity)
}

#[test]
fn a_figure_that_has_fallen_is_noticed_once_and_again_after_it_was_pushed() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity) = fallen(hz, RagdollRest::default());
        sim.seconds(0.3);
        let count = |sim: &Sim| sim.app.world().resource::<Rests>().0.len() as f32;
        findings.near(format!("{hz} Hz: while it falls"), count(&sim), 0.0, 0.0);
        sim.seconds(7.0);
        findings.near(format!("{hz} Hz: after it"), count(&sim), 1.0, 0.0);
        let chest = bone(&sim, entity, "chest");
        push(&mut sim, chest, Vec3::X * 80.0);
        sim.seconds(0.2);
        findings.near(
            format!("{hz} Hz: still time"),
            sim.get::<RagdollState>(entity).still,
            0.0,
            0.0,
        );
        sim.seconds(6.0);
        findings.near(format!("{hz} Hz: again"), count(&sim), 2.0, 0.0);
    }
}

#[test]
fn a_figure_that_stood_still_falls_as_if_it_would_never_freeze() {
    let mut findings = Findings::new();
    let run = |freeze_after: Option<f32>| {
        let mut sim = Sim::new(60.0);
        ground(&mut sim);
        let mut ragdoll = Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.75),
            75.0,
        );
        ragdoll.rest.freeze_after = freeze_after;
        let entity = figure(&mut sim, ragdoll, RagdollMode::Powered, Vec3::Y * 0.02);
        sim.ticks(2);
        let pelvis = bone(&sim, entity, "pelvis");
        edit::<BoneControl>(&mut sim, pelvis, |c| c.pin = 1.0);
        sim.seconds(3.0);
        let stood = sim.position(pelvis).y;
        ask(&mut sim, entity, RagdollMode::Limp);
        sim.seconds(0.4);
        let mode = sim.get::<RagdollState>(entity).mode;
        (stood - sim.position(pelvis).y, mode)
    };
    let (free, (fell, mode)) = (run(None), run(Some(0.5)));
    findings.holds(format!("{mode:?}"), mode == RagdollMode::Limp);
    findings.at_least("it falls, m", free.0, 0.02);
    findings.near("as the other, m", fell, free.0, 0.0);
}

#[test]
fn a_baked_figure_has_no_bodies_and_lies_there_again_when_it_is_a_ragdoll_again() {
    let (mut sim, entity) = fallen(60.0, RagdollRest::default());
    sim.seconds(4.0);
    let names = |sim: &Sim| -> Vec<(String, Transform)> {
        let all = bones(sim, entity);
        let named = |b: &Entity| (sim.get::<Name>(*b).to_string(), sim.get::<Transform>(*b));
        all.iter().map(named).collect()
    };
    let lay = names(&sim);
    let ragdoll = sim.get::<Ragdoll>(entity);
    let bodies = |sim: &mut Sim| {
        let mut sets = sim
            .app
            .world_mut()
            .query::<&bevy_rapier3d::prelude::RapierRigidBodySet>();
        sets.single(sim.app.world()).unwrap().bodies.len()
    };
    let mut findings = Findings::new();
    findings.near("bodies before", bodies(&mut sim) as f32, 16.0, 0.0);
    sim.app.world_mut().trigger(BakeRagdoll { entity });
    sim.seconds(0.5);
    findings.near("bodies baked", bodies(&mut sim) as f32, 1.0, 0.0);
    findings.holds("no bones", bones(&sim, entity).is_empty());
    // Put elsewhere meanwhile.
    let moved = Vec3::new(3.0, 0.0, -2.0);
    edit::<Transform>(&mut sim, entity, |t| t.translation += moved);
    insert(&mut sim, entity, ragdoll);
    sim.ticks(2);
    let now = names(&sim);
    findings.near("bones again", now.len() as f32, lay.len() as f32, 0.0);
    for ((name, a), (_, b)) in lay.iter().zip(&now) {
        let off = (a.translation + moved).distance(b.translation);
        findings.at_most(format!("{name}: off, m"), off, 5.0e-3);
    }
}

#[test]
fn a_figure_freezes_when_that_is_due_and_thaws_when_it_is_hit() {
    let mut findings = Findings::new();
    let rest = RagdollRest {
        freeze_after: Some(1.0),
        ..default()
    };
    let (mut sim, entity) = fallen(60.0, rest);
    let mut before = 0.0;
    for _ in 0..600 {
        sim.ticks(1);
        let state = sim.get::<RagdollState>(entity);
        if state.mode == RagdollMode::Frozen {
            break;
        }
        before = state.still;
    }
    findings.near("still before it froze, s", before, 1.0, 0.02);
    let places = |sim: &Sim| -> Vec<Transform> {
        let all = bones(sim, entity);
        all.iter().map(|b| sim.get::<Transform>(*b)).collect()
    };
    sim.ticks(1);
    let frozen = places(&sim);
    sim.seconds(2.0);
    findings.same("frozen bones", &frozen, &places(&sim));
    findings.holds(
        "no bone is simulated",
        outputs(&sim, entity).iter().all(|o| !o.simulated),
    );
    let chest = bone(&sim, entity, "chest");
    push(&mut sim, chest, Vec3::X * 60.0);
    sim.ticks(1);
    let (after, mass) = momentum(&sim, entity);
    findings.at_least("speed after the hit, m/s", after.x / mass, 0.5);
    findings.holds(
        "limp again",
        sim.get::<RagdollState>(entity).mode == RagdollMode::Limp,
    );
}

#[test]
fn a_figure_baked_below_something_that_is_turned_lies_there_again() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    ground(&mut sim);
    let above = Transform::from_xyz(1.0, 0.3, 2.0)
        .with_rotation(Quat::from_rotation_y(0.9))
        .with_scale(Vec3::splat(1.0));
    let parent = sim.spawn(above);
    let mode = RagdollMode::Limp;
    let entity = human(&mut sim, HumanoidDetail::Bodies15, mode, Vec3::ZERO);
    insert(&mut sim, entity, ChildOf(parent));
    sim.seconds(4.0);
    let places = |sim: &Sim| -> Vec<Vec3> {
        let all = bones(sim, entity);
        all.iter().map(|b| sim.position(*b)).collect()
    };
    let ragdoll = sim.get::<Ragdoll>(entity);
    // Again and again.
    for round in 0..3 {
        let lay = places(&sim);
        sim.app.world_mut().trigger(BakeRagdoll { entity });
        sim.ticks(3);
        findings.holds(format!("{round}: no bones"), bones(&sim, entity).is_empty());
        // Twice is nothing more.
        sim.app.world_mut().trigger(BakeRagdoll { entity });
        insert(&mut sim, entity, ragdoll.clone());
        sim.ticks(2);
        let now = places(&sim);
        findings.near(format!("{round}: bones"), now.len() as f32, 15.0, 0.0);
        for (a, b) in lay.iter().zip(&now) {
            findings.at_most(format!("{round}: off, m"), a.distance(*b), 5.0e-3);
        }
        findings.holds(format!("{round}: finite"), finite(&sim, entity));
    }
}

#[test]
fn a_figure_baked_before_it_was_anywhere_keeps_the_pose_asked_for() {
    let mut findings = Findings::new();
    let mut sim = Sim::new(60.0);
    let mode = RagdollMode::HitBoxes;
    let entity = human(&mut sim, HumanoidDetail::Bodies10, mode, Vec3::Y);
    let profile = sim.get::<Ragdoll>(entity).profile;
    let pose = RagdollPose::from_turns(&profile, [("head", Quat::from_rotation_x(0.3))]);
    insert(&mut sim, entity, pose.clone());
    sim.app.world_mut().trigger(BakeRagdoll { entity });
    sim.ticks(2);
    findings.holds("the pose", sim.get::<RagdollPose>(entity) == pose);
    findings.holds("no bones", bones(&sim, entity).is_empty());
}

#[test]
fn what_a_bone_took_its_pose_from_may_go_and_the_figure_may_go_and_come() {
    let mut findings = Findings::new();
    let mode = RagdollMode::HitBoxes;
    let (mut sim, entity) = alone(60.0, HumanoidDetail::Bodies10, mode, Vec3::Y);
    sim.ticks(2);
    let head = bone(&sim, entity, "head");
    let at = Vec3::new(0.3, 3.0, 0.0);
    let source = sim.spawn(Transform::from_translation(at));
    insert(&mut sim, head, BoneSource(source));
    sim.ticks(20);
    findings.at_most("at its source, m", sim.position(head).distance(at), 1.0e-3);
    sim.app.world_mut().despawn(source);
    sim.ticks(20);
    let off = sim.position(head).distance(at);
    findings.at_most("the source is gone, m", off, 1.0e-3);
    ask(&mut sim, entity, RagdollMode::Limp);
    sim.seconds(0.5);
    findings.holds("finite", finite(&sim, entity));
    let ragdoll = sim.get::<Ragdoll>(entity);
    for round in 0..3 {
        sim.app.world_mut().entity_mut(entity).remove::<Ragdoll>();
        sim.ticks(round);
        findings.holds("no bones", bones(&sim, entity).is_empty());
        edit::<Transform>(&mut sim, entity, |t| t.translation.x += 3.0);
        insert(&mut sim, entity, ragdoll.clone());
        sim.ticks(2);
        let pelvis = sim.position(bone(&sim, entity, "pelvis"));
        let figure = sim.position(entity);
        findings.at_most("beside its figure, m", (pelvis.x - figure.x).abs(), 0.05);
        findings.near("bones", bones(&sim, entity).len() as f32, 10.0, 0.0);
    }
}
