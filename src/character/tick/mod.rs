//! One character's tick, from the pose it starts with to the pose it is sent to.

mod gather;
mod outcome;
mod surroundings;

use bevy::{math::ops, prelude::*};

use super::{
    body::{self, CharacterBody},
    config::Character,
    intent::{CharacterIntent, Stance},
    motor::CharacterMotor,
    output::{CharacterContacts, StanceRefusal},
    platform::{self, Carry},
    report::{CharacterMemory, CharacterReport, Happened},
    solver::{Bend, Growth, Scratch, Solver},
    state::{CharacterState, GroundState, MovementMode},
};
use crate::backend::{
    handles::RapierRigidBodyHandle,
    motion::WorldPose,
    neighbourhood::{MoverMemory, MoverPose},
};

use outcome::support_velocity;
pub(super) use surroundings::{Surroundings, Volume};

/// Faster than this nothing is moved, metres per second.
pub(in crate::character) const FASTEST: f32 = 1.0e4;
/// A turn of less than this is none, radians.
const STILL_TURN: f32 = 1.0e-5;
/// Deeper than this inside something that closes in is being crushed, metres.
const CRUSH: f32 = 2.0e-3;

/// A character that has something to do this tick.
pub(super) struct Tick<'a, 'b, 'w, 's> {
    around: &'a Surroundings<'a, 'w, 's>,
    config: &'a Character,
    motor: &'a CharacterMotor,
    intent: &'a CharacterIntent,
    body: &'a mut Mut<'b, CharacterBody>,
    state: &'a mut CharacterState,
    contacts: &'a mut CharacterContacts,
    report: &'a mut CharacterReport,
    memory: &'a mut MoverMemory,
    start: WorldPose,
    carry: Carry,
    /// How far something that moves could push it aside in the tick, metres.
    push: f32,
}

impl<'a, 'b, 'w, 's> Tick<'a, 'b, 'w, 's> {
    /// Looks whether there is anything to do at all. A character at rest on ground at rest, with
    /// nothing moving near, ends here.
    pub fn begin(
        around: &'a Surroundings<'a, 'w, 's>,
        config: &'a Character,
        motor: &'a CharacterMotor,
        intent: &'a CharacterIntent,
        handle: &RapierRigidBodyHandle,
        body: &'a mut Mut<'b, CharacterBody>,
        state: &'a mut Mut<'b, CharacterState>,
        contacts: &'a mut Mut<'b, CharacterContacts>,
        report: &'a mut Mut<'b, CharacterReport>,
        memory: &'a mut Mut<'b, CharacterMemory>,
    ) -> Option<Self> {
        let (now, mut asked) = around.view.body_pose(handle)?;
        let mover = body.mover.as_ref()?;
        // Rounding on the way through the physics world and the transform is no placement: then
        // the state knows better. A turn by the game is none either: it takes nobody off the
        // ground.
        let length = asked.rotation.length();
        let sound = asked.position.is_finite() && length > 1.0e-3 && length.is_finite();
        if sound && !asked.rotation.is_normalized() {
            // As below a parent that is stretched.
            asked.rotation = asked.rotation.normalize();
        }
        let kept = state.last_pose.map(|pose| WorldPose {
            position: pose.position,
            rotation: pose.rotation,
        });
        let (start, placed, turned) = match kept {
            Some(kept) if !sound => (kept, false, true),
            Some(kept) => {
                let placed = !(same_place(asked, kept) && same_place(now, kept));
                let turned = !same_turn(asked, kept);
                let start = WorldPose {
                    position: if placed { asked } else { kept }.position,
                    rotation: if placed || turned { asked } else { kept }.rotation,
                };
                (start, placed, turned)
            }
            None if sound => (asked, true, false),
            None => return None,
        };
        let wanted = body::wanted_height(config, intent.stance);
        let reach = Vec3::splat(mover.reach + 0.1);
        let middle = start.position + state.up * mover.middle;
        let carry = match state.anchor {
            Some(anchor) if state.on_ground() && !placed => platform::carry(
                around.view.carrier(anchor.entity, around.dt),
                &anchor,
                around.surface_velocity(anchor.entity),
                start.position,
                state,
                config.mass,
                around.dt,
            ),
            _ => Carry::default(),
        };
        let lost = state.on_ground() && !placed && carry.lost;
        let at_rest = !report.woken
            && !placed
            && !turned
            && !lost
            && !carry.moving
            && wanted == Some(state.height)
            && state.platform_velocity == Vec3::ZERO
            && state.view_offset == Vec3::ZERO
            && state.on_ground()
            && !state.crushed
            && !state.overlapping
            && asked_turn(motor, intent, start.rotation, state.up).abs() < STILL_TURN
            && !around.settings_changed
            && !around.activity.near(middle - reach, middle + reach);
        if at_rest {
            if report.solved {
                report.solved = false;
                // What is told is told of the last tick, in which nothing was tried.
                contacts.rest();
            }
            return None;
        }
        let report = &mut **report;
        report.solved = true;
        report.happened = Happened::default();
        report.hits.clear();
        report.placed = placed;
        let state = &mut **state;
        if !report.woken {
            report.was = state.ground.state;
            report.left = state.ground.entity;
            report.jumped = false;
            report.mean = state.velocity;
        }
        Some(Self {
            around,
            config,
            motor,
            intent,
            body,
            state,
            contacts,
            report,
            memory: &mut memory.bypass_change_detection().0,
            start,
            carry,
            push: 0.0,
        })
    }

