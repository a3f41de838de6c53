//! A figure as one sets it up with Rapier alone.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{Sim, terrain::StableId};

/// The same bodies, tied by Rapier's joints as its documentation shows it.
pub fn peer(sim: &mut Sim, ragdoll: &Ragdoll, pose: Option<&RagdollPose>, i: u32, at: Transform) {
    let profile = &ragdoll.profile;
    let whole: f32 = profile.bones.iter().map(|bone| bone.mass.share).sum();
    let mut made: Vec<Entity> = Vec::new();
    for (n, bone) in profile.bones.iter().enumerate() {
        let place = at * Transform::from_translation(bone.position).with_rotation(bone.rotation);
        let (shape, offset) = match bone.shape {
            BoneShape::Capsule { from, to, radius } => {
                (Collider::capsule(from, to, radius), Transform::IDENTITY)
            }
            BoneShape::Box {
                center,
                rotation,
                half,
            } => (
                Collider::cuboid(half.x, half.y, half.z),
                Transform::from_translation(center).with_rotation(rotation),
            ),
        };
        let shape = Collider::compound(vec![(offset.translation, offset.rotation, shape)]);
        let mass = ragdoll.mass * bone.mass.share / whole;
        let gyration = bone.mass.gyration;
        let entity = sim.spawn((
            RigidBody::Dynamic,
            shape,
            ColliderMassProperties::Density(0.0),
            AdditionalMassProperties::MassProperties(MassProperties {
                local_center_of_mass: bone.mass.center,
                mass,
                principal_inertia_local_frame: bone.mass.axes,
                principal_inertia: gyration * gyration * mass,
            }),
            place,
        ));
        if n == 0 {
            sim.app
                .world_mut()
                .entity_mut(entity)
                .insert((StableId(i), Pelvis));
        }
        let parent = bone.parent.as_deref().and_then(|p| profile.index(p));
        if let Some(parent) = parent
            && let Some(body) = made.get(parent)
        {
            let joint = tie(profile, parent, n, pose);
            sim.app
                .world_mut()
                .entity_mut(entity)
                .insert(ImpulseJoint::new(*body, TypedJoint::GenericJoint(joint)));
        }
        made.push(entity);
    }
}

/// The first body of a figure of Rapier's.
#[derive(Component)]
pub struct Pelvis;

/// Hertz of the motors.
const FREQUENCY: f32 = 10.0;

/// A limit on each axis, and, for a pose, a motor on each.
fn tie(
    profile: &RagdollProfile,
    parent: usize,
    child: usize,
    pose: Option<&RagdollPose>,
) -> GenericJoint {
    let (up, own) = (&profile.bones[parent], &profile.bones[child]);
    let frame = own.joint.frame;
    let (f1, f2) = (
        (up.rotation.inverse() * frame).normalize(),
        (own.rotation.inverse() * frame).normalize(),
    );
    let axes = [JointAxis::AngX, JointAxis::AngY, JointAxis::AngZ];
    let slides = JointAxesMask::LIN_X | JointAxesMask::LIN_Y | JointAxesMask::LIN_Z;
    let turns = JointAxesMask::ANG_X | JointAxesMask::ANG_Y | JointAxesMask::ANG_Z;
    let across = JointAxesMask::ANG_Y | JointAxesMask::ANG_Z;
    let (locked, ranges) = match own.joint.kind {
        JointKind::Ball {
            swing,
            center,
            twist,
        } => (
            slides,
            [
                Some([twist.x, twist.y]),
                Some([center.x - swing.x, center.x + swing.x]),
                Some([center.y - swing.y, center.y + swing.y]),
            ],
        ),
        JointKind::Condyloid { swing, center } => (
            slides | JointAxesMask::ANG_X,
            [
                None,
                Some([center.x - swing.x, center.x + swing.x]),
                Some([center.y - swing.y, center.y + swing.y]),
            ],
        ),
        JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => {
            (slides | across, [Some([min, max]), None, None])
        }
        JointKind::Saddle { y, z } => (
            slides | JointAxesMask::ANG_X,
            [None, Some([y.x, y.y]), Some([z.x, z.y])],
        ),
        JointKind::Gliding { .. } | JointKind::Fixed => (slides | turns, [None; 3]),
    };
    let asked = pose.map_or(Quat::IDENTITY, |pose| {
        let turn = |i: usize| pose.bones[i].rotation;
        f1.inverse() * turn(parent).inverse() * turn(child) * f2
    });
    let asked = asked.to_scaled_axis().to_array();
    let mut joint = GenericJointBuilder::new(locked)
        .local_anchor1(up.rotation.inverse() * (own.position - up.position))
        .local_anchor2(Vec3::ZERO)
        .local_basis1(f1)
        .local_basis2(f2);
    let rate = core::f32::consts::TAU * FREQUENCY;
    for ((axis, range), asked) in axes.into_iter().zip(ranges).zip(asked) {
        let Some(range) = range else { continue };
        joint = joint.limits(axis, range);
        if pose.is_some() {
            let asked = asked.clamp(range[0], range[1]);
            joint = joint.motor_position(axis, asked, rate * rate, 2.0 * rate);
        }
    }
    let mut joint = joint.build();
    joint.set_contacts_enabled(false);
    joint
}
