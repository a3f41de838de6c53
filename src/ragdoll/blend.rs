//! What is shown: each joint of a skeleton between its animation and the physics of its bone.
//!
//! After the animation and before transforms are propagated, every joint that has a bone is put between
//! where the animation has it and where the bone is. The mix is taken against the joint of the parent
//! bone, so a limb that is shown by half stays at its shoulder; only the root is mixed in the world, and
//! is kept from sliding by moving the figure to it ([`FollowRoot`](super::FollowRoot)).
//!
//! What the animation wrote is kept beside what is shown, so that the next tick aims at the animation
//! and not at the mix, also where the animation stands still and writes nothing.

use bevy::{
    ecs::{entity::EntityHashMap, system::SystemParam},
    prelude::*,
};

use super::{
    bone::{BoneOf, Bones, RagdollBone},
    config::Ragdoll,
    intent::{BoneControl, part},
    plan::RagdollPlan,
    pose::BonePose,
    state::{BoneBody, RagdollState},
};

/// How animation and physics are mixed in what is shown.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct RagdollBlend {
    /// How long physics takes to be shown fully once a bone is simulated, seconds, at least 0.
    pub fade_in: f32,
    /// How long it takes to be shown no more once the bone follows the animation again, seconds, at
    /// least 0.
    pub fade_out: f32,
    /// Whether joints keep their distances, so that nothing is seen of bones that are pulled apart.
    pub keep_lengths: bool,
}

impl Default for RagdollBlend {
    fn default() -> Self {
        Self {
            fade_in: 0.1,
            fade_out: 0.4,
            keep_lengths: true,
        }
    }
}

/// On a bone: the joint of a skeleton that it takes its pose from, and that is shown where it is.
///
/// The joint's [`Transform`] is written in `PostUpdate`, after Bevy's animation; joints without a bone are
/// left as they are animated. Stronger than a [`BoneSource`](super::BoneSource).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Debug, PartialEq, Clone)]
pub struct BoneJoint {
    /// The joint.
    pub joint: Entity,
    /// The bone in the axes of the joint.
    pub offset: BonePose,
}

impl BoneJoint {
    /// A joint with the origin and the axes of its bone.
    pub fn new(joint: Entity) -> Self {
        Self {
            joint,
            offset: BonePose::default(),
        }
    }
}

/// On a joint that is shown otherwise than animated.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct AnimatedJoint {
    animated: Transform,
    shown: Transform,
}

/// A joint, what is kept of its animation, and what it hangs on.
type Joint = (
    &'static Transform,
    Option<&'static AnimatedJoint>,
    Option<&'static ChildOf>,
);

/// Skeletons as they are animated.
#[derive(SystemParam)]
pub(super) struct Skeletons<'w, 's> {
    joints: Query<'w, 's, Joint>,
}

impl Skeletons<'_, '_> {
    /// Where a bone is asked to be by the animation of its joint, world, and the joint's scale.
    pub fn asked(&self, joint: &BoneJoint) -> Option<(BonePose, Vec3)> {
        let world = climb(joint.joint, |entity| {
            let (transform, kept, parent) = self.joints.get(entity).ok()?;
            Some((animated(transform, kept), parent.map(ChildOf::parent)))
        })?;
        Some((joint.offset.seen_from(&world), world.scale))
    }
}

/// What the animation has a joint at; what is not what was shown, it has written since.
fn animated(transform: &Transform, kept: Option<&AnimatedJoint>) -> Transform {
    match kept {
        Some(kept) if kept.shown == *transform => kept.animated,
        _ => *transform,
    }
}

/// Multiplies transforms upwards until there is no parent.
fn climb(
    from: Entity,
    local: impl Fn(Entity) -> Option<(Transform, Option<Entity>)>,
) -> Option<Transform> {
    let (mut whole, mut at) = local(from)?;
    while let Some(up) = at {
        let (transform, next) = local(up)?;
        whole = transform * whole;
        at = next;
    }
    Some(whole)
}

/// Whether a bone was given a joint since the last tick.
#[derive(Resource, Default)]
pub(super) struct NewJoints(bool);

pub(super) fn note_joint(_: On<Insert, BoneJoint>, mut new: ResMut<NewJoints>) {
    new.0 = true;
}

