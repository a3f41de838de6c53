//! After the physics step: events, in the order of the entities.

use bevy::prelude::*;

use super::{
    events::{Crushed, Hit, Landed, LeftGround, StanceChanged, Stepped},
    report::CharacterReport,
};

/// Triggers what happened in the tick.
pub(super) fn trigger_events(
    mut commands: Commands,
    mut characters: Query<(Entity, &mut CharacterReport)>,
    mut happened: Local<Vec<Entity>>,
) {
    happened.clear();
    // Room for more than a usual tick needs.
    happened.reserve(64);
    happened.extend(
        characters
            .iter()
            .filter(|(_, report)| report.solved && report.tells())
            .map(|(entity, _)| entity),
    );
    happened.sort_unstable();
    for entity in happened.iter().copied() {
        let Ok((_, mut report)) = characters.get_mut(entity) else {
            continue;
        };
        let report = report.bypass_change_detection();
        let happened = core::mem::take(&mut report.happened);
        if happened.left {
            commands.trigger(LeftGround {
                entity,
                ground: report.left,
                jumped: report.jumped,
            });
        }
        if let Some((ground, speed, air_time)) = happened.landed {
            commands.trigger(Landed {
                entity,
                ground,
                speed,
                air_time,
            });
        }
        if let Some(height) = happened.stepped {
            commands.trigger(Stepped { entity, height });
        }
        if let Some((stance, from, to)) = happened.stance {
            commands.trigger(StanceChanged {
                entity,
                stance,
                from,
                to,
            });
        }
        for hit in report.hits.drain(..) {
            commands.trigger(Hit {
                entity,
                other: hit.other,
                point: hit.point,
                normal: hit.normal,
                speed: hit.speed,
                impulse: hit.impulse,
            });
        }
        if let Some((by, against, depth)) = happened.crushed {
            commands.trigger(Crushed {
                entity,
                by,
                against,
                depth,
            });
        }
    }
}
