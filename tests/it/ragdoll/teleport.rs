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