/// Two bones cannot show one joint: the later one is told, and shows none.
pub(super) fn tell_shared(
    mut commands: Commands,
    mut new: ResMut<NewJoints>,
    all: Query<(Entity, Ref<BoneJoint>, Option<&Name>, Option<&BoneOf>)>,
) {
    if !core::mem::take(&mut new.0) {
        return;
    }
    let name = |name: Option<&Name>| name.map_or(String::new(), |n| n.as_str().to_owned());
    let mut shown: EntityHashMap<Entity> = EntityHashMap::default();
    // Those that were there first, first.
    for late in [false, true] {
        for (bone, joint, own, of) in all.iter().filter(|(_, j, ..)| j.is_changed() == late) {
            let Some(first) = shown.insert(joint.joint, bone) else {
                continue;
            };
            shown.insert(joint.joint, first);
            let other = all.get(first).ok();
            let (other_name, other_of) =
                other.map_or((None, None), |(_, _, name, of)| (name, of.map(|of| of.0)));
            tracing::warn!(
                "{}: ragdoll: bone \"{}\": BoneJoint::joint is {}, which bone \"{}\" of {} shows \
                 already; it shows none",
                of.map_or(bone, |of| of.0),
                name(own),
                joint.joint,
                name(other_name),
                other_of.unwrap_or(first),
            );
            commands.entity(bone).try_remove::<BoneJoint>();
        }
    }
}

/// Fades what is shown of each bone in and out, tick by tick.
pub(super) fn fade(
    time: Res<Time>,
    mut ragdolls: Query<(&Ragdoll, &mut RagdollState, &Bones)>,
    bones: Query<(&RagdollBone, &BoneControl)>,
) {
    let dt = time.delta_secs();
    for (config, mut state, tied) in &mut ragdolls {
        let state = state.bypass_change_detection();
        for (bone, control) in bones.iter_many(tied.iter()) {
            let Some(bone) = state.bones.get_mut(bone.order) else {
                continue;
            };
            let leads =
                matches!(bone.body, BoneBody::Dynamic | BoneBody::Fixed) || !bone.offset.is_over();
            let wanted = if leads { part(control.blend) } else { 0.0 };
            let way = wanted - bone.shown;
            if way == 0.0 {
                continue;
            }
            let fade = if way > 0.0 {
                config.blend.fade_in
            } else {
                config.blend.fade_out
            };
            let most = if fade > dt { dt / fade } else { 1.0 };
            bone.shown = if way.abs() <= most {
                wanted
            } else {
                bone.shown + most.copysign(way)
            };
        }
    }
}

/// A joint on its way to being shown.
#[derive(Clone, Copy)]
pub(super) struct ShownJoint {
    joint: Entity,
    /// Nearest bone above with a joint.
    parent: Option<usize>,
    /// As animated, own axes.
    local: Transform,
    /// As animated, world.
    animated: Transform,
    /// As its bone has it, world.
    physical: BonePose,
    weight: f32,
    shown: Transform,
}

/// Between two poses.
fn mixed(a: &Transform, b: &Transform, weight: f32) -> Transform {
    if weight <= 0.0 {
        return *a;
    }
    if weight >= 1.0 {
        return b.with_scale(a.scale);
    }
    Transform {
        translation: a.translation.lerp(b.translation, weight),
        rotation: a.rotation.slerp(b.rotation, weight),
        scale: a.scale,
    }
}

/// The same seen from a frame.
fn within(frame: &Transform, t: &Transform) -> Transform {
    let back = frame.rotation.inverse();
    Transform {
        translation: (back * (t.translation - frame.translation)) / frame.scale,
        rotation: (back * t.rotation).normalize(),
        scale: t.scale / frame.scale,
    }
}

