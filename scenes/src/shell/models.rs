//! What vehicles look like.

use bevy::prelude::*;
use bevy_embody::prelude::*;

use super::looks::Paints;
use crate::course::Course;

/// On a vehicle: the model it is shown as, by the name of its preset.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelOf(pub &'static str);

/// The models: a node by the name of each preset, and one for its wheels.
#[derive(Resource, Clone, Debug)]
pub struct Models(pub Course);

/// Gives every [`ModelOf`] its looks, as soon as it is spawned.
pub(super) struct ModelsPlugin;

impl Plugin for ModelsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ModelPaints>().add_observer(dress);
    }
}

#[derive(Resource, Default)]
struct ModelPaints(Paints);

fn dress(
    added: On<Add, ModelOf>,
    mut commands: Commands,
    vehicles: Query<(&ModelOf, &Wheels)>,
    models: Option<Res<Models>>,
    mut paints: ResMut<ModelPaints>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (Some(models), Ok((model, wheels))) = (models, vehicles.get(added.entity)) else {
        return;
    };
    paints.0.fill(&models.0, &mut materials);
    let wheel = format!("{}.wheel", model.0);
    let dressed = core::iter::once((added.entity, model.0))
        .chain(wheels.iter().map(|entity| (entity, wheel.as_str())));
    for (entity, name) in dressed {
        if let Some((_, node)) = models.0.node(name) {
            commands.entity(entity).insert(Visibility::default());
            paints
                .0
                .dress(&mut commands, &mut meshes, entity, &node.surfaces);
        }
    }
}
