//! The system that runs the motors, and the choice of mode.

use bevy::{ecs::batching::BatchingStrategy, prelude::*};
use bevy_rapier3d::plugin::context::RapierContextEntityLink;

use super::{
    CharacterMotor, Course, CustomMotor,
    air::{Flight, jump_speed},
    free, ladder, limited,
    walk::walk,
};
use crate::{
    backend::world::PhysicsWorlds,
    character::{
        body::CharacterBody,
        config::{Character, LeaveVelocity},
        intent::{CharacterIntent, Stance},
        output::CharacterSnapshot,
        report::CharacterReport,
        state::{CharacterState, GroundState, MovementMode},
        surface::{CharacterUp, Ladder, UpDirection, WaterVolume},
    },
};

/// Waking-up speed: below this a velocity counts as none, metres per second.
const STILL: f32 = 1.0e-6;

/// Decides every character's velocity for the tick and publishes it to the others.
pub(crate) fn drive_motors(
    time: Res<Time>,
    worlds: PhysicsWorlds,
    poses: Query<&GlobalTransform>,
    volumes: Volumes,
    mut characters: Query<(
        &Character,
        &CharacterMotor,
        &CharacterIntent,
        &CharacterBody,
        &RapierContextEntityLink,
        Option<&CharacterUp>,
        Has<CustomMotor>,
        &mut CharacterState,
        &mut CharacterSnapshot,
        &mut CharacterReport,
    )>,
) {
    let dt = time.delta_secs();
    if !(dt > 0.0) {
        return;
    }
    // Most motors have little to do: a task of a few would cost more than it does.
    let batches = BatchingStrategy::new().min_batch_size(256);
    characters
        .par_iter_mut()
        .batching_strategy(batches)
        .for_each(
            |(
                config,
                motor,
                intent,
                body,
                link,
                up,
                custom,
                mut state,
                mut snapshot,
                mut report,
            )| {
                let Some(view) = worlds.of(link) else { return };
                if body.mover.is_none() || !view.active {
                    return;
                }
                let intent = finite(*intent);
                let at_rest = state.on_ground()
                    && state.velocity == Vec3::ZERO
                    && intent.movement == Vec3::ZERO
                    && !intent.jump
                    && !state.jump_held
                    && state.mode == MovementMode::Walk
                    && state.jump_buffer == 0.0
                    && up.is_none();
                if at_rest {
                    if snapshot.active {
                        snapshot.active = false;
                        snapshot.velocity = Vec3::ZERO;
                    }
                    if report.woken {
                        report.woken = false;
                    }
                    return;
                }
                let state = &mut *state;
                let report = &mut *report;
                report.woken = true;
                report.was = state.ground.state;
                report.left = state.ground.entity;
                report.jumped = false;
                if let Some(up) = up {
                    follow_up(state, up, view.gravity, &poses, dt);
                }
                let course = if custom {
                    let leaves = state.velocity.dot(state.up) > 0.1
                        && state.velocity.dot(state.ground.normal) > 0.1;
                    if state.on_ground() && leaves {
                        leave_ground(config, state);
                    }
                    Course::constant(finite_or_zero(state.velocity))
                } else {
                    let gravity =
                        motor.gravity.unwrap_or(view.gravity.length()) * motor.gravity_scale;
                    let mut run = Run {
                        config,
                        motor,
                        intent: &intent,
                        gravity,
                        dt,
                        state,
                        report,
                    };
                    run.choose_mode(&volumes);
                    run.course(&volumes)
                };
                state.velocity = if course.end.length_squared() > STILL * STILL {
                    course.end
                } else {
                    Vec3::ZERO
                };
                report.mean = course.mean;
                snapshot.active = true;
                snapshot.velocity = course.mean + state.platform_velocity;
            },
        );
}

/// An intent without numbers that are none; the bad ones count as nothing asked.
fn finite(mut intent: CharacterIntent) -> CharacterIntent {
    intent.movement = finite_or_zero(intent.movement);
    intent.facing = intent.facing.filter(|facing| facing.is_finite());
    intent
}

fn finite_or_zero(v: Vec3) -> Vec3 {
    if v.is_finite() { v } else { Vec3::ZERO }
}

