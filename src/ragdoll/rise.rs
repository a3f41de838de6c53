//! Getting up: which clip begins like the figure lies, where it is played, and waiting for it.
//!
//! Each clip is laid over the figure by the turn about up, and the way, that brings the centres of its
//! bones closest by mass, which has a closed form. Then the clip whose bones are turned least from those
//! of the figure is taken, by the mean square angle, again by mass. The figure's entity goes where the
//! clip is, on the floor there; the bones follow from where they lie without a jump, first to the clip's
//! beginning, then, once the animation plays it, along with it.

use bevy::{math::ops, prelude::*};

use super::{
    bone::{BoneOf, Bones},
    config::Ragdoll,
    follow::{at_height, facing, heading, lowest},
    intent::{RagdollIntent, RagdollMode},
    math::rotation::{angle, from_rotation_vector},
    plan::RagdollPlan,
    pose::{BonePose, RagdollPose},
    rest,
    sever::is_cut,
    state::{BoneBody, RagdollState},
    tick::Slot,
    up::RagdollUp,
};
use crate::backend::{handles::RapierContextEntityLink, world::PhysicsWorlds};

/// How long the beginning of a clip is held for an animation that has yet to begin, seconds.
const PATIENCE: f32 = 0.3;
/// An animation that is nearer to the clip's beginning than this plays it, radians on the mean.
const NEAR: f32 = 0.2;
/// How far above its middle the figure looks for its floor, metres, and how far down from there.
const ABOVE: f32 = 0.3;
const REACH: f32 = 4.0;
/// Ground steeper than this is not stood on, as the cosine of its slope.
const STEEP: f32 = 0.5;

/// On a ragdoll: the clips by which it gets up. In [`RagdollMode::GettingUp`] it takes the one that begins
/// most like it lies and says so by [`GetsUp`]; the game then plays that clip from its beginning.
///
/// Without it, or without clips, the figure rises to whatever pose is asked for, where it is.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct GetUp {
    /// From the front, from the back, from either side: as many as there are.
    pub clips: Vec<GetUpClip>,
}

/// A clip by which a figure gets up.
#[derive(Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct GetUpClip {
    /// Its name, for the game.
    pub name: String,
    /// Its beginning, lying: every bone in the axes of the figure, as the clip has it.
    pub start: RagdollPose,
}

/// It begins to get up: play this clip from its beginning.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct GetsUp {
    /// The ragdoll.
    pub entity: Entity,
    /// The place of the clip in [`GetUp::clips`].
    pub clip: usize,
}

/// How a figure lies.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[reflect(Debug, PartialEq, Hash, Clone)]
pub enum Lying {
    /// Not at all: its root is upright.
    Upright,
    /// On its face.
    Front,
    /// On its back.
    Back,
    /// On its left side.
    Left,
    /// On its right side.
    Right,
    /// Upside down.
    Head,
}

impl Lying {
    /// How a figure lies whose root is turned so, and has this rotation in the bind pose; `up` is of unit
    /// length, world.
    pub fn of(root: Quat, bind: Quat, up: Vec3) -> Self {
        let up = (root * bind.inverse()).inverse() * up;
        let most = up.abs().max_element();
        if up.z.abs() >= most {
            if up.z > 0.0 { Self::Front } else { Self::Back }
        } else if up.y.abs() >= most {
            if up.y > 0.0 {
                Self::Upright
            } else {
                Self::Head
            }
        } else if up.x > 0.0 {
            Self::Left
        } else {
            Self::Right
        }
    }
}

/// A clip laid over a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Laid {
    /// Upright, turned about up.
    pub rotation: Quat,
    /// Of the clip's origin; the height is the floor's business.
    pub origin: Vec3,
    /// Mean square angle of the bones, square radians.
    pub cost: f32,
}

