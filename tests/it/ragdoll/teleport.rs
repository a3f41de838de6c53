//! A figure that is put elsewhere is there at once, with all its bones, as fast as it was.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use super::support::*;

#[test]
fn a_teleported_figure_is_there_in_whatever_mode_with_the_velocity_it_had() {
    let mut findings = Findings::new();
    for hz in RATES {
        for mode in [
            RagdollMode::Limp,
            RagdollMode::HitBoxes,
            RagdollMode::Powered,
            RagdollMode::Frozen,
            RagdollMode::Animated,
        ] {
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, mode, Vec3::Y * 30.0);
            sim.seconds(0.3);
            let before = sim.get::<RagdollState>(entity);
            let way = Vec3::new(50.0, 3.0, -20.0);
            edit::<Transform>(&mut sim, entity, |t| t.translation += way);
            sim.app.world_mut().trigger(Teleported { entity });
            sim.ticks(1);
            let after = sim.get::<RagdollState>(entity);
            let dt = sim.dt();
            for (a, b) in before.bones.iter().zip(&after.bones) {
                let what = format!("{hz} Hz, {mode:?}");
                let fastest = a.velocity.length().max(b.velocity.length());
                let off = (a.place.position + way).distance(b.place.position);
                findings.at_most(format!("{what}: off, m"), off, fastest * dt + 1.0e-3);
                let change = a.velocity.distance(b.velocity);
                findings.at_most(format!("{what}: change, m/s"), change, G * dt + 0.05);
            }
        }
    }
}

#[test]
fn a_figure_that_is_turned_as_it_is_put_elsewhere_turns_about_its_own_place() {
    let mut findings = Findings::new();
    for hz in RATES {
        for mode in [
            RagdollMode::Limp,
            RagdollMode::HitBoxes,
            RagdollMode::Powered,
            RagdollMode::Frozen,
            RagdollMode::Keyframed,
        ] {
            let (mut sim, entity) = alone(hz, HumanoidDetail::Bodies15, mode, Vec3::Y * 30.0);
            sim.seconds(0.3);
            let before = sim.get::<RagdollState>(entity);
            let to = Transform::from_xyz(40.0, 12.0, -9.0).with_rotation(Quat::from_euler(
                EulerRot::YXZ,
                2.3,
                0.4,
                -0.2,
            ));
            insert(&mut sim, entity, to);
            sim.app.world_mut().trigger(Teleported { entity });
            sim.ticks(1);
            let after = sim.get::<RagdollState>(entity);
            let dt = sim.dt();
            let what = format!("{hz} Hz, {mode:?}");
            let from = before.figure;
            let turn = to.rotation * from.rotation.inverse();
            for (a, b) in before.bones.iter().zip(&after.bones) {
                let expected = to.translation + turn * (a.place.position - from.position);
                let fastest = a.velocity.length().max(b.velocity.length());
                let off = expected.distance(b.place.position);
                findings.at_most(format!("{what}: off, m"), off, fastest * dt + 1.0e-3);
                let off = (turn * a.place.rotation).angle_between(b.place.rotation);
                let spin = a.spin.length().max(b.spin.length());
                findings.at_most(format!("{what}: turned, rad"), off, spin * dt + 2.0e-3);
                let change = a.velocity.distance(b.velocity);
                findings.at_most(format!("{what}: change, m/s"), change, G * dt + 0.05);
            }
            findings.at_most(
                format!("{what}: gap, m"),
                worst(&sim, entity, |o| o.gap),
                0.002,
            );
        }
    }
}

#[test]
fn a_figure_that_goes_with_its_root_is_put_where_it_was_told_to_be() {
    let mut findings = Findings::new();
    for hz in RATES {
        let (mut sim, entity) = above_ground(hz, HumanoidDetail::Bodies15, RagdollMode::Limp, 0.2);
        insert(&mut sim, entity, FollowRoot);
        // Until it lies, and its entity beside where it was spawned.
        sim.seconds(5.0);
        let before = sim.get::<RagdollState>(entity);
        let went = sim.get::<Transform>(entity);
        let to = went.translation + Vec3::new(4.0, 0.0, -3.0);
        let turn = Quat::from_rotation_y(1.9);
        let to = Transform::from_translation(to).with_rotation(turn * went.rotation);
        insert(&mut sim, entity, to);
        sim.app.world_mut().trigger(Teleported { entity });
        sim.ticks(1);
        let after = sim.get::<RagdollState>(entity);
        for (a, b) in before.bones.iter().zip(&after.bones) {
            let way = a.place.position - went.translation;
            let off = (to.translation + turn * way).distance(b.place.position);
            // It wakes, and its contacts are found anew.
            let slack = a.velocity.length().max(b.velocity.length()).max(0.2) * sim.dt();
            findings.at_most(format!("{hz} Hz: bone off, m"), off, slack + 2.0e-3);
        }
        let now = sim.get::<Transform>(entity);
        let off = now.translation.distance(to.translation);
        findings.at_most(format!("{hz} Hz: figure off, m"), off, 0.02);
        let off = now.rotation.angle_between(to.rotation);
        findings.at_most(format!("{hz} Hz: figure turned, rad"), off, 0.02);
    }
}
