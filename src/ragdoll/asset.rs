//! Body plans from files: a [`RagdollProfile`] as JSON, `*.ragdoll.json` (feature `serialize`).

use core::fmt;

use bevy::{
    asset::{AssetLoader, LoadContext, io::Reader},
    prelude::*,
};

use super::{config::Ragdoll, profile::RagdollProfile, validate::refuse_profile};

/// On an entity: makes it a [`Ragdoll`] as soon as the profile is loaded.
#[derive(Component, Clone, Debug, Default)]
#[require(Transform)]
pub struct RagdollFromProfile {
    /// The body plan.
    pub profile: Handle<RagdollProfile>,
    /// What the ragdoll is beside it.
    pub ragdoll: Ragdoll,
}

/// Loads body plans; one that cannot work is refused, with the name of the bone.
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub struct RagdollProfileLoader;

/// Why a body plan was not loaded.
#[derive(Debug)]
pub enum RagdollProfileError {
    /// The file could not be read.
    Read(std::io::Error),
    /// It is no profile.
    Parse(serde_json::Error),
    /// It cannot work.
    Refused(String),
}

impl fmt::Display for RagdollProfileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read(error) => write!(f, "the ragdoll profile cannot be read: {error}"),
            Self::Parse(error) => write!(f, "this is no ragdoll profile: {error}"),
            Self::Refused(what) => write!(f, "the ragdoll profile cannot work: {what}"),
        }
    }
}

impl core::error::Error for RagdollProfileError {}

/// Reads a profile.
fn parse(bytes: &[u8]) -> Result<RagdollProfile, RagdollProfileError> {
    let profile = serde_json::from_slice(bytes).map_err(RagdollProfileError::Parse)?;
    match refuse_profile(&profile) {
        Some(what) => Err(RagdollProfileError::Refused(what)),
        None => Ok(profile),
    }
}

impl AssetLoader for RagdollProfileLoader {
    type Asset = RagdollProfile;
    type Settings = ();
    type Error = RagdollProfileError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        _context: &mut LoadContext<'_>,
    ) -> Result<RagdollProfile, RagdollProfileError> {
        let mut bytes = Vec::new();
        let read = reader.read_to_end(&mut bytes).await;
        read.map_err(RagdollProfileError::Read)?;
        parse(&bytes)
    }

    fn extensions(&self) -> &[&str] {
        &["ragdoll.json"]
    }
}

/// Builds what has come.
pub(super) fn build(
    mut commands: Commands,
    waiting: Query<(Entity, &RagdollFromProfile), Without<Ragdoll>>,
    profiles: Option<Res<Assets<RagdollProfile>>>,
) {
    let Some(profiles) = profiles else { return };
    for (entity, wish) in &waiting {
        if let Some(profile) = profiles.get(&wish.profile) {
            commands.entity(entity).insert(Ragdoll {
                profile: profile.clone(),
                ..wish.ragdoll.clone()
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ragdoll::humanoid::HumanoidDetail;

    #[test]
    fn a_profile_comes_back_from_its_file_and_a_bad_one_is_refused_with_the_bone() {
        let mut profile = RagdollProfile::humanoid(HumanoidDetail::Bodies23, 1.75);
        profile.no_contact.push(("head".into(), "hand_l".into()));
        let bytes = serde_json::to_vec(&profile).unwrap();
        assert_eq!(parse(&bytes).unwrap(), profile);
        profile.bones[5].parent = Some("tail".into());
        let bytes = serde_json::to_vec(&profile).unwrap();
        let refused = parse(&bytes).unwrap_err().to_string();
        assert!(refused.contains("\"tail\""), "{refused}");
        let none = parse(b"{\"bones\": 3}").unwrap_err().to_string();
        assert!(none.contains("no ragdoll profile"), "{none}");
    }
}
