//! The human of the asset generator: loaded, made a ragdoll by its skin, and animated by its clips.

use core::time::Duration;

use bevy::{
    animation::{ActiveAnimation, AnimationPlugin, AnimationTargetId, animated_field},
    app::{PluginGroup, PluginGroupBuilder},
    gltf::{Gltf, GltfLoaderSettings, GltfPlugin, convert_coordinates::GltfConvertCoordinates},
    image::ImagePlugin,
    mesh::MeshPlugin,
    prelude::*,
    world_serialization::WorldSerializationPlugin,
};
use bevy_embody::{prelude::*, ragdoll::SkinReport};

/// What loading a figure needs where there is no window; behind Bevy's `AssetPlugin`.
#[derive(Clone, Copy, Debug, Default)]
pub struct FigureAssetsPlugins;

impl PluginGroup for FigureAssetsPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(ImagePlugin::default())
            .add(MeshPlugin)
            .add(WorldSerializationPlugin)
            .add(Materials)
            .add(GltfPlugin::default())
            .add(AnimationPlugin)
    }
}

/// Materials that nobody will look at.
struct Materials;

impl Plugin for Materials {
    fn build(&self, app: &mut App) {
        app.init_asset::<StandardMaterial>()
            .register_type::<MeshMaterial3d<StandardMaterial>>();
    }
}

/// A clip of the human; in the order of the clips of the graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clip {
    /// Standing.
    Idle,
    /// Walking.
    Walk,
    /// Running.
    Run,
    /// Getting up from the front.
    GetUpFront,
    /// Getting up from the back.
    GetUpBack,
}

impl Clip {
    const ALL: [(Self, &'static str); 5] = [
        (Self::Idle, "idle"),
        (Self::Walk, "walk"),
        (Self::Run, "run"),
        (Self::GetUpFront, "get_up_front"),
        (Self::GetUpBack, "get_up_back"),
    ];
    /// In the order of [`GetUp::clips`].
    const GET_UP: [Self; 2] = [Self::GetUpFront, Self::GetUpBack];

    /// Speed of the ground that it is made for, metres per second.
    fn speed(self) -> Option<f32> {
        match self {
            Self::Walk => Some(1.3),
            Self::Run => Some(3.3),
            _ => None,
        }
    }

    /// What one does at this speed, metres per second.
    fn at(speed: f32) -> Self {
        match speed {
            s if s > 2.3 => Self::Run,
            s if s > 0.2 => Self::Walk,
            _ => Self::Idle,
        }
    }
}

/// A human: with it an entity gets the generated figure, a ragdoll of its skin, and clips by how fast it
/// goes.
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(Transform, Visibility, RagdollFromSkin, Gait)]
pub struct Human;

/// How fast a human's legs go, metres per second: written each tick for characters, by hand for others.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Gait(pub f32);

/// On a human whose clips can be played.
#[derive(Component, Clone, Copy, Debug)]
pub struct Animated {
    player: Entity,
    /// What it plays.
    pub clip: Clip,
}

impl Animated {
    /// Whether it is busy getting up.
    pub fn gets_up(&self) -> bool {
        Clip::GET_UP.contains(&self.clip)
    }
}

/// The file and what was made of it.
#[derive(Resource, Default)]
struct HumanFile {
    file: Option<Handle<Gltf>>,
    graph: Option<(Handle<AnimationGraph>, Vec<AnimationNodeIndex>)>,
}

/// Loads every [`Human`] and animates it.
#[derive(Clone, Copy, Debug, Default)]
pub struct HumanPlugin;

impl Plugin for HumanPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<HumanFile>()
            .add_observer(begin_to_get_up)
            .add_systems(
                FixedPreUpdate,
                (dress, prepare, learn_to_get_up)
                    .chain()
                    .run_if(any_with_component::<Human>),
            )
            .add_systems(
                FixedUpdate,
                (pace, animate)
                    .chain()
                    .run_if(any_with_component::<Animated>),
            );
    }
}

/// Gives new humans their scene once the file is there.
fn dress(
    mut commands: Commands,
    mut human: ResMut<HumanFile>,
    assets: Res<AssetServer>,
    files: Res<Assets<Gltf>>,
    mut graphs: ResMut<Assets<AnimationGraph>>,
    new: Query<Entity, (With<Human>, Without<WorldAssetRoot>)>,
) {
    if new.is_empty() {
        return;
    }
    // Files face +Z, characters -Z.
    let turned = |settings: &mut GltfLoaderSettings| {
        settings.convert_coordinates = Some(GltfConvertCoordinates {
            rotate_scene_entity: true,
            ..default()
        });
    };
    let load = || {
        let loader = assets.load_builder().with_settings(turned);
        loader.load("human.glb")
    };
    let file = human.file.get_or_insert_with(load).clone();
    let Some(file) = files.get(&file) else {
        return;
    };
    if human.graph.is_none() {
        let clips = Clip::ALL.map(|(_, name)| file.named_animations.get(name).cloned());
        let (graph, nodes) = AnimationGraph::from_clips(clips.into_iter().flatten());
        if nodes.len() == Clip::ALL.len() {
            human.graph = Some((graphs.add(graph), nodes));
        }
    }
    let Some(scene) = file.scenes.first() else {
        return;
    };
    for entity in &new {
        commands
            .entity(entity)
            .insert(WorldAssetRoot(scene.clone()));
    }
}

