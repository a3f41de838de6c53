//! A body plan made ready: bones in order, frames, masses, and what hangs on each joint.

use bevy::{math::Vec2, prelude::*};

use super::{
    conditioning::condition,
    config::Ragdoll,
    math::{
        cone::EllipticCone,
        inertia::{MassPoint, along_axes, subtrees},
    },
    pose::BonePose,
    profile::{BoneShape, JointKind, JointProfile, RagdollProfile, overlap},
};
use crate::backend::joints::{JointFrames, JointRows, RowSpring};

/// On a ragdoll: what was made of its config.
#[derive(Component, Default, Debug)]
pub(crate) struct RagdollPlan {
    /// Parents before children; empty while the config is refused.
    pub bones: Vec<PlannedBone>,
    /// Pairs of bones that must not collide though no joint ties them.
    pub apart: Vec<(usize, usize)>,
    /// Whether those pairs were told apart.
    pub told: bool,
    /// The config that it was made of.
    pub made_of: Option<Box<Ragdoll>>,
    /// What was wrong with the last config, so that it is told once.
    pub refused: Option<String>,
    /// Which bones are gone though nobody asked for that.
    pub lost: Vec<bool>,
    /// Whether a bad [`RagdollUp`](super::RagdollUp) was told.
    pub told_up: bool,
    /// Whether a bad [`RagdollState::rise_time`](super::RagdollState::rise_time) was told.
    pub told_rise: bool,
    /// Whether any joint can part.
    pub breakable: bool,
    /// The largest ratio of what hangs on a bone, with it, to the bone that bears it.
    pub load: f32,
    /// Substeps beyond those of the physics world.
    pub extra_substeps: usize,
    /// Kilograms.
    pub mass: f32,
    /// Of the whole in the bind pose about its centre of mass, the mean of its three moments, kg·m².
    pub inertia: f32,
}

/// One bone.
#[derive(Clone, Debug)]
pub(crate) struct PlannedBone {
    /// Its number in the profile.
    pub index: usize,
    pub parent: Option<usize>,
    /// In the axes of the figure.
    pub bind: BonePose,
    pub shape: BoneShape,
    /// Kilograms.
    pub mass: f32,
    /// In the bone's axes.
    pub center: Vec3,
    pub inertia_axes: Quat,
    /// Principal moments, kg·m².
    pub inertia: Vec3,
    pub joint: JointProfile,
    pub cone: Option<EllipticCone>,
    /// Of the joint: limits are counted from the first, the second is the child's.
    pub frames: JointFrames,
    /// Inertia of everything that hangs on the joint about it, along the child's axes of the joint.
    pub carried: Vec3,
}

/// Friction slows what hangs on a joint by at most this, radians per second squared: about what that of people
/// does to a hand. In a figure whose every joint has so much of it, limits and friction tremble.
const MOST_SLOWING: f32 = 600.0;

/// The indices of a profile's bones with parents before children; bones that hang on none of them, as
/// in a cycle, are left out.
pub(super) fn in_order(profile: &RagdollProfile) -> Vec<usize> {
    let mut order: Vec<usize> = Vec::with_capacity(profile.bones.len());
    loop {
        let before = order.len();
        for (i, bone) in profile.bones.iter().enumerate() {
            let placed = |i: &usize| profile.bones[*i].name.as_str();
            let ready = match &bone.parent {
                None => true,
                Some(parent) => order.iter().any(|o| placed(o) == parent),
            };
            if ready && !order.contains(&i) {
                order.push(i);
            }
        }
        if order.len() == before {
            return order;
        }
    }
}

