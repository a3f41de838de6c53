//! The pose that a ragdoll is asked to take.

use bevy::prelude::*;

use super::profile::RagdollProfile;

/// Where a bone is.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct BonePose {
    /// Its joint, metres.
    pub position: Vec3,
    /// Its rotation.
    pub rotation: Quat,
}

impl Default for BonePose {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            rotation: Quat::IDENTITY,
        }
    }
}

impl BonePose {
    /// Whether it can be used.
    pub(crate) fn is_sound(&self) -> bool {
        self.position.is_finite() && self.rotation.is_finite() && self.rotation.is_normalized()
    }

    /// The same in the frame that `frame` is in.
    pub(crate) fn seen_from(&self, frame: &Transform) -> Self {
        Self {
            position: frame.translation + frame.rotation * self.position,
            rotation: (frame.rotation * self.rotation).normalize(),
        }
    }
}

/// The pose asked for, of every bone in the order of
/// [`RagdollProfile::bones`](super::RagdollProfile::bones), in the axes of the ragdoll's entity. Bones
/// beyond the list take their bind pose. Bones with a [`BoneSource`] take theirs from there.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct RagdollPose {
    /// One for each bone.
    pub bones: Vec<BonePose>,
}

impl RagdollPose {
    /// The pose in which the joint of each named bone is turned, against the bind pose, in the axes of
    /// the figure; the root by its own turn.
    ///
    /// A right elbow bent by a right angle, arm hanging: `("forearm_r", Quat::from_rotation_x(PI / 2.0))`.
    pub fn from_turns<'a>(
        profile: &RagdollProfile,
        turns: impl IntoIterator<Item = (&'a str, Quat)>,
    ) -> Self {
        let mut own = vec![Quat::IDENTITY; profile.bones.len()];
        for (name, turn) in turns {
            if let Some(i) = profile.index(name) {
                own[i] = turn;
            }
        }
        let mut whole: Vec<Option<(Vec3, Quat)>> = vec![None; profile.bones.len()];
        // As many passes as there are bones place even a chain that is listed backwards.
        for _ in 0..profile.bones.len() {
            for (i, bone) in profile.bones.iter().enumerate() {
                if whole[i].is_some() {
                    continue;
                }
                whole[i] = match bone.parent.as_deref().map(|p| profile.index(p)) {
                    None => Some((bone.position, own[i])),
                    Some(Some(p)) => whole[p].map(|(at, turn)| {
                        let way = bone.position - profile.bones[p].position;
                        (at + turn * way, turn * own[i])
                    }),
                    Some(None) => None,
                };
            }
        }
        let pose = |(i, place): (usize, Option<(Vec3, Quat)>)| {
            let bone = &profile.bones[i];
            let (position, turn) = place.unwrap_or((bone.position, Quat::IDENTITY));
            BonePose {
                position,
                rotation: (turn * bone.rotation).normalize(),
            }
        };
        Self {
            bones: whole.into_iter().enumerate().map(pose).collect(),
        }
    }
}

/// On a bone: the entity whose place in the world it takes, such as a joint of an animated skeleton.
/// Bevy's animation writes that in `PostUpdate`; the ticks of the next frame see it.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoneSource(pub Entity);