/// Gives those that are ragdolls now a player of clips.
fn prepare(
    mut commands: Commands,
    human: Res<HumanFile>,
    ready: Query<Entity, (With<Human>, With<SkinReport>, Without<Animated>)>,
    children: Query<&Children>,
    mut players: Query<&mut AnimationPlayer>,
) {
    let Some((graph, nodes)) = &human.graph else {
        return;
    };
    for entity in &ready {
        let below = children.iter_descendants(entity);
        let found = below.into_iter().find(|e| players.contains(*e));
        let Some(player) = found else { continue };
        let Ok(mut clips) = players.get_mut(player) else {
            continue;
        };
        let mut transitions = AnimationTransitions::new();
        transitions
            .play(&mut clips, nodes[0], Duration::ZERO)
            .repeat();
        commands
            .entity(player)
            .insert((AnimationGraphHandle(graph.clone()), transitions));
        let clip = Clip::Idle;
        commands.entity(entity).insert(Animated { player, clip });
    }
}

/// Reads off the clips how somebody lies who is about to get up.
fn learn_to_get_up(
    mut commands: Commands,
    human: Res<HumanFile>,
    files: Res<Assets<Gltf>>,
    clips: Res<Assets<AnimationClip>>,
    new: Query<(Entity, &Ragdoll, &Bones), (With<Human>, Without<GetUp>)>,
    bones: Query<(&RagdollBone, &BoneJoint)>,
    nodes: Query<(&Transform, &ChildOf, Option<&AnimationTargetId>)>,
) {
    let file = human.file.as_ref().and_then(|file| files.get(file));
    let Some(file) = file else { return };
    for (entity, ragdoll, tied) in &new {
        let mut known = GetUp::default();
        for (clip, name) in Clip::ALL {
            if !Clip::GET_UP.contains(&clip) {
                continue;
            }
            let clip = file.named_animations.get(name);
            let Some(clip) = clip.and_then(|clip| clips.get(clip)) else {
                continue;
            };
            let mut start = RagdollPose {
                bones: vec![BonePose::default(); ragdoll.profile.bones.len()],
            };
            for (bone, tie) in bones.iter_many(tied.iter()) {
                let joint = at_start(clip, tie.joint, entity, &nodes);
                if let Some(slot) = start.bones.get_mut(bone.index) {
                    slot.position = joint.transform_point(tie.offset.position);
                    slot.rotation = (joint.rotation * tie.offset.rotation).normalize();
                }
            }
            known.clips.push(GetUpClip {
                name: name.into(),
                start,
            });
        }
        commands.entity(entity).insert(known);
    }
}

/// Where a clip begins with a joint, in the axes of the figure.
fn at_start(
    clip: &AnimationClip,
    joint: Entity,
    figure: Entity,
    nodes: &Query<(&Transform, &ChildOf, Option<&AnimationTargetId>)>,
) -> Transform {
    let mut whole = Transform::IDENTITY;
    let mut at = joint;
    while at != figure
        && let Ok((transform, parent, target)) = nodes.get(at)
    {
        let mut local = *transform;
        if let Some(target) = target {
            let place = animated_field!(Transform::translation);
            local.translation = clip
                .sample_clamped(place, *target, 0.0)
                .unwrap_or(local.translation);
            let turn = animated_field!(Transform::rotation);
            local.rotation = clip
                .sample_clamped(turn, *target, 0.0)
                .unwrap_or(local.rotation);
        }
        whole = local * whole;
        at = parent.parent();
    }
    whole
}

/// The legs of characters go as fast as they do.
fn pace(mut humans: Query<(&mut Gait, &CharacterState)>) {
    for (mut gait, state) in &mut humans {
        gait.0 = state.velocity.with_y(0.0).length();
    }
}

fn begin_to_get_up(
    begins: On<GetsUp>,
    human: Res<HumanFile>,
    mut humans: Query<&mut Animated>,
    mut players: Query<(&mut AnimationPlayer, &mut AnimationTransitions)>,
) {
    let (Some((_, nodes)), Ok(mut animated)) = (&human.graph, humans.get_mut(begins.entity)) else {
        return;
    };
    animated.clip = Clip::GET_UP[begins.clip.min(1)];
    if let Ok((mut player, mut transitions)) = players.get_mut(animated.player) {
        player.stop_all();
        let node = nodes[animated.clip as usize];
        transitions.play(&mut player, node, Duration::ZERO).replay();
    }
}

fn animate(
    human: Res<HumanFile>,
    mut humans: Query<(&mut Animated, &Gait)>,
    mut players: Query<(&mut AnimationPlayer, &mut AnimationTransitions)>,
) {
    let Some((_, nodes)) = &human.graph else {
        return;
    };
    for (mut animated, gait) in &mut humans {
        let Ok((mut player, mut transitions)) = players.get_mut(animated.player) else {
            continue;
        };
        let node = nodes[animated.clip as usize];
        let over = player
            .animation(node)
            .is_none_or(ActiveAnimation::is_finished);
        if animated.gets_up() && !over {
            continue;
        }
        let wanted = Clip::at(gait.0);
        if animated.clip != wanted {
            animated.clip = wanted;
            let node = nodes[wanted as usize];
            transitions
                .play(&mut player, node, Duration::from_millis(250))
                .repeat();
        }
        if let Some(made_for) = wanted.speed()
            && let Some(playing) = player.animation_mut(nodes[wanted as usize])
        {
            playing.set_speed(gait.0 / made_for);
        }
    }
}
