//! Which ragdolls cannot work, and which work badly: one warning each, naming the bone.

use core::f32::consts::PI;

use bevy::{math::Vec2, prelude::*};

use super::{
    config::Ragdoll,
    plan::in_order,
    profile::{BoneProfile, BoneShape, JointKind, RagdollProfile, overlap},
};

/// Neighbours of masses that differ by more than this are hard on the solver.
const MOST_MASS_RATIO: f32 = 12.0;
/// A range narrower than this had better be locked.
const NARROW: f32 = 0.087;

/// What is wrong, in words.
pub(super) fn refuse(config: &Ragdoll) -> Option<String> {
    refuse_settings(config).or_else(|| refuse_profile(&config.profile))
}

/// What is wrong beside the body plan, in words.
pub(super) fn refuse_settings(config: &Ragdoll) -> Option<String> {
    let field = |ok: bool, name: &str, value: f32, need: &str| {
        (!ok).then(|| format!("Ragdoll::{name} is {value}, but needs {need}"))
    };
    let positive =
        |name: &str, v: f32| field(v > 0.0 && v.is_finite(), name, v, "a finite number above 0");
    let not_negative = |name: &str, v: f32| {
        field(
            v >= 0.0 && v.is_finite(),
            name,
            v,
            "a finite number of at least 0",
        )
    };
    let part = |name: &str, v: f32| field((0.0..=1.0).contains(&v), name, v, "0 to 1");
    positive("mass", config.mass)
        .or_else(|| part("conditioning", config.conditioning))
        .or_else(|| not_negative("damping", config.damping))
        .or_else(|| positive("max_speed", config.max_speed))
        .or_else(|| positive("max_spin", config.max_spin))
        .or_else(|| not_negative("fade", config.fade))
        .or_else(|| not_negative("blend.fade_in", config.blend.fade_in))
        .or_else(|| not_negative("blend.fade_out", config.blend.fade_out))
        .or_else(|| not_negative("rest.speed", config.rest.speed))
        .or_else(|| not_negative("rest.time", config.rest.time))
        .or_else(|| not_negative("rest.freeze_after", config.rest.freeze_after.unwrap_or(0.0)))
        .or_else(|| positive("keyframe_speed", config.keyframe_speed))
        .or_else(|| positive("drive.frequency", config.drive.frequency))
        .or_else(|| not_negative("drive.damping_ratio", config.drive.damping_ratio))
        .or_else(|| part("drive.velocity", config.drive.velocity))
        .or_else(|| part("drive.gravity", config.drive.gravity))
        .or_else(|| {
            let v = config.drive.torque;
            field(v >= 0.0, "drive.torque", v, "a number of at least 0")
        })
        .or_else(|| positive("drive.pin_frequency", config.drive.pin_frequency))
}

/// What is wrong with a body plan, in words that name the bone.
pub(super) fn refuse_profile(profile: &RagdollProfile) -> Option<String> {
    if profile.bones.is_empty() {
        return Some("it has no bones".into());
    }
    for (i, bone) in profile.bones.iter().enumerate() {
        let name = &bone.name;
        if profile.bones[..i].iter().any(|b| b.name == *name) {
            return Some(format!("two bones are named \"{name}\""));
        }
        if let Some(parent) = &bone.parent
            && profile.bone(parent).is_none()
        {
            return Some(format!(
                "bone \"{name}\" hangs on \"{parent}\", which does not exist"
            ));
        }
        if let Some(what) = refuse_bone(bone) {
            return Some(format!("bone \"{name}\" {what}"));
        }
    }
    let roots: Vec<&BoneProfile> = profile
        .bones
        .iter()
        .filter(|b| b.parent.is_none())
        .collect();
    if roots.len() > 1 {
        return Some(format!(
            "bones \"{}\" and \"{}\" both have no parent",
            roots[0].name, roots[1].name
        ));
    }
    let order = in_order(profile);
    let cut_off = (0..profile.bones.len()).find(|i| !order.contains(i));
    cut_off.map(|i| {
        format!(
            "bone \"{}\" hangs on itself through its parents",
            profile.bones[i].name
        )
    })
}

