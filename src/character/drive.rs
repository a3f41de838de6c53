//! The systems of the tick between synchronisation and step: bring the search tree up to date,
//! solve every character against it, then write all results in a fixed order.
//!
//! Characters are solved in parallel against the same unchanging world and each other's published
//! wishes, and every effect is collected first, so neither threads nor order matter.

use bevy::{ecs::batching::BatchingStrategy, prelude::*, utils::Parallel};
use bevy_rapier3d::prelude::{Collider, CollisionGroups};

use super::{
    body::CharacterBody,
    config::Character,
    intent::CharacterIntent,
    motor::CharacterMotor,
    output::{CharacterContacts, CharacterSnapshot},
    report::{BodyImpulse, CharacterMemory, CharacterReport},
    solver::Scratch,
    state::CharacterState,
    surface::{
        CharacterFilter, CharacterIgnores, Ladder, NotPushable, SurfaceGrip, SurfaceVelocity,
        WaterVolume,
    },
    tick::{Surroundings, Tick, Volume},
};
use crate::backend::{
    activity::Activity,
    handles::{RapierColliderHandle, RapierContextEntityLink, RapierRigidBodyHandle},
    world::PhysicsWorlds,
    world_mut::PhysicsWorldsMut,
};

/// What a change to a collider that was made since the last tick looks like.
type Touched = Or<(
    Added<RapierColliderHandle>,
    Changed<GlobalTransform>,
    Changed<Collider>,
    Changed<CollisionGroups>,
    Changed<SurfaceVelocity>,
    Changed<SurfaceGrip>,
    Added<WaterVolume>,
    Added<Ladder>,
)>;

/// Brings the search tree up to the tick and marks where anything moves.
pub(super) fn refresh_world(
    time: Res<Time>,
    mut worlds: PhysicsWorldsMut,
    mut activity: ResMut<Activity>,
    touched: Query<
        (&RapierColliderHandle, &RapierContextEntityLink),
        (Touched, Without<Character>),
    >,
    own: Query<(), With<Character>>,
    moving: Query<(
        &CharacterSnapshot,
        &CharacterBody,
        &GlobalTransform,
        &RapierColliderHandle,
        &RapierContextEntityLink,
    )>,
) {
    let dt = time.delta_secs();
    activity.clear();
    worlds.refresh(
        dt,
        touched.iter(),
        |entity| own.contains(entity),
        &mut activity,
    );
    for (snapshot, body, pose, handle, link) in &moving {
        if snapshot.active
            && let Some(mover) = &body.mover
        {
            let middle = pose.translation() + pose.up() * mover.middle;
            let reach = Vec3::splat(mover.reach + snapshot.velocity.length() * dt + 0.1);
            activity.mark(middle - reach, middle + reach);
            worlds.look_ahead(handle, link, snapshot.velocity * dt);
        }
    }
}

/// Solves every character that has anything to do.
pub(super) fn solve_characters(
    time: Res<Time>,
    worlds: PhysicsWorlds,
    activity: Res<Activity>,
    surfaces: Query<(
        Option<&'static SurfaceVelocity>,
        Option<&'static SurfaceGrip>,
    )>,
    others: Query<&'static CharacterSnapshot>,
    walls: Query<(), With<NotPushable>>,
    volumes: Query<Volume>,
    mut characters: Query<(
        (Entity, Ref<Character>, &CharacterMotor, &CharacterIntent),
        (&RapierContextEntityLink, &RapierRigidBodyHandle),
        (
            Option<Ref<CollisionGroups>>,
            Option<Ref<CharacterFilter>>,
            Option<Ref<CharacterIgnores>>,
        ),
        &mut CharacterBody,
        &mut CharacterState,
        &mut CharacterContacts,
        (&mut CharacterReport, &mut CharacterMemory),
    )>,
    scratch: Local<Parallel<Scratch>>,
) {
    let dt = time.delta_secs();
    if !(dt > 0.0) {
        return;
    }
    // Costs differ from one character to the next: small batches even them out.
    let batches = BatchingStrategy::new().batches_per_thread(4);
    characters
        .par_iter_mut()
        .batching_strategy(batches)
        .for_each(
            |(
                (entity, config, motor, intent),
                (link, handle),
                (groups, filter, ignores),
                mut body,
                mut state,
                mut contacts,
                (mut report, mut memory),
            )| {
                let Some(view) = worlds.of(link) else { return };
                if !view.active {
                    return;
                }
                // A component that was taken away is a change as well.
                let filters = u8::from(groups.is_some())
                    | u8::from(filter.is_some()) << 1
                    | u8::from(ignores.is_some()) << 2;
                let settings_changed = config.is_changed()
                    || body.filters != filters
                    || groups.as_ref().is_some_and(Ref::is_changed)
                    || filter.as_ref().is_some_and(Ref::is_changed)
                    || ignores.as_ref().is_some_and(Ref::is_changed);
                if body.filters != filters {
                    body.bypass_change_detection().filters = filters;
                }
                let surroundings = Surroundings {
                    settings_changed,
                    entity,
                    view,
                    dt,
                    groups: groups.as_deref().copied().unwrap_or_default(),
                    filter: filter.as_deref(),
                    ignores: ignores.as_deref(),
                    activity: &activity,
                    surfaces: &surfaces,
                    others: &others,
                    walls: &walls,
                    volumes: &volumes,
                };
                let Some(tick) = Tick::begin(
                    &surroundings,
                    &config,
                    motor,
                    intent,
                    handle,
                    &mut body,
                    &mut state,
                    &mut contacts,
                    &mut report,
                    &mut memory,
                ) else {
                    return;
                };
                scratch.scope(|scratch| tick.run(scratch));
            },
        );
}

/// Writes what the ticks decided: impulses by order of character, then the characters' poses.
pub(super) fn apply_effects(
    mut worlds: PhysicsWorldsMut,
    mut characters: Query<(
        Entity,
        &RapierContextEntityLink,
        &RapierRigidBodyHandle,
        &mut CharacterReport,
    )>,
    mut impulses: Local<Vec<(Entity, u32, RapierContextEntityLink, BodyImpulse)>>,
) {
    impulses.clear();
    impulses.reserve(64);
    for (entity, link, handle, mut report) in &mut characters {
        if !report.solved {
            continue;
        }
        let report = report.bypass_change_detection();
        let numbered = (0..).zip(report.impulses.drain(..));
        impulses.extend(numbered.map(|(n, i)| (entity, n, *link, i)));
        if let Some(target) = report.target.take() {
            worlds.place_body(link, handle, target);
        }
    }
    // One character's impulses keep the order in which it met the bodies.
    impulses.sort_unstable_by_key(|(entity, n, ..)| (*entity, *n));
    for (.., link, i) in impulses.iter() {
        worlds.push_body(link, i.body, i.impulse, i.force, i.point, i.wake);
    }
}

/// Takes the tick's forces off the bodies again.
pub(super) fn end_forces(mut worlds: PhysicsWorldsMut) {
    worlds.end_forces();
}