    /// Solves the tick.
    pub fn run(mut self, scratch: &mut Scratch) {
        self.memory.begin();
        let dt = self.around.dt;
        if self.report.placed {
            self.state.residual = Vec3::ZERO;
            self.state.anchor = None;
        }
        let rotation = self.rotation();
        self.shrink();
        let Some(mover) = self.body.mover.clone() else {
            return;
        };
        let up = self.state.up;
        let pose = MoverPose {
            position: self.state.residual,
            rotation,
            up,
        };
        let own = self.report.mean.clamp_length_max(FASTEST) * dt;
        let displacement = own + self.carry.displacement;
        let grounded = self.state.on_ground();
        let walks = self.state.mode == MovementMode::Walk;
        let wanted = body::wanted_height(self.config, self.intent.stance);
        let growth = wanted.map_or(0.0, |height| (height - self.state.height).max(0.0));

        self.gather(&mut scratch.near, &mover, pose, displacement, growth, false);
        self.push = self.push_ahead(&scratch.near, displacement);
        if self.push > 0.0 {
            self.gather(&mut scratch.near, &mover, pose, displacement, growth, false);
        }
        let steps = grounded && walks && self.config.step.is_some();

        let mut solver = Solver::new(self.config, mover, pose, dt, scratch);
        solver.velocity = self.state.velocity;
        solver.carry = self.carry.displacement;
        solver.grounded = grounded && walks;
        let from = solver.recover(pose.position);
        self.state.overlapping = from != pose.position;
        let mut p = solver.slide(from, displacement, 0.0, walks);
        if !p.is_finite() {
            p = pose.position;
            solver.velocity = Vec3::ZERO;
        }

        // A step, if something was in the way of feet on the ground.
        let mut climbed = None;
        if steps && solver.blockers.iter().any(|b| b.bend != Bend::Ground) {
            let wish = solver.level(own);
            let missing = wish - solver.level(p - from - self.carry.displacement);
            // What was lost, not what was turned aside.
            let lost = missing.dot(wish) > 1.0e-5 * wish.length();
            if lost {
                self.look_wider(&mut solver, displacement, growth);
            }
            if lost && let Some((q, height)) = solver.try_step(p, missing, self.state.velocity) {
                climbed = Some(((q - p).dot(up), height));
                p = q;
            }
        }

        let walking = own.length_squared() > 0.0;
        let mut support = solver.support(p, walking || climbed.is_some());
        let ramp = own.dot(up) + self.carry.displacement.dot(up);
        let mut snapped = 0.0;
        let rising = !grounded && {
            // On the way up a touch is not a landing.
            let relative = solver.velocity - support_velocity(&solver, &support, dt);
            relative.dot(support.normal) > 0.05
        };
        if rising {
            support.state = match support.state {
                GroundState::OnGround => GroundState::Unsupported,
                other => other,
            };
        }
        let stands = match self.state.mode {
            MovementMode::Walk => !self.report.lifted,
            MovementMode::Climb => true,
            MovementMode::Fly | MovementMode::Swim => false,
        };
        if !stands && support.state == GroundState::OnGround {
            support.state = GroundState::Unsupported;
        }
        if climbed.is_some() {
            if support.state != GroundState::OnGround {
                // On the rim of a step, or beside something else: the step carries, and it is level.
                support.state = GroundState::OnGround;
                support.normal = up;
            }
        } else if walks
            && support.distance > 2.0e-4
            && (grounded || support.state == GroundState::OnGround)
            && let Some((q, found)) = solver.snap(p, walking)
        {
            snapped = (p - q).dot(up);
            p = q;
            support = found;
        }

        if let Some(height) = wanted
            && growth > 0.0
        {
            match solver.room_to_grow(p, self.state.height, growth) {
                Growth::Free => self.resize(height),
                Growth::Blocked { obstacle, room } => {
                    let by = solver.near.obstacles[obstacle as usize].entity;
                    self.contacts.stance_refused = Some(StanceRefusal::Blocked { by, room });
                }
            }
        } else {
            self.contacts.stance_refused = match wanted {
                Some(_) => None,
                None => Some(StanceRefusal::BadHeight(match self.intent.stance {
                    Stance::Height(height) => height,
                    _ => self.config.crouch_height,
                })),
            };
        }

        self.note_crush(&mut solver, p);
        self.finish(&mut solver, p, rotation, support, climbed, snapped, ramp);
    }