impl RagdollPlan {
    /// Of a config that was found to be sound.
    pub fn of(config: &Ragdoll) -> Self {
        let profile = &config.profile;
        let order = in_order(profile);
        let place = |name: &str| order.iter().position(|o| profile.bones[*o].name == name);
        let parents: Vec<Option<usize>> = (order.iter())
            .map(|o| profile.bones[*o].parent.as_deref().and_then(place))
            .collect();
        let whole: f32 = order.iter().map(|o| profile.bones[*o].mass.share).sum();
        let mut masses: Vec<f32> = (order.iter())
            .map(|o| config.mass * profile.bones[*o].mass.share / whole)
            .collect();
        let mut inertias: Vec<Vec3> = (order.iter().zip(&masses))
            .map(|(o, m)| {
                let g = profile.bones[*o].mass.gyration;
                g * g * *m
            })
            .collect();
        condition(&mut masses, &mut inertias, &parents, config.conditioning);
        let own: Vec<MassPoint> = (order.iter().enumerate())
            .map(|(i, o)| {
                let bone = &profile.bones[*o];
                let axes = Mat3::from_quat(bone.rotation * bone.mass.axes);
                MassPoint {
                    mass: masses[i],
                    center: bone.position + bone.rotation * bone.mass.center,
                    inertia: axes * Mat3::from_diagonal(inertias[i]) * axes.transpose(),
                }
            })
            .collect();
        let sums = subtrees(&own, &parents);
        let load =
            |(i, parent): (usize, &Option<usize>)| parent.map_or(0.0, |p| sums[i].mass / masses[p]);
        let load = parents.iter().enumerate().map(load).fold(0.0, f32::max);
        let bones: Vec<PlannedBone> = (order.iter().enumerate())
            .map(|(i, o)| {
                let bone = &profile.bones[*o];
                let (at, turn) = match parents[i] {
                    Some(p) => {
                        let parent = &profile.bones[order[p]];
                        (parent.position, parent.rotation)
                    }
                    None => (bone.position, bone.rotation),
                };
                let frame = bone.joint.frame;
                PlannedBone {
                    index: *o,
                    parent: parents[i],
                    bind: BonePose {
                        position: bone.position,
                        rotation: bone.rotation,
                    },
                    shape: bone.shape,
                    mass: masses[i],
                    center: bone.mass.center,
                    inertia_axes: bone.mass.axes,
                    inertia: inertias[i],
                    joint: bone.joint,
                    cone: bone.joint.kind.cone(),
                    frames: JointFrames {
                        anchor1: turn.inverse() * (bone.position - at),
                        rotation1: (turn.inverse() * frame * bone.joint.kind.center()).normalize(),
                        anchor2: Vec3::ZERO,
                        rotation2: (bone.rotation.inverse() * frame).normalize(),
                    },
                    carried: along_axes(sums[i].about(bone.position), frame),
                }
            })
            .collect();
        let apart = apart(profile, &order, &bones);
        let figure = (sums.first()).map_or(Mat3::ZERO, |s| s.inertia);
        Self {
            made_of: Some(Box::new(config.clone())),
            refused: None,
            lost: vec![false; bones.len()],
            breakable: bones.iter().any(|b| b.joint.breaks.is_some()),
            bones,
            apart,
            told: false,
            told_up: false,
            told_rise: false,
            load,
            extra_substeps: 0,
            mass: config.mass,
            inertia: (figure.x_axis.x + figure.y_axis.y + figure.z_axis.z) / 3.0,
        }
    }
}

/// Pairs that are named, and pairs that lie in each other in the bind pose.
fn apart(profile: &RagdollProfile, order: &[usize], bones: &[PlannedBone]) -> Vec<(usize, usize)> {
    let mut pairs = Vec::new();
    let name = |i: usize| profile.bones[order[i]].name.as_str();
    let at = |b: &PlannedBone| {
        Transform::from_translation(b.bind.position).with_rotation(b.bind.rotation)
    };
    for (i, a) in bones.iter().enumerate() {
        for (j, b) in bones.iter().enumerate().skip(i + 1) {
            if b.parent == Some(i) || a.parent == Some(j) {
                continue;
            }
            let named = profile
                .no_contact
                .iter()
                .any(|(x, y)| (x == name(i) && y == name(j)) || (x == name(j) && y == name(i)));
            if named || overlap(&a.shape, &at(a), &b.shape, &at(b)) > -0.005 {
                pairs.push((i, j));
            }
        }
    }
    pairs
}

