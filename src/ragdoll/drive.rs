//! The systems of the tick between synchronisation and step.

use bevy::{prelude::*, transform::helper::TransformHelper};

use super::{
    blend::{BoneJoint, Skeletons},
    bone::{BoneTies, Bones, RagdollBone},
    config::Ragdoll,
    hit,
    intent::{BoneControl, RagdollIntent, RagdollMode, part},
    keyframe,
    plan::RagdollPlan,
    pose::{BonePose, BoneSource, RagdollPose},
    prepare::wanted,
    rest,
    rise::{self, GetUp},
    sever,
    state::{BoneBody, RagdollState},
    tick::{self, BoneForce, Slot, Way},
    weight::{self, Carried},
};
use crate::backend::{
    handles::{RapierColliderHandle, RapierContextEntityLink, RapierRigidBodyHandle},
    joints::{JointIterations, JointWorlds, WorldSteps},
    world_mut::PhysicsWorldsMut,
};

/// The forces of this tick.
#[derive(Resource, Default)]
pub(super) struct BoneForces(Vec<BoneForce>);

impl BoneForces {
    /// Adds one.
    pub fn add(&mut self, force: BoneForce) {
        self.0.push(force);
    }
}

/// Gives new bones their mass before they are first moved.
pub(super) fn admit_new(
    mut worlds: PhysicsWorldsMut,
    new: Query<
        (&RapierColliderHandle, &RapierContextEntityLink),
        (Added<RapierColliderHandle>, With<RagdollBone>),
    >,
) {
    worlds.admit(new.iter());
}

/// A bone as the physics world knows it.
type TiedBone<'a> = (
    &'a RagdollBone,
    &'a RapierContextEntityLink,
    &'a RapierRigidBodyHandle,
    &'a mut BoneTies,
);

/// Ties new bones to their parents.
pub(super) fn tie(
    mut worlds: JointWorlds,
    mut ragdolls: Query<(&mut RagdollPlan, &Bones)>,
    mut bones: Query<TiedBone>,
    mut handles: Local<Vec<Option<(RapierContextEntityLink, RapierRigidBodyHandle)>>>,
) {
    for (mut plan, tied) in &mut ragdolls {
        if plan.told || plan.bones.is_empty() {
            continue;
        }
        handles.clear();
        handles.resize(plan.bones.len(), None);
        for (bone, link, handle, _) in bones.iter_many(tied.iter()) {
            if let Some(slot @ None) = handles.get_mut(bone.order) {
                *slot = Some((*link, *handle));
            }
        }
        // All that there are or none: the first tick has them all. What was despawned since is not waited
        // for.
        let known = handles.iter().flatten().count();
        if known < tied.iter().count() {
            continue;
        }
        for entity in tied.iter() {
            let Ok((bone, link, handle, mut ties)) = bones.get_mut(entity) else {
                continue;
            };
            if bone.order >= handles.len() {
                continue;
            }
            let parent = plan.bones[bone.order].parent.and_then(|p| handles[p]);
            if let Some((_, parent)) = parent {
                sever::tie_bone(
                    &mut worlds,
                    &plan,
                    bone.order,
                    link,
                    &parent,
                    handle,
                    &mut ties,
                );
            }
        }
        for (i, j) in plan.apart.iter() {
            if let (Some((link, a)), Some((_, b))) = (handles[*i], handles[*j]) {
                worlds.ignore(&link, &a, &b);
            }
        }
        plan.told = true;
    }
}

/// What a bone cannot be asked for.
struct Unsound {
    field: &'static str,
    pose: BonePose,
    scale: Vec3,
}

impl Unsound {
    fn tell(&self, ragdoll: Entity, bone: Option<&Name>) {
        let name = bone.map_or("", Name::as_str);
        let field = self.field;
        if self.pose.is_sound() {
            tracing::warn!(
                "{ragdoll}: ragdoll: bone \"{name}\": {field} has the scale {}, but needs one above 0: a \
                 mirrored pose is none; the bone keeps its last one",
                self.scale
            );
        } else {
            tracing::warn!(
                "{ragdoll}: ragdoll: bone \"{name}\": {field} is at {} with the rotation {}, which is no \
                 pose; the bone keeps its last one",
                self.pose.position,
                self.pose.rotation
            );
        }
    }
}

/// Where a bone is asked to be at the end of the tick.
fn asked(
    helper: &TransformHelper,
    skeletons: &Skeletons,
    joint: Option<&BoneJoint>,
    source: Option<&BoneSource>,
    pose: &RagdollPose,
    root: &Transform,
    plan: &RagdollPlan,
    order: usize,
) -> Option<Result<BonePose, Unsound>> {
    let (field, pose, scale) = match (joint, source) {
        (Some(joint), _) => {
            let (pose, scale) = skeletons.asked(joint)?;
            ("BoneJoint::joint", pose, scale)
        }
        (None, Some(source)) => {
            let global = helper.compute_global_transform(source.0).ok()?;
            let (scale, rotation, position) = global.to_scale_rotation_translation();
            ("BoneSource", BonePose { position, rotation }, scale)
        }
        (None, None) => {
            let bone = &plan.bones[order];
            let asked = *pose.bones.get(bone.index).unwrap_or(&bone.bind);
            // As it was written: seen from elsewhere a length of 2 would be evened out.
            let pose = if asked.is_sound() {
                asked.seen_from(root)
            } else {
                asked
            };
            ("RagdollPose::bones", pose, Vec3::ONE)
        }
    };
    // What is not a number is not above 0.
    Some(if pose.is_sound() && scale.min_element() > 0.0 {
        Ok(pose)
    } else {
        Err(Unsound { field, pose, scale })
    })
}

