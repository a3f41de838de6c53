//! Changes made in the panel, kept until the next tick applies them.

use core::any::TypeId;

use bevy::{
    prelude::*,
    reflect::{GetPath, PartialReflect},
};
use tracing::warn;

/// Changes that wait for the next tick. The panel never writes to a component itself: what it is
/// told is queued here and applied in [`FixedPreUpdate`], so a tick sees whole changes only, and a
/// replay that records the queue repeats a session of tuning.
#[derive(Resource, Debug, Default)]
pub struct TuningEdits {
    waiting: Vec<Edit>,
}

/// One field of one component of one entity, and its new value.
#[derive(Debug)]
struct Edit {
    entity: Entity,
    component: TypeId,
    path: String,
    value: Box<dyn PartialReflect>,
}

impl TuningEdits {
    /// Queues a new value for the field at this reflection path (`.step.0.height`) of a component.
    /// It takes the place of an earlier value for the same field or a part of it.
    pub fn set<C: Component>(
        &mut self,
        entity: Entity,
        path: impl Into<String>,
        value: impl PartialReflect,
    ) {
        self.push(entity, TypeId::of::<C>(), path.into(), Box::new(value));
    }

    /// Number of changes that wait.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Whether nothing waits.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    pub(super) fn push(
        &mut self,
        entity: Entity,
        component: TypeId,
        path: String,
        value: Box<dyn PartialReflect>,
    ) {
        // A part set before the whole would be lost or would not exist any more.
        self.waiting.retain(|edit| {
            edit.entity != entity || edit.component != component || !is_part_of(&edit.path, &path)
        });
        self.waiting.push(Edit {
            entity,
            component,
            path,
            value,
        });
    }

    /// The value that waits for exactly this field.
    pub(super) fn pending(
        &self,
        entity: Entity,
        component: TypeId,
        path: &str,
    ) -> Option<&dyn PartialReflect> {
        self.waiting
            .iter()
            .find(|edit| edit.entity == entity && edit.component == component && edit.path == path)
            .map(|edit| edit.value.as_partial_reflect())
    }
}

/// Whether a reflection path names a field or a part of it.
fn is_part_of(path: &str, whole: &str) -> bool {
    path.strip_prefix(whole)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Applies what waits, in the order in which it was asked.
pub(super) fn apply_edits(world: &mut World) {
    let Some(mut edits) = world.get_resource_mut::<TuningEdits>() else {
        return;
    };
    if edits.is_empty() {
        return;
    }
    let waiting = core::mem::take(&mut edits.waiting);
    let registry = world.resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    for edit in waiting {
        if let Err(reason) = apply(world, &registry, &edit) {
            warn!(
                "the change of {} on {} to {:?} is not made: {reason}",
                edit.path, edit.entity, edit.value
            );
        }
    }
}

fn apply(
    world: &mut World,
    registry: &bevy::reflect::TypeRegistry,
    edit: &Edit,
) -> Result<(), String> {
    let reflected = registry
        .get_type_data::<ReflectComponent>(edit.component)
        .ok_or("its component is not registered")?;
    // An entity that went away takes its changes with it.
    let Ok(mut entity) = world.get_entity_mut(edit.entity) else {
        return Ok(());
    };
    let Some(mut component) = reflected.reflect_mut(&mut entity) else {
        return Ok(());
    };
    component
        .reflect_path_mut(edit.path.as_str())
        .map_err(|error| error.to_string())?
        .try_apply(edit.value.as_ref())
        .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::{Character, CharacterMotor, CharacterShape};
    use bevy::reflect::enums::{DynamicEnum, DynamicVariant};

    fn world() -> (World, Entity) {
        let mut world = World::new();
        let registry = AppTypeRegistry::default();
        {
            let mut types = registry.write();
            types.register::<Character>();
            types.register::<CharacterMotor>();
        }
        world.insert_resource(registry);
        world.init_resource::<TuningEdits>();
        let entity = world.spawn(Character::default()).id();
        (world, entity)
    }

    #[test]
    fn a_queued_change_is_made_once_and_only_when_applied() {
        let (mut world, entity) = world();
        world
            .resource_mut::<TuningEdits>()
            .set::<Character>(entity, ".step.0.height", 0.7f32);
        let height = |world: &World| world.get::<Character>(entity).unwrap().step.unwrap().height;
        assert_eq!(height(&world), 0.4);
        apply_edits(&mut world);
        assert_eq!(height(&world), 0.7);
        assert!(world.resource::<TuningEdits>().is_empty());
    }

    #[test]
    fn a_later_change_of_the_whole_drops_the_waiting_change_of_a_part() {
        let (mut world, entity) = world();
        let mut edits = world.resource_mut::<TuningEdits>();
        edits.set::<Character>(entity, ".step.0.height", 0.7f32);
        edits.set::<Character>(
            entity,
            ".step",
            DynamicEnum::new("None", DynamicVariant::Unit),
        );
        assert_eq!(edits.len(), 1);
        apply_edits(&mut world);
        assert_eq!(world.get::<Character>(entity).unwrap().step, None);
    }

    #[test]
    fn a_field_whose_name_begins_like_another_keeps_its_change() {
        let (mut world, entity) = world();
        let mut edits = world.resource_mut::<TuningEdits>();
        edits.set::<Character>(entity, ".step_smoothing", 0.5f32);
        edits.set::<Character>(
            entity,
            ".step",
            DynamicEnum::new("None", DynamicVariant::Unit),
        );
        apply_edits(&mut world);
        assert_eq!(world.get::<Character>(entity).unwrap().step_smoothing, 0.5);
    }

    #[test]
    fn a_change_of_variant_then_of_its_field_both_act() {
        let (mut world, entity) = world();
        let mut edits = world.resource_mut::<TuningEdits>();
        edits.set::<Character>(
            entity,
            ".shape",
            CharacterShape::Cylinder {
                radius: 0.5,
                height: 2.0,
            },
        );
        edits.set::<Character>(entity, ".shape.radius", 0.25f32);
        apply_edits(&mut world);
        assert_eq!(
            world.get::<Character>(entity).unwrap().shape,
            CharacterShape::Cylinder {
                radius: 0.25,
                height: 2.0
            }
        );
    }

    #[test]
    fn a_change_that_makes_no_sense_is_refused_and_the_others_are_made() {
        let (mut world, entity) = world();
        let mut edits = world.resource_mut::<TuningEdits>();
        edits.set::<Character>(entity, ".no_such_field", 1.0f32);
        edits.set::<Character>(entity, ".mass", "heavy".to_string());
        edits.set::<CharacterMotor>(entity, ".walk_speed", 3.0f32);
        apply_edits(&mut world);
        assert_eq!(world.get::<Character>(entity).unwrap().mass, 70.0);
        assert_eq!(world.get::<CharacterMotor>(entity).unwrap().walk_speed, 3.0);
    }

    #[test]
    fn changes_of_an_entity_that_is_gone_are_forgotten() {
        let (mut world, entity) = world();
        world
            .resource_mut::<TuningEdits>()
            .set::<Character>(entity, ".mass", 1.0f32);
        world.despawn(entity);
        apply_edits(&mut world);
        assert!(world.resource::<TuningEdits>().is_empty());
    }
}
