//! Puts a human figure together.

use bevy::prelude::*;

use super::{
    joints::joint,
    part::{BodyPart, HumanoidDetail},
    rig::HumanoidRig,
};
use crate::ragdoll::profile::{
    BoneMass, BoneProfile, BoneShape, JointProfile, RagdollProfile, capsule_within,
    radius_of_volume,
};

/// Density of the body, kilograms per cubic metre.
const DENSITY: f32 = 1010.0;
/// Mass of an adult of average build at a stature of 1 m, by the square of the stature: a body mass
/// index of 23.
const BUILD: f32 = 23.0;

impl RagdollProfile {
    /// A standing human figure of this stature, metres: bodies by the level of detail.
    ///
    /// ```
    /// # use bevy_embody::ragdoll::{HumanoidDetail, RagdollProfile};
    /// let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
    /// assert_eq!(profile.bones.len(), 19);
    /// ```
    pub fn humanoid(detail: HumanoidDetail, stature: f32) -> Self {
        Self::of_rig(detail, &HumanoidRig::standing(stature))
    }

    /// A human figure with its joints where those of a skeleton are.
    pub fn of_rig(detail: HumanoidDetail, rig: &HumanoidRig) -> Self {
        let bones = BodyPart::ALL
            .into_iter()
            .filter(|part| part.is_body(detail))
            .map(|part| bone(part, rig, detail))
            .collect();
        Self {
            bones,
            no_contact: Vec::new(),
        }
    }
}

/// First and last part of the chain that a body covers.
fn extent(part: BodyPart, detail: HumanoidDetail) -> (BodyPart, BodyPart) {
    use BodyPart::*;
    match (part, detail) {
        (Pelvis, HumanoidDetail::Bodies10) => (Pelvis, Chest),
        (Pelvis, HumanoidDetail::Bodies15) => (Pelvis, LowerSpine),
        (Chest, HumanoidDetail::Bodies15) => (MiddleSpine, Chest),
        (Chest, HumanoidDetail::Bodies19) => (UpperSpine, Chest),
        (LowerSpine, HumanoidDetail::Bodies19) => (LowerSpine, MiddleSpine),
        (Head, HumanoidDetail::Bodies10 | HumanoidDetail::Bodies15) => (Neck, Head),
        (LeftForearm, HumanoidDetail::Bodies10) => (LeftForearm, LeftHand),
        (RightForearm, HumanoidDetail::Bodies10) => (RightForearm, RightHand),
        (LeftFoot, HumanoidDetail::Bodies15 | HumanoidDetail::Bodies19) => (LeftFoot, LeftToes),
        (RightFoot, HumanoidDetail::Bodies15 | HumanoidDetail::Bodies19) => (RightFoot, RightToes),
        _ => (part, part),
    }
}

/// The first part that a body covers: its bone is the one that the body goes with.
pub(crate) fn first_part(part: BodyPart, detail: HumanoidDetail) -> BodyPart {
    extent(part, detail).0
}

fn bone(part: BodyPart, rig: &HumanoidRig, detail: HumanoidDetail) -> BoneProfile {
    let (first, last) = extent(part, detail);
    let start = rig.start(first);
    let end = rig.end(last);
    let share: f32 = BodyPart::ALL
        .into_iter()
        .filter(|p| p.body(detail) == part)
        .map(BodyPart::share)
        .sum();
    let volume = share * BUILD * rig.stature * rig.stature / DENSITY;
    let shape = shape(part, rig, end - start, volume);
    let mass = match part.limb() {
        Some((center, gyration)) if first == last => {
            BoneMass::limb(share, &shape, end - start, center, gyration)
        }
        _ => BoneMass::solid(share, &shape),
    };
    let rotation = rig.rotations[first as usize];
    let (shape, mass) = turned(shape, mass, rotation.inverse());
    let parent = first.parent().map(|p| p.body(detail));
    BoneProfile {
        name: part.name().into(),
        parent: parent.map(|p| p.name().into()),
        position: start,
        rotation,
        shape,
        mass,
        joint: match parent {
            Some(parent) => joint(part, parent, rig, detail),
            None => JointProfile::default(),
        },
    }
}

/// What was found in the figure's axes, in the bone's own.
fn turned(shape: BoneShape, mass: BoneMass, by: Quat) -> (BoneShape, BoneMass) {
    let shape = match shape {
        BoneShape::Capsule { from, to, radius } => BoneShape::Capsule {
            from: by * from,
            to: by * to,
            radius,
        },
        BoneShape::Box {
            center,
            rotation,
            half,
        } => BoneShape::Box {
            center: by * center,
            rotation: (by * rotation).normalize(),
            half,
        },
    };
    let mass = BoneMass {
        center: by * mass.center,
        axes: (by * mass.axes).normalize(),
        ..mass
    };
    (shape, mass)
}