fn refuse_bone(bone: &BoneProfile) -> Option<String> {
    if !bone.position.is_finite() {
        return Some(format!("is at {}", bone.position));
    }
    if !bone.rotation.is_finite() || !bone.rotation.is_normalized() {
        return Some(format!(
            "has the rotation {}, which is none (a scaled or mirrored skeleton?)",
            bone.rotation
        ));
    }
    if !bone.shape.is_sound() {
        return Some(format!("has the shape {:?}, which has no size", bone.shape));
    }
    if let BoneShape::Capsule { from, to, .. } = bone.shape
        && bone.shape.length() < 1.0e-3
    {
        return Some(format!("has no length, from {from} to {to}"));
    }
    let mass = &bone.mass;
    if !(mass.share > 0.0 && mass.share.is_finite()) {
        return Some(format!("has a share of {} of the mass", mass.share));
    }
    let sound = mass.gyration.min_element() > 0.0
        && mass.gyration.is_finite()
        && mass.center.is_finite()
        && mass.axes.is_normalized();
    if !sound {
        return Some(format!("has its mass at {mass:?}"));
    }
    if bone.parent.is_some() {
        return refuse_joint(bone);
    }
    None
}

fn refuse_joint(bone: &BoneProfile) -> Option<String> {
    let joint = &bone.joint;
    if !joint.frame.is_finite() || !joint.frame.is_normalized() {
        return Some(format!("has a joint with the axes {}", joint.frame));
    }
    if !(joint.friction >= 0.0 && joint.friction.is_finite()) {
        return Some(format!("has a joint with a friction of {}", joint.friction));
    }
    if !(joint.max_torque >= 0.0) {
        return Some(format!("has a greatest torque of {}", joint.max_torque));
    }
    if let Some(breaks) = joint.breaks
        && !(breaks.force > 0.0 && breaks.time >= 0.0)
    {
        return Some(format!("has a joint that parts at {breaks:?}"));
    }
    if let Some(soft) = joint.softness
        && !(soft.frequency > 0.0 && soft.damping_ratio >= 0.0)
    {
        return Some(format!("has a joint as soft as {soft:?}"));
    }
    let range = |v: Vec2, most: f32| v.x <= v.y && v.y - v.x < most && v.abs().max_element() < 7.0;
    let cone = |v: Vec2| v.min_element() > 0.0 && v.max_element() <= PI;
    let ok = match joint.kind {
        JointKind::Ball {
            swing,
            center,
            twist,
        } => cone(swing) && center.length() < PI && range(twist, 2.0 * PI + 1.0e-3),
        JointKind::Condyloid { swing, center } => cone(swing) && center.length() < PI,
        JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => {
            range(Vec2::new(min, max), 2.0 * PI)
        }
        JointKind::Saddle { y, z } => range(y, PI) && range(z, PI),
        JointKind::Gliding { reach } => reach.min_element() >= 0.0 && reach.is_finite(),
        JointKind::Fixed => true,
    };
    (!ok).then(|| format!("has a joint with impossible limits, {:?}", joint.kind))
}

/// What works, but badly: one line for each bone that it is about.
pub(super) fn lint(config: &Ragdoll) -> Vec<String> {
    let mut lines = Vec::new();
    let profile = &config.profile;
    for bone in &profile.bones {
        let Some(parent) = bone.parent.as_deref().and_then(|p| profile.bone(p)) else {
            continue;
        };
        let name = &bone.name;
        let ratio = (bone.mass.share / parent.mass.share).max(parent.mass.share / bone.mass.share);
        if config.conditioning < 0.5 && ratio > MOST_MASS_RATIO {
            lines.push(format!(
                "bone \"{name}\" and \"{}\" differ in mass {ratio:.0} times: raise \
                 `Ragdoll::conditioning`, or the joint will not settle",
                parent.name
            ));
        }
        let off = (bone.joint.kind).violation(bone.joint.kind.center().inverse());
        if off > 0.02 {
            lines.push(format!(
                "bone \"{name}\" is {:.0} degrees beyond its limits in the bind pose",
                off.to_degrees()
            ));
        }
        let narrowest = match bone.joint.kind {
            JointKind::Ball { swing, twist, .. } => swing.min_element().min(twist.y - twist.x),
            JointKind::Condyloid { swing, .. } => swing.min_element(),
            JointKind::Hinge { min, max } | JointKind::Pivot { min, max } => max - min,
            JointKind::Saddle { y, z } => (y.y - y.x).min(z.y - z.x),
            JointKind::Gliding { .. } | JointKind::Fixed => PI,
        };
        if narrowest < NARROW {
            lines.push(format!(
                "bone \"{name}\" has a limit {:.1} degrees wide, which jitters: lock it, or make \
                 it at least 5 degrees",
                narrowest.to_degrees()
            ));
        }
    }
    for (i, a) in profile.bones.iter().enumerate() {
        for b in &profile.bones[i + 1..] {
            let deep = depth(a, b);
            let named = (profile.no_contact.iter())
                .any(|(x, y)| (*x == a.name && *y == b.name) || (*x == b.name && *y == a.name));
            if deep > 0.0 && !named && !are_near(profile, a, b) {
                lines.push(format!(
                    "bones \"{}\" and \"{}\" lie {:.0} mm in each other in the bind pose and will not \
                     collide: name the pair in `RagdollProfile::no_contact` if that is meant",
                    a.name,
                    b.name,
                    deep * 1000.0
                ));
            }
        }
    }
    lines
}

