//! A ragdoll of whatever skinned figure a loaded scene holds.

use bevy::{
    mesh::{
        Mesh3d, VertexAttributeValues,
        skinning::{SkinnedMesh, SkinnedMeshInverseBindposes},
    },
    prelude::*,
};

use super::fit::{fit_box, fit_capsule};
use crate::ragdoll::{
    config::Ragdoll,
    follow::FollowRoot,
    humanoid::{BodyPart, HumanoidDetail, first_part},
    names::{NameMap, SkeletonBone, SkeletonMatch},
    pose::BonePose,
    profile::{BoneMass, BoneShape, RagdollProfile},
};

/// How much longer one axis of a skeleton may be than another.
const EVEN: f32 = 1.02;
/// Part of a vertex that a bone must move for the vertex to be of its body.
const OWN: f32 = 0.5;

/// On the entity of a scene with a skinned human figure: makes it a [`Ragdoll`] as soon as the scene is
/// there, and tells so by [`RagdollReady`].
///
/// Bones are found by their names; their bodies are fitted to the skin that they move, with the masses
/// and joints of anatomy; the skeleton's joints are then shown where the bodies are. The figure must
/// face the `-Z` of this entity: glTF files face `+Z`, which Bevy's loader turns round when it is asked
/// to (`GltfConvertCoordinates::rotate_scene_entity`). Its scale in the world must be the same along every
/// axis, and that of its bones too: a mirrored or stretched skeleton is told, and stays without bones.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_embody::prelude::*;
/// # #[derive(Component)] struct SomeScene;
/// # fn spawn(mut commands: Commands, scene: SomeScene) {
/// commands.spawn((scene, RagdollFromSkin::default()));
/// # }
/// ```
#[derive(Component, Clone, Debug, PartialEq)]
#[require(Transform)]
pub struct RagdollFromSkin {
    /// The finest level of detail; `None` the finest that the skeleton allows.
    pub detail: Option<HumanoidDetail>,
    /// What the ragdoll is beside its profile, which is found.
    pub ragdoll: Ragdoll,
    /// Whether bodies are fitted to the skin; otherwise they have the volumes of anatomy.
    pub fit: bool,
    /// Names of bones beside those that are known.
    pub names: NameMap,
}

impl Default for RagdollFromSkin {
    fn default() -> Self {
        Self {
            detail: None,
            ragdoll: Ragdoll::default(),
            fit: true,
            names: NameMap::default(),
        }
    }
}

/// What was found in a skeleton: on the entity that had [`RagdollFromSkin`].
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct SkinReport {
    /// The bones of the skeleton, in their bind pose in the axes of the figure.
    pub bones: Vec<SkeletonBone>,
    /// The entity of each.
    pub joints: Vec<Entity>,
    /// Which part of a figure each is, or goes along with, or that it was left.
    pub found: SkeletonMatch,
    /// The level of detail.
    pub detail: HumanoidDetail,
    /// Bodies that were fitted to the skin, by name; the others have the volumes of anatomy.
    pub fitted: Vec<String>,
}

/// The ragdoll of a scene is there, with its [`Bones`](crate::ragdoll::Bones) and its [`SkinReport`].
/// Triggered once.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct RagdollReady {
    /// The ragdoll.
    pub entity: Entity,
}

/// On a ragdoll: the joints that its bones show, by the bones' names.
#[derive(Component, Clone, Debug, Default)]
pub(crate) struct SkeletonJoints {
    pub joints: Vec<(String, Entity, BonePose)>,
    /// Whether [`RagdollReady`] was triggered.
    pub told: bool,
}

/// A mesh and how it is moved.
type Skinned = (Entity, &'static SkinnedMesh, Option<&'static Mesh3d>);