/// Lays a pose, given in the axes of the figure, over where bones are. What is cut off lies elsewhere, and
/// does not count.
pub(crate) fn lay(
    plan: &RagdollPlan,
    place: impl Fn(usize) -> BonePose,
    cut: impl Fn(usize) -> bool,
    pose: &RagdollPose,
    up: Vec3,
) -> Laid {
    let upright = Quat::from_rotation_arc(Vec3::Y, up);
    let back = upright.inverse();
    let asked = |i: usize| {
        let bone = &plan.bones[i];
        *pose.bones.get(bone.index).unwrap_or(&bone.bind)
    };
    let center = |i: usize, at: &BonePose| at.position + at.rotation * plan.bones[i].center;
    let (mut mass, mut of_pose, mut of_figure) = (0.0, Vec3::ZERO, Vec3::ZERO);
    let whole = || (plan.bones.iter().enumerate()).filter(|(i, _)| !cut(*i));
    for (i, bone) in whole() {
        mass += bone.mass;
        of_pose += center(i, &asked(i)) * bone.mass;
        of_figure += center(i, &place(i)) * bone.mass;
    }
    let (of_pose, of_figure) = (of_pose / mass, of_figure / mass);
    let (mut cos, mut sin) = (0.0, 0.0);
    for (i, bone) in whole() {
        let a = center(i, &asked(i)) - of_pose;
        let b = back * (center(i, &place(i)) - of_figure);
        cos += bone.mass * (a.x * b.x + a.z * b.z);
        sin += bone.mass * (a.z * b.x - a.x * b.z);
    }
    let rotation = upright * from_rotation_vector(Vec3::Y * ops::atan2(sin, cos));
    let mut cost = 0.0;
    for (i, bone) in whole() {
        let off = angle((rotation * asked(i).rotation).inverse() * place(i).rotation);
        cost += bone.mass * off * off / mass;
    }
    Laid {
        rotation,
        origin: of_figure - rotation * of_pose,
        cost,
    }
}

/// Where and by which clip a figure would get up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RisePlace {
    pub clip: Option<usize>,
    pub position: Vec3,
    pub rotation: Quat,
}

/// Finds the clip and the place on the floor. `skip` names what is no floor.
pub(crate) fn find_place(
    plan: &RagdollPlan,
    state: &RagdollState,
    clips: Option<&GetUp>,
    worlds: &PhysicsWorlds,
    link: &RapierContextEntityLink,
    up: Vec3,
    skip: impl Fn(Entity) -> bool,
) -> Option<RisePlace> {
    if plan.bones.is_empty() || plan.bones.len() != state.bones.len() {
        return None;
    }
    let place = |i: usize| state.bones[i].place;
    let clips = clips.map_or(&[][..], |c| &c.clips[..]);
    let cut = |i: usize| is_cut(plan, state, i);
    let laid = clips
        .iter()
        .map(|clip| lay(plan, place, cut, &clip.start, up));
    let best = (laid.enumerate()).min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
    let root = place(0).position;
    let (clip, rotation, origin) = match best {
        Some((clip, laid)) => (Some(clip), laid.rotation, laid.origin),
        None => {
            let bind = &plan.bones[0].bind;
            let ahead = heading(place(0).rotation, bind.rotation, up);
            let upright = Quat::from_rotation_arc(Vec3::Y, up);
            let rotation = ahead.map_or(upright, |ahead| facing(ahead, up));
            (None, rotation, root - rotation * bind.position)
        }
    };
    let view = worlds.of(link)?;
    let low = lowest(plan, state, up);
    let floor = |at: Vec3| {
        let from = at_height(at, up, root.dot(up) + ABOVE);
        let found = view.floor_below(from, -up, REACH, &skip);
        let found = found.filter(|(_, normal)| normal.dot(up) > STEEP);
        found.map(|(point, _)| point.dot(up))
    };
    // Behind a wall or beyond an edge there is no place for the feet: then it is below the root.
    let (position, height) = match floor(origin) {
        Some(height) if (height - low).abs() < ABOVE + 0.5 => (origin, height),
        _ => (root, floor(root).unwrap_or(low)),
    };
    let position = at_height(position, up, height);
    position.is_finite().then_some(RisePlace {
        clip,
        position,
        rotation,
    })
}