/// How deep two bones lie in each other in the bind pose, metres.
fn depth(a: &BoneProfile, b: &BoneProfile) -> f32 {
    let at = |b: &BoneProfile| Transform::from_translation(b.position).with_rotation(b.rotation);
    overlap(&a.shape, &at(a), &b.shape, &at(b))
}

/// Whether bones are so near in the tree that they cannot but lie in each other: at most two joints.
fn are_near(profile: &RagdollProfile, a: &BoneProfile, b: &BoneProfile) -> bool {
    let up = |b: &BoneProfile| b.parent.as_deref().and_then(|p| profile.bone(p));
    let names = |b: &BoneProfile| {
        let parent = up(b);
        let grand = parent.and_then(up);
        [parent, grand].map(|p| p.map(|p| p.name.clone()))
    };
    let (of_a, of_b) = (names(a), names(b));
    let above =
        |of: &[Option<String>; 2], b: &BoneProfile| of.iter().flatten().any(|n| *n == b.name);
    above(&of_a, b) || above(&of_b, a) || (of_a[0].is_some() && of_a[0] == of_b[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::humanoid::HumanoidDetail;

    fn broken(change: impl FnOnce(&mut RagdollProfile)) -> String {
        let mut profile = RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.75);
        change(&mut profile);
        refuse_profile(&profile).unwrap_or_default()
    }

    #[test]
    fn what_is_wrong_with_a_skeleton_is_told_with_the_name_of_the_bone() {
        for detail in [HumanoidDetail::Bodies10, HumanoidDetail::Bodies23] {
            let config = Ragdoll::new(RagdollProfile::humanoid(detail, 1.75), 75.0);
            assert_eq!(refuse(&config), None);
            assert_eq!(lint(&config), Vec::<String>::new());
        }
        let cycle = broken(|p| p.bone_mut("pelvis").unwrap().parent = Some("hand_l".into()));
        assert!(cycle.contains("hangs on itself"), "{cycle}");
        let missing = broken(|p| p.bone_mut("shin_r").unwrap().parent = Some("tail".into()));
        assert!(
            missing.contains("\"shin_r\"") && missing.contains("\"tail\""),
            "{missing}"
        );
        let empty = broken(|p| {
            p.bone_mut("head").unwrap().shape = BoneShape::Capsule {
                from: Vec3::ZERO,
                to: Vec3::ZERO,
                radius: 0.0,
            };
        });
        assert!(
            empty.contains("\"head\"") && empty.contains("no size"),
            "{empty}"
        );
        let nan = broken(|p| p.bone_mut("foot_l").unwrap().position.y = f32::NAN);
        assert!(nan.contains("\"foot_l\"") && nan.contains("NaN"), "{nan}");
        let mirrored = broken(|p| p.bone_mut("chest").unwrap().rotation = Quat::IDENTITY * 2.0);
        assert!(
            mirrored.contains("\"chest\"") && mirrored.contains("mirrored"),
            "{mirrored}"
        );
        let twice = broken(|p| p.bones[3].name = "pelvis".into());
        assert!(twice.contains("two bones"), "{twice}");
        let light = broken(|p| p.bone_mut("hand_l").unwrap().mass.share = 0.0);
        assert!(light.contains("\"hand_l\""), "{light}");
    }

    #[test]
    fn what_works_badly_is_told_with_the_name_of_the_bone() {
        let mut config = Ragdoll::new(
            RagdollProfile::humanoid(HumanoidDetail::Bodies15, 1.75),
            75.0,
        );
        config.conditioning = 0.0;
        config.profile.bone_mut("hand_l").unwrap().mass.share = 1.0e-4;
        config.profile.bone_mut("shin_l").unwrap().joint.kind = JointKind::Hinge {
            min: 0.3,
            max: 0.35,
        };
        // A hand in the other thigh.
        let thigh = config.profile.bone("thigh_r").unwrap().position;
        config.profile.bone_mut("hand_l").unwrap().position = thigh - Vec3::Y * 0.2;
        let lines = lint(&config).join("\n");
        for part in [
            "\"hand_l\" and \"thigh_r\" lie",
            "\"hand_l\" and \"forearm_l\" differ",
            "\"shin_l\" is 17 degrees beyond",
            "\"shin_l\" has a limit 2.9",
        ] {
            assert!(lines.contains(part), "{part} in {lines}");
        }
    }
}
