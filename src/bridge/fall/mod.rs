//! A character that becomes a ragdoll, and gets up again.
//!
//! The figure is the character's own: one entity has both. Upright, its bones follow the pose and the
//! capsule walks; down, the capsule is switched off and its entity goes along below the pelvis; to get up,
//! there must be room for the capsule where the figure would stand. Velocity goes over both ways.

mod body;
mod change;
mod impact;

use bevy::prelude::*;

use crate::{
    character::CharacterIgnores,
    ragdoll::{FollowRoot, RagdollMode, RagdollSystems},
    schedule::EmbodySystems,
};

use body::OwnBones;

/// On an entity that is a [`Character`](crate::character::Character) and a
/// [`Ragdoll`](crate::ragdoll::Ragdoll): lets it fall ([`FallCommands::become_ragdoll`]) and get up
/// ([`FallCommands::recover`]).
///
/// It writes the [`RagdollIntent::mode`](crate::ragdoll::RagdollIntent) when it is added and when its phase
/// changes, and only then. Its own bones are nothing to its capsule. For characters at the top level of
/// the world. The figure's [`RagdollUp`](crate::ragdoll::RagdollUp) is kept that of the character.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[require(CharacterRagdollState, CharacterIgnores, FollowRoot, OwnBones)]
pub struct CharacterRagdoll {
    /// What the bones are while the character is upright.
    pub upright: RagdollMode,
    /// What they are while it is down.
    pub down: RagdollMode,
    /// Something that runs into it with at least this impulse throws it down, newton-seconds, above 0;
    /// `None` nothing does. What it runs into itself does not count.
    ///
    /// The impulse is that of a collision without rebound: closing speed times the reduced mass of
    /// both. A crate of 20 kg at 5 m/s has 78 N·s against 70 kg; a door that nothing stops counts as
    /// infinitely heavy.
    pub fall_impulse: Option<f32>,
    /// It gets up by itself when it has lain still for so long, seconds, at least 0; `None` when it is told
    /// to.
    pub get_up_after: Option<f32>,
}

impl Default for CharacterRagdoll {
    fn default() -> Self {
        Self {
            upright: RagdollMode::HitBoxes,
            down: RagdollMode::Limp,
            fall_impulse: None,
            get_up_after: None,
        }
    }
}

/// Where a character is between standing and lying.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Default, Debug, PartialEq, Hash, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum BodyPhase {
    /// It is a character.
    #[default]
    Upright,
    /// It is a ragdoll.
    Down,
    /// It would get up, but has no room.
    Waiting,
    /// It gets up: a character again, whose bones come after it.
    Rising,
}

/// What a character that can fall carries from tick to tick.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct CharacterRagdollState {
    /// Where it is.
    pub phase: BodyPhase,
    /// Whether it is to fall in the next tick.
    pub falls: bool,
    /// Whether it is to get up as soon as it can.
    pub rises: bool,
    /// Velocity of the character before its last tick, metres per second, world.
    pub velocity: Vec3,
}

/// Trigger it to let a character fall.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct BecomeRagdoll {
    /// The character.
    pub entity: Entity,
}

/// Trigger it to let a fallen character get up as soon as there is room.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct Recover {
    /// The character.
    pub entity: Entity,
}

/// It fell.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct FellDown {
    /// The character.
    pub entity: Entity,
}

/// It is on its feet again.
#[derive(EntityEvent, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct StoodUp {
    /// The character.
    pub entity: Entity,
}

/// Falling and getting up by a call.
pub trait FallCommands {
    /// Lets a character fall: see [`BecomeRagdoll`].
    fn become_ragdoll(&mut self, character: Entity);
    /// Lets a fallen character get up as soon as there is room: see [`Recover`].
    fn recover(&mut self, character: Entity);
}

impl FallCommands for Commands<'_, '_> {
    fn become_ragdoll(&mut self, character: Entity) {
        self.trigger(BecomeRagdoll { entity: character });
    }

    fn recover(&mut self, character: Entity) {
        self.trigger(Recover { entity: character });
    }
}

/// The systems of [`CharacterRagdollPlugin`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CharacterRagdollSystems;

/// Lets characters become ragdolls and get up. Part of [`EmbodyPlugins`](crate::EmbodyPlugins).
#[derive(Clone, Copy, Debug, Default)]
pub struct CharacterRagdollPlugin;

impl Plugin for CharacterRagdollPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<CharacterRagdoll>()
            .register_type::<CharacterRagdollState>()
            .register_type::<BecomeRagdoll>()
            .register_type::<Recover>()
            .register_type::<FellDown>()
            .register_type::<StoodUp>()
            .add_observer(change::note_fall)
            .add_observer(change::note_rise)
            .add_observer(change::forget)
            .add_observer(impact::note)
            .add_systems(
                FixedPostUpdate,
                (
                    (
                        impact::check,
                        change::stand,
                        body::ignore_own_bones,
                        change::change,
                    )
                        .chain()
                        .after(EmbodySystems::Prepare)
                        .before(RagdollSystems::Prepare),
                    impact::feel.in_set(EmbodySystems::React),
                    body::part_contacts
                        .after(RagdollSystems::Drive)
                        .before(bevy_rapier3d::prelude::PhysicsSet::StepSimulation),
                )
                    .in_set(CharacterRagdollSystems)
                    .run_if(any_with_component::<CharacterRagdoll>),
            );
    }
}
