//! The parts of a human figure, and which of them are bodies of their own.

use bevy::prelude::*;

/// How many bodies a human figure is made of.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum HumanoidDetail {
    /// Trunk, head, upper and lower arms and legs: crowds and far away.
    Bodies10,
    /// Also pelvis apart from chest, hands and feet.
    Bodies15,
    /// Also abdomen, neck and shoulder girdle.
    #[default]
    Bodies19,
    /// Also two more in the spine, and toes: close by, powered.
    Bodies23,
}

macro_rules! parts {
    ($($part:ident $name:literal $doc:literal,)*) => {
        /// A part of a human figure.
        #[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[reflect(Debug, PartialEq, Hash, Clone)]
        #[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
        pub enum BodyPart { $(#[doc = $doc] $part,)* }

        impl BodyPart {
            /// Every part, parents before children.
            pub const ALL: [Self; Self::COUNT] = [$(Self::$part,)*];

            /// The name of its bone in a profile.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$part => $name,)* }
            }
        }
    };
}

parts! {
    Pelvis "pelvis" "The pelvis, root of the figure.",
    LowerSpine "lower_spine" "Lumbar spine, lower half of the abdomen.",
    MiddleSpine "middle_spine" "Upper half of the abdomen.",
    UpperSpine "upper_spine" "Lower thorax.",
    Chest "chest" "Upper thorax.",
    Neck "neck" "The neck.",
    Head "head" "The head.",
    LeftClavicle "clavicle_l" "Left half of the shoulder girdle.",
    LeftUpperArm "upper_arm_l" "Left upper arm.",
    LeftForearm "forearm_l" "Left forearm.",
    LeftHand "hand_l" "Left hand.",
    RightClavicle "clavicle_r" "Right half of the shoulder girdle.",
    RightUpperArm "upper_arm_r" "Right upper arm.",
    RightForearm "forearm_r" "Right forearm.",
    RightHand "hand_r" "Right hand.",
    LeftThigh "thigh_l" "Left thigh.",
    LeftShin "shin_l" "Left shank.",
    LeftFoot "foot_l" "Left foot.",
    LeftToes "toes_l" "Toes of the left foot.",
    RightThigh "thigh_r" "Right thigh.",
    RightShin "shin_r" "Right shank.",
    RightFoot "foot_r" "Right foot.",
    RightToes "toes_r" "Toes of the right foot.",
}

impl BodyPart {
    /// How many there are.
    pub const COUNT: usize = 23;

    /// The part that bears it in the full figure.
    pub const fn parent(self) -> Option<Self> {
        use BodyPart::*;
        Some(match self {
            Pelvis => return None,
            LowerSpine | LeftThigh | RightThigh => Pelvis,
            MiddleSpine => LowerSpine,
            UpperSpine => MiddleSpine,
            Chest => UpperSpine,
            Neck | LeftClavicle | RightClavicle => Chest,
            Head => Neck,
            LeftUpperArm => LeftClavicle,
            LeftForearm => LeftUpperArm,
            LeftHand => LeftForearm,
            RightUpperArm => RightClavicle,
            RightForearm => RightUpperArm,
            RightHand => RightForearm,
            LeftShin => LeftThigh,
            LeftFoot => LeftShin,
            LeftToes => LeftFoot,
            RightShin => RightThigh,
            RightFoot => RightShin,
            RightToes => RightFoot,
        })
    }

    /// Share of the body's mass.
    pub const fn share(self) -> f32 {
        use BodyPart::*;
        match self {
            Pelvis => 0.142,
            // The abdomen, 0.139.
            LowerSpine | MiddleSpine => 0.0695,
            // The thorax, 0.216, with the shoulder girdle.
            UpperSpine => 0.080,
            Chest => 0.106,
            LeftClavicle | RightClavicle => 0.015,
            // Head and neck, 0.081.
            Neck => 0.0116,
            Head => 0.0694,
            LeftUpperArm | RightUpperArm => 0.028,
            LeftForearm | RightForearm => 0.016,
            LeftHand | RightHand => 0.006,
            LeftThigh | RightThigh => 0.100,
            LeftShin | RightShin => 0.0465,
            // The foot, 0.0145.
            LeftFoot | RightFoot => 0.0118,
            LeftToes | RightToes => 0.0027,
        }
    }

    /// Where along a limb its centre of mass is, and its radius of gyration across, as parts of its
    /// length; `None` for parts whose shape tells.
    pub(super) const fn limb(self) -> Option<(f32, f32)> {
        use BodyPart::*;
        match self {
            LeftUpperArm | RightUpperArm => Some((0.436, 0.322)),
            LeftForearm | RightForearm => Some((0.430, 0.303)),
            LeftHand | RightHand => Some((0.506, 0.297)),
            LeftThigh | RightThigh => Some((0.433, 0.323)),
            LeftShin | RightShin => Some((0.433, 0.302)),
            _ => None,
        }
    }

    /// −1 on the left, 1 on the right, 0 in the middle.
    pub const fn side(self) -> f32 {
        use BodyPart::*;
        match self {
            LeftClavicle | LeftUpperArm | LeftForearm | LeftHand | LeftThigh | LeftShin
            | LeftFoot | LeftToes => -1.0,
            RightClavicle | RightUpperArm | RightForearm | RightHand | RightThigh | RightShin
            | RightFoot | RightToes => 1.0,
            _ => 0.0,
        }
    }

    /// The same part of the other side.
    pub fn mirrored(self) -> Self {
        let i = self as usize;
        match i {
            7..=10 | 15..=18 => Self::ALL[i + 4],
            11..=14 | 19..=22 => Self::ALL[i - 4],
            _ => self,
        }
    }

    /// Whether it is a body of its own at this level.
    pub const fn is_body(self, detail: HumanoidDetail) -> bool {
        use BodyPart::*;
        match self {
            Pelvis | Head | LeftUpperArm | RightUpperArm | LeftForearm | RightForearm
            | LeftThigh | RightThigh | LeftShin | RightShin => true,
            Chest | LeftHand | RightHand | LeftFoot | RightFoot => {
                !matches!(detail, HumanoidDetail::Bodies10)
            }
            LowerSpine | Neck | LeftClavicle | RightClavicle => {
                matches!(detail, HumanoidDetail::Bodies19 | HumanoidDetail::Bodies23)
            }
            MiddleSpine | UpperSpine | LeftToes | RightToes => {
                matches!(detail, HumanoidDetail::Bodies23)
            }
        }
    }

    /// The body that it is a part of at this level.
    pub fn body(self, detail: HumanoidDetail) -> Self {
        use BodyPart::*;
        if self.is_body(detail) {
            return self;
        }
        match (self, detail) {
            // The middle of the spine goes with its nearer end; the neck goes with the head.
            (UpperSpine, HumanoidDetail::Bodies15 | HumanoidDetail::Bodies19)
            | (MiddleSpine, HumanoidDetail::Bodies15) => Chest,
            (Neck, _) => Head,
            _ => match self.parent() {
                Some(parent) => parent.body(detail),
                None => self,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_level_has_as_many_bodies_as_its_name_says() {
        for (detail, count) in [
            (HumanoidDetail::Bodies10, 10),
            (HumanoidDetail::Bodies15, 15),
            (HumanoidDetail::Bodies19, 19),
            (HumanoidDetail::Bodies23, 23),
        ] {
            let bodies = BodyPart::ALL.iter().filter(|p| p.is_body(detail)).count();
            assert_eq!(bodies, count);
            for part in BodyPart::ALL {
                assert!(part.body(detail).is_body(detail), "{part:?}");
            }
        }
    }

    #[test]
    fn the_shares_are_those_of_a_whole_body() {
        let sum: f32 = BodyPart::ALL.iter().map(|p| p.share()).sum();
        assert!((sum - 1.0).abs() < 1.0e-6, "{sum}");
    }

    #[test]
    fn left_and_right_mirror_each_other() {
        for part in BodyPart::ALL {
            assert_eq!(part.mirrored().mirrored(), part);
            assert_eq!(part.mirrored().side(), -part.side());
            assert_eq!(part.mirrored().share(), part.share());
        }
    }
}