    /// Rotation at the end of the tick: upright, turned with the platform, facing as asked.
    fn rotation(&mut self) -> Quat {
        let up = self.state.up;
        let mut rotation = self.start.rotation;
        if self.carry.turn != 0.0 && self.config.turn_with_platform {
            rotation = Quat::from_axis_angle(up, self.carry.turn) * rotation;
        }
        if let Some(rate) = self.motor.turn_rate {
            let angle = asked_turn(self.motor, self.intent, rotation, up);
            let most = rate * self.around.dt;
            if angle != 0.0 {
                rotation = Quat::from_axis_angle(up, angle.clamp(-most, most)) * rotation;
            }
        }
        let own_up = rotation * Vec3::Y;
        if own_up.dot(up) < 1.0 - 1.0e-7 {
            rotation = Quat::from_rotation_arc(own_up, up) * rotation;
        }
        rotation.normalize()
    }

    /// Takes up a lower height at once: shrinking needs no room.
    fn shrink(&mut self) {
        if let Some(height) = body::wanted_height(self.config, self.intent.stance)
            && height < self.state.height
        {
            self.resize(height);
        }
    }

    fn resize(&mut self, height: f32) {
        if let Some(mover) = body::mover(&self.config.shape, height) {
            self.body.mover = Some(mover);
            self.body.height = height;
            self.report.happened.stance = Some((self.intent.stance, self.state.height, height));
            self.state.height = height;
            self.state.stance = self.intent.stance;
        }
    }

    /// Finds out whether the character is caught between things that close.
    fn note_crush(&mut self, solver: &mut Solver, p: Vec3) {
        let crushed = solver.pinned.then(|| solver.crusher(p, CRUSH)).flatten();
        if let Some((by, against, depth)) = crushed
            && !self.state.crushed
        {
            let entity = |i: u32| solver.near.obstacles[i as usize].entity;
            self.report.happened.crushed = Some((entity(by), against.map(entity), depth));
        }
        self.state.crushed = crushed.is_some();
    }
}

/// Turn about up from where it faces to where it is asked to face, radians.
fn asked_turn(motor: &CharacterMotor, intent: &CharacterIntent, rotation: Quat, up: Vec3) -> f32 {
    if motor.turn_rate.is_none() {
        return 0.0;
    }
    let facing = intent.facing.unwrap_or(intent.movement);
    let level = facing - up * facing.dot(up);
    let Some(level) = level.try_normalize() else {
        return 0.0;
    };
    let ahead = rotation * Vec3::NEG_Z;
    let ahead = (ahead - up * ahead.dot(up)).normalize_or(level);
    ops::atan2(ahead.cross(level).dot(up), ahead.dot(level))
}

/// Whether two poses are at one place, up to rounding.
fn same_place(a: WorldPose, b: WorldPose) -> bool {
    let near = 1.0e-5 + 1.0e-6 * b.position.abs().max_element();
    // Written so that what is not a number is far.
    a.position.distance(b.position) <= near
}

/// Whether two poses are turned alike, up to rounding. By the difference of the quaternions, half
/// the angle: their product cannot tell less than a tenth of a degree.
fn same_turn(a: WorldPose, b: WorldPose) -> bool {
    let flip = if a.rotation.dot(b.rotation) < 0.0 {
        -b.rotation
    } else {
        b.rotation
    };
    (a.rotation - flip).length_squared() <= 1.0e-12
}