/// The shape of a body from its joint on, in the figure's axes.
fn shape(part: BodyPart, rig: &HumanoidRig, end: Vec3, volume: f32) -> BoneShape {
    use BodyPart::*;
    let h = rig.stature;
    let length = end.length().max(0.01 * h);
    // A slab as wide as asked, as deep as its volume needs.
    let slab = |center: Vec3, rotation: Quat, height: f32, width: f32| {
        let depth = volume / (height * width);
        BoneShape::Box {
            center,
            rotation,
            half: Vec3::new(width, height, depth) * 0.5,
        }
    };
    let upright = Quat::from_rotation_arc(Vec3::Y, end.normalize_or(Vec3::Y));
    match part {
        Pelvis => {
            // Down to the crotch, below the joints of the hip.
            let below = 0.035 * h;
            let center = end.normalize_or(Vec3::Y) * ((length - below) * 0.5);
            slab(center, upright, length + below, 0.18 * h)
        }
        LowerSpine | MiddleSpine | UpperSpine => slab(end * 0.5, upright, length, 0.155 * h),
        Chest => slab(end * 0.5, upright, length, 0.175 * h),
        LeftFoot | RightFoot => {
            // From the heel behind the ankle, on the sole.
            let floor = (rig.start(part).y - rig.stature * 0.039).max(0.0);
            let sole = floor - rig.start(part).y;
            let front = end.z.min(-0.05 * h);
            let heel = 0.032 * h;
            let half = Vec3::new(0.024 * h, -sole * 0.5, (heel - front) * 0.5);
            BoneShape::Box {
                center: Vec3::new(0.0, sole * 0.5, (heel + front) * 0.5),
                rotation: Quat::IDENTITY,
                half: half.max(Vec3::splat(0.005 * h)),
            }
        }
        _ => capsule_within(end, radius_of_volume(length, volume)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::profile::JointKind;

    fn levels() -> [HumanoidDetail; 4] {
        [
            HumanoidDetail::Bodies10,
            HumanoidDetail::Bodies15,
            HumanoidDetail::Bodies19,
            HumanoidDetail::Bodies23,
        ]
    }

    #[test]
    fn every_level_is_one_tree_with_all_the_mass() {
        for detail in levels() {
            let profile = RagdollProfile::humanoid(detail, 1.75);
            let share: f32 = profile.bones.iter().map(|b| b.mass.share).sum();
            assert!((share - 1.0).abs() < 1.0e-5, "{detail:?}: {share}");
            let roots = profile.bones.iter().filter(|b| b.parent.is_none()).count();
            assert_eq!(roots, 1, "{detail:?}");
            for bone in &profile.bones {
                if let Some(parent) = &bone.parent {
                    assert!(profile.bone(parent).is_some(), "{}", bone.name);
                }
                assert!(bone.shape.is_sound(), "{}: {:?}", bone.name, bone.shape);
            }
        }
    }

    #[test]
    fn the_figure_stands_on_the_ground_and_is_as_tall_as_asked() {
        for detail in levels() {
            let profile = RagdollProfile::humanoid(detail, 1.8);
            let (mut low, mut high) = (f32::MAX, f32::MIN);
            for bone in &profile.bones {
                let (a, b, r) = bone.shape.core();
                for p in [a, b] {
                    let y = bone.position.y + (bone.rotation * p).y;
                    low = low.min(y - r);
                    high = high.max(y + r);
                }
            }
            assert!((high - 1.8).abs() < 0.02, "{detail:?}: {high}");
            if detail != HumanoidDetail::Bodies10 {
                assert!(low.abs() < 0.02, "{detail:?}: {low}");
            }
        }
    }

    #[test]
    fn the_bind_pose_is_within_every_limit() {
        for detail in levels() {
            for bone in RagdollProfile::humanoid(detail, 1.75).bones {
                let q = bone.joint.kind.center().inverse();
                let off = bone.joint.kind.violation(q);
                assert!(off < 1.0e-3, "{}: {} beyond", bone.name, off.to_degrees());
            }
        }
    }

    #[test]
    fn knees_bend_backward_and_elbows_forward() {
        let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
        for (name, sign) in [
            ("shin_l", 1.0),
            ("shin_r", 1.0),
            ("forearm_l", -1.0),
            ("forearm_r", -1.0f32),
        ] {
            let bone = profile.bone(name).unwrap();
            let JointKind::Hinge { min, max } = bone.joint.kind else {
                panic!("{name} is no hinge");
            };
            assert!(max > 2.0 && min > -0.1, "{name}: {min} to {max}");
            let axis = bone.joint.frame * Vec3::X;
            let bent = Quat::from_axis_angle(axis, 1.0) * Vec3::NEG_Y;
            assert!(bent.z * sign > 0.5, "{name}: {bent}");
        }
    }

    #[test]
    fn the_thigh_reaches_its_anatomical_range_and_no_farther() {
        let profile = RagdollProfile::humanoid(HumanoidDetail::Bodies19, 1.75);
        let joint = profile.bone("thigh_r").unwrap().joint;
        // Flexion forward is a turn about the figure's X.
        let at = |flexion: f32| {
            let turn = Quat::from_rotation_x(flexion.to_radians());
            let q = (joint.frame * joint.kind.center()).inverse() * turn * joint.frame;
            joint.kind.violation(q).to_degrees()
        };
        assert!(at(115.0) < 0.1 && at(-28.0) < 0.1);
        assert!((at(130.0) - 10.0).abs() < 1.0);
        assert!((at(-40.0) - 10.0).abs() < 1.0);
    }
}
