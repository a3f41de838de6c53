//! Before the physics world takes over changes: configs are checked, masses set.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{AdditionalMassProperties, ColliderMassProperties, MassProperties};

use super::{
    config::{Vehicle, VehicleMass},
    report::VehicleReport,
    validate,
    wheel::{Wheel, WheelOf, Wheels},
};
use crate::validate::{Problem, warn_bad};

/// Checks what is new or changed.
pub(super) fn check_configs(
    changed_wheels: Query<&WheelOf, Or<(Changed<Wheel>, Changed<WheelOf>)>>,
    changed: Query<Entity, Or<(Changed<Vehicle>, Changed<Wheels>, Changed<VehicleMass>)>>,
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
    stirred.extend(changed_wheels.iter().map(|of| of.0));
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
