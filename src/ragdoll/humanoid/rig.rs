//! Where the joints of a human figure are.

use bevy::prelude::*;

use super::part::BodyPart;

/// The joints of a human figure in its bind pose, in the figure's axes (`Y` up, facing `-Z`), metres.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct HumanoidRig {
    /// Where each part begins: its joint with the part that bears it.
    pub starts: [Vec3; BodyPart::COUNT],
    /// Rotation of each part's bone in the bind pose.
    pub rotations: [Quat; BodyPart::COUNT],
    /// Top of the head.
    pub crown: Vec3,
    /// Tips of the fingers, left and right.
    pub fingertips: [Vec3; 2],
    /// Tips of the toes, left and right.
    pub toe_tips: [Vec3; 2],
    /// Height from sole to crown.
    pub stature: f32,
}

impl HumanoidRig {
    /// A standing figure of this stature (metres), arms hanging a little away from the body.
    pub fn standing(stature: f32) -> Self {
        use BodyPart::*;
        let h = stature;
        let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z) * h;
        let mut starts = [Vec3::ZERO; BodyPart::COUNT];
        let mut set = |part: BodyPart, p: Vec3| starts[part as usize] = p;
        set(Pelvis, at(0.0, 0.530, 0.0));
        set(LowerSpine, at(0.0, 0.585, 0.008));
        set(MiddleSpine, at(0.0, 0.635, 0.008));
        set(UpperSpine, at(0.0, 0.685, 0.008));
        set(Chest, at(0.0, 0.735, 0.008));
        set(Neck, at(0.0, 0.830, 0.008));
        set(Head, at(0.0, 0.875, 0.0));
        // Hanging 10 degrees out.
        let hang = Vec3::new(0.173_65, -0.984_81, 0.0);
        for side in [-1.0f32, 1.0] {
            let part = |left: BodyPart| if side < 0.0 { left } else { left.mirrored() };
            let across = Vec3::new(side, 1.0, 1.0);
            let shoulder = at(0.1295, 0.818, 0.008);
            set(part(LeftClavicle), at(0.012, 0.815, -0.010) * across);
            set(part(LeftUpperArm), shoulder * across);
            set(part(LeftForearm), (shoulder + hang * (0.186 * h)) * across);
            set(part(LeftHand), (shoulder + hang * (0.332 * h)) * across);
            set(part(LeftThigh), at(0.055, 0.530, 0.0) * across);
            set(part(LeftShin), at(0.055, 0.285, 0.0) * across);
            set(part(LeftFoot), at(0.055, 0.039, 0.0) * across);
            set(part(LeftToes), at(0.055, 0.012, -0.085) * across);
        }
        let hand = at(0.1295, 0.818, 0.008) + hang * (0.440 * h);
        let toe = at(0.055, 0.010, -0.120);
        let left = Vec3::new(-1.0, 1.0, 1.0);
        Self {
            starts,
            rotations: [Quat::IDENTITY; BodyPart::COUNT],
            crown: at(0.0, 1.0, 0.0),
            fingertips: [hand * left, hand],
            toe_tips: [toe * left, toe],
            stature,
        }
    }

    /// Where a part begins.
    pub fn start(&self, part: BodyPart) -> Vec3 {
        self.starts[part as usize]
    }

    /// Where a part ends: where the next one of its chain begins, or its tip.
    pub fn end(&self, part: BodyPart) -> Vec3 {
        use BodyPart::*;
        let side = usize::from(part.side() > 0.0);
        match part {
            Pelvis => self.start(LowerSpine),
            Head => self.crown,
            LeftHand | RightHand => self.fingertips[side],
            LeftToes | RightToes => self.toe_tips[side],
            Chest => self.start(Neck),
            _ => {
                let next = BodyPart::ALL.into_iter().find(|p| p.parent() == Some(part));
                next.map_or(self.start(part), |p| self.start(p))
            }
        }
    }
}
