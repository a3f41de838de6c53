//! Which values a character cannot work with.

use super::{
    config::{Character, CharacterShape},
    motor::CharacterMotor,
};
use crate::validate::{Check, Problem};

/// The first value of a config that is out of its range.
pub(super) fn character(config: &Character) -> Option<Problem> {
    let mut check = Check::default();
    match &config.shape {
        CharacterShape::Capsule { radius, height } => {
            check.positive("Character::shape.radius", *radius);
            check.positive("Character::shape.height", *height);
            let tall = *height >= 2.0 * radius * 0.9999;
            check.that(
                tall,
                "Character::shape.height",
                *height,
                "at least two radii",
            );
        }
        CharacterShape::Cylinder { radius, height } => {
            check.positive("Character::shape.radius", *radius);
            check.positive("Character::shape.height", *height);
        }
        CharacterShape::Box { size } => {
            check.positive("Character::shape.size.x", size.x);
            check.positive("Character::shape.size.y", size.y);
            check.positive("Character::shape.size.z", size.z);
        }
        CharacterShape::ConvexHull { points } => {
            for p in points {
                check.finite("Character::shape.points", p.x + p.y + p.z);
            }
            check.positive("Character::shape.points (height)", config.shape.height());
        }
    }
    check.positive("Character::crouch_height", config.crouch_height);
    let slope = config.max_slope;
    let ok = (0.0..=core::f32::consts::FRAC_PI_2 + 1.0e-4).contains(&slope);
    check.that(ok, "Character::max_slope", slope, "0 to π/2");
    if let Some(step) = &config.step {
        check.not_negative("Character::step.height", step.height);
        check.not_negative("Character::step.min_width", step.min_width);
    }
    check.not_negative("Character::ground_snap", config.ground_snap);
    check.limit("Character::recovery_speed", config.recovery_speed);
    check.positive("Character::mass", config.mass);
    check.limit("Character::push_strength", config.push_strength);
    check.not_negative("Character::step_smoothing", config.step_smoothing);
    check.0
}

/// The first value of a motor that is out of its range.
pub(super) fn motor(motor: &CharacterMotor) -> Option<Problem> {
    let mut check = Check::default();
    for (field, value) in [
        ("CharacterMotor::walk_speed", motor.walk_speed),
        ("CharacterMotor::sprint_speed", motor.sprint_speed),
        ("CharacterMotor::crouch_speed", motor.crouch_speed),
        ("CharacterMotor::jump_height", motor.jump_height),
        ("CharacterMotor::coyote_time", motor.coyote_time),
        ("CharacterMotor::jump_buffer", motor.jump_buffer),
        ("CharacterMotor::fly_speed", motor.fly_speed),
        ("CharacterMotor::swim_speed", motor.swim_speed),
        ("CharacterMotor::climb_speed", motor.climb_speed),
    ] {
        check.not_negative(field, value);
    }
    for (field, value) in [
        ("CharacterMotor::acceleration", motor.acceleration),
        ("CharacterMotor::friction", motor.friction),
        ("CharacterMotor::air_acceleration", motor.air_acceleration),
        ("CharacterMotor::fly_acceleration", motor.fly_acceleration),
        ("CharacterMotor::swim_acceleration", motor.swim_acceleration),
        ("CharacterMotor::max_fall_speed", motor.max_fall_speed),
        ("CharacterMotor::turn_rate", motor.turn_rate.unwrap_or(0.0)),
    ] {
        check.limit(field, value);
    }
    check.finite("CharacterMotor::gravity_scale", motor.gravity_scale);
    check.finite("CharacterMotor::gravity", motor.gravity.unwrap_or(0.0));
    check.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_accepted() {
        assert_eq!(character(&Character::default()), None);
        assert_eq!(motor(&CharacterMotor::default()), None);
    }

    #[test]
    fn a_bad_value_is_named() {
        let config = Character {
            mass: f32::NAN,
            ..Default::default()
        };
        assert_eq!(character(&config).map(|p| p.field), Some("Character::mass"));
        assert_eq!(
            character(&Character::capsule(0.5, 0.6)).map(|p| p.field),
            Some("Character::shape.height")
        );
    }
}
