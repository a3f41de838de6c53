use bevy::prelude::*;

use super::*;
use crate::ragdoll::profile::RagdollProfile;

/// A skeleton by lines of a name and its parent, as listed; places by the part that is meant.
fn skeleton(lines: &[(&str, &str, Option<BodyPart>)]) -> Vec<SkeletonBone> {
    let rig = HumanoidRig::standing(1.8);
    let mut bones: Vec<SkeletonBone> = Vec::new();
    for (name, parent, part) in lines {
        let at = part.map_or(Vec3::ZERO, |p| rig.start(p));
        let parent = bones.iter().position(|b| b.name == *parent);
        bones.push(SkeletonBone {
            name: (*name).into(),
            parent,
            pose: Transform::from_translation(at),
        });
    }
    bones
}

/// Both sides of the limbs by the names of a convention; `side` makes a name of one.
fn limbs(
    side: impl Fn(&str, bool) -> String,
    chest: &str,
    hips: &str,
    names: [&str; 8],
) -> Vec<(String, String, Option<BodyPart>)> {
    use BodyPart::*;
    let parts = [
        LeftClavicle,
        LeftUpperArm,
        LeftForearm,
        LeftHand,
        LeftThigh,
        LeftShin,
        LeftFoot,
        LeftToes,
    ];
    let mut lines = Vec::new();
    for right in [false, true] {
        for (i, (name, part)) in names.iter().zip(parts).enumerate() {
            let parent = match i {
                0 => chest.to_string(),
                4 => hips.to_string(),
                _ => side(names[i - 1], right),
            };
            let part = if right { part.mirrored() } else { part };
            lines.push((side(name, right), parent, Some(part)));
        }
    }
    lines
}

fn check(
    convention: &str,
    trunk: &[(&str, &str, Option<BodyPart>)],
    limbs: Vec<(String, String, Option<BodyPart>)>,
    merged: usize,
    left: usize,
) {
    let mut lines: Vec<(&str, &str, Option<BodyPart>)> = trunk.to_vec();
    lines.extend(
        limbs
            .iter()
            .map(|(n, p, part)| (n.as_str(), p.as_str(), *part)),
    );
    let bones = skeleton(&lines);
    let found = SkeletonMatch::find(&bones, &NameMap::default());
    for (part, bone) in &found.matched {
        assert_eq!(
            lines[*bone].2,
            Some(*part),
            "{convention}: {}",
            lines[*bone].0
        );
    }
    let meant = lines.iter().filter(|l| l.2.is_some()).count();
    assert_eq!(found.matched.len(), meant, "{convention}: {found:?}");
    assert_eq!(found.merged.len(), merged, "{convention}: {found:?}");
    assert_eq!(found.left.len(), left, "{convention}: {found:?}");
    let detail = found.detail().unwrap();
    let rig = found.rig(&bones).unwrap();
    assert!(
        (rig.stature - 1.8).abs() < 0.01,
        "{convention}: {}",
        rig.stature
    );
    let profile = RagdollProfile::of_rig(detail, &rig);
    assert_eq!(
        crate::ragdoll::validate::refuse_profile(&profile),
        None,
        "{convention}"
    );
}

