//! Makes a variant of an enum out of another, so that a change of kind keeps what it can.

use bevy::{
    prelude::*,
    reflect::{
        PartialReflect, Type, TypeRegistry,
        enums::{DynamicEnum, DynamicVariant, Enum, EnumInfo, VariantInfo},
        structs::DynamicStruct,
        tuple::DynamicTuple,
    },
};

/// Builds the variant of this name. Fields of the same name and type are taken over from `old`,
/// others from the type's default or a value that makes sense for a body of about a metre.
pub(super) fn build(
    registry: &TypeRegistry,
    info: &'static EnumInfo,
    name: &str,
    old: &dyn Enum,
) -> Option<DynamicEnum> {
    let variant: DynamicVariant = match info.variant(name)? {
        VariantInfo::Unit(_) => DynamicVariant::Unit,
        VariantInfo::Tuple(variant) => {
            let mut fields = DynamicTuple::default();
            for (i, field) in variant.iter().enumerate() {
                fields.insert_boxed(value(registry, field.ty(), i.to_string().as_str(), old)?);
            }
            fields.into()
        }
        VariantInfo::Struct(variant) => {
            let mut fields = DynamicStruct::default();
            for field in variant.iter() {
                let value = value(registry, field.ty(), field.name(), old)?;
                fields.insert_boxed(field.name(), value);
            }
            fields.into()
        }
    };
    let mut built = DynamicEnum::new_with_index(info.index_of(name)?, name, variant);
    built.set_represented_type(old.get_represented_type_info());
    Some(built)
}

fn value(
    registry: &TypeRegistry,
    ty: &Type,
    name: &str,
    old: &dyn Enum,
) -> Option<Box<dyn PartialReflect>> {
    if let Some(kept) = old.field(name)
        && kept
            .get_represented_type_info()
            .is_some_and(|info| info.ty() == ty)
    {
        return Some(kept.to_dynamic());
    }
    let width = 2.0 * number(old, "radius").unwrap_or(0.3);
    let height = number(old, "height").unwrap_or(1.8);
    if ty.is::<f32>() {
        return Some(Box::new(match name {
            "radius" => 0.3,
            "height" => 1.8,
            // Gravity, a rate, a speed: all sensible near ten.
            _ => 10.0f32,
        }));
    }
    if ty.is::<Vec3>() {
        return Some(Box::new(Vec3::new(width, height, width)));
    }
    if ty.is::<Vec<Vec3>>() {
        return Some(Box::new(prism(width, height)));
    }
    let default = registry.get_type_data::<ReflectDefault>(ty.id())?.default();
    Some(default.into_partial_reflect())
}

fn number(old: &dyn Enum, name: &str) -> Option<f32> {
    old.field(name)?.try_downcast_ref::<f32>().copied()
}

/// The corners of an upright prism on eight sides, its foot at the origin.
fn prism(width: f32, height: f32) -> Vec<Vec3> {
    let half = width * 0.5;
    // tan(22.5°): what an octagon keeps of a square's side.
    let cut = half * (core::f32::consts::SQRT_2 - 1.0);
    [0.0, height]
        .into_iter()
        .flat_map(|y| {
            [(half, cut), (cut, half)]
                .into_iter()
                .flat_map(move |(a, b)| {
                    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)]
                        .map(|(x, z)| Vec3::new(a * x, y, b * z))
                })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::{CharacterShape, StepConfig};
    use bevy::reflect::{FromReflect, Typed};

    fn registry() -> TypeRegistry {
        let mut registry = TypeRegistry::new();
        registry.register::<CharacterShape>();
        registry.register::<Option<StepConfig>>();
        registry.register::<StepConfig>();
        registry
    }

    fn shape(old: &CharacterShape, name: &str) -> CharacterShape {
        let info = CharacterShape::type_info().as_enum().unwrap();
        let built = build(&registry(), info, name, old).unwrap();
        let mut new = old.clone();
        new.try_apply(&built).unwrap();
        assert_eq!(CharacterShape::from_reflect(&built).unwrap(), new);
        new
    }

    #[test]
    fn a_change_of_shape_keeps_its_size() {
        let capsule = CharacterShape::Capsule {
            radius: 0.4,
            height: 2.0,
        };
        for name in ["Cylinder", "Box", "ConvexHull"] {
            let changed = shape(&capsule, name);
            assert!((changed.height() - 2.0).abs() < 1e-6, "{changed:?}");
            assert!(
                changed.radius() > 0.39 && changed.radius() < 0.57,
                "{changed:?}"
            );
        }
    }

    #[test]
    fn an_option_is_filled_with_its_default() {
        let old: Option<StepConfig> = None;
        let info = <Option<StepConfig>>::type_info().as_enum().unwrap();
        let built = build(&registry(), info, "Some", &old).unwrap();
        let mut new = old;
        new.try_apply(&built).unwrap();
        assert_eq!(new, Some(StepConfig::default()));
    }
}
