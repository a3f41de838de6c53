//! Names of bones taken apart: the words in them, and the side.

/// A name as its words in lower case, without prefixes of tools, and its side.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Words {
    /// All words as one.
    pub joined: String,
    /// −1 left, 1 right, 0 neither.
    pub side: i8,
    /// The number at the end, if any.
    pub number: Option<u32>,
}

/// Words that tools put before or into every name.
const NOISE: [&str; 14] = [
    "mixamorig",
    "mixamo",
    "bip",
    "bip01",
    "bip001",
    "biped",
    "def",
    "j",
    "c",
    "rig",
    "armature",
    "jnt",
    "joint",
    "bone",
];

/// Splits at everything that is no letter, at digits, and where a small letter meets a capital one.
fn split(name: &str) -> Vec<String> {
    let mut words: Vec<String> = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let starts = (c.is_uppercase() && before.is_lowercase())
            || (c.is_ascii_digit() != before.is_ascii_digit());
        if !c.is_alphanumeric() || starts {
            words.push(String::new());
        }
        if c.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|w| !w.is_empty());
    words
}

pub(super) fn words(name: &str) -> Words {
    // "mixamorig:Hips", "Armature|Hips".
    let name = name.rsplit([':', '|']).next().unwrap_or(name);
    let mut found = Words::default();
    for word in split(name) {
        if let Ok(number) = word.parse() {
            found.number = Some(number);
            continue;
        }
        match word.as_str() {
            "l" | "left" => found.side = -1,
            "r" | "right" => found.side = 1,
            w if NOISE.contains(&w) => {}
            w => found.joined.push_str(w),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_all_tools_come_down_to_the_same_words() {
        for (name, joined, side, number) in [
            ("mixamorig:LeftForeArm", "forearm", -1, None),
            ("mixamorig:Spine2", "spine", 0, Some(2)),
            ("J_Bip_R_UpperArm", "upperarm", 1, None),
            ("DEF-upper_arm.L.001", "upperarm", -1, Some(1)),
            ("upperarm_l", "upperarm", -1, None),
            ("spine_03", "spine", 0, Some(3)),
            ("leftUpperLeg", "upperleg", -1, None),
            ("Right Thigh", "thigh", 1, None),
            ("calf_twist_01_r", "calftwist", 1, Some(1)),
        ] {
            let expected = Words {
                joined: joined.into(),
                side,
                number,
            };
            assert_eq!(words(name), expected, "{name}");
        }
    }
}
