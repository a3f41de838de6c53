//! A form for any reflected value: what a type gains as a field appears here by itself.

use core::any::TypeId;

use bevy::{
    prelude::*,
    reflect::{
        PartialReflect, ReflectRef, TypeRegistry,
        enums::{Enum, VariantType},
    },
};
use bevy_egui::egui::{self, Ui};

use super::{
    edits::TuningEdits,
    units::{is_angle, may_be_negative},
    variants,
};

/// Draws the fields of one component of one entity and queues what is changed.
pub(super) struct Form<'a> {
    registry: &'a TypeRegistry,
    edits: &'a mut TuningEdits,
    entity: Entity,
    component: TypeId,
    /// The unit of a field by its name.
    unit: fn(&str) -> &'static str,
}

impl<'a> Form<'a> {
    pub(super) fn new(
        registry: &'a TypeRegistry,
        edits: &'a mut TuningEdits,
        entity: Entity,
        unit: fn(&str) -> &'static str,
    ) -> Self {
        Self {
            registry,
            edits,
            entity,
            component: TypeId::of::<()>(),
            unit,
        }
    }

    /// Draws all fields of a component.
    pub(super) fn component<C: Component + PartialReflect>(&mut self, ui: &mut Ui, value: &C) {
        self.component = TypeId::of::<C>();
        ui.push_id(self.component, |ui| self.fields(ui, value, ""));
    }

    /// Draws the fields of a value in two columns.
    fn fields(&mut self, ui: &mut Ui, value: &dyn PartialReflect, path: &str) {
        egui::Grid::new(("fields", path))
            .num_columns(2)
            .spacing([8.0, 3.0])
            .show(ui, |ui| {
                for (name, step, field) in parts(value) {
                    let path = format!("{path}{step}");
                    ui.label(spoken(&name));
                    ui.vertical(|ui| self.value(ui, &name, field, &path));
                    ui.end_row();
                }
            });
    }

    /// Draws one value; `path` leads to it from the component.
    fn value(&mut self, ui: &mut Ui, name: &str, value: &dyn PartialReflect, path: &str) {
        // What waits for the next tick is shown already, or dragging would fall back each frame.
        let pending = self
            .edits
            .pending(self.entity, self.component, path)
            .map(PartialReflect::to_dynamic);
        let value = pending.as_deref().unwrap_or(value);

        if let Some(&number) = value.try_downcast_ref::<f32>() {
            self.number(ui, name, number, path);
        } else if let Some(&flag) = value.try_downcast_ref::<bool>() {
            let mut new = flag;
            if ui.checkbox(&mut new, "").changed() {
                self.set(path, new);
            }
        } else if let Some(&vector) = value.try_downcast_ref::<Vec3>() {
            ui.horizontal(|ui| {
                let mut new = vector;
                for axis in [&mut new.x, &mut new.y, &mut new.z] {
                    ui.add(egui::DragValue::new(axis).speed(0.01).max_decimals(3));
                }
                if new != vector {
                    self.set(path, new);
                }
            });
        } else if let Some(&pair) = value.try_downcast_ref::<Vec2>() {
            ui.horizontal(|ui| {
                let mut new = pair;
                for axis in [&mut new.x, &mut new.y] {
                    ui.add(egui::DragValue::new(axis).speed(0.01).max_decimals(3));
                }
                if new != pair {
                    self.set(path, new);
                }
            });
        } else {
            match value.reflect_ref() {
                ReflectRef::Enum(value) => self.choice(ui, name, value, path),
                ReflectRef::Struct(_) | ReflectRef::TupleStruct(_) => self.fields(ui, value, path),
                ReflectRef::List(list) => {
                    egui::CollapsingHeader::new(format!("{} values", list.len()))
                        .id_salt(path)
                        .show(ui, |ui| self.fields(ui, value, path));
                }
                _ => {
                    ui.weak(format!("{value:?}"));
                }
            }
        }
    }

    fn number(&mut self, ui: &mut Ui, name: &str, number: f32, path: &str) {
        // A drag field would turn it into a number by merely showing it.
        if number.is_nan() {
            ui.horizontal(|ui| {
                ui.colored_label(egui::Color32::LIGHT_RED, "not a number");
                if ui.small_button("set to 0").clicked() {
                    self.set(path, 0.0f32);
                }
            });
            return;
        }
        let mut new = number;
        if is_angle(name) {
            let mut degrees = number.to_degrees();
            let drag = egui::DragValue::new(&mut degrees)
                .speed(0.25)
                .max_decimals(1)
                .suffix("°");
            if ui.add(drag).changed() {
                new = degrees.to_radians();
            }
        } else {
            // A drag of 100 points about doubles a value, whatever its size.
            let speed = if number.is_finite() {
                (f64::from(number.abs()) * 0.01).max(0.001)
            } else {
                1.0
            };
            let mut drag = egui::DragValue::new(&mut new)
                .speed(speed)
                .max_decimals(3)
                .suffix((self.unit)(name));
            if !may_be_negative(name) {
                drag = drag
                    .range(0.0..=f32::INFINITY)
                    .clamp_existing_to_range(false);
            }
            ui.add(drag);
        }
        if new.to_bits() != number.to_bits() {
            self.set(path, new);
        }
    }

