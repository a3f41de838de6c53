//! Bones in their bind pose, and what becomes of them in another.

use bevy::math::{DMat3, DQuat, DVec3};

/// A bone in the bind pose: metres, `+Y` up, the figure faces `+Z` with its left at `+X`.
#[derive(Clone, Debug)]
pub struct Bone {
    pub name: String,
    pub parent: Option<usize>,
    pub head: DVec3,
    pub tail: DVec3,
}

impl Bone {
    /// Axes of the node in the bind pose: `+Y` along the bone, as animation tools draw it.
    pub fn frame(&self) -> DQuat {
        if self.parent.is_none() {
            return DQuat::IDENTITY;
        }
        let y = (self.tail - self.head).normalize();
        let front = if y.z.abs() > 0.8 { DVec3::Y } else { DVec3::Z };
        let z = (front - y * front.dot(y)).normalize();
        DQuat::from_mat3(&DMat3::from_cols(y.cross(z), y, z)).normalize()
    }
}

/// All bones, parents before their children; the first is the root.
#[derive(Clone, Debug, Default)]
pub struct Skeleton {
    pub bones: Vec<Bone>,
}

impl Skeleton {
    /// Adds a bone below `parent`; an empty name is none.
    pub fn add(&mut self, name: &str, parent: &str, head: DVec3, tail: DVec3) {
        let parent = (!parent.is_empty()).then(|| self.find(parent));
        self.bones.push(Bone {
            name: name.into(),
            parent,
            head,
            tail,
        });
    }

    /// The bone of that name, which is there: the names are this generator's own.
    pub fn find(&self, name: &str) -> usize {
        self.bones
            .iter()
            .position(|bone| bone.name == name)
            .unwrap_or_else(|| panic!("no bone {name}"))
    }

    /// Where the bone starts as its parent sees it in the bind pose, along the model's axes.
    pub fn offset(&self, bone: usize) -> DVec3 {
        let bone = &self.bones[bone];
        bone.head - bone.parent.map_or(DVec3::ZERO, |p| self.bones[p].head)
    }
}

/// A pose: how every bone is turned from where its parent holds it in the bind pose, about the
/// model's axes, and how far the root has moved.
#[derive(Clone, Debug)]
pub struct Pose {
    pub shift: DVec3,
    pub turns: Vec<DQuat>,
}

/// Where a bone is in a pose: its head, and its turn from the bind pose.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub at: DVec3,
    pub turn: DQuat,
}

impl Pose {
    pub fn bind(skeleton: &Skeleton) -> Self {
        Self {
            shift: DVec3::ZERO,
            turns: vec![DQuat::IDENTITY; skeleton.bones.len()],
        }
    }

    /// Where one bone is, from the root down.
    pub fn place(&self, skeleton: &Skeleton, bone: usize) -> Place {
        let offset = skeleton.offset(bone);
        match skeleton.bones[bone].parent {
            None => Place {
                at: offset + self.shift,
                turn: self.turns[bone],
            },
            Some(parent) => {
                let above = self.place(skeleton, parent);
                Place {
                    at: above.at + above.turn * offset,
                    turn: above.turn * self.turns[bone],
                }
            }
        }
    }

    /// Turns a bone so that it is turned like this in the model.
    pub fn aim(&mut self, skeleton: &Skeleton, bone: usize, turn: DQuat) {
        let above = skeleton.bones[bone]
            .parent
            .map_or(DQuat::IDENTITY, |p| self.place(skeleton, p).turn);
        self.turns[bone] = (above.inverse() * turn).normalize();
    }

    /// Translation and rotation of the node of a bone, as a file wants them.
    pub fn node(&self, skeleton: &Skeleton, bone: usize) -> (DVec3, DQuat) {
        let own = skeleton.bones[bone].frame();
        let offset = skeleton.offset(bone);
        match skeleton.bones[bone].parent {
            None => (offset + self.shift, self.turns[bone] * own),
            Some(parent) => {
                let back = skeleton.bones[parent].frame().inverse();
                (back * offset, (back * self.turns[bone] * own).normalize())
            }
        }
    }
}

/// The same turn seen in a mirror that swaps left and right.
pub fn mirror(turn: DQuat) -> DQuat {
    DQuat::from_xyzw(turn.x, -turn.y, -turn.z, turn.w)
}
