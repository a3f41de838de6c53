//! Finds the parts of a human figure among the bones of a skeleton by their names.
//!
//! Names of Mixamo, VRM, Rigify, Unreal and plain English are known; a game adds its own. What was
//! matched, what goes along with a matched bone, and what was left is reported.

mod words;

use bevy::prelude::*;

use super::humanoid::{BodyPart, HumanoidDetail, HumanoidRig};
use words::{Words, words};

/// A bone of a skeleton in its bind pose.
#[derive(Clone, Debug, PartialEq)]
pub struct SkeletonBone {
    /// Its name.
    pub name: String,
    /// The index of the bone that bears it.
    pub parent: Option<usize>,
    /// Where it is, in the axes of the figure: `Y` up, facing `-Z`, metres.
    pub pose: Transform,
}

/// Names that a game adds to those that are known, or sets above them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NameMap {
    /// Exact names and their parts.
    pub exact: Vec<(String, BodyPart)>,
}

/// What was found in a skeleton.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SkeletonMatch {
    /// The bone of each part that was found.
    pub matched: Vec<(BodyPart, usize)>,
    /// Bones that go along with the part that bears them: fingers, twist bones, hair.
    pub merged: Vec<(usize, BodyPart)>,
    /// Bones above or beside the figure.
    pub left: Vec<usize>,
    /// Parts without a bone.
    pub missing: Vec<BodyPart>,
}

/// Parts without which nothing can be built.
const NEEDED: [BodyPart; 10] = [
    BodyPart::Pelvis,
    BodyPart::Head,
    BodyPart::LeftUpperArm,
    BodyPart::LeftForearm,
    BodyPart::RightUpperArm,
    BodyPart::RightForearm,
    BodyPart::LeftThigh,
    BodyPart::LeftShin,
    BodyPart::RightThigh,
    BodyPart::RightShin,
];

/// A part of the left side, or of the middle, by the words of its name.
fn known(words: &str, thigh_is_named: bool) -> Option<BodyPart> {
    use BodyPart::*;
    Some(match words {
        "hips" | "hip" | "pelvis" => Pelvis,
        "neck" => Neck,
        "head" => Head,
        "clavicle" | "shoulder" | "collar" | "collarbone" => LeftClavicle,
        "upperarm" | "arm" | "uparm" => LeftUpperArm,
        "forearm" | "lowerarm" | "elbow" => LeftForearm,
        "hand" | "wrist" => LeftHand,
        "thigh" | "upperleg" | "upleg" | "femur" => LeftThigh,
        "leg" if !thigh_is_named => LeftThigh,
        "leg" | "shin" | "lowerleg" | "lowleg" | "calf" | "shank" | "knee" => LeftShin,
        "foot" | "ankle" => LeftFoot,
        "toe" | "toes" | "toebase" | "ball" => LeftToes,
        _ => return None,
    })
}

/// Whether a bone is one of the spine.
fn is_spine(words: &str) -> bool {
    matches!(
        words,
        "spine" | "chest" | "upperchest" | "torso" | "abdomen" | "waist" | "thorax"
    )
}

/// Which parts the bones of a spine are, from the bottom up.
fn spine_parts(count: usize) -> &'static [BodyPart] {
    use BodyPart::*;
    match count {
        0 => &[],
        1 => &[Chest],
        2 => &[LowerSpine, Chest],
        3 => &[LowerSpine, UpperSpine, Chest],
        _ => &[LowerSpine, MiddleSpine, UpperSpine, Chest],
    }
}

impl SkeletonMatch {
    /// Finds the parts of a human figure.
    pub fn find(bones: &[SkeletonBone], map: &NameMap) -> Self {
        let named: Vec<Words> = bones.iter().map(|b| words(&b.name)).collect();
        let thighs = ["thigh", "upperleg", "upleg", "femur"];
        let thigh_is_named = named.iter().any(|w| thighs.contains(&w.joined.as_str()));
        let mut found = [None; BodyPart::COUNT];
        for (name, part) in &map.exact {
            let bone = bones.iter().position(|b| b.name == *name);
            found[*part as usize] = found[*part as usize].or(bone);
        }
        for (i, w) in named.iter().enumerate() {
            let Some(part) = known(&w.joined, thigh_is_named) else {
                continue;
            };
            let paired = part.side() != 0.0;
            let part = match w.side {
                0 if paired => continue,
                1 => part.mirrored(),
                _ => part,
            };
            // The first of several, as of an arm in pieces, is the nearest to the trunk.
            let slot = &mut found[part as usize];
            *slot = slot.or(Some(i));
        }
        let mut this = Self::default();
        this.place_spine(bones, &named, &mut found);
        for part in BodyPart::ALL {
            match found[part as usize] {
                Some(bone) => this.matched.push((part, bone)),
                None => this.missing.push(part),
            }
        }
        for i in 0..bones.len() {
            if found.contains(&Some(i)) {
                continue;
            }
            match this.bearer(bones, i) {
                Some(part) => this.merged.push((i, part)),
                None => this.left.push(i),
            }
        }
        this
    }

