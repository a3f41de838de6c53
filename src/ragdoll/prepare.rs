//! Before the physics world takes over changes: bones are built, and switched between kinds of bodies.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{
    AdditionalMassProperties, AdditionalSolverIterations, Collider, ColliderMassProperties,
    CollisionGroups, Damping, Group, MassProperties, RigidBody, RigidBodyDisabled,
};

use super::{
    blend::BoneJoint,
    bone::{BoneOf, Bones, RagdollBone},
    config::Ragdoll,
    intent::{BoneControl, RagdollIntent, RagdollMode},
    plan::{PlannedBone, RagdollPlan},
    pose::RagdollPose,
    profile::BoneShape,
    rest, sever,
    skin::{RagdollReady, SkeletonJoints},
    state::{BoneBody, BoneState, RagdollState},
    validate,
};

/// Joints are drawn apart by their load with the square of the substep: at this one, seconds, a figure
/// that hangs in its pose by less than a millimetre.
const SUBSTEP: f32 = 1.0 / 240.0;
/// Substeps of a tick in the physics engine, unless the game sets others.
const USUAL_SUBSTEPS: f32 = 4.0;
/// The most that are added.
const MOST_SUBSTEPS: f32 = 28.0;
/// A joint that bears so many times the mass of the bone it hangs from is held by these substeps.
const USUAL_LOAD: f32 = 20.0;

/// How many substeps are added at this length of a tick, seconds.
fn extra_substeps(dt: f32, finer: f32) -> usize {
    // A hair less, so that a rate that is no round number of seconds does not ask for one more.
    let wanted = (dt / SUBSTEP * finer - 0.01).ceil() - USUAL_SUBSTEPS;
    wanted.clamp(0.0, MOST_SUBSTEPS) as usize
}

/// How many times finer than usual the substeps of a figure must be: gaps grow with the load, and with the
/// square of the substep.
fn finer(plan: &RagdollPlan) -> f32 {
    (plan.load / USUAL_LOAD).clamp(1.0, 16.0).sqrt()
}

/// A figure whose root is faster than this, metres per second, has substeps half as long: it may be stopped
/// within one, and its joints are drawn apart by that. It is a fall of 4 m.
const FAST: f32 = 9.0;

/// Adds as many substeps as the tick and the figure need, also when that changes.
pub(super) fn pace(
    time: Res<Time>,
    mut commands: Commands,
    mut ragdolls: Query<(&mut RagdollPlan, &RagdollState, &Bones)>,
) {
    let dt = time.delta_secs();
    if !(dt > 0.0) {
        return;
    }
    for (mut plan, state, tied) in &mut ragdolls {
        let is_fast = |root: &BoneState| root.velocity.length_squared() > FAST * FAST;
        let speed = if state.bones.first().is_some_and(is_fast) {
            2.0
        } else {
            1.0
        };
        let wanted = extra_substeps(dt, finer(&plan) * speed);
        if plan.extra_substeps == wanted {
            continue;
        }
        plan.bypass_change_detection().extra_substeps = wanted;
        for bone in tied.iter() {
            commands
                .entity(bone)
                .try_insert(AdditionalSolverIterations(wanted));
        }
    }
}