/// Turns the character's up towards where it should be.
fn follow_up(
    state: &mut CharacterState,
    up: &CharacterUp,
    gravity: Vec3,
    poses: &Query<&GlobalTransform>,
    dt: f32,
) {
    let wanted = match up.direction {
        UpDirection::World(direction) => direction,
        UpDirection::AwayFrom(center) => state.last_position - center,
        UpDirection::AgainstGravity => -gravity,
        UpDirection::Of(entity, direction) => poses
            .get(entity)
            .map_or(Vec3::ZERO, |pose| pose.rotation() * direction),
        UpDirection::Ground => {
            if state.on_ground() {
                state.ground.normal
            } else {
                state.up
            }
        }
    };
    let Some(wanted) = wanted.try_normalize().filter(|up| up.is_finite()) else {
        return;
    };
    let angle = state.up.angle_between(wanted);
    if !(angle > 1.0e-6) {
        return;
    }
    let most = up.turn_rate.max(0.0) * dt;
    let turn = if most >= angle {
        Quat::from_rotation_arc(state.up, wanted)
    } else {
        // Opposite directions have no axis of their own: any level one will do.
        let axis = state
            .up
            .cross(wanted)
            .try_normalize()
            .unwrap_or_else(|| state.up.any_orthonormal_vector());
        Quat::from_axis_angle(axis, most)
    };
    state.up = (turn * state.up).normalize();
}

/// The ground's motion becomes the character's own, as far as the config says.
pub(crate) fn leave_ground(config: &Character, state: &mut CharacterState) {
    let platform = state.platform_velocity;
    state.velocity += match config.leave_velocity {
        LeaveVelocity::None => Vec3::ZERO,
        LeaveVelocity::Full => platform,
        LeaveVelocity::UpOnly => state.up * platform.dot(state.up).max(0.0),
    };
    state.platform_velocity = Vec3::ZERO;
    state.ground.state = GroundState::InAir;
    state.anchor = None;
}

/// One motor in one tick.
struct Run<'a> {
    config: &'a Character,
    motor: &'a CharacterMotor,
    intent: &'a CharacterIntent,
    gravity: f32,
    dt: f32,
    state: &'a mut CharacterState,
    report: &'a mut CharacterReport,
}

type Volumes<'w, 's> = Query<
    'w,
    's,
    (
        Option<&'static WaterVolume>,
        Option<&'static Ladder>,
        &'static GlobalTransform,
    ),
>;

