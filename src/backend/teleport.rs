//! Tells the backend of a jump, which it would take for a very fast motion.

use bevy::prelude::*;
use bevy_rapier3d::{prelude::*, rapier::math::Pose};

use crate::{EmbodySystems, Teleported};

/// Bodies that were teleported since the last tick.
#[derive(Resource, Default)]
struct Pending(Vec<Entity>);

pub(crate) fn add_teleports(app: &mut App) {
    app.init_resource::<Pending>()
        .add_observer(|event: On<Teleported>, mut pending: ResMut<Pending>| {
            pending.0.push(event.entity);
        })
        .add_systems(
            FixedPostUpdate,
            place_teleported
                .after(PhysicsSet::SyncBackend)
                .before(EmbodySystems::Drive)
                .run_if(|pending: Res<Pending>| !pending.0.is_empty()),
        );
}

/// Puts bodies where they are, in place of sending them there.
fn place_teleported(
    mut pending: ResMut<Pending>,
    bodies: Query<(
        &RapierRigidBodyHandle,
        &RapierContextEntityLink,
        &GlobalTransform,
    )>,
    mut sets: Query<&mut RapierRigidBodySet>,
) {
    for entity in pending.0.drain(..) {
        if let Ok((handle, link, pose)) = bodies.get(entity)
            && let Ok(mut set) = sets.get_mut(link.0)
            && let Some(body) = set.bodies.get_mut(handle.0)
        {
            let pose = pose.compute_transform();
            body.set_position(Pose::from_parts(pose.translation, pose.rotation), true);
        }
    }
}