/// Puts every joint where it is shown.
pub(super) fn show(
    mut commands: Commands,
    ragdolls: Query<(&Ragdoll, &RagdollPlan, &RagdollState, &Bones)>,
    bones: Query<(&RagdollBone, &Transform, &BoneJoint)>,
    mut joints: Query<
        (&mut Transform, Option<&mut AnimatedJoint>, Option<&ChildOf>),
        Without<RagdollBone>,
    >,
    mut made: Local<Vec<Option<ShownJoint>>>,
) {
    for (config, plan, state, tied) in &ragdolls {
        if plan.bones.is_empty() || state.bones.len() != plan.bones.len() {
            continue;
        }
        if state.bones.iter().all(|b| b.shown <= 0.0) {
            for (_, _, joint) in bones.iter_many(tied.iter()) {
                if let Ok((mut transform, Some(kept), _)) = joints.get_mut(joint.joint) {
                    let back = animated(&transform, Some(&kept));
                    transform.set_if_neq(back);
                    commands.entity(joint.joint).try_remove::<AnimatedJoint>();
                }
            }
            continue;
        }
        collect(plan, state, tied, &bones, &joints, &mut made);
        for i in 0..made.len() {
            let Some(mut at) = made[i] else { continue };
            let physical = Transform::from_translation(at.physical.position)
                .with_rotation(at.physical.rotation);
            at.shown = match at.parent.and_then(|p| made[p]) {
                Some(of) => {
                    let frame = |t: &Transform| t.with_scale(Vec3::ONE);
                    let own = within(&frame(&of.animated), &at.animated);
                    let bears = Transform::from_translation(of.physical.position)
                        .with_rotation(of.physical.rotation);
                    let by_physics = within(&bears, &physical);
                    frame(&of.shown) * mixed(&own, &by_physics, at.weight)
                }
                None => mixed(&at.animated, &physical, at.weight),
            };
            // What is between this joint and the next one with a bone goes along as it is animated.
            let above = joints.get(at.joint).ok().and_then(|(_, _, up)| up);
            let above = above.map(ChildOf::parent).and_then(|up| {
                climb_to(up, &made, |entity| {
                    let (transform, kept, parent) = joints.get(entity).ok()?;
                    Some((animated(transform, kept), parent.map(ChildOf::parent)))
                })
            });
            let above = above.unwrap_or_default();
            let mut local = within(&above, &at.shown).with_scale(at.local.scale);
            if at.weight <= 0.0 {
                local = at.local;
            } else if config.blend.keep_lengths && at.parent.is_some() && !state.bones[i].severed {
                local.translation = at.local.translation;
            }
            at.shown = above * local;
            made[i] = Some(at);
            let Ok((mut transform, kept, _)) = joints.get_mut(at.joint) else {
                continue;
            };
            if !(local.translation.is_finite() && local.rotation.is_finite()) {
                continue;
            }
            let keeps = AnimatedJoint {
                animated: at.local,
                shown: local,
            };
            match kept {
                Some(mut kept) => *kept = keeps,
                None => {
                    commands.entity(at.joint).try_insert(keeps);
                }
            }
            transform.set_if_neq(local);
        }
    }
}

/// Finds what each bone with a joint is animated and simulated as.
fn collect(
    plan: &RagdollPlan,
    state: &RagdollState,
    tied: &Bones,
    bones: &Query<(&RagdollBone, &Transform, &BoneJoint)>,
    joints: &Query<
        (&mut Transform, Option<&mut AnimatedJoint>, Option<&ChildOf>),
        Without<RagdollBone>,
    >,
    made: &mut Vec<Option<ShownJoint>>,
) {
    made.clear();
    made.resize(plan.bones.len(), None);
    for (bone, transform, joint) in bones.iter_many(tied.iter()) {
        let order = bone.order;
        let (Some(known), Ok((local, kept, _))) = (state.bones.get(order), joints.get(joint.joint))
        else {
            continue;
        };
        let world = climb(joint.joint, |entity| {
            let (transform, kept, parent) = joints.get(entity).ok()?;
            Some((animated(transform, kept), parent.map(ChildOf::parent)))
        });
        let Some(world) = world else { continue };
        let body = match known.body {
            BoneBody::Off => known.place,
            _ => BonePose {
                position: transform.translation,
                rotation: transform.rotation,
            },
        };
        let rotation = (body.rotation * joint.offset.rotation.inverse()).normalize();
        made[order] = Some(ShownJoint {
            joint: joint.joint,
            parent: None,
            local: animated(local, kept),
            animated: world,
            physical: BonePose {
                position: body.position - rotation * joint.offset.position,
                rotation,
            },
            weight: part(known.shown),
            shown: world,
        });
    }
    for i in 0..made.len() {
        let mut at = plan.bones[i].parent;
        while let Some(up) = at
            && made[up].is_none()
        {
            at = plan.bones[up].parent;
        }
        if let Some(this) = &mut made[i] {
            this.parent = at;
        }
    }
}

/// Where an entity is shown: as animated below the nearest joint that has a bone.
fn climb_to(
    from: Entity,
    made: &[Option<ShownJoint>],
    local: impl Fn(Entity) -> Option<(Transform, Option<Entity>)>,
) -> Option<Transform> {
    let mut whole = Transform::IDENTITY;
    let mut at = Some(from);
    while let Some(here) = at {
        if let Some(joint) = made.iter().flatten().find(|j| j.joint == here) {
            return Some(joint.shown * whole);
        }
        let (transform, next) = local(here)?;
        whole = transform * whole;
        at = next;
    }
    Some(whole)
}
