//! What a course looks like: its triangles, colours and materials on the spawned entities.

use bevy::prelude::*;

use bevy_embody::prelude::*;

use super::looks::Paints;
use crate::course::{Course, CourseNode, extras::BodyKind};

/// Gives every [`CourseNode`] its looks, as soon as it is spawned.
pub(super) struct CourseViewPlugin;

impl Plugin for CourseViewPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<CoursePaints>().add_observer(dress);
    }
}

#[derive(Resource, Default)]
struct CoursePaints(Paints);

fn dress(
    added: On<Add, CourseNode>,
    mut commands: Commands,
    course: Res<Course>,
    nodes: Query<&CourseNode>,
    mut paints: ResMut<CoursePaints>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let Some(node) = nodes
        .get(added.entity)
        .ok()
        .and_then(|node| course.nodes.get(node.0))
    else {
        return;
    };
    paints.0.fill(&course, &mut materials);
    let mut entity = commands.entity(added.entity);
    entity.insert(Visibility::default());
    if node.extras.body != BodyKind::Fixed {
        entity.insert(Interpolated);
    }
    paints
        .0
        .dress(&mut commands, &mut meshes, added.entity, &node.surfaces);
}
