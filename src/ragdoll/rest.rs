//! Lying still: when a simulated figure counts as at rest, and freezing it then.

use bevy::prelude::*;

use super::{
    bone::{BoneOutput, Bones, RagdollBone},
    config::Ragdoll,
    intent::{RagdollIntent, RagdollMode},
    plan::RagdollPlan,
    sever::is_cut,
    state::{BoneBody, RagdollState},
};
use crate::backend::{
    handles::{RapierContextEntityLink, RapierRigidBodyHandle},
    joints::JointWorlds,
};

/// When a simulated figure counts as lying still.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct RagdollRest {
    /// The whole is not faster than this, as the root of its mean square speed by mass, metres per
    /// second, at least 0: a hand that trembles keeps nobody awake. Once it lies it moves again when it is
    /// twice as fast. The physics lets a figure that lies
    /// still fall asleep while no point of it is faster than four times this.
    pub speed: f32,
    /// For so long, seconds, at least 0.
    pub time: f32,
    /// A limp figure is frozen when it has lain still for so long, seconds; `None` never. It thaws when
    /// it is hit or asked for another mode.
    pub freeze_after: Option<f32>,
}

impl Default for RagdollRest {
    fn default() -> Self {
        Self {
            speed: 0.1,
            time: 0.3,
            freeze_after: None,
        }
    }
}

/// What lies still moves again when it is faster than [`RagdollRest::speed`] this many times.
const STIRS: f32 = 2.0;

/// No point of a figure that lies still is faster than this many times [`RagdollRest::speed`] when it falls
/// asleep. What touches sleeps together or not at all: in a pile something always trembles a little.
const DOZE: f32 = 4.0;

/// A figure with a joint farther beyond its limits than this, radians, has not settled yet.
const STRAINED: f32 = 0.012;

/// It has come to rest. Triggered once, after the tick; again after it has moved.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct CameToRest {
    /// The ragdoll.
    pub entity: Entity,
}

/// The mode of this tick: what is asked, or frozen when that is due.
pub(super) fn mode(intent: &RagdollIntent, state: &RagdollState, config: &Ragdoll) -> RagdollMode {
    let due = |after: f32| {
        // One that stood still, held by its drive, has not lain yet.
        let lies = matches!(state.mode, RagdollMode::Limp | RagdollMode::Frozen);
        lies && state.still >= after.max(config.rest.time)
    };
    match intent.mode {
        RagdollMode::Limp if config.rest.freeze_after.is_some_and(due) => RagdollMode::Frozen,
        asked => asked,
    }
}

/// Whether it is frozen and was already so in the last tick: then nothing is to be done.
pub(super) fn is_settled(mode: RagdollMode, state: &RagdollState) -> bool {
    mode == RagdollMode::Frozen
        && state.mode == RagdollMode::Frozen
        && state.hits.is_empty()
        && !state.bones.is_empty()
        && (state.bones.iter()).all(|b| b.body == BoneBody::Fixed)
}

/// Counts how long each figure has lain still.
pub(super) fn notice(
    time: Res<Time>,
    mut commands: Commands,
    mut worlds: JointWorlds,
    mut ragdolls: Query<(
        Entity,
        &Ragdoll,
        &RagdollIntent,
        &RagdollPlan,
        &mut RagdollState,
        &Bones,
    )>,
    bones: Query<(
        &RagdollBone,
        &BoneOutput,
        &RapierContextEntityLink,
        &RapierRigidBodyHandle,
    )>,
) {
    let dt = time.delta_secs();
    for (entity, config, intent, plan, mut state, tied) in &mut ragdolls {
        let state = state.bypass_change_detection();
        if state.mode == RagdollMode::Frozen && intent.mode == RagdollMode::Limp {
            continue;
        }
        let (mut mass, mut sum) = (0.0, 0.0);
        for (i, (bone, known)) in plan.bones.iter().zip(&state.bones).enumerate() {
            // A limb that rolls away is not the figure.
            if known.body == BoneBody::Dynamic && !is_cut(plan, state, i) {
                mass += bone.mass;
                sum += bone.mass * known.velocity.length_squared();
            }
        }
        // What lies must move more clearly to count as up again than to have lain down.
        let lay = state.still >= config.rest.time;
        let speed = config.rest.speed * if lay { STIRS } else { 1.0 };
        let still = mass > 0.0 && sum <= mass * speed * speed;
        let within = |bone: Entity| {
            bones
                .get(bone)
                .is_ok_and(|(_, o, ..)| o.violation < STRAINED)
        };
        let lies = still && state.still + dt >= config.rest.time && tied.iter().all(within);
        for (bone, output, link, handle) in bones.iter_many(tied.iter()) {
            if output.simulated && !output.asleep {
                let dozes = lies && !is_cut(plan, state, bone.order);
                worlds.doze(link, handle, dozes.then_some(DOZE * config.rest.speed));
            }
        }
        if !still {
            state.still = 0.0;
            continue;
        }
        let before = state.still;
        state.still += dt;
        if before < config.rest.time && state.still >= config.rest.time {
            commands.trigger(CameToRest { entity });
        }
    }
}