impl Run<'_> {
    /// Enters and leaves water and ladders.
    fn choose_mode(&mut self, volumes: &Volumes) {
        if self.state.mode == MovementMode::Fly {
            return;
        }
        let volume = self
            .state
            .volume
            .and_then(|entity| volumes.get(entity).ok());
        let mode = match volume {
            Some((Some(_), _, _)) => MovementMode::Swim,
            Some((_, Some(_), pose)) => {
                let out = pose.rotation() * Vec3::Z;
                let climbing = self.state.mode == MovementMode::Climb;
                let steps_off = self.state.on_ground() && self.intent.movement.dot(out) > 0.1;
                if (climbing && !steps_off) || ladder::begins(self.intent.movement, out) {
                    MovementMode::Climb
                } else {
                    MovementMode::Walk
                }
            }
            _ => MovementMode::Walk,
        };
        if mode != self.state.mode {
            let leaps = self.state.mode == MovementMode::Swim && self.intent.jump;
            self.state.mode = mode;
            if leaps && mode == MovementMode::Walk {
                // Out of the water onto a bank.
                let speed = jump_speed(self.motor.jump_height * 0.5, self.gravity);
                let climb = self.state.velocity.dot(self.state.up);
                self.state.velocity += self.state.up * (speed - climb).max(0.0);
            }
            if mode != MovementMode::Walk && self.state.on_ground() && mode == MovementMode::Swim {
                leave_ground(self.config, self.state);
            }
        }
    }

    fn course(&mut self, volumes: &Volumes) -> Course {
        let pressed = self.intent.jump && !self.state.jump_held;
        self.state.jump_held = self.intent.jump;
        self.state.jump_buffer = if pressed {
            self.motor.jump_buffer.max(self.dt)
        } else {
            (self.state.jump_buffer - self.dt).max(0.0)
        };
        self.state.coyote_time = if self.state.on_ground() {
            self.motor.coyote_time
        } else {
            (self.state.coyote_time - self.dt).max(0.0)
        };
        let movement = limited(self.intent.movement);
        let volume = self
            .state
            .volume
            .and_then(|entity| volumes.get(entity).ok());
        match self.state.mode {
            MovementMode::Walk => self.on_foot(),
            MovementMode::Fly => {
                if self.state.on_ground() {
                    leave_ground(self.config, self.state);
                }
                let wish = movement * self.motor.fly_speed;
                let rate = self.motor.fly_acceleration;
                free::drift(self.state.velocity, wish, Vec3::ZERO, rate, self.dt)
            }
            MovementMode::Swim => {
                let flow = volume
                    .and_then(|(water, ..)| water.map(|water| water.flow))
                    .filter(|flow| flow.is_finite())
                    .unwrap_or(Vec3::ZERO);
                let up = if self.intent.jump {
                    self.state.up
                } else {
                    Vec3::ZERO
                };
                let wish = limited(movement + up) * self.motor.swim_speed;
                let rate = self.motor.swim_acceleration;
                free::drift(self.state.velocity, wish, flow, rate, self.dt)
            }
            MovementMode::Climb => {
                let Some((_, _, pose)) = volume else {
                    return self.on_foot();
                };
                let out = pose.rotation() * Vec3::Z;
                if self.state.jump_buffer > 0.0 {
                    self.state.jump_buffer = 0.0;
                    self.state.mode = MovementMode::Walk;
                    self.state.volume = None;
                    self.state.velocity = (out + self.state.up) * self.motor.climb_speed;
                    leave_ground(self.config, self.state);
                    return self.in_air(Vec3::ZERO);
                }
                let rungs = pose.rotation() * Vec3::Y;
                let course =
                    ladder::climb(movement, rungs, out, self.state.up, self.motor.climb_speed);
                if self.state.on_ground() && course.end.dot(self.state.up) > 0.0 {
                    leave_ground(self.config, self.state);
                }
                course
            }
        }
    }

    fn on_foot(&mut self) -> Course {
        let up = self.state.up;
        let movement = self.intent.movement;
        let speed = if self.state.stance != Stance::Stand {
            self.motor.crouch_speed
        } else if self.intent.sprint {
            self.motor.sprint_speed
        } else {
            self.motor.walk_speed
        };
        let wish = limited(movement - up * movement.dot(up)) * speed;
        let may_jump = self.state.on_ground() || self.state.coyote_time > 0.0;
        if self.state.jump_buffer > 0.0 && may_jump {
            self.state.jump_buffer = 0.0;
            self.state.coyote_time = 0.0;
            self.state.jumping = true;
            self.report.jumped = true;
            let climb = self.state.velocity.dot(up);
            let take_off = jump_speed(self.motor.jump_height, self.gravity);
            self.state.velocity += up * (take_off - climb);
            if self.state.on_ground() {
                leave_ground(self.config, self.state);
            }
            return self.in_air(wish);
        }
        if !self.state.on_ground() {
            return self.in_air(wish);
        }
        self.state.jumping = false;
        let grip = self.state.ground.material.grip.max(0.0);
        let rate = if wish == Vec3::ZERO {
            self.motor.friction
        } else {
            self.motor.acceleration
        };
        // Infinite rate on ice: ice wins.
        let rate = if grip > 0.0 { rate * grip } else { 0.0 };
        walk(
            self.state.velocity,
            wish,
            self.state.ground.normal,
            up,
            self.config.slope_speed,
            rate,
            self.dt,
        )
    }

    fn in_air(&mut self, mut wish: Vec3) -> Course {
        if self.state.ground.state == GroundState::Steep {
            // Nobody runs up what is too steep to stand on.
            let normal = self.state.ground.normal;
            let out = normal - self.state.up * normal.dot(self.state.up);
            if let Some(out) = out.try_normalize() {
                wish -= out * wish.dot(out).min(0.0);
            }
        }
        Flight {
            up: self.state.up,
            gravity: self.gravity,
            wish,
            rate: self.motor.air_acceleration,
            max_fall: self.motor.max_fall_speed,
            dt: self.dt,
        }
        .fly(self.state.velocity)
    }
}