/// Builds the ragdolls of scenes that have come.
pub(crate) fn build(
    mut commands: Commands,
    waiting: Query<(Entity, &RagdollFromSkin), Without<SkinReport>>,
    children: Query<&Children>,
    skins: Query<Skinned>,
    nodes: Query<(&Transform, Option<&Name>, Option<&ChildOf>)>,
    binds: Option<Res<Assets<SkinnedMeshInverseBindposes>>>,
    meshes: Option<Res<Assets<Mesh>>>,
) {
    let Some(binds) = binds else { return };
    for (entity, wish) in &waiting {
        let below = children.iter_descendants(entity);
        let skinned: Vec<_> = below.filter_map(|e| skins.get(e).ok()).collect();
        let Some(first) = skinned.first() else {
            continue;
        };
        let loaded = |(_, skin, mesh): &(Entity, &SkinnedMesh, Option<&Mesh3d>)| {
            let mesh_there = match (mesh, &meshes) {
                (Some(mesh), Some(meshes)) => meshes.get(&mesh.0).is_some(),
                _ => true,
            };
            binds.get(&skin.inverse_bindposes).is_some() && mesh_there
        };
        if !skinned.iter().all(loaded) {
            continue;
        }
        let Some(figure) = read(entity, first.1, &nodes, &binds) else {
            tracing::warn!(
                "{entity}: RagdollFromSkin: the joints of {} are not below it",
                first.0
            );
            commands.entity(entity).insert(SkinReport::default());
            continue;
        };
        let (bones, joints, model) = figure;
        if let Some(what) = unfit(scale_of(entity, &nodes), &bones) {
            tracing::warn!(
                "{entity}: RagdollFromSkin: {what}, but needs one above 0 that is the same along every axis \
                 (is it mirrored or stretched?); it has no bones"
            );
            commands.entity(entity).insert(SkinReport {
                bones,
                joints,
                ..default()
            });
            continue;
        }
        let found = SkeletonMatch::find(&bones, &wish.names);
        let rig = match found.rig(&bones) {
            Ok(rig) => rig,
            Err(missing) => {
                tracing::warn!(
                    "{entity}: RagdollFromSkin: the skeleton has no bone for {missing:?}; name them in \
                     RagdollFromSkin::names"
                );
                commands.entity(entity).insert(SkinReport {
                    bones,
                    joints,
                    found,
                    ..default()
                });
                continue;
            }
        };
        let finest = found.detail().unwrap_or(HumanoidDetail::Bodies10);
        let detail = wish
            .detail
            .map_or(finest, |d| if coarser(d, finest) { d } else { finest });
        let mut profile = RagdollProfile::of_rig(detail, &rig);
        let mut report = SkinReport {
            bones,
            joints,
            found,
            detail,
            fitted: Vec::new(),
        };
        if wish.fit
            && let Some(meshes) = &meshes
        {
            let mut cloud = vec![Vec::new(); profile.bones.len()];
            for (_, skin, mesh) in &skinned {
                if let Some(mesh) = mesh.and_then(|m| meshes.get(&m.0)) {
                    collect(mesh, skin, &report, &profile, &model, &mut cloud);
                }
            }
            report.fitted = fit(&mut profile, &cloud);
        }
        let joints = SkeletonJoints {
            joints: tie(&profile, &report),
            told: false,
        };
        let ragdoll = Ragdoll {
            profile,
            ..wish.ragdoll.clone()
        };
        commands
            .entity(entity)
            .insert((ragdoll, joints, report, FollowRoot));
    }
}

fn coarser(a: HumanoidDetail, b: HumanoidDetail) -> bool {
    let count = |d: HumanoidDetail| BodyPart::ALL.iter().filter(|p| p.is_body(d)).count();
    count(a) <= count(b)
}

/// The scale of an entity in the world, as far as it is along its own axes.
fn scale_of(entity: Entity, nodes: &Query<(&Transform, Option<&Name>, Option<&ChildOf>)>) -> Vec3 {
    let (mut whole, mut at) = (Vec3::ONE, Some(entity));
    while let Some((transform, _, parent)) = at.and_then(|e| nodes.get(e).ok()) {
        whole *= transform.scale;
        at = parent.map(ChildOf::parent);
    }
    whole
}

/// What no ragdoll can be made of, in words: bodies are as large along every axis, and not inside out.
fn unfit(whole: Vec3, bones: &[SkeletonBone]) -> Option<String> {
    let fits = |scale: Vec3| {
        let (least, most) = (scale.min_element(), scale.max_element());
        scale.is_finite() && least > 0.0 && most <= EVEN * least
    };
    if !fits(whole) {
        return Some(format!("its scale is {whole}"));
    }
    let bone = bones.iter().find(|bone| !fits(bone.pose.scale))?;
    let name = &bone.name;
    Some(format!(
        "bone \"{name}\" has the scale {} in its bind pose",
        bone.pose.scale
    ))
}