/// Moves a figure that begins to get up to where its clip is, and says which it is.
pub(super) fn begin(
    mut commands: Commands,
    worlds: PhysicsWorlds,
    mut ragdolls: Query<
        (
            Entity,
            &Ragdoll,
            &RagdollIntent,
            &RagdollPlan,
            &mut RagdollState,
            &mut Transform,
            &RagdollUp,
            &GetUp,
            &Bones,
        ),
        Without<ChildOf>,
    >,
    bones: Query<(&BoneOf, &RapierContextEntityLink)>,
) {
    for (entity, config, intent, plan, mut state, mut transform, up, clips, tied) in &mut ragdolls {
        let begins = rest::mode(intent, &state, config) == RagdollMode::GettingUp
            && state.mode != RagdollMode::GettingUp;
        let simulated =
            |b: &super::state::BoneState| matches!(b.body, BoneBody::Dynamic | BoneBody::Fixed);
        if !begins || !state.bones.first().is_some_and(simulated) {
            continue;
        }
        let Some((_, link)) = bones.iter_many(tied.iter()).next() else {
            continue;
        };
        // The same as where a character looks for room: of other figures, bones are in the way.
        let own =
            |other: Entity| other == entity || bones.get(other).is_ok_and(|(of, _)| of.0 == entity);
        let up = up.direction();
        let Some(place) = find_place(plan, &state, Some(clips), &worlds, link, up, own) else {
            continue;
        };
        let Some(clip) = place.clip else { continue };
        transform.translation = place.position;
        transform.rotation = place.rotation;
        let figure = Transform::from_translation(place.position).with_rotation(place.rotation);
        // The pose asked for begins here: it has no velocity from having been elsewhere.
        let start = &clips.clips[clip].start;
        for (bone, known) in plan.bones.iter().zip(&mut state.bones) {
            let asked = start.bones.get(bone.index).unwrap_or(&bone.bind);
            known.target = Some(asked.seen_from(&figure));
        }
        state.rise = Some(clip);
        commands.trigger(GetsUp { entity, clip });
    }
}

/// How long it takes to rise, seconds; what is no time is mended, and told once.
pub(super) fn time(entity: Entity, plan: &mut RagdollPlan, state: &mut RagdollState) -> f32 {
    let asked = state.rise_time;
    let bad = !(asked >= 0.0 && asked.is_finite());
    if bad {
        state.rise_time = RagdollState::default().rise_time;
        if !plan.told_rise {
            tracing::warn!(
                "{entity}: ragdoll: RagdollState::rise_time is {asked}, but needs a finite number of at \
                 least 0; it is {}",
                state.rise_time
            );
        }
    }
    plan.told_rise |= bad;
    state.rise_time
}

