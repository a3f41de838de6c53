//! The kinds of controllers that are measured beside their peers. A new one is a module and a line in
//! [`SUBJECTS`].

mod characters;
mod ragdolls;
mod vehicles;

use core::ops::Range;

use bevy::prelude::*;
use embody_scenes::{Sim, terrain::StableId};

use crate::{scene::Scene, side::Side};

pub use ragdolls::{Joints, joints};

/// A kind of controller, its scenes and what is demanded of it.
pub struct Subject {
    /// In the plural; also the name of the scene in which the sides are compared.
    pub name: &'static str,
    pub one: &'static str,
    /// Its scenes; the first one is that of the peer.
    pub scenes: &'static [Scene],
    /// Ours that are compared with the peer.
    pub compared: &'static [Compared],
    /// Adds a side's controller and the probes around everything it does in a tick.
    pub plugin: fn(&mut App, Side),
    /// What becomes of everyone, seen from outside.
    pub watch: fn(&mut World) -> Vec<Seen>,
    /// Heights between which everyone stays, metres.
    pub level: Range<f32>,
    /// How many are compared.
    pub count: u32,
    pub steps: usize,
    /// What else is measured of ours, in other scenes.
    pub variants: &'static [Variant],
    pub bounds: Bounds,
    /// Whether they act on each other: then figures are of all of them, milliseconds per tick, each of ours
    /// is held against the peer's of the same scene, and there are no crowds of other sizes.
    pub together: bool,
    /// What a figure counts, for the page of results.
    pub counted: &'static str,
}

/// One of ours that is compared with the peer.
pub struct Compared {
    pub scene: &'static str,
    /// In lines of results, as `probe=ray`; empty where there is only one.
    pub tag: &'static str,
    /// In the table.
    pub label: &'static str,
    /// Most of the peer's time on one thread, as a factor.
    pub ratio: Option<f64>,
    /// Most on one thread, microseconds each.
    pub most: Option<f64>,
}

/// One of ours in another scene, on one thread.
pub struct Variant {
    pub scene: &'static str,
    /// In lines of results.
    pub name: &'static str,
    /// In the table.
    pub label: &'static str,
    pub count: u32,
    /// It costs less than this, microseconds each.
    pub most: f64,
}

/// What is demanded.
pub struct Bounds {
    /// Least speed-up by a second thread.
    pub speed_up: f64,
    /// Most that one of many may cost, of one of few.
    pub growth: f64,
}

/// One of the measured, seen from outside.
pub struct Seen {
    pub id: StableId,
    pub at: Vec3,
    /// Speed that it is asked for, metres per second.
    pub wished: f32,
    /// Whether it can still do so: stands on its feet.
    pub upright: bool,
}

/// All subjects.
pub const SUBJECTS: &[Subject] = &[characters::SUBJECT, vehicles::SUBJECT, ragdolls::SUBJECT];

/// The subject of this name.
pub fn find(name: &str) -> Result<&'static Subject, String> {
    SUBJECTS
        .iter()
        .find(|subject| subject.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = SUBJECTS.iter().map(|subject| subject.name).collect();
            format!("`{name}` is not compared; there are: {}", names.join(", "))
        })
}

/// A scene by its name, and whose it is.
pub fn find_scene(name: &str) -> Result<(&'static Subject, &'static Scene), String> {
    all_scenes()
        .find(|(_, scene)| scene.name == name)
        .ok_or_else(|| {
            let names: Vec<_> = all_scenes().map(|(_, scene)| scene.name).collect();
            format!(
                "there is no scene `{name}`; there are: {}",
                names.join(", ")
            )
        })
}

/// Every scene with its subject.
pub fn all_scenes() -> impl Iterator<Item = (&'static Subject, &'static Scene)> {
    SUBJECTS
        .iter()
        .flat_map(|subject| subject.scenes.iter().map(move |scene| (subject, scene)))
}

/// Fills an empty world.
pub type Build = fn(&mut Sim, Side, u32);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measured_scene_is_there() {
        for subject in SUBJECTS {
            for variant in subject.variants {
                let found = subject.scenes.iter().any(|s| s.name == variant.scene);
                assert!(found, "{} of {}", variant.scene, subject.name);
            }
            for compared in subject.compared {
                let found = subject.scenes.iter().any(|s| s.name == compared.scene);
                assert!(found, "{} of {}", compared.scene, subject.name);
            }
            assert_eq!(subject.scenes[0].name, subject.name);
        }
    }
}