#[test]
fn skeletons_of_known_conventions_are_matched_whole() {
    use BodyPart::*;
    let mixamo =
        |n: &str, right: bool| format!("mixamorig:{}{n}", if right { "Right" } else { "Left" });
    check(
        "Mixamo",
        &[
            ("mixamorig:Hips", "", Some(Pelvis)),
            ("mixamorig:Spine", "mixamorig:Hips", Some(LowerSpine)),
            ("mixamorig:Spine1", "mixamorig:Spine", Some(UpperSpine)),
            ("mixamorig:Spine2", "mixamorig:Spine1", Some(Chest)),
            ("mixamorig:Neck", "mixamorig:Spine2", Some(Neck)),
            ("mixamorig:Head", "mixamorig:Neck", Some(Head)),
            ("mixamorig:HeadTop_End", "mixamorig:Head", None),
        ],
        limbs(
            mixamo,
            "mixamorig:Spine2",
            "mixamorig:Hips",
            [
                "Shoulder", "Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot", "ToeBase",
            ],
        ),
        1,
        0,
    );
    let vrm = |n: &str, right: bool| format!("{}{n}", if right { "right" } else { "left" });
    check(
        "VRM",
        &[
            ("Root", "", None),
            ("hips", "Root", Some(Pelvis)),
            ("spine", "hips", Some(LowerSpine)),
            ("chest", "spine", Some(UpperSpine)),
            ("upperChest", "chest", Some(Chest)),
            ("neck", "upperChest", Some(Neck)),
            ("head", "neck", Some(Head)),
        ],
        limbs(
            vrm,
            "upperChest",
            "hips",
            [
                "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes",
            ],
        ),
        0,
        1,
    );
    let unreal = |n: &str, right: bool| format!("{n}_{}", if right { "r" } else { "l" });
    check(
        "Unreal",
        &[
            ("root", "", None),
            ("pelvis", "root", Some(Pelvis)),
            ("spine_01", "pelvis", Some(LowerSpine)),
            ("spine_02", "spine_01", Some(UpperSpine)),
            ("spine_03", "spine_02", Some(Chest)),
            ("neck_01", "spine_03", Some(Neck)),
            ("head", "neck_01", Some(Head)),
        ],
        limbs(
            unreal,
            "spine_03",
            "pelvis",
            [
                "clavicle", "upperarm", "lowerarm", "hand", "thigh", "calf", "foot", "ball",
            ],
        ),
        0,
        1,
    );
    let rigify = |n: &str, right: bool| format!("DEF-{n}.{}", if right { "R" } else { "L" });
    check(
        "Rigify",
        &[
            ("DEF-spine", "", Some(Pelvis)),
            ("DEF-spine.001", "DEF-spine", Some(LowerSpine)),
            ("DEF-spine.002", "DEF-spine.001", Some(UpperSpine)),
            ("DEF-spine.003", "DEF-spine.002", Some(Chest)),
            ("DEF-spine.004", "DEF-spine.003", Some(Neck)),
            ("DEF-spine.005", "DEF-spine.004", None),
            ("DEF-spine.006", "DEF-spine.005", Some(Head)),
        ],
        limbs(
            rigify,
            "DEF-spine.003",
            "DEF-spine",
            [
                "shoulder",
                "upper_arm",
                "forearm",
                "hand",
                "thigh",
                "shin",
                "foot",
                "toe",
            ],
        ),
        1,
        0,
    );
    let plain = |n: &str, right: bool| format!("{} {n}", if right { "Right" } else { "Left" });
    check(
        "plain",
        &[
            ("Pelvis", "", Some(Pelvis)),
            ("Abdomen", "Pelvis", Some(LowerSpine)),
            ("Chest", "Abdomen", Some(Chest)),
            ("Neck", "Chest", Some(Neck)),
            ("Head", "Neck", Some(Head)),
            ("Hair", "Head", None),
        ],
        limbs(
            plain,
            "Chest",
            "Pelvis",
            [
                "Collarbone",
                "Upper Arm",
                "Forearm",
                "Hand",
                "Thigh",
                "Shin",
                "Foot",
                "Toes",
            ],
        ),
        1,
        0,
    );
}

#[test]
fn a_games_own_names_come_before_those_that_are_known() {
    let bones = skeleton(&[
        ("Wurzel", "", Some(BodyPart::Pelvis)),
        ("head", "Wurzel", None),
        ("Schaedel", "Wurzel", Some(BodyPart::Head)),
    ]);
    let map = NameMap {
        exact: vec![
            ("Wurzel".into(), BodyPart::Pelvis),
            ("Schaedel".into(), BodyPart::Head),
        ],
    };
    let found = SkeletonMatch::find(&bones, &map);
    assert_eq!(found.bone(BodyPart::Pelvis), Some(0));
    assert_eq!(found.bone(BodyPart::Head), Some(2));
    assert_eq!(found.merged, [(1, BodyPart::Pelvis)]);
    let lacking = found.rig(&bones).unwrap_err();
    assert!(lacking.contains(&BodyPart::LeftThigh) && !lacking.contains(&BodyPart::Head));
}