    /// A choice of variant, then the fields of the one chosen. An `Option` is a tick box.
    fn choice(&mut self, ui: &mut Ui, name: &str, value: &dyn Enum, path: &str) {
        let Some(info) = value
            .get_represented_type_info()
            .and_then(|info| info.as_enum().ok())
        else {
            ui.weak(spoken(value.variant_name()));
            return;
        };
        let optional = info.variant_names() == ["None", "Some"];
        let mut chosen = value.variant_name().to_string();
        if optional {
            let mut on = chosen == "Some";
            ui.checkbox(&mut on, "");
            chosen = if on { "Some" } else { "None" }.into();
        } else {
            egui::ComboBox::from_id_salt(path)
                .selected_text(spoken(&chosen))
                .show_ui(ui, |ui| {
                    for variant in info.variant_names() {
                        ui.selectable_value(&mut chosen, (*variant).into(), spoken(variant));
                    }
                });
        }
        if chosen != value.variant_name() {
            match variants::build(self.registry, info, &chosen, value) {
                Some(new) => self.push(path, Box::new(new)),
                None => {
                    let chosen = info.variant_path(&chosen);
                    bevy::utils::once!(tracing::warn!("{chosen} cannot be made in the panel"));
                }
            }
            return;
        }
        match value.variant_type() {
            VariantType::Unit => {}
            // The one field of `Some` goes by the name of the option.
            VariantType::Tuple if value.field_len() == 1 => {
                if let Some(field) = value.field_at(0) {
                    self.value(ui, name, field, &format!("{path}.0"));
                }
            }
            VariantType::Tuple | VariantType::Struct => {
                self.fields(ui, value.as_partial_reflect(), path);
            }
        }
    }

    fn set(&mut self, path: &str, value: impl PartialReflect) {
        self.push(path, Box::new(value));
    }

    fn push(&mut self, path: &str, value: Box<dyn PartialReflect>) {
        self.edits
            .push(self.entity, self.component, path.into(), value);
    }
}

/// The direct parts of a value: name, step of a reflection path, value.
fn parts(value: &dyn PartialReflect) -> Vec<(String, String, &dyn PartialReflect)> {
    match value.reflect_ref() {
        ReflectRef::Struct(value) => (0..value.field_len())
            .filter_map(|i| {
                let name = value.name_at(i)?;
                Some((name.into(), format!(".{name}"), value.field_at(i)?))
            })
            .collect(),
        ReflectRef::TupleStruct(value) => (0..value.field_len())
            .filter_map(|i| Some((i.to_string(), format!(".{i}"), value.field(i)?)))
            .collect(),
        ReflectRef::Enum(value) => (0..value.field_len())
            .filter_map(|i| {
                let name = value.name_at(i).map_or(i.to_string(), Into::into);
                Some((name.clone(), format!(".{name}"), value.field_at(i)?))
            })
            .collect(),
        ReflectRef::List(value) => value
            .iter()
            .enumerate()
            .map(|(i, item)| (i.to_string(), format!("[{i}]"), item))
            .collect(),
        _ => Vec::new(),
    }
}

/// `max_slope` and `AlongGround` as a person would write them.
fn spoken(name: &str) -> String {
    let mut text = String::with_capacity(name.len() + 4);
    for letter in name.chars() {
        if letter == '_' {
            text.push(' ');
        } else if letter.is_uppercase() {
            if !text.is_empty() {
                text.push(' ');
            }
            text.extend(letter.to_lowercase());
        } else {
            text.push(letter);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::{Character, CharacterMotor};
    use bevy::reflect::GetPath;

    /// Draws a form without a screen, and returns nothing: what counts is that it does not panic
    /// and queues nothing by itself.
    fn draw(edits: &mut TuningEdits, character: &Character, motor: &CharacterMotor) {
        let mut registry = TypeRegistry::new();
        registry.register::<Character>();
        registry.register::<CharacterMotor>();
        let context = egui::Context::default();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| {
            let mut form = Form::new(&registry, edits, Entity::PLACEHOLDER, |_| "");
            form.component(ui, character);
            form.component(ui, motor);
        });
        output.textures_delta.clear();
    }

    #[test]
    fn looking_at_a_character_changes_nothing_of_it() {
        let mut edits = TuningEdits::default();
        draw(
            &mut edits,
            &Character::default(),
            &CharacterMotor::default(),
        );
        let odd = CharacterMotor {
            acceleration: f32::INFINITY,
            walk_speed: f32::NAN,
            gravity_scale: -1.0,
            jump_height: -1.0,
            ..default()
        };
        draw(&mut edits, &Character::cuboid(1.0, 2.0, 1.0), &odd);
        assert!(edits.is_empty(), "{edits:?}");
    }

    #[test]
    fn every_part_is_found_again_by_its_path() {
        fn check(
            root: &dyn PartialReflect,
            value: &dyn PartialReflect,
            path: &str,
            seen: &mut usize,
        ) {
            for (_, step, field) in parts(value) {
                let path = format!("{path}{step}");
                let found = bevy::reflect::ParsedPath::parse(&path)
                    .unwrap()
                    .reflect_element_of(root);
                assert_eq!(found.reflect_partial_eq(field), Some(true), "{path}");
                *seen += 1;
                check(root, field, &path, seen);
            }
        }
        trait ElementOf {
            fn reflect_element_of<'r>(
                &self,
                root: &'r dyn PartialReflect,
            ) -> &'r dyn PartialReflect;
        }
        impl ElementOf for bevy::reflect::ParsedPath {
            fn reflect_element_of<'r>(
                &self,
                root: &'r dyn PartialReflect,
            ) -> &'r dyn PartialReflect {
                use bevy::reflect::ReflectPath;
                self.reflect_element(root).unwrap()
            }
        }
        let mut seen = 0;
        let character = Character::default();
        check(&character, &character, "", &mut seen);
        assert!(seen > 15, "{seen} parts");
        assert!(character.reflect_path(".step.0.height").is_ok());
    }

    #[test]
    fn names_are_written_as_words() {
        assert_eq!(spoken("max_slope"), "max slope");
        assert_eq!(spoken("AlongGround"), "along ground");
    }
}