/// Holds the beginning of the clip until the animation plays it, then goes over to the animation.
pub(super) fn wait_for_clip(
    clips: Option<&GetUp>,
    plan: &RagdollPlan,
    state: &mut RagdollState,
    figure: &Transform,
    slots: &mut [Option<Slot>],
) {
    let Some(clip) = state.rise else { return };
    let clip = clips.and_then(|c| c.clips.get(clip));
    let start = |i: usize| {
        let bone = &plan.bones[i];
        let asked = clip.and_then(|c| c.start.bones.get(bone.index));
        asked.unwrap_or(&bone.bind).seen_from(figure)
    };
    let (mut sum, mut mass) = (0.0, 0.0);
    for (i, slot) in slots.iter().enumerate() {
        if let Some(slot) = slot {
            let off = angle(start(i).rotation.inverse() * slot.target.rotation);
            sum += plan.bones[i].mass * off;
            mass += plan.bones[i].mass;
        }
    }
    let late = state.mode == RagdollMode::GettingUp && state.age >= PATIENCE;
    let plays = clip.is_none() || late || sum <= NEAR * mass;
    for (i, slot) in slots.iter_mut().enumerate() {
        let Some(slot) = slot else { continue };
        if plays {
            slot.before = slot.target;
            slot.anew = true;
        } else {
            slot.target = start(i);
        }
    }
    if plays {
        state.rise = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::{humanoid::HumanoidDetail, profile::RagdollProfile};
    use core::f32::consts::FRAC_PI_2;

    fn plan() -> (Ragdoll, RagdollPlan) {
        let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
        let config = Ragdoll::new(profile, 75.0);
        let plan = RagdollPlan::of(&config);
        (config, plan)
    }

    fn places(plan: &RagdollPlan, pose: &RagdollPose, at: &Transform) -> Vec<BonePose> {
        let place = |b: &super::super::plan::PlannedBone| pose.bones[b.index].seen_from(at);
        plan.bones.iter().map(place).collect()
    }

    #[test]
    fn a_pose_laid_over_itself_turned_and_moved_finds_the_turn_and_the_way() {
        let (config, plan) = plan();
        let lying = RagdollPose::from_turns(
            &config.profile,
            [
                ("pelvis", Quat::from_rotation_x(FRAC_PI_2)),
                ("upper_arm_l", Quat::from_rotation_x(1.0)),
                ("thigh_r", Quat::from_rotation_x(0.7)),
            ],
        );
        let ups = [Vec3::Y, Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, -0.48, 0.64)];
        let turns = ups
            .iter()
            .flat_map(|up| [-3.0f32, -1.2, 0.0, 0.4, 2.2].map(|yaw| (*up, yaw)));
        for (up, yaw) in turns {
            let upright = Quat::from_rotation_arc(Vec3::Y, up);
            let at = Transform::from_xyz(3.0, 1.0, -7.0)
                .with_rotation(from_rotation_vector(up * yaw) * upright);
            let figure = places(&plan, &lying, &at);
            let laid = lay(&plan, |i| figure[i], |_| false, &lying, up);
            assert!(
                angle(laid.rotation.inverse() * at.rotation) < 1.0e-3,
                "{up} {yaw}"
            );
            assert!(laid.origin.distance(at.translation) < 1.0e-3, "{yaw}");
            assert!(laid.cost < 1.0e-5, "{yaw}: {}", laid.cost);
        }
    }

    #[test]
    fn who_lies_on_the_back_is_nearest_to_the_clip_from_the_back() {
        let (config, plan) = plan();
        let lies = |pelvis: Quat, arm: f32| {
            let arm = Quat::from_rotation_x(arm);
            let turns = [
                ("pelvis", pelvis),
                ("upper_arm_r", arm),
                ("shin_l", arm.inverse()),
            ];
            RagdollPose::from_turns(&config.profile, turns)
        };
        let ways = [
            Quat::from_rotation_x(-FRAC_PI_2),
            Quat::from_rotation_x(FRAC_PI_2),
            Quat::from_rotation_z(FRAC_PI_2),
            Quat::from_rotation_z(-FRAC_PI_2),
        ];
        for (n, way) in ways.into_iter().enumerate() {
            for yaw in [0.0f32, 1.0, 2.0, 3.0] {
                let turn = from_rotation_vector(Vec3::Y * yaw);
                let at = Transform::from_xyz(1.0, 0.0, 2.0).with_rotation(turn);
                let lean = Quat::from_rotation_x(0.2);
                let figure = places(&plan, &lies(way * lean, 0.6), &at);
                let best = ways.into_iter().enumerate().min_by(|(_, a), (_, b)| {
                    let cost =
                        |w: Quat| lay(&plan, |i| figure[i], |_| false, &lies(w, 0.0), Vec3::Y).cost;
                    cost(*a).total_cmp(&cost(*b))
                });
                assert_eq!(best.map(|b| b.0), Some(n), "yaw {yaw}");
            }
        }
    }

    #[test]
    fn how_a_figure_lies_is_told_by_what_of_its_root_is_up() {
        let x = |a: f32| Quat::from_rotation_x(a);
        let z = |a: f32| Quat::from_rotation_z(a);
        for (turn, expected) in [
            (x(0.3), Lying::Upright),
            (x(-FRAC_PI_2), Lying::Front),
            (x(FRAC_PI_2), Lying::Back),
            (z(FRAC_PI_2), Lying::Left),
            (z(-FRAC_PI_2), Lying::Right),
            (x(3.0), Lying::Head),
        ] {
            for yaw in [0.0f32, 2.0] {
                let bind = Quat::from_rotation_y(0.4);
                let root = Quat::from_rotation_y(yaw) * turn * bind;
                assert_eq!(Lying::of(root, bind, Vec3::Y), expected);
                // The same where up is elsewhere.
                let world = Quat::from_rotation_z(1.1);
                assert_eq!(Lying::of(world * root, bind, world * Vec3::Y), expected);
            }
        }
    }
}
