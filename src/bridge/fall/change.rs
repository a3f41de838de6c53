//! From one phase to the next.

use bevy::prelude::*;
use bevy_rapier3d::prelude::RigidBodyDisabled;

use super::{
    BecomeRagdoll, BodyPhase, CharacterRagdoll, CharacterRagdollState, FellDown, OwnBones, Recover,
    StoodUp,
};
use crate::{
    backend::{handles::RapierContextEntityLink, world::PhysicsWorlds},
    character::{Character, CharacterIgnores, CharacterState},
    ragdoll::{
        BoneOf, GetUp, RagdollIntent, RagdollMode, RagdollPlan, RagdollState, RagdollUp,
        find_place, is_cut,
    },
};

/// How far above its floor room for a capsule is looked for, metres: what is lower can be stepped onto.
const CLEARANCE: f32 = 0.1;

pub(super) fn note_fall(
    asked: On<BecomeRagdoll>,
    mut characters: Query<&mut CharacterRagdollState>,
) {
    match characters.get_mut(asked.entity) {
        Ok(mut state) => (state.falls, state.rises) = (true, false),
        Err(_) => warn_missing(asked.entity),
    }
}

pub(super) fn note_rise(asked: On<Recover>, mut characters: Query<&mut CharacterRagdollState>) {
    match characters.get_mut(asked.entity) {
        Ok(mut state) => state.rises = state.phase != BodyPhase::Upright || state.falls,
        Err(_) => warn_missing(asked.entity),
    }
}

fn warn_missing(entity: Entity) {
    tracing::warn!("{entity}: it was told to fall or to get up, but has no CharacterRagdoll");
}

/// Who stands does not begin as whatever an intent is that nobody wrote.
pub(super) fn stand(
    mut new: Query<
        (
            &CharacterRagdoll,
            &CharacterRagdollState,
            &mut RagdollIntent,
        ),
        Or<(Added<CharacterRagdoll>, Added<RagdollIntent>)>,
    >,
) {
    for (config, state, mut intent) in &mut new {
        if state.phase == BodyPhase::Upright && intent.mode != config.upright {
            intent.mode = config.upright;
        }
    }
}

type Fallen<'a> = (
    Entity,
    &'a CharacterRagdoll,
    &'a mut CharacterRagdollState,
    (&'a Character, &'a mut CharacterState),
    (
        &'a mut RagdollIntent,
        &'a mut RagdollState,
        &'a RagdollPlan,
        &'a mut RagdollUp,
        Option<&'a GetUp>,
    ),
    &'a mut Transform,
    &'a RapierContextEntityLink,
    (Has<RigidBodyDisabled>, &'a mut OwnBones),
);

/// Takes every character to its next phase.
pub(super) fn change(
    mut commands: Commands,
    worlds: PhysicsWorlds,
    mut characters: Query<Fallen>,
    bones: Query<&BoneOf>,
) {
    for (
        entity,
        config,
        mut state,
        (character, mut moves),
        ragdoll,
        mut transform,
        link,
        (off, mut own_bones),
    ) in &mut characters
    {
        let (mut intent, mut figure, plan, mut known_up, clips) = ragdoll;
        let up = moves.up;
        known_up.set_if_neq(RagdollUp(up));
        if plan.bones.is_empty() {
            continue;
        }
        if state.falls {
            state.falls = false;
            if state.phase != BodyPhase::Down && state.phase != BodyPhase::Waiting {
                // The bones came a tick behind the capsule: what it gained since, they get now.
                let gained = moves.world_velocity() - state.velocity;
                for bone in &mut figure.bones {
                    bone.velocity += gained;
                }
                intent.mode = config.down;
                commands.trigger(FellDown { entity });
            }
            state.phase = BodyPhase::Down;
            figure.still = 0.0;
            if !off {
                commands.entity(entity).insert(RigidBodyDisabled);
                own_bones.disabled = true;
            }
            continue;
        }
        // By the phase, not by its changes: it may have been restored.
        let lies = matches!(state.phase, BodyPhase::Down | BodyPhase::Waiting);
        if lies && !off {
            commands.entity(entity).insert(RigidBodyDisabled);
            own_bones.disabled = true;
        } else if !lies && own_bones.disabled {
            own_bones.disabled = false;
            commands.entity(entity).remove::<RigidBodyDisabled>();
        }
        match state.phase {
            BodyPhase::Upright => {
                let velocity = moves.world_velocity();
                state.bypass_change_detection().velocity = velocity;
            }
            BodyPhase::Down | BodyPhase::Waiting => {
                let by_itself = config
                    .get_up_after
                    .is_some_and(|t| t >= 0.0 && figure.still >= t);
                if !state.rises && !by_itself {
                    continue;
                }
                let own = |other: Entity| {
                    other == entity || bones.get(other).is_ok_and(|of| of.0 == entity)
                };
                let place = find_place(plan, &figure, clips, &worlds, link, up, own);
                let radius = character.shape.radius();
                let free = place.filter(|place| {
                    let foot = place.position + up * (CLEARANCE + radius);
                    let top = place.position
                        + up * (character.shape.height() - radius).max(CLEARANCE + radius);
                    let room = |view: crate::backend::world::PhysicsView| {
                        view.has_room(foot, top, radius * 0.9, own)
                    };
                    worlds.of(link).is_some_and(room)
                });
                let Some(place) = free else {
                    if state.phase != BodyPhase::Waiting {
                        state.phase = BodyPhase::Waiting;
                    }
                    continue;
                };
                transform.translation = place.position;
                transform.rotation = place.rotation;
                let (mut mass, mut momentum) = (0.0, Vec3::ZERO);
                for (i, (bone, known)) in plan.bones.iter().zip(&figure.bones).enumerate() {
                    if !is_cut(plan, &figure, i) {
                        mass += bone.mass;
                        momentum += known.velocity * bone.mass;
                    }
                }
                *moves = CharacterState {
                    velocity: (momentum / mass).reject_from_normalized(up),
                    up,
                    ..default()
                };
                intent.mode = RagdollMode::GettingUp;
                state.phase = BodyPhase::Rising;
                state.rises = false;
                state.velocity = moves.velocity;
                if own_bones.disabled {
                    own_bones.disabled = false;
                    commands.entity(entity).remove::<RigidBodyDisabled>();
                }
            }
            BodyPhase::Rising => {
                state.velocity = moves.world_velocity();
                if figure.mode == RagdollMode::GettingUp && figure.age >= figure.rise_time {
                    state.phase = BodyPhase::Upright;
                    state.rises = false;
                    intent.mode = config.upright;
                    commands.trigger(StoodUp { entity });
                }
            }
        }
    }
}

/// Who cannot fall any more is on its feet, with bones that are nobody's.
pub(super) fn forget(
    removed: On<Remove, CharacterRagdoll>,
    mut commands: Commands,
    mut characters: Query<(&OwnBones, &mut CharacterIgnores)>,
) {
    let entity = removed.entity;
    let Ok((own, mut ignores)) = characters.get_mut(entity) else {
        return;
    };
    own.release(&mut ignores);
    let Ok(mut entity) = commands.get_entity(entity) else {
        return;
    };
    if own.disabled {
        entity.try_remove::<RigidBodyDisabled>();
    }
    entity.try_remove::<(CharacterRagdollState, OwnBones)>();
}
