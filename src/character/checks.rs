//! Tells about components that cannot work on or around a character: each bad value once.

use bevy::{ecs::entity::EntityHashSet, prelude::*};
use bevy_rapier3d::prelude::{RigidBody, Sensor};

use super::{
    config::Character,
    surface::{CharacterUp, SurfaceGrip, SurfaceVelocity, UpDirection, WaterVolume},
};
use crate::backend::checks::{EmbodyDiagnosis, EmbodyProblem};

/// Reports characters that Rapier itself moves, or lets others pass through.
pub(super) fn check_bodies(
    bodies: Query<(Entity, &RigidBody), (With<Character>, Changed<RigidBody>)>,
    sensors: Query<Entity, (With<Character>, Added<Sensor>)>,
    mut diagnosis: Option<ResMut<EmbodyDiagnosis>>,
) {
    let Some(diagnosis) = &mut diagnosis else {
        return;
    };
    for (entity, body) in &bodies {
        if *body != RigidBody::KinematicPositionBased {
            diagnosis.report(EmbodyProblem::MovedTwice {
                entity,
                body: *body,
            });
        }
    }
    for entity in &sensors {
        diagnosis.report(EmbodyProblem::SensorCharacter { entity });
    }
}

/// Warns, once, of components that are left out because of their values.
pub(super) fn check_surroundings(
    ups: Query<(Entity, &CharacterUp), Changed<CharacterUp>>,
    belts: Query<(Entity, &SurfaceVelocity), Changed<SurfaceVelocity>>,
    grips: Query<(Entity, &SurfaceGrip), Changed<SurfaceGrip>>,
    waters: Query<(Entity, &WaterVolume), Changed<WaterVolume>>,
    mut told: Local<[EntityHashSet; 5]>,
) {
    let [told_up, told_rate, told_belt, told_grip, told_water] = &mut *told;
    for (entity, up) in &ups {
        let (bad, need) = match up.direction {
            UpDirection::World(v) | UpDirection::Of(_, v) => (
                !(v.is_finite() && v.length_squared() > 0.0),
                "a direction; up stays as it is",
            ),
            UpDirection::AwayFrom(point) => {
                (!point.is_finite(), "a finite point; up stays as it is")
            }
            UpDirection::AgainstGravity | UpDirection::Ground => (false, ""),
        };
        warn_once(
            told_up,
            entity,
            bad,
            "CharacterUp::direction",
            &up.direction,
            need,
        );
        let bad = !(up.turn_rate >= 0.0);
        let need = "a number of at least 0; up stays as it is";
        warn_once(
            told_rate,
            entity,
            bad,
            "CharacterUp::turn_rate",
            &up.turn_rate,
            need,
        );
    }
    for (entity, belt) in &belts {
        let bad = !(belt.linear.is_finite() && belt.angular.is_finite());
        let need = "finite numbers; it is taken as standing still";
        warn_once(told_belt, entity, bad, "SurfaceVelocity", belt, need);
    }
    for (entity, grip) in &grips {
        let bad = !(grip.0 >= 0.0 && grip.0.is_finite());
        let need = if grip.0 < 0.0 {
            "a finite number of at least 0; it is taken as 0"
        } else {
            "a finite number of at least 0; it is taken as 1"
        };
        warn_once(told_grip, entity, bad, "SurfaceGrip", &grip.0, need);
    }
    for (entity, water) in &waters {
        let bad = !water.flow.is_finite();
        let need = "finite numbers; it is taken as standing still";
        warn_once(
            told_water,
            entity,
            bad,
            "WaterVolume::flow",
            &water.flow,
            need,
        );
    }
}

/// Warns when a value that was good, or new, is bad.
fn warn_once(
    told: &mut EntityHashSet,
    entity: Entity,
    bad: bool,
    field: &str,
    value: &dyn core::fmt::Debug,
    need: &str,
) {
    if !bad {
        told.remove(&entity);
    } else if told.insert(entity) {
        tracing::warn!("{entity}: {field} is {value:?}, but needs {need}");
    }
}
