//! Being hit: an impulse at a point, and muscles that let go around it for a while.
//!
//! The bone that is hit loses strength by how hard the hit is, its parents and children less with every
//! joint between; all of it comes back in time. The impulse arrives whole: what a bone is too light to
//! take up goes on to the bone that it hangs on.

use bevy::prelude::*;

use super::{
    bone::{BoneOf, Bones, RagdollBone},
    config::Ragdoll,
    intent::part,
    plan::RagdollPlan,
    state::{BoneBody, BoneState, PendingHit, RagdollState},
    tick::{Slot, bearer},
};
use crate::backend::joints::JointWorlds;

/// A bone takes up no more of a hit than makes it this part of [`Ragdoll::max_speed`].
const MOST_SPEED: f32 = 0.5;

/// On a ragdoll: how hits weaken it. Without it hits push and nothing else.
///
/// In [`HitBoxes`](super::RagdollMode::HitBoxes) and [`Partial`](super::RagdollMode::Partial), weakened
/// bones are simulated until their strength is back: the figure flinches. Its root never is.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct HitReaction {
    /// Part of its strength that a bone loses to a full hit, `0..=1`.
    pub loss: f32,
    /// Impulse of a full hit, newton-seconds, above 0; weaker ones take in proportion.
    pub full_impulse: f32,
    /// Part of the loss that goes on from a bone to the one that bears it, `0..=1`.
    pub to_parents: f32,
    /// Part of the loss that goes on from a bone to those that it bears, `0..=1`.
    pub to_children: f32,
    /// Time before strength begins to come back, seconds, at least 0.
    pub hold: f32,
    /// Time in which a lost full strength comes back, seconds, at least 0.
    pub recovery: f32,
}

impl Default for HitReaction {
    fn default() -> Self {
        Self {
            loss: 0.9,
            full_impulse: 20.0,
            to_parents: 0.6,
            to_children: 0.8,
            hold: 0.1,
            recovery: 0.6,
        }
    }
}

/// Trigger it to hit a ragdoll, or one of its bones. The next tick delivers it.
///
/// A bone that is named is the one that is hit; of a ragdoll it is the one nearest to the point. Bones
/// that are not simulated and do not flinch feel nothing.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct RagdollHit {
    /// The ragdoll or the bone.
    pub entity: Entity,
    /// Where, world, metres.
    pub point: Vec3,
    /// Newton-seconds, world.
    pub impulse: Vec3,
}

/// Hits by a call.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_embody::prelude::*;
/// fn shoot(mut commands: Commands, target: Single<Entity, With<Ragdoll>>) {
///     commands.hit(*target, Vec3::new(0.0, 1.4, 0.0), Vec3::NEG_Z * 8.0);
/// }
/// ```
pub trait HitCommands {
    /// Hits a ragdoll, or one of its bones, at a point (world, metres) with an impulse
    /// (newton-seconds): see [`RagdollHit`].
    fn hit(&mut self, entity: Entity, point: Vec3, impulse: Vec3);
}

impl HitCommands for Commands<'_, '_> {
    fn hit(&mut self, entity: Entity, point: Vec3, impulse: Vec3) {
        self.trigger(RagdollHit {
            entity,
            point,
            impulse,
        });
    }
}

/// Notes a hit for the next tick.
pub(super) fn take(
    hit: On<RagdollHit>,
    bones: Query<(&RagdollBone, &BoneOf)>,
    mut ragdolls: Query<(&RagdollPlan, &mut RagdollState)>,
) {
    let bone = bones.get(hit.entity).ok();
    let ragdoll = bone.map_or(hit.entity, |(_, of)| of.0);
    let Ok((plan, mut state)) = ragdolls.get_mut(ragdoll) else {
        tracing::warn!(
            "{}: it was hit, but is no ragdoll nor a bone of one",
            hit.entity
        );
        return;
    };
    if !(hit.point.is_finite() && hit.impulse.is_finite()) {
        let RagdollHit { point, impulse, .. } = *hit;
        tracing::warn!(
            "{ragdoll}: it was hit at {point} with {impulse}, which is nowhere or nothing"
        );
        return;
    }
    let bone = bone.map(|(bone, _)| bone.order);
    if let Some(bone) = bone.or_else(|| nearest(plan, &state, hit.point)) {
        state.hits.push(PendingHit {
            bone,
            point: hit.point,
            impulse: hit.impulse,
        });
    }
}

