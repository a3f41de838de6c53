//! The nodes of the level whose poses a station's trace keeps.

use bevy::prelude::*;

use crate::course::{CourseMotion, CourseNode, layout::Place};

/// The tracked nodes of a station, in the order in which it names them.
#[derive(Debug, Default)]
pub struct Tracked {
    nodes: Vec<Option<Entity>>,
    /// Names that the level does not have.
    pub missing: Vec<String>,
}

impl Tracked {
    /// Looks the names up in the level.
    pub fn find(world: &mut World, names: &[String]) -> Self {
        let mut all = world.query_filtered::<(Entity, &Name), With<CourseNode>>();
        let mut tracked = Self::default();
        for wanted in names {
            let node = all
                .iter(world)
                .find(|(_, name)| name.as_str() == wanted)
                .map(|(entity, _)| entity);
            if node.is_none() {
                tracked.missing.push(wanted.clone());
            }
            tracked.nodes.push(node);
        }
        tracked
    }

    /// Lets what moves by the clock begin anew.
    pub fn restart(&self, world: &mut World) {
        for node in self.nodes.iter().flatten() {
            if let Some(mut motion) = world.get_mut::<CourseMotion>(*node) {
                motion.time = 0.0;
            }
        }
    }

    /// Poses of those that are there, in the station's axes.
    pub fn poses(&self, world: &World, place: &Place) -> Vec<Transform> {
        self.nodes
            .iter()
            .filter_map(|node| world.get::<Transform>((*node)?))
            .map(|pose| place.local_pose(pose))
            .collect()
    }
}