/// Builds the bones of what is new or changed.
pub(super) fn build(
    time: Res<Time>,
    helper: TransformHelper,
    mut commands: Commands,
    mut ragdolls: Query<
        (
            Entity,
            Ref<Ragdoll>,
            &RagdollPose,
            &Transform,
            &mut RagdollPlan,
            &mut RagdollState,
            Option<&Bones>,
            Option<&mut SkeletonJoints>,
        ),
        Changed<Ragdoll>,
    >,
) {
    for (entity, config, pose, own, mut plan, mut state, bones, mut joints) in &mut ragdolls {
        // Who writes the component every tick has not changed it for that.
        if plan.made_of.as_deref() == Some(&*config) {
            continue;
        }
        // A plan that bones were made of is sound: who tunes settings every tick pays for those alone.
        let tuned = (plan.made_of.as_deref()).is_some_and(|made_of| config.has_bones_of(made_of));
        let refused = if tuned {
            validate::refuse_settings(&config)
        } else {
            validate::refuse(&config)
        };
        if tuned
            && refused.is_none()
            && let Some(made_of) = plan.made_of.as_deref_mut()
        {
            if made_of.groups != config.groups {
                for bone in bones.iter().flat_map(|b| b.iter()) {
                    commands.entity(bone).try_insert(groups(&config));
                }
            }
            made_of.take_settings(&config);
            continue;
        }
        for bone in bones.iter().flat_map(|b| b.iter()) {
            commands.entity(bone).despawn();
        }
        let told = plan.refused.take();
        *plan = RagdollPlan::default();
        if let Some(what) = refused {
            state.bones.clear();
            if told.as_ref() != Some(&what) {
                tracing::warn!("{entity}: ragdoll: {what}; it has no bones until then");
            }
            plan.refused = Some(what);
            continue;
        }
        for line in validate::lint(&config) {
            tracing::warn!("{entity}: ragdoll: {line}");
        }
        *plan = RagdollPlan::of(&config);
        plan.extra_substeps = extra_substeps(time.delta_secs(), finer(&plan));
        // One that came with a state goes on from there.
        let saved = config.is_added() && state.bones.len() == plan.bones.len();
        if !saved {
            state.bones.clear();
            state.bones.resize(plan.bones.len(), BoneState::default());
        }
        for bone in &mut state.bones {
            bone.body = BoneBody::Off;
        }
        let global = helper.compute_global_transform(entity).unwrap_or_default();
        let (_, rotation, translation) = global.to_scale_rotation_translation();
        let scale = own.scale;
        if joints.is_none() && !scale.abs_diff_eq(Vec3::ONE, 1.0e-3) {
            tracing::warn!(
                "{entity}: ragdoll: its scale is {scale}, but needs 1: a figure is as large as \
                 Ragdoll::profile says, and the scale counts for nothing"
            );
        }
        let figure = Transform::from_translation(translation).with_rotation(rotation);
        for (order, bone) in plan.bones.iter().enumerate() {
            let asked = pose.bones.get(bone.index).filter(|p| p.is_sound());
            let place = match &state.bones[order] {
                known if known.target.is_some() && known.place.is_sound() => known.place,
                _ => asked.unwrap_or(&bone.bind).seen_from(&figure),
            };
            let name = &config.profile.bones[bone.index].name;
            let joint = (joints.as_ref()).and_then(|j| j.joints.iter().find(|(of, ..)| of == name));
            let mut made = commands.spawn((
                Name::new(name.clone()),
                RagdollBone {
                    index: bone.index,
                    order,
                },
                BoneOf(entity),
                body(bone, config.damping),
                groups(&config),
                AdditionalSolverIterations(plan.extra_substeps),
                Transform::from_translation(place.position).with_rotation(place.rotation),
            ));
            if let Some((_, joint, offset)) = joint {
                made.insert(BoneJoint {
                    joint: *joint,
                    offset: *offset,
                });
            }
        }
        // Behind the bones, which are there when it is heard.
        if let Some(joints) = &mut joints
            && !joints.told
        {
            joints.told = true;
            commands.trigger(RagdollReady { entity });
        }
    }
}

/// With whom bones collide.
fn groups(config: &Ragdoll) -> CollisionGroups {
    let of = config.groups;
    CollisionGroups::new(
        Group::from_bits_retain(of.memberships),
        Group::from_bits_retain(of.filters),
    )
}