/// Switches, drives and sends every bone.
pub(super) fn drive(
    time: Res<Time>,
    helper: TransformHelper,
    skeletons: Skeletons,
    mut worlds: JointWorlds,
    mut forces: ResMut<BoneForces>,
    mut ragdolls: Query<(
        Entity,
        &Ragdoll,
        &RagdollIntent,
        &RagdollPose,
        &mut RagdollPlan,
        &mut RagdollState,
        &Bones,
        Option<&GetUp>,
    )>,
    mut bones: Query<(
        TiedBone,
        &BoneControl,
        Option<&BoneJoint>,
        Option<&BoneSource>,
        Option<&Name>,
    )>,
    mut slots: Local<Vec<Option<Slot>>>,
    mut ways: Local<Vec<Option<Way>>>,
    mut carried: Local<Vec<Carried>>,
) {
    forces.0.clear();
    let dt = time.delta_secs();
    if !(dt > 0.0) {
        return;
    }
    for (entity, config, intent, pose, mut plan, mut state, tied, clips) in &mut ragdolls {
        let count = plan.bones.len();
        if count == 0 || !plan.told || state.bones.len() != count {
            continue;
        }
        let mode = rest::mode(intent, &state, config);
        if rest::is_settled(mode, &state) {
            state.bypass_change_detection().age += dt;
            continue;
        }
        // While it was frozen nobody asked where the pose was.
        let thaws = state.mode == RagdollMode::Frozen && mode != RagdollMode::Frozen;
        let Ok(root) = helper.compute_global_transform(entity) else {
            continue;
        };
        let (_, rotation, translation) = root.to_scale_rotation_translation();
        let root = Transform::from_translation(translation).with_rotation(rotation);
        state.bypass_change_detection().figure = BonePose {
            position: translation,
            rotation,
        };
        let driven = matches!(
            mode,
            RagdollMode::Powered | RagdollMode::Partial | RagdollMode::HitBoxes
        );
        slots.clear();
        slots.resize(count, None);
        for bone in tied.iter() {
            let Ok(((is, link, handle, mut ties), control, joint, source, name)) =
                bones.get_mut(bone)
            else {
                continue;
            };
            if is.order >= count {
                continue;
            }
            if slots[is.order].is_some() {
                let ties = ties.bypass_change_detection();
                if !ties.told {
                    let name = name.map_or("", Name::as_str);
                    tracing::warn!(
                        "{entity}: ragdoll: bone \"{name}\" is there twice, as {bone} too; it is left alone \
                         (was BoneOf written?)"
                    );
                }
                ties.told = true;
                continue;
            }
            let Some(motion) = worlds.motion(link, handle) else {
                continue;
            };
            let known = state.bones[is.order].target;
            let asked = asked(
                &helper, &skeletons, joint, source, pose, &root, &plan, is.order,
            );
            let ties = ties.bypass_change_detection();
            let asked = match asked {
                Some(Err(unsound)) => {
                    if !ties.told {
                        unsound.tell(entity, name);
                    }
                    ties.told = true;
                    None
                }
                sound => {
                    ties.told = false;
                    sound.and_then(Result::ok)
                }
            };
            let at = || plan.bones[is.order].bind.seen_from(&root);
            let target = asked.or(known).unwrap_or_else(at);
            let cut = sever::is_cut(&plan, &state, is.order);
            slots[is.order] = Some(Slot {
                severed: state.bones[is.order].severed,
                entity: bone,
                link: *link,
                handle: *handle,
                motion,
                body: wanted(mode, control, &plan, &state, is.order),
                target,
                before: known.filter(|_| !thaws).unwrap_or(target),
                strength: tick::strength(driven && !cut, intent.strength, control)
                    * (1.0 - part(state.bones[is.order].hurt)),
                pin: if driven && !cut {
                    part(control.pin)
                } else {
                    0.0
                },
                keyed: mode == RagdollMode::Keyframed && !cut,
                anew: false,
            });
        }
        let plan = plan.bypass_change_detection();
        for (i, slot) in slots.iter().enumerate() {
            if slot.is_none() && plan.lost.get(i) == Some(&false) {
                plan.lost[i] = true;
                let bone = config.profile.bones.get(plan.bones[i].index);
                let name = bone.map_or("", |b| b.name.as_str());
                tracing::warn!(
                    "{entity}: ragdoll: bone \"{name}\" is gone, but nobody said so by Dismember; what \
                     hung on it hangs on nothing"
                );
            }
        }
        let fade = match mode {
            RagdollMode::GettingUp => rise::time(entity, plan, state.bypass_change_detection()),
            _ => config.fade,
        };
        let plan: &RagdollPlan = plan;
        if mode == RagdollMode::GettingUp {
            let state = state.bypass_change_detection();
            rise::wait_for_clip(clips, plan, state, &root, &mut slots);
        } else if state.rise.is_some() {
            state.bypass_change_detection().rise = None;
        }
        let Some(first) = slots.iter().flatten().next() else {
            continue;
        };
        let link = first.link;
        let Some((gravity, true)) = worlds.gravity(&link) else {
            continue;
        };
        let parent_of = |i: usize| tick::bearer(plan, &slots, i).and_then(|p| slots[p].as_ref());
        let stirred = (slots.iter().enumerate()).any(|(i, slot)| {
            slot.as_ref()
                .is_some_and(|s| tick::stirs(s, parent_of(i), &state.bones[i]))
        }) || !state.hits.is_empty();
        let simulated = |s: &Slot| s.body == BoneBody::Dynamic;
        let awake = stirred || (slots.iter().flatten()).any(|s| simulated(s) && !s.motion.sleeping);
        let follows = slots.iter().flatten().any(|s| !simulated(s));
        if state.mode == mode {
            state.bypass_change_detection().age += dt;
        } else {
            if mode != RagdollMode::Frozen {
                state.still = 0.0;
            }
            state.mode = mode;
            state.age = 0.0;
        }
        if !awake && !follows {
            continue;
        }
        ways.clear();
        for i in 0..count {
            let was = state.bones[i].body;
            let way = slots[i].as_ref().map(|slot| {
                let parent = tick::bearer(plan, &slots, i).and_then(|p| ways[p].as_ref());
                tick::change_over(&mut worlds, slot, parent, &mut state.bones[i], fade, dt)
            });
            ways.push(way);
            // What was switched is where it was put, as fast as it was made.
            if let Some(slot) = &mut slots[i]
                && slot.body != was
                && let Some(motion) = worlds.motion(&slot.link, &slot.handle)
            {
                slot.motion = motion;
            }
        }
        if !awake {
            continue;
        }
        let substeps = worlds.substeps(&link) + plan.extra_substeps as f32;
        let step = (dt, substeps);
        weight::share_pins(plan, &slots, &mut carried);
        for (i, slot) in slots.iter().enumerate() {
            let Some(slot) = slot else { continue };
            if let Ok(((.., mut ties), ..)) = bones.get_mut(slot.entity) {
                let ties = ties.bypass_change_detection();
                tick::pin(
                    &mut worlds,
                    config,
                    plan,
                    slot,
                    carried[i].pinned,
                    ties,
                    step,
                );
                if !simulated(slot) {
                    continue;
                }
                if stirred {
                    worlds.wake(&slot.link, &slot.handle);
                }
                worlds.cap(&slot.link, &slot.handle, config.max_speed, config.max_spin);
                if let Some(parent) = tick::bearer(plan, &slots, i).and_then(|p| slots[p].as_ref())
                {
                    tick::drive(
                        &mut worlds,
                        config,
                        &plan.bones[i],
                        slot,
                        parent,
                        ties,
                        step,
                    );
                }
                if slot.keyed {
                    let bone = &plan.bones[i];
                    keyframe::send_by_velocity(
                        &mut worlds,
                        config,
                        bone,
                        slot,
                        gravity,
                        dt,
                        &mut forces.0,
                    );
                }
            }
        }
        let state = state.bypass_change_detection();
        hit::deliver(&mut worlds, config, plan, &slots, state);
        if driven {
            let carried = &mut carried;
            weight::bear_weight(config, plan, &slots, gravity, carried, &mut forces.0);
        }
    }
}

/// Writes the forces.
pub(super) fn apply_forces(mut worlds: PhysicsWorldsMut, forces: Res<BoneForces>) {
    for f in &forces.0 {
        worlds.force_body(&f.link, &f.handle, f.force, f.torque, false);
    }
}

/// Lets each world go over the joints as often as its ragdolls ask, and as before when they are gone.
pub(super) fn set_iterations(
    mut worlds: WorldSteps,
    mut known: ResMut<JointIterations>,
    ragdolls: Query<(&Ragdoll, &Bones)>,
    bones: Query<&RapierContextEntityLink, With<RagdollBone>>,
) {
    known.set(&mut worlds, |world| {
        let asked = ragdolls.iter().map(|(config, tied)| {
            let mut links = bones.iter_many(tied.iter());
            let here = links.next().is_some_and(|link| link.0 == world);
            if here {
                usize::from(config.iterations)
            } else {
                0
            }
        });
        asked.max().unwrap_or(0)
    });
}

/// Takes the tick's forces off the bodies again.
pub(super) fn end_forces(mut worlds: PhysicsWorldsMut) {
    worlds.end_forces();
}