/// A range of a turn; one that goes all round bounds nothing, and would hold at its seam.
pub(super) fn bounds(range: Vec2) -> Option<[f32; 2]> {
    (range.y - range.x < core::f32::consts::TAU - 1.0e-3).then_some([range.x, range.y])
}

impl PlannedBone {
    /// Torque with which its joint resists turning, newton-metres.
    pub fn friction(&self) -> f32 {
        let most = self.carried.max_element() * MOST_SLOWING;
        self.joint.friction.min(most)
    }

    /// What its joint takes away or bounds.
    pub fn rows(&self) -> JointRows {
        let mut rows = JointRows {
            locked_slides: [true; 3],
            ..default()
        };
        match self.joint.kind {
            JointKind::Ball { twist, .. } => {
                rows.turns[0] = bounds(twist);
                rows.cone = Some(self.cap(Quat::IDENTITY).1);
            }
            JointKind::Condyloid { .. } => {
                rows.locked_turns[0] = true;
                rows.cone = Some(self.cap(Quat::IDENTITY).1);
            }
            JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => {
                rows.locked_turns = [false, true, true];
                rows.turns[0] = Some([min, max]);
            }
            JointKind::Saddle { y, z } => {
                rows.locked_turns = [true, false, false];
                rows.turns[1] = Some([y.x, y.y]);
                rows.turns[2] = Some([z.x, z.y]);
            }
            JointKind::Gliding { reach } => {
                rows.locked_slides = [true, reach.x <= 0.0, reach.y <= 0.0];
                rows.locked_turns = [true; 3];
                rows.slides = [None, Some([-reach.x, reach.x]), Some([-reach.y, reach.y])];
            }
            JointKind::Fixed => rows.locked_turns = [true; 3],
        }
        rows
    }

    /// The rows as a joint that is what it is, and one that is aimed anew each tick or gives.
    pub fn split(&self) -> (JointRows, Option<(JointRows, Option<RowSpring>)>) {
        let rows = self.rows();
        let apart = matches!(self.joint.kind, JointKind::Condyloid { .. });
        // What locks the twist must not turn with the cone: from a turned axis the twist changes with
        // every swing along the rim.
        if self.joint.softness.is_none() && !apart {
            return (rows, None);
        }
        let hard = JointRows {
            locked_slides: rows.locked_slides,
            locked_turns: rows.locked_turns,
            ..default()
        };
        let giving = JointRows {
            locked_slides: [false; 3],
            locked_turns: [false; 3],
            ..rows
        };
        let Some(soft) = self.joint.softness else {
            return (hard, Some((giving, None)));
        };
        // The engine's spring has the inertia of the bone about its own centre.
        let own = Mat3::from_quat(self.inertia_axes);
        let own = own * Mat3::from_diagonal(self.inertia) * own.transpose();
        let own = along_axes(own, self.frames.rotation2);
        let more = match self.joint.kind {
            JointKind::Hinge { .. } | JointKind::Pivot { .. } => self.carried.x / own.x,
            _ => (self.carried.y + self.carried.z) / (own.y + own.z),
        };
        let spring = RowSpring {
            frequency: soft.frequency * more.sqrt(),
            damping_ratio: soft.damping_ratio * more.sqrt(),
        };
        (hard, Some((giving, Some(spring))))
    }

    /// Rotation of the child's axes of the joint in those that limits are counted from.
    pub fn joint_rotation(&self, parent: Quat, child: Quat) -> Quat {
        ((parent * self.frames.rotation1).inverse() * child * self.frames.rotation2).normalize()
    }

    /// Rotation of the child in its parent that is nearest to the one asked for and within the limits.
    pub fn within_limits(&self, relative: Quat) -> Quat {
        let (f1, f2) = (self.frames.rotation1, self.frames.rotation2);
        let q = (f1.inverse() * relative * f2).normalize();
        (f1 * self.joint.kind.clamp(q) * f2.inverse()).normalize()
    }
}