/// The body of a bone, not yet there for the physics.
fn body(bone: &PlannedBone, damping: f32) -> impl Bundle + use<> {
    let collider = match bone.shape {
        BoneShape::Capsule { from, to, radius } if from.distance(to) > 1.0e-4 => {
            Collider::capsule(from, to, radius)
        }
        BoneShape::Capsule { from, radius, .. } => {
            Collider::compound(vec![(from, Quat::IDENTITY, Collider::ball(radius))])
        }
        BoneShape::Box {
            center,
            rotation,
            half,
        } => Collider::compound(vec![(
            center,
            rotation,
            Collider::cuboid(half.x, half.y, half.z),
        )]),
    };
    (
        RigidBody::KinematicPositionBased,
        RigidBodyDisabled,
        collider,
        // The collider's own mass would come on top.
        ColliderMassProperties::Density(0.0),
        AdditionalMassProperties::MassProperties(MassProperties {
            local_center_of_mass: bone.center,
            mass: bone.mass,
            principal_inertia_local_frame: bone.inertia_axes,
            principal_inertia: bone.inertia,
        }),
        Damping {
            linear_damping: damping,
            angular_damping: damping,
        },
    )
}

/// What a bone is in a mode.
pub(super) fn wanted(
    mode: RagdollMode,
    control: &BoneControl,
    plan: &RagdollPlan,
    state: &RagdollState,
    bone: usize,
) -> BoneBody {
    if sever::is_cut(plan, state, bone) {
        return match mode {
            RagdollMode::Frozen => BoneBody::Fixed,
            _ => BoneBody::Dynamic,
        };
    }
    // Flinches, unless it is the one that bears the others.
    let flinches = || state.bones[bone].hurt > 0.0 && plan.bones[bone].parent.is_some();
    match mode {
        RagdollMode::Animated => BoneBody::Off,
        RagdollMode::Powered | RagdollMode::Keyframed | RagdollMode::Limp => BoneBody::Dynamic,
        RagdollMode::Partial if control.simulated => BoneBody::Dynamic,
        RagdollMode::Partial | RagdollMode::HitBoxes if flinches() => BoneBody::Dynamic,
        RagdollMode::HitBoxes | RagdollMode::GettingUp | RagdollMode::Partial => {
            BoneBody::Kinematic
        }
        RagdollMode::Frozen => BoneBody::Fixed,
    }
}

/// Makes of every bone the kind of body that its mode asks for.
pub(super) fn switch(
    mut commands: Commands,
    ragdolls: Query<(
        &Ragdoll,
        &RagdollIntent,
        &RagdollPlan,
        &RagdollState,
        &Bones,
    )>,
    bones: Query<(
        &RagdollBone,
        &BoneControl,
        Option<&RigidBody>,
        Has<RigidBodyDisabled>,
    )>,
) {
    for (config, intent, plan, state, tied) in &ragdolls {
        let mode = rest::mode(intent, state, config);
        if rest::is_settled(mode, state) {
            continue;
        }
        for entity in tied.iter() {
            let Ok((bone, control, body, off)) = bones.get(entity) else {
                continue;
            };
            if bone.order >= plan.bones.len() || state.bones.len() != plan.bones.len() {
                continue;
            }
            // By what is there: a state that was written over it may tell of other bodies.
            let now = match body {
                _ if off => BoneBody::Off,
                Some(RigidBody::Dynamic) => BoneBody::Dynamic,
                Some(RigidBody::Fixed) => BoneBody::Fixed,
                _ => BoneBody::Kinematic,
            };
            let want = wanted(mode, control, plan, state, bone.order);
            if want == now {
                continue;
            }
            let mut bone = commands.entity(entity);
            match want {
                BoneBody::Off => {
                    bone.insert((RigidBody::KinematicPositionBased, RigidBodyDisabled));
                    continue;
                }
                BoneBody::Kinematic => bone.insert(RigidBody::KinematicPositionBased),
                BoneBody::Dynamic => bone.insert(RigidBody::Dynamic),
                BoneBody::Fixed => bone.insert(RigidBody::Fixed),
            };
            if now == BoneBody::Off {
                bone.remove::<RigidBodyDisabled>();
            }
        }
    }
}
