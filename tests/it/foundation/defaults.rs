//! Default values are a promise; a slip of a finger in one shows here.

use bevy_embody::prelude::*;

#[test]
fn the_default_character_is_as_documented() {
    insta::assert_debug_snapshot!(Character::default(), @r"
    Character {
        shape: Capsule {
            radius: 0.3,
            height: 1.8,
        },
        crouch_height: 1.0,
        max_slope: 0.87266463,
        slope_speed: AlongGround,
        step: Some(
            StepConfig {
                height: 0.4,
                min_width: 0.1,
                onto_dynamic: false,
            },
        ),
        ground_snap: 0.4,
        recovery_speed: 3.0,
        mass: 70.0,
        push_strength: 500.0,
        pushed_by_bodies: true,
        leave_velocity: Full,
        turn_with_platform: true,
        weighs_on_ground: true,
        step_smoothing: 0.08,
    }
    ");
}

#[test]
fn the_default_motor_is_as_documented() {
    insta::assert_debug_snapshot!(CharacterMotor::default(), @r"
    CharacterMotor {
        walk_speed: 5.0,
        sprint_speed: 8.0,
        crouch_speed: 2.5,
        acceleration: 50.0,
        friction: 40.0,
        air_acceleration: 12.0,
        jump_height: 1.2,
        coyote_time: 0.1,
        jump_buffer: 0.12,
        gravity_scale: 1.0,
        gravity: None,
        max_fall_speed: 100.0,
        fly_speed: 8.0,
        fly_acceleration: 40.0,
        swim_speed: 3.0,
        swim_acceleration: 12.0,
        climb_speed: 2.5,
        turn_rate: None,
    }
    ");
}

#[test]
fn the_default_intent_asks_for_nothing() {
    insta::assert_debug_snapshot!(CharacterIntent::default(), @r"
    CharacterIntent {
        movement: Vec3(
            0.0,
            0.0,
            0.0,
        ),
        jump: false,
        sprint: false,
        stance: Stand,
        facing: None,
    }
    ");
}
