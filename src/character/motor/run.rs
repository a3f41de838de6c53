//! The system that runs the motors, and the choice of mode.

use bevy::{ecs::batching::BatchingStrategy, math::ops, prelude::*};
use bevy_rapier3d::prelude::RigidBodyDisabled;

use super::{
    CharacterMotor, Course, CustomMotor,
    air::{Flight, jump_speed},
    free, ladder, limited,
    walk::walk,
};
use crate::{
    backend::{
        handles::RapierContextEntityLink,
        world::{PhysicsView, PhysicsWorlds},
    },
    character::{
        body::{self, CharacterBody},
        config::{Character, LeaveVelocity},
        intent::{CharacterIntent, Stance},
        output::CharacterSnapshot,
        report::CharacterReport,
        state::{CharacterState, GroundState, MovementMode},
        surface::{CharacterUp, UpDirection},
        tick::{FASTEST, Volume},
    },
};

/// Waking-up speed: below this a velocity counts as none, metres per second.
const STILL: f32 = 1.0e-6;
/// Ups closer than this are the same, radians.
const SAME_UP: f32 = 1.0e-6;

/// Decides every character's velocity for the tick and publishes it to the others.
pub(crate) fn drive_motors(
    time: Res<Time>,
    worlds: PhysicsWorlds,
    poses: Query<&GlobalTransform>,
    volumes: Query<Volume>,
    mut characters: Query<(
        Entity,
        &Character,
        &CharacterMotor,
        &CharacterIntent,
        &CharacterBody,
        &RapierContextEntityLink,
        Option<&CharacterUp>,
        (Has<CustomMotor>, Has<RigidBodyDisabled>),
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
                entity,
                config,
                motor,
                intent,
                body,
                link,
                up,
                (custom, disabled),
                mut state,
                mut snapshot,
                mut report,
            )| {
                let Some(view) = worlds.of(link) else { return };
                if body.mover.is_none() || disabled || !view.active {
                    // Out of the game: nobody waits for it, and nothing happens to it.
                    if snapshot.active {
                        snapshot.active = false;
                        snapshot.velocity = Vec3::ZERO;
                    }
                    if report.solved || report.woken {
                        report.solved = false;
                        report.woken = false;
                    }
                    return;
                }
                let wanted = up.and_then(|up| wanted_up(entity, &state, up, view.gravity, &poses));
                let intent = finite(*intent);
                let at_rest = state.on_ground()
                    && (custom || motor.downward(view.gravity) >= 0.0)
                    && state.velocity == Vec3::ZERO
                    && intent.movement == Vec3::ZERO
                    && !intent.jump
                    && !state.jump_held
                    && state.mode == MovementMode::Walk
                    && state.jump_buffer == 0.0
                    && state.water.is_none()
                    && wanted.is_none_or(|wanted| angle_between(state.up, wanted) <= SAME_UP);
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
                report.lifted = false;
                if let (Some(up), Some(wanted)) = (up, wanted) {
                    // Nobody has to turn to the up that it begins with.
                    let first = state.last_pose.is_none();
                    let most = if first {
                        f32::INFINITY
                    } else {
                        up.turn_rate.max(0.0) * dt
                    };
                    follow_up(state, wanted, most);
                }
                let course = if custom {
                    let leaves = state.velocity.dot(state.up) > 0.1
                        && state.velocity.dot(state.ground.normal) > 0.1;
                    if state.on_ground() && leaves {
                        leave_ground(config, state);
                    }
                    Course::constant(finite_or_zero(state.velocity))
                } else {
                    let gravity = motor.downward(view.gravity);
                    report.lifted = gravity < 0.0;
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
                    run.course(&volumes, &view)
                };
                state.velocity = if course.end.length_squared() > STILL * STILL {
                    course.end
                } else {
                    Vec3::ZERO
                };
                report.mean = course.mean;
                snapshot.active = true;
                snapshot.velocity =
                    (course.mean + state.platform_velocity).clamp_length_max(FASTEST);
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

/// Where up should be, unit length; `None` where the rule tells nothing.
fn wanted_up(
    character: Entity,
    state: &CharacterState,
    up: &CharacterUp,
    gravity: Vec3,
    poses: &Query<&GlobalTransform>,
) -> Option<Vec3> {
    let pose = || poses.get(character).ok();
    let wanted = match up.direction {
        UpDirection::World(direction) => direction,
        UpDirection::AwayFrom(center) => match state.last_pose {
            Some(pose) => pose.position - center,
            None => pose()?.translation() - center,
        },
        UpDirection::AgainstGravity => -gravity,
        UpDirection::Of(entity, direction) => poses
            .get(entity)
            .map_or(Vec3::ZERO, |pose| pose.rotation() * direction),
        UpDirection::Ground => {
            if state.on_ground() {
                state.ground.normal
            } else if state.last_pose.is_some() {
                state.up
            } else {
                Vec3::ZERO
            }
        }
    };
    let unit = |v: Vec3| v.try_normalize().filter(|up| up.is_finite());
    unit(wanted).or_else(|| {
        // Without a rule a character begins upright in its own axes.
        let first = state.last_pose.is_none();
        first.then(|| unit(pose()?.rotation() * Vec3::Y)).flatten()
    })
}

/// Angle between two unit vectors, radians; exact also where it is small.
fn angle_between(a: Vec3, b: Vec3) -> f32 {
    ops::atan2(a.cross(b).length(), a.dot(b))
}

/// Turns the character's up towards where it should be, by at most this angle, radians.
fn follow_up(state: &mut CharacterState, wanted: Vec3, most: f32) {
    let angle = angle_between(state.up, wanted);
    if !(angle > SAME_UP) {
        return;
    }
    if most >= angle {
        // Not by an arc, which is none below a thousandth of a radian.
        state.up = wanted;
        return;
    }
    // Opposite directions have no axis of their own: any level one will do.
    let axis = state
        .up
        .cross(wanted)
        .try_normalize()
        .unwrap_or_else(|| state.up.any_orthonormal_vector());
    let turn = Quat::from_axis_angle(axis, most);
    state.up = (turn * state.up).normalize();
}

/// The ground's motion becomes the character's own, as far as the config says.
pub(crate) fn leave_ground(config: &Character, state: &mut CharacterState) {
    state.velocity += kept_velocity(config, state.up, state.platform_velocity);
    state.platform_velocity = Vec3::ZERO;
    state.ground.state = GroundState::InAir;
    state.anchor = None;
}

/// What of a platform's velocity is kept by who leaves it.
pub(crate) fn kept_velocity(config: &Character, up: Vec3, platform: Vec3) -> Vec3 {
    match config.leave_velocity {
        LeaveVelocity::None => Vec3::ZERO,
        LeaveVelocity::Full => platform,
        LeaveVelocity::UpOnly => up * platform.dot(up).max(0.0),
    }
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

impl Run<'_> {
    /// Enters and leaves water and ladders. A ladder that is climbed, or moved towards, comes
    /// before water.
    fn choose_mode(&mut self, volumes: &Query<Volume>) {
        if self.state.mode == MovementMode::Fly {
            self.state.volume_mode = None;
            return;
        }
        let climbs = self.ladder(volumes).is_some_and(|pose| {
            let out = pose.rotation() * Vec3::Z;
            let climbing = self.state.mode == MovementMode::Climb;
            let steps_off = self.state.on_ground() && self.intent.movement.dot(out) > 0.1;
            (climbing && !steps_off) || ladder::begins(self.intent.movement, out)
        });
        let given = if climbs {
            Some(MovementMode::Climb)
        } else if self.water(volumes).is_some() {
            Some(MovementMode::Swim)
        } else {
            None
        };
        // What the game has set outlasts all but another volume.
        let by_game = self.state.volume_mode != Some(self.state.mode)
            && self.state.mode != MovementMode::Climb;
        let mode = match given {
            Some(mode) => mode,
            None if by_game => self.state.mode,
            None => MovementMode::Walk,
        };
        self.state.volume_mode = given;
        if mode != self.state.mode {
            let was = self.state.mode;
            let leaps = was == MovementMode::Swim && self.intent.jump;
            self.state.mode = mode;
            if leaps && mode == MovementMode::Walk {
                // Towards a bank the feet, which hang as deep as the waist is high, have to clear it.
                let deep = if self.intent.movement.reject_from(self.state.up) == Vec3::ZERO {
                    0.0
                } else {
                    0.5 * self.state.height
                };
                let climb = self.state.velocity.dot(self.state.up);
                // The waist came out somewhere within the last tick: in the mean, half way.
                let risen = 0.5 * climb.max(0.0) * self.dt;
                let height = (self.motor.jump_height * 0.5 + deep - risen).max(0.0);
                let speed = jump_speed(height, self.gravity);
                self.state.velocity += self.state.up * (speed - climb).max(0.0);
            }
            if self.state.volume_mode.is_none() && was == MovementMode::Climb {
                // Over the end of a ladder, onto what it leads to: no hop.
                let climb = self.state.velocity.dot(self.state.up);
                self.state.velocity -= self.state.up * climb.max(0.0);
            }
            if mode != MovementMode::Walk && self.state.on_ground() && mode == MovementMode::Swim {
                leave_ground(self.config, self.state);
            }
        }
    }

    /// Pose of the ladder that it is at.
    fn ladder<'v>(&self, volumes: &'v Query<Volume>) -> Option<&'v GlobalTransform> {
        let (_, ladder, pose) = volumes.get(self.state.ladder?).ok()?;
        ladder.map(|_| pose)
    }

    /// Flow of the water that it is in, metres per second.
    fn water(&self, volumes: &Query<Volume>) -> Option<Vec3> {
        let (water, ..) = volumes.get(self.state.water?).ok()?;
        water.map(|water| finite_or_zero(water.flow))
    }

    fn course(&mut self, volumes: &Query<Volume>, view: &PhysicsView) -> Course {
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
                let flow = self.water(volumes).unwrap_or(Vec3::ZERO);
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
                let (Some(entity), Some(pose)) = (self.state.ladder, self.ladder(volumes)) else {
                    return self.on_foot();
                };
                let (out, rungs) = (pose.rotation() * Vec3::Z, pose.rotation() * Vec3::Y);
                let middle = self.state.last_pose.map_or(pose.translation(), |last| {
                    last.position + self.state.up * (self.state.height * 0.5)
                });
                // The ladder takes its climber along, as ground would.
                let along = view.point_velocity(entity, middle, self.dt);
                if self.state.jump_buffer > 0.0 {
                    self.state.jump_buffer = 0.0;
                    self.state.mode = MovementMode::Walk;
                    self.state.volume_mode = None;
                    self.state.ladder = None;
                    leave_ground(self.config, self.state);
                    self.state.velocity = (out + self.state.up) * self.motor.climb_speed
                        + kept_velocity(self.config, self.state.up, along);
                    return self.in_air(Vec3::ZERO);
                }
                let course =
                    ladder::climb(movement, rungs, out, self.state.up, self.motor.climb_speed);
                if self.state.on_ground() && course.end.dot(self.state.up) > 0.0 {
                    leave_ground(self.config, self.state);
                }
                let along = if self.state.on_ground() {
                    along - self.state.platform_velocity
                } else {
                    along
                };
                Course::constant(course.end + along)
            }
        }
    }

    fn on_foot(&mut self) -> Course {
        let up = self.state.up;
        if self.gravity < 0.0 && self.state.on_ground() {
            leave_ground(self.config, self.state);
        }
        let movement = self.intent.movement;
        let speed = self.speed();
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

    /// Speed on foot: that of standing at the full height, of crouching at the crouched height and
    /// below, in proportion between.
    fn speed(&self) -> f32 {
        let standing = if self.intent.sprint {
            self.motor.sprint_speed
        } else {
            self.motor.walk_speed
        };
        let full = self.config.shape.height();
        let low = body::wanted_height(self.config, Stance::Crouch).unwrap_or(full);
        let (above, range) = (self.state.height - low, full - low);
        if above >= range {
            standing
        } else if above <= 0.0 {
            self.motor.crouch_speed
        } else {
            self.motor.crouch_speed + (standing - self.motor.crouch_speed) * (above / range)
        }
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