/// The bones of a skin in their bind pose, in the axes of the figure, and what takes the model there.
fn read(
    entity: Entity,
    skin: &SkinnedMesh,
    nodes: &Query<(&Transform, Option<&Name>, Option<&ChildOf>)>,
    binds: &Assets<SkinnedMeshInverseBindposes>,
) -> Option<(Vec<SkeletonBone>, Vec<Entity>, Transform)> {
    let binds = binds.get(&skin.inverse_bindposes)?;
    let parent = |e: Entity| nodes.get(e).ok()?.2.map(ChildOf::parent);
    let bind =
        |i: usize| Transform::from_matrix(binds.get(i).map_or(Mat4::IDENTITY, Mat4::inverse));
    let bones: Vec<SkeletonBone> = (skin.joints.iter().enumerate())
        .map(|(i, joint)| {
            let mut up = parent(*joint);
            let mut bears = None;
            while let Some(e) = up {
                bears = skin.joints.iter().position(|j| *j == e);
                if bears.is_some() {
                    break;
                }
                up = parent(e);
            }
            let name = nodes.get(*joint).ok().and_then(|n| n.1);
            SkeletonBone {
                name: name.map(|n| n.as_str().to_owned()).unwrap_or_default(),
                parent: bears,
                pose: bind(i),
            }
        })
        .collect();
    let root = bones.iter().position(|b| b.parent.is_none())?;
    // Where the root joint is, as it stands in the scene: its bind pose shows where the model is.
    let mut place = Transform::IDENTITY;
    let mut at = skin.joints[root];
    while at != entity {
        place = *nodes.get(at).ok()?.0 * place;
        at = parent(at)?;
    }
    let model = Transform::from_matrix(place.to_matrix() * bind(root).to_matrix().inverse());
    // The scale of the figure as a whole counts; its place does not.
    let model = Transform::from_scale(scale_of(entity, nodes)) * model;
    let posed = |mut bone: SkeletonBone| {
        bone.pose = model * bone.pose;
        bone
    };
    let bones: Vec<SkeletonBone> = bones.into_iter().map(posed).collect();
    Some((bones, skin.joints.clone(), model))
}

/// The body of a profile that a bone of the skeleton belongs to.
fn body_of(bone: usize, report: &SkinReport, profile: &RagdollProfile) -> Option<usize> {
    let matched = report.found.matched.iter().find(|(_, b)| *b == bone);
    let merged = report.found.merged.iter().find(|(b, _)| *b == bone);
    let part = matched.map(|m| m.0).or(merged.map(|m| m.1))?;
    profile.index(part.body(report.detail).name())
}

/// Sorts the vertices of a mesh by body, in the axes of the bodies' bones.
fn collect(
    mesh: &Mesh,
    skin: &SkinnedMesh,
    report: &SkinReport,
    profile: &RagdollProfile,
    model: &Transform,
    cloud: &mut [Vec<Vec3>],
) {
    let positions = mesh.attribute(Mesh::ATTRIBUTE_POSITION);
    let (Some(positions), Some(VertexAttributeValues::Uint16x4(joints))) = (
        positions.and_then(VertexAttributeValues::as_float3),
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX),
    ) else {
        return;
    };
    let Some(VertexAttributeValues::Float32x4(weights)) =
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT)
    else {
        return;
    };
    // Another mesh of the figure may list its joints otherwise.
    let bodies: Vec<Option<usize>> = (skin.joints.iter())
        .map(|joint| {
            let bone = report.joints.iter().position(|j| j == joint)?;
            body_of(bone, report, profile)
        })
        .collect();
    for ((position, joints), weights) in positions.iter().zip(joints).zip(weights) {
        let body = |j: u16| bodies.get(usize::from(j)).copied().flatten();
        for (joint, weight) in joints.iter().zip(weights) {
            let Some(of) = body(*joint).filter(|_| *weight > 0.0) else {
                continue;
            };
            let all = joints.iter().zip(weights);
            let whole: f32 = all
                .filter(|(j, _)| body(**j) == Some(of))
                .map(|(_, w)| *w)
                .sum();
            if whole > OWN {
                let bone = &profile.bones[of];
                let at = model.transform_point(Vec3::from_array(*position));
                cloud[of].push(bone.rotation.inverse() * (at - bone.position));
                break;
            }
        }
    }
}

/// Gives each body the shape of its points, of the kind that it has.
fn fit(profile: &mut RagdollProfile, cloud: &[Vec<Vec3>]) -> Vec<String> {
    let mut fitted = Vec::new();
    for (bone, points) in profile.bones.iter_mut().zip(cloud) {
        let shape = match bone.shape {
            BoneShape::Capsule { from, to, .. } => fit_capsule(points, Some(to - from)),
            BoneShape::Box { rotation, .. } => fit_box(points, rotation),
        };
        let Some(shape) = shape else { continue };
        bone.shape = shape;
        if let BoneShape::Box { .. } = shape {
            bone.mass = BoneMass::solid(bone.mass.share, &shape);
        }
        fitted.push(bone.name.clone());
    }
    fitted
}

/// The joint of each body, and the body's bone in its axes.
fn tie(profile: &RagdollProfile, report: &SkinReport) -> Vec<(String, Entity, BonePose)> {
    let mut tied = Vec::new();
    for bone in &profile.bones {
        let part = BodyPart::ALL.into_iter().find(|p| p.name() == bone.name);
        let Some(part) = part else { continue };
        let first = report.found.bone(first_part(part, report.detail));
        let Some(joint) = first.or_else(|| report.found.bone(part)) else {
            continue;
        };
        let at = &report.bones[joint].pose;
        let back = at.rotation.inverse().normalize();
        tied.push((
            bone.name.clone(),
            report.joints[joint],
            BonePose {
                position: back * (bone.position - at.translation),
                rotation: (back * bone.rotation).normalize(),
            },
        ));
    }
    tied
}
