//! The systems of the tick between synchronisation and step: solve every vehicle against the same
//! unchanging world, then write all forces in the order of the vehicles, so that neither threads nor
//! the order of spawning matter.

use arrayvec::ArrayVec;
use bevy::{ecs::batching::BatchingStrategy, prelude::*, utils::Parallel};
use bevy_rapier3d::prelude::CollisionGroups;

use super::{
    assists::{AntiLockBrakes, HillHold, LeanControl, StabilityControl, TractionControl},
    config::Vehicle,
    intent::VehicleIntent,
    output::VehicleTelemetry,
    report::{GroundPush, VehicleReport},
    state::VehicleState,
    tick::{self, Assists, Scratch, Surfaces, Surroundings, WheelList},
    wheel::{ProbeInterval, Wheel, Wheels},
};
use crate::backend::{
    handles::{RapierColliderHandle, RapierContextEntityLink, RapierRigidBodyHandle},
    world::PhysicsWorlds,
    world_mut::PhysicsWorldsMut,
};

/// Lets wheels find colliders that were spawned since the last step.
pub(super) fn admit_new(
    mut worlds: PhysicsWorldsMut,
    new: Query<(&RapierColliderHandle, &RapierContextEntityLink), Added<RapierColliderHandle>>,
) {
    worlds.admit(new.iter());
}

/// Solves every vehicle that has anything to do.
pub(super) fn solve_vehicles(
    time: Res<Time>,
    worlds: PhysicsWorlds,
    surfaces: Surfaces,
    wheels: Query<(Entity, &Wheel)>,
    mut vehicles: Query<(
        (Entity, &Vehicle, &VehicleIntent, &Wheels),
        (
            &RapierContextEntityLink,
            &RapierRigidBodyHandle,
            Option<&CollisionGroups>,
        ),
        (
            Option<&AntiLockBrakes>,
            Option<&TractionControl>,
            Option<&StabilityControl>,
            Option<&HillHold>,
            Option<&LeanControl>,
            Option<&ProbeInterval>,
        ),
        &mut VehicleState,
        &mut VehicleTelemetry,
        &mut VehicleReport,
    )>,
    scratch: Local<Parallel<Scratch>>,
) {
    let dt = time.delta_secs();
    if !(dt > 0.0) {
        return;
    }
    let batches = BatchingStrategy::new().batches_per_thread(4);
    vehicles.par_iter_mut().batching_strategy(batches).for_each(
        |(
            (entity, config, intent, tied),
            (link, handle, groups),
            (abs, traction, stability, hill, lean, interval),
            mut state,
            mut telemetry,
            mut report,
        )| {
            let report = report.bypass_change_detection();
            if !report.valid {
                report.clear();
                report.bare = true;
                telemetry.set_if_neq(VehicleTelemetry::default());
                return;
            }
            let Some(view) = worlds.of(link).filter(|view| view.active) else {
                report.clear();
                return;
            };
            if tick::rests(
                &view,
                handle,
                dt,
                intent,
                state.bypass_change_detection(),
                report,
            ) {
                report.clear();
                report.asleep = true;
                if !telemetry.asleep {
                    telemetry.asleep = true;
                }
                return;
            }
            let mut list = WheelList::new();
            let mut entities = ArrayVec::new();
            for (wheel, config) in wheels.iter_many(tied.iter()).take(Wheel::MOST) {
                list.push(config);
                entities.push(wheel);
            }
            if list.is_empty() {
                report.clear();
                report.bare = true;
                return;
            }
            let surroundings = Surroundings {
                view,
                dt,
                entity,
                handle,
                groups: groups.copied(),
                surfaces: &surfaces,
                wheels: list,
                wheel_entities: entities,
                probe_every: interval.map_or(1, |i| i.ticks),
                assists: Assists {
                    abs: abs.filter(|a| a.is_sound()),
                    traction: traction.filter(|a| a.is_sound()),
                    stability: stability.filter(|a| a.is_sound()),
                    hill: hill.filter(|a| a.is_sound()),
                    lean: lean.filter(|a| a.is_sound()),
                },
            };
            scratch.scope(|scratch| {
                tick::run(
                    &surroundings,
                    config,
                    intent,
                    state.bypass_change_detection(),
                    telemetry.bypass_change_detection(),
                    report,
                    scratch,
                );
            });
            if report.bare {
                telemetry.set_if_neq(VehicleTelemetry::default());
            }
            if report.solved {
                state.set_changed();
                telemetry.set_changed();
            }
        },
    );
}

/// What acts on the physics world.
type Acting = (With<Vehicle>, With<Wheels>);

/// Writes what the ticks decided.
pub(super) fn apply_forces(
    mut worlds: PhysicsWorldsMut,
    mut vehicles: Query<
        (
            Entity,
            &RapierContextEntityLink,
            &RapierRigidBodyHandle,
            &mut VehicleReport,
        ),
        Acting,
    >,
    mut pushes: Local<Vec<(Entity, RapierContextEntityLink, GroundPush)>>,
) {
    pushes.clear();
    pushes.reserve(64);
    for (entity, link, handle, mut report) in &mut vehicles {
        let report = report.bypass_change_detection();
        if core::mem::take(&mut report.wake) {
            worlds.wake_body(link, handle);
        }
        if !report.solved {
            continue;
        }
        worlds.force_body(link, handle, report.force, report.torque, true);
        pushes.extend(report.pushes.iter().map(|p| (entity, *link, *p)));
    }
    // Stable: one vehicle's pushes keep the order of its wheels.
    pushes.sort_by_key(|(entity, ..)| *entity);
    for (_, link, p) in pushes.iter() {
        worlds.push_body(link, p.body, Vec3::ZERO, p.force, p.point, p.wake);
    }
}

/// Lets the body of what has just lost its wheels, or is no vehicle any more, fall.
pub(super) fn let_fall<C: Component>(
    lost: On<Remove, C>,
    bodies: Query<(&RapierContextEntityLink, &RapierRigidBodyHandle), With<VehicleReport>>,
    mut worlds: PhysicsWorldsMut,
) {
    if let Ok((link, handle)) = bodies.get(lost.entity) {
        worlds.wake_body(link, handle);
    }
}

/// Takes the tick's forces off the bodies again.
pub(super) fn end_forces(mut worlds: PhysicsWorldsMut) {
    worlds.end_forces();
}
