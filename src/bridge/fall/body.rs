//! A character's own bones are nothing to its capsule.

use bevy::prelude::*;

use super::CharacterRagdoll;
use crate::{
    backend::{
        handles::{RapierContextEntityLink, RapierRigidBodyHandle},
        joints::JointWorlds,
    },
    character::CharacterIgnores,
    ragdoll::Bones,
};

/// The bones that a character was told of.
#[derive(Component, Default)]
pub(crate) struct OwnBones {
    bones: Vec<Entity>,
    /// Whether capsule and bones were told apart.
    parted: bool,
    /// Whether the capsule is disabled because it lies, not because the game wants it so.
    pub(super) disabled: bool,
    /// The settings that were told to be bad, as bits: who writes them every tick is not told every tick.
    pub(super) told: [Option<u32>; 2],
}

impl OwnBones {
    /// Takes the bones off the list of what a character ignores.
    pub(super) fn release(&self, ignores: &mut CharacterIgnores) {
        ignores.0.retain(|e| !self.bones.contains(e));
    }
}

/// The solver of characters leaves out the bones.
pub(super) fn ignore_own_bones(
    mut characters: Query<
        (&Bones, &mut OwnBones, &mut CharacterIgnores),
        (With<CharacterRagdoll>, Changed<Bones>),
    >,
) {
    for (bones, mut own, mut ignores) in &mut characters {
        own.release(&mut ignores);
        own.bones.clear();
        own.bones.extend(bones.iter());
        ignores.0.extend(bones.iter());
        own.parted = false;
    }
}

/// The physics world lets them pass through each other, also those that flinch.
pub(super) fn part_contacts(
    mut worlds: JointWorlds,
    mut characters: Query<
        (
            &mut OwnBones,
            &RapierRigidBodyHandle,
            &RapierContextEntityLink,
        ),
        With<CharacterRagdoll>,
    >,
    bones: Query<&RapierRigidBodyHandle>,
) {
    for (mut own, capsule, link) in &mut characters {
        if own.parted || own.bones.is_empty() {
            continue;
        }
        for bone in bones.iter_many(&own.bones) {
            worlds.ignore(link, capsule, bone);
        }
        own.parted = true;
    }
}