/// The bone whose surface is nearest to a point.
fn nearest(plan: &RagdollPlan, state: &RagdollState, point: Vec3) -> Option<usize> {
    let distance = |i: usize| {
        let (place, (a, b, radius)) = (state.bones[i].place, plan.bones[i].shape.core());
        let own = place.rotation.inverse() * (point - place.position);
        let way = b - a;
        let t = (own - a).dot(way) / way.length_squared().max(1.0e-12);
        own.distance(a + way * t.clamp(0.0, 1.0)) - radius
    };
    let count = plan.bones.len().min(state.bones.len());
    (0..count).min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
}

/// Part of a loss at one bone that each bone feels.
fn spread(
    plan: &RagdollPlan,
    bones: &[BoneState],
    at: usize,
    reaction: &HitReaction,
    felt: &mut Vec<f32>,
) {
    let bearer = |i: usize| plan.bones[i].parent.filter(|_| !bones[i].severed);
    felt.clear();
    felt.resize(plan.bones.len(), 0.0);
    let (up, down) = (part(reaction.to_parents), part(reaction.to_children));
    let (mut bone, mut share) = (Some(at), 1.0);
    while let Some(i) = bone {
        felt[i] = share;
        share *= up;
        bone = bearer(i);
    }
    // Parents come first.
    for i in 0..felt.len() {
        if let Some(p) = bearer(i) {
            felt[i] = felt[i].max(felt[p] * down);
        }
    }
}

/// Lets strength come back, and takes it where a hit is on its way.
pub(super) fn feel(
    time: Res<Time>,
    mut ragdolls: Query<(Option<&HitReaction>, &RagdollPlan, &mut RagdollState), With<Bones>>,
    mut felt: Local<Vec<f32>>,
) {
    let dt = time.delta_secs();
    for (reaction, plan, mut state) in &mut ragdolls {
        let state = state.bypass_change_detection();
        if state.bones.len() != plan.bones.len() {
            continue;
        }
        if !state.hits.is_empty() {
            state.still = 0.0;
        }
        let Some(reaction) = reaction else {
            for bone in &mut state.bones {
                (bone.hurt, bone.dazed) = (0.0, 0.0);
            }
            continue;
        };
        for bone in state.bones.iter_mut().filter(|b| b.hurt > 0.0) {
            // What is left of this tick when the hold ends in it counts.
            let over = (dt - bone.dazed).max(0.0);
            bone.dazed = (bone.dazed - dt).max(0.0);
            bone.hurt = if reaction.recovery > over {
                (bone.hurt - over / reaction.recovery).max(0.0)
            } else if over > 0.0 {
                0.0
            } else {
                bone.hurt
            };
        }
        for hit in &state.hits {
            if hit.bone >= plan.bones.len() {
                continue;
            }
            spread(plan, &state.bones, hit.bone, reaction, &mut felt);
            let hard = part(hit.impulse.length() / reaction.full_impulse);
            let loss = part(reaction.loss) * hard;
            for (bone, share) in state.bones.iter_mut().zip(&felt) {
                let hurt = loss * share;
                if hurt > bone.hurt {
                    bone.hurt = hurt;
                    bone.dazed = reaction.hold.max(0.0);
                }
            }
        }
    }
}

/// Gives the bones the impulses of the hits.
pub(super) fn deliver(
    worlds: &mut JointWorlds,
    config: &Ragdoll,
    plan: &RagdollPlan,
    slots: &[Option<Slot>],
    state: &mut RagdollState,
) {
    for hit in state.hits.drain(..) {
        let (mut rest, mut point, mut at) = (hit.impulse, hit.point, hit.bone);
        while let Some(Some(slot)) = slots.get(at)
            && slot.body == BoneBody::Dynamic
        {
            let bone = &plan.bones[at];
            let above = bearer(plan, slots, at).filter(|p| {
                slots[*p]
                    .as_ref()
                    .is_some_and(|s| s.body == BoneBody::Dynamic)
            });
            let most = match above {
                Some(_) => bone.mass * config.max_speed * MOST_SPEED,
                None => f32::INFINITY,
            };
            let taken = rest.clamp_length_max(most);
            worlds.strike(&slot.link, &slot.handle, taken, point);
            rest -= taken;
            let Some(above) = above.filter(|_| rest.length_squared() > 1.0e-12) else {
                break;
            };
            point = slot.motion.position;
            at = above;
        }
    }
}
