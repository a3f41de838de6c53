//! Standing by joint torques alone.

use bevy::{math::ops, prelude::*};
use bevy_embody::{prelude::*, ragdoll::BalanceState};
use embody_scenes::Sim;

use super::support::*;

fn standing(balance: Option<RagdollBalance>) -> (Sim, Entity) {
    let mut sim = Sim::new(60.0);
    sim.floor(0.0);
    let entity = human(
        &mut sim,
        HumanoidDetail::Bodies23,
        RagdollMode::Powered,
        Vec3::ZERO,
    );
    if let Some(balance) = balance {
        insert(&mut sim, entity, balance);
    }
    (sim, entity)
}

/// Height of the pelvis, metres.
fn height(sim: &Sim, entity: Entity) -> f32 {
    sim.get::<RagdollState>(entity).bones[0].place.position.y
}

#[test]
fn a_figure_stands_for_a_minute_by_the_torques_of_its_joints_and_falls_without() {
    let mut findings = Findings::new();
    let (mut sim, entity) = standing(None);
    sim.seconds(4.0);
    findings.at_most("without, pelvis, m", height(&sim, entity), 0.5);
    let (mut sim, entity) = standing(Some(RagdollBalance::default()));
    sim.seconds(60.0);
    findings.at_least("with, pelvis, m", height(&sim, entity), 0.85);
    let state = sim.get::<BalanceState>(entity);
    findings.holds("stands", state.stands);
    findings.at_least("capture point inside its feet, m", state.margin, 0.05);
    let (momentum, mass) = momentum(&sim, entity);
    findings.at_most("sways, m/s", momentum.length() / mass, 0.05);
}

#[test]
fn one_small_push_is_taken_without_help_and_ten_of_thirty_newton_seconds_with_all_help() {
    let mut findings = Findings::new();
    for (assist, push, times) in [(0.0, 8.0, 1), (1.0, 30.0, 10)] {
        let (mut sim, entity) = standing(Some(RagdollBalance {
            assist,
            ..default()
        }));
        sim.seconds(2.0);
        for n in 0..times {
            let angle = 2.4 * (n + 1) as f32;
            let (sin, cos) = ops::sin_cos(angle);
            let chest = sim.position(entity) + Vec3::Y * 1.25;
            let mut commands = sim.app.world_mut().commands();
            commands.hit(entity, chest, Vec3::new(cos, 0.0, sin) * push);
            sim.app.world_mut().flush();
            sim.seconds(3.0);
        }
        let what = format!("assist {assist}, {times} times {push} N·s: pelvis, m");
        findings.at_least(what, height(&sim, entity), 0.8);
    }
}

#[test]
fn standing_turns_off_in_the_air_and_when_it_has_fallen() {
    let (mut sim, entity) = standing(Some(RagdollBalance::default()));
    sim.seconds(0.5);
    let mut findings = Findings::new();
    findings.holds("stands", sim.get::<BalanceState>(entity).stands);
    ask(&mut sim, entity, RagdollMode::Limp);
    sim.seconds(3.0);
    findings.holds("limp", !sim.get::<BalanceState>(entity).stands);
    ask(&mut sim, entity, RagdollMode::Powered);
    sim.seconds(0.2);
    findings.holds("lies", !sim.get::<BalanceState>(entity).stands);
    let high = Vec3::Y * 20.0;
    let entity = human(
        &mut sim,
        HumanoidDetail::Bodies23,
        RagdollMode::Powered,
        high,
    );
    insert(&mut sim, entity, RagdollBalance::default());
    sim.seconds(0.5);
    findings.holds("in the air", !sim.get::<BalanceState>(entity).stands);
    sim.app
        .world_mut()
        .entity_mut(entity)
        .remove::<RagdollBalance>();
    let left = sim.app.world().get::<BalanceState>(entity);
    findings.holds("nothing is left of it", left.is_none());
}