    /// The chain of spine bones; without a bone named for the pelvis or the head, its ends are those.
    fn place_spine(
        &self,
        bones: &[SkeletonBone],
        named: &[Words],
        found: &mut [Option<usize>; BodyPart::COUNT],
    ) {
        use BodyPart::*;
        let mut chain: Vec<usize> = (0..bones.len())
            .filter(|i| is_spine(&named[*i].joined) && named[*i].side == 0)
            .filter(|i| !found.contains(&Some(*i)))
            .collect();
        chain.sort_by_key(|i| depth(bones, *i));
        if found[Pelvis as usize].is_none() && chain.len() > 1 {
            found[Pelvis as usize] = Some(chain.remove(0));
        }
        // What bears the arms is the chest; spine bones above it are neck and head.
        let arm = found[LeftClavicle as usize].or(found[LeftUpperArm as usize]);
        let chest = arm.and_then(|arm| chain.iter().rposition(|s| bears(bones, *s, arm)));
        if let Some(chest) = chest {
            let mut above = chain.split_off(chest + 1);
            if found[Head as usize].is_none() {
                found[Head as usize] = above.pop();
            }
            let neck = &mut found[Neck as usize];
            *neck = neck.or(above.first().copied());
        }
        let parts = spine_parts(chain.len());
        for (n, part) in parts.iter().enumerate() {
            let slot = &mut found[*part as usize];
            // Of more than four the lowest, the highest, and two between.
            let pick = n * (chain.len() - 1) / (parts.len() - 1).max(1);
            let pick = if parts.len() == 1 {
                chain.len() - 1
            } else {
                pick
            };
            *slot = slot.or(Some(chain[pick]));
        }
    }

    /// The part that bears a bone.
    fn bearer(&self, bones: &[SkeletonBone], bone: usize) -> Option<BodyPart> {
        let mut at = bones[bone].parent;
        for _ in 0..bones.len() {
            let up = at?;
            if let Some((part, _)) = self.matched.iter().find(|(_, b)| *b == up) {
                return Some(*part);
            }
            at = bones[up].parent;
        }
        None
    }

    /// The bone of a part.
    pub fn bone(&self, part: BodyPart) -> Option<usize> {
        let found = self.matched.iter().find(|(p, _)| *p == part);
        found.map(|(_, bone)| *bone)
    }

    /// The finest level at which every body has a bone of its own; `None` when even the coarsest lacks
    /// one.
    pub fn detail(&self) -> Option<HumanoidDetail> {
        let levels = [
            HumanoidDetail::Bodies23,
            HumanoidDetail::Bodies19,
            HumanoidDetail::Bodies15,
            HumanoidDetail::Bodies10,
        ];
        let missing = |d: HumanoidDetail| self.missing.iter().any(|p| p.is_body(d));
        levels.into_iter().find(|d| !missing(*d))
    }

    /// The joints of the figure where the skeleton has them; parts without a bone are put where they are in
    /// a figure of the same build. The error names the parts that cannot be done without.
    pub fn rig(&self, bones: &[SkeletonBone]) -> Result<HumanoidRig, Vec<BodyPart>> {
        let lacking: Vec<BodyPart> = (NEEDED.into_iter())
            .filter(|p| self.bone(*p).is_none())
            .collect();
        if !lacking.is_empty() {
            return Err(lacking);
        }
        let at = |part: BodyPart| self.bone(part).map(|b| bones[b].pose.translation);
        let feet = [BodyPart::LeftFoot, BodyPart::RightFoot].map(at);
        let low = feet
            .into_iter()
            .flatten()
            .map(|p| p.y)
            .fold(f32::MAX, f32::min);
        let head = at(BodyPart::Head).unwrap_or_default();
        // Ankle and base of the skull are at 0.039 and 0.875 of the stature.
        let stature = if low < f32::MAX {
            (head.y - low) / (0.875 - 0.039)
        } else {
            head.y / 0.875
        };
        let ground = head.y - 0.875 * stature;
        let standing = HumanoidRig::standing(stature);
        let mut rig = standing;
        let base = Vec3::Y * ground;
        for part in BodyPart::ALL {
            let i = part as usize;
            rig.starts[i] = match (at(part), part.parent()) {
                (Some(at), _) => at,
                // As far from what bears it as in a standing figure.
                (None, Some(parent)) => {
                    rig.start(parent) + standing.start(part) - standing.start(parent)
                }
                (None, None) => standing.start(part) + base,
            };
            if let Some(bone) = self.bone(part) {
                rig.rotations[i] = bones[bone].pose.rotation.normalize();
            }
        }
        let starts = rig.starts;
        let tip = |last: BodyPart, before: BodyPart, length: f32| {
            let last = starts[last as usize];
            let way = last - starts[before as usize];
            last + way.normalize_or(Vec3::NEG_Y) * (length * stature)
        };
        rig.crown = head + Vec3::Y * (0.125 * stature);
        rig.fingertips = [
            tip(BodyPart::LeftHand, BodyPart::LeftForearm, 0.108),
            tip(BodyPart::RightHand, BodyPart::RightForearm, 0.108),
        ];
        let toe = Vec3::new(0.0, -0.002, -0.035) * stature;
        rig.toe_tips = [BodyPart::LeftToes, BodyPart::RightToes].map(|p| rig.start(p) + toe);
        Ok(rig)
    }
}

/// How many bones are above a bone.
fn depth(bones: &[SkeletonBone], bone: usize) -> usize {
    let mut at = bones[bone].parent;
    let mut steps = 0;
    while let Some(up) = at
        && steps <= bones.len()
    {
        steps += 1;
        at = bones[up].parent;
    }
    steps
}

/// Whether one bone is above another.
fn bears(bones: &[SkeletonBone], above: usize, bone: usize) -> bool {
    let mut at = bones[bone].parent;
    for _ in 0..bones.len() {
        match at {
            Some(up) if up == above => return true,
            Some(up) => at = bones[up].parent,
            None => return false,
        }
    }
    false
}

#[cfg(test)]
mod tests;
