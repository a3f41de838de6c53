//! Mends the transforms of bodies below a turned parent.
//!
//! Rapier's plugin writes a body's pose back as a transform relative to its parent, but turns the
//! parent's scale where it should turn the body's position, so below any turned parent the child
//! lands somewhere else. Here the transform is computed again, from the body itself. Bodies without
//! a parent, and those that Rapier placed well, are left alone.

use bevy::{
    ecs::schedule::{InternedScheduleLabel, IntoScheduleConfigs},
    prelude::*,
};
use bevy_rapier3d::{
    plugin::{context::RapierContextEntityLink, systems},
    prelude::{
        PhysicsSet, RapierRigidBodyHandle, RapierRigidBodySet, RigidBody, RigidBodyDisabled,
    },
};

/// A transform that is farther off than this was not placed well, metres.
const OFF: f32 = 1.0e-4;

pub(super) fn add_mending(app: &mut App, schedule: InternedScheduleLabel) {
    app.add_systems(
        schedule,
        place_below_turned_parents
            .in_set(PhysicsSet::Writeback)
            .after(systems::writeback_rigid_bodies),
    );
}

/// A body that is the child of another entity.
type ChildBody = (With<RigidBody>, Without<RigidBodyDisabled>);

fn place_below_turned_parents(
    mut children: Query<
        (
            &RapierRigidBodyHandle,
            &RapierContextEntityLink,
            &ChildOf,
            &mut Transform,
        ),
        ChildBody,
    >,
    parents: Query<&GlobalTransform>,
    sets: Query<&RapierRigidBodySet>,
) {
    for (handle, link, child_of, mut transform) in &mut children {
        let Ok(parent) = parents.get(child_of.parent()) else {
            continue;
        };
        let (scale, rotation, translation) = parent.to_scale_rotation_translation();
        if rotation == Quat::IDENTITY {
            continue;
        }
        let Some(body) = sets
            .get(link.0)
            .ok()
            .and_then(|set| set.bodies.get(handle.0))
        else {
            continue;
        };
        let (pose, back) = (body.position(), rotation.inverse());
        let place = (back * (pose.translation - translation)) / scale;
        // Not what is not a number either: a parent scaled to nothing has no places.
        if place.is_finite() && transform.translation.distance(place) > OFF {
            transform.translation = place;
            transform.rotation = (back * pose.rotation).normalize();
        }
    }
}
