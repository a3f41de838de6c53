//! Before the physics world takes over changes: configs are checked, masses set.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{AdditionalMassProperties, ColliderMassProperties, MassProperties};

use super::{
    assists::{AntiLockBrakes, HillHold, LeanControl, StabilityControl, TractionControl},
    config::{Vehicle, VehicleMass},
    report::VehicleReport,
    state::VehicleState,
    surface::{RoadVelocity, SurfaceFriction},
    validate,
    wheel::{Wheel, WheelOf, Wheels},
};
use crate::validate::{Problem, warn_bad};

/// Checks what is new or changed.
pub(super) fn check_configs(
    changed_wheels: Query<(Entity, &WheelOf), Or<(Changed<Wheel>, Changed<WheelOf>)>>,
    changed: Query<Entity, Or<(Changed<Vehicle>, Changed<Wheels>, Changed<VehicleMass>)>>,
    mut bare: RemovedComponents<Wheel>,
    ties: Query<&WheelOf>,
    loose: Query<Entity, (Added<Wheel>, Without<WheelOf>)>,
    mut vehicles: Query<(
        &Vehicle,
        Option<&VehicleMass>,
        Option<&Wheels>,
        &mut VehicleReport,
    )>,
    wheels: Query<&Wheel>,
    mut stirred: Local<Vec<Entity>>,
) {
    stirred.clear();
    for wheel in &loose {
        tracing::warn!("{wheel}: Wheel needs a WheelOf that names its vehicle; it does nothing");
    }
    for (wheel, of) in &changed_wheels {
        if vehicles.contains(of.0) {
            stirred.push(of.0);
        } else {
            let it = of.0;
            tracing::warn!("{wheel}: WheelOf is {it}, but needs a Vehicle; the wheel does nothing");
        }
    }
    stirred.extend(
        bare.read()
            .filter_map(|wheel| Some(ties.get(wheel).ok()?.0)),
    );
    stirred.extend(changed.iter());
    stirred.sort_unstable();
    stirred.dedup();
    for &entity in stirred.iter() {
        let Ok((config, mass, tied, mut report)) = vehicles.get_mut(entity) else {
            continue;
        };
        let report = report.bypass_change_detection();
        report.changed = true;
        report.reshare = true;
        report.valid = true;
        let mut problems = vec![];
        problems.extend(validate::vehicle(config).map(|p| (entity, p)));
        problems.extend(mass.and_then(validate::mass).map(|p| (entity, p)));
        let mut count = 0;
        for wheel in tied.iter().flat_map(|t| t.iter()) {
            count += 1;
            // A wheel of the relationship without a config would shift all that follow.
            let found = match wheels.get(wheel) {
                Ok(config) => validate::wheel(config),
                Err(_) => Some(validate::absent("Wheel")),
            };
            problems.extend(found.map(|p| (wheel, p)));
        }
        if count > Wheel::MOST {
            problems.push((entity, validate::too_many(count)));
        }
        if count == 0 {
            report.valid = false;
        }
        if let Some((who, Problem { field, value, need })) = problems.first() {
            report.valid = false;
            report.wake = true;
            let then = "the vehicle has no wheels until then";
            warn_bad(*who, field, value, need, then);
        }
    }
}

/// Gives bodies the masses asked for by number.
pub(super) fn set_masses(
    mut commands: Commands,
    vehicles: Query<(Entity, &VehicleMass), Changed<VehicleMass>>,
) {
    for (entity, mass) in &vehicles {
        if validate::mass(mass).is_some() {
            continue;
        }
        commands.entity(entity).insert((
            // The collider's own mass would come on top.
            ColliderMassProperties::Density(0.0),
            AdditionalMassProperties::MassProperties(MassProperties {
                local_center_of_mass: mass.center,
                mass: mass.mass,
                principal_inertia_local_frame: Quat::IDENTITY,
                principal_inertia: mass.inertia,
            }),
        ));
    }
}

/// Gives bodies the masses of their colliders again.
pub(super) fn unset_masses(
    mut commands: Commands,
    mut lost: RemovedComponents<VehicleMass>,
    vehicles: Query<(), (With<Vehicle>, Without<VehicleMass>)>,
) {
    for entity in lost.read() {
        if vehicles.contains(entity) {
            commands
                .entity(entity)
                .remove::<(ColliderMassProperties, AdditionalMassProperties)>();
        }
    }
}

/// Names helpers with values that they cannot work with.
pub(super) fn check_helpers(
    abs: Query<(Entity, &AntiLockBrakes), Changed<AntiLockBrakes>>,
    traction: Query<(Entity, &TractionControl), Changed<TractionControl>>,
    stability: Query<(Entity, &StabilityControl), Changed<StabilityControl>>,
    hill: Query<(Entity, &HillHold), Changed<HillHold>>,
    lean: Query<(Entity, &LeanControl), Changed<LeanControl>>,
) {
    for (entity, helper) in abs.iter().filter(|(_, h)| !h.is_sound()) {
        refuse(
            entity,
            helper,
            "slip above 0 and at most 1, least_speed at least 0",
        );
    }
    for (entity, helper) in traction.iter().filter(|(_, h)| !h.is_sound()) {
        refuse(entity, helper, "a finite slip above 0");
    }
    for (entity, helper) in stability.iter().filter(|(_, h)| !h.is_sound()) {
        refuse(entity, helper, "finite numbers of at least 0");
    }
    for (entity, helper) in hill.iter().filter(|(_, h)| !h.is_sound()) {
        refuse(entity, helper, "a finite time of at least 0");
    }
    for (entity, helper) in lean.iter().filter(|(_, h)| !h.is_sound()) {
        refuse(
            entity,
            helper,
            "a frequency above 0, damping at least 0, max_lean from 0 to below π/2",
        );
    }
}

fn refuse(entity: Entity, value: &dyn core::fmt::Debug, need: &str) {
    tracing::warn!("{entity}: {value:?} needs {need}; it does nothing until then");
}

/// Names surfaces with values that mean nothing, and wakes who sleeps on one that changed.
pub(super) fn check_surfaces(
    friction: Query<(Entity, &SurfaceFriction), Changed<SurfaceFriction>>,
    roads: Query<(Entity, &RoadVelocity), Changed<RoadVelocity>>,
    mut plain: RemovedComponents<SurfaceFriction>,
    mut still: RemovedComponents<RoadVelocity>,
    mut vehicles: Query<(&VehicleState, &mut VehicleReport)>,
    mut changed: Local<Vec<Entity>>,
) {
    changed.clear();
    for (entity, surface) in &friction {
        if !surface.is_sound() {
            refuse(entity, surface, "finite numbers of at least 0");
        }
        changed.push(entity);
    }
    for (entity, road) in &roads {
        if !road.is_sound() {
            refuse(entity, road, "finite numbers");
        }
        changed.push(entity);
    }
    changed.extend(plain.read().chain(still.read()));
    if changed.is_empty() {
        return;
    }
    changed.sort_unstable();
    for (state, mut report) in &mut vehicles {
        let stands_on = |ground| changed.binary_search(&ground).is_ok();
        if state.wheels.iter().any(|w| w.ground.is_some_and(stands_on)) {
            report.bypass_change_detection().changed = true;
        }
    }
}
