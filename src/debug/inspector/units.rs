//! Units of fields by the words in their names, which the whole crate keeps to.

/// The unit that a field of this name has, with a leading space; empty if none is known.
pub(super) fn unit(name: &str) -> &'static str {
    let last = name.rsplit('_').next().unwrap_or(name);
    match last {
        "speed" => " m/s",
        "height" | "radius" | "width" | "snap" => " m",
        "acceleration" | "friction" | "gravity" => " m/s²",
        "time" | "buffer" | "smoothing" => " s",
        "mass" => " kg",
        "strength" => " N",
        "rate" => " rad/s",
        _ => "",
    }
}

/// As [`unit`], for the fields of vehicles and wheels.
#[cfg(feature = "vehicle")]
pub(super) fn vehicle_unit(name: &str) -> &'static str {
    match name.rsplit('_').next().unwrap_or(name) {
        "speed" => " m/s",
        "radius" | "width" | "travel" | "length" => " m",
        "torque" | "recuperation" => " N m",
        "preload" | "load" | "force" => " N",
        "mass" => " kg",
        "inertia" => " kg m²",
        "time" => " s",
        "rate" => " rad/s",
        "rpm" | "idle" | "redline" | "up" | "down" => " rpm",
        "power" => " W",
        "area" => " m²",
        "frequency" => " Hz",
        _ => "",
    }
}

/// As [`unit`], for the fields of ragdolls and bones.
#[cfg(feature = "ragdoll")]
pub(super) fn ragdoll_unit(name: &str) -> &'static str {
    match name.rsplit('_').next().unwrap_or(name) {
        "speed" => " m/s",
        "spin" => " rad/s",
        "mass" => " kg",
        "frequency" => " Hz",
        "fade" | "time" | "after" | "in" | "out" => " s",
        "radius" => " m",
        "impulse" => " N s",
        _ if name.ends_with("max_torque") || name == "friction" => " N m",
        _ => "",
    }
}

/// Whether a field of this name is an angle in radians, better shown in degrees.
pub(super) fn is_angle(name: &str) -> bool {
    matches!(
        name.rsplit('_').next(),
        Some("slope" | "angle" | "camber" | "toe" | "offset" | "lean")
    )
}

/// Whether a field of this name may be negative.
pub(super) fn may_be_negative(name: &str) -> bool {
    name.ends_with("scale")
        || name.len() == 1
        || matches!(name, "ackermann" | "camber" | "toe" | "offset")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::character::{Character, CharacterMotor, StepConfig};
    use bevy::reflect::{TypeInfo, Typed};

    #[test]
    fn every_number_of_a_character_has_a_unit_or_is_known_to_have_none() {
        for info in [
            Character::type_info(),
            CharacterMotor::type_info(),
            StepConfig::type_info(),
        ] {
            let TypeInfo::Struct(info) = info else {
                panic!("a config is a struct")
            };
            for field in info.iter().filter(|field| field.is::<f32>()) {
                let name = field.name();
                assert!(
                    !unit(name).is_empty() || is_angle(name) || name == "gravity_scale",
                    "{name} has no unit"
                );
            }
        }
    }
}
