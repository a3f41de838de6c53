//! One character's tick, from the pose it starts with to the pose it is sent to.

use bevy::{math::ops, prelude::*};
use bevy_rapier3d::prelude::{CollisionGroups, RapierRigidBodyHandle};

use super::{
    body::{self, CharacterBody},
    config::Character,
    intent::CharacterIntent,
    motor::{CharacterMotor, along_ground, leave_ground},
    output::{CharacterContact, CharacterContacts, CharacterSnapshot, StanceRefusal},
    platform::{self, Carry},
    report::{BodyImpulse, CharacterReport, Happened, NewHit},
    solver::{Growth, Scratch, Solver, Support},
    state::{Anchor, CharacterState, Ground, GroundMaterial, GroundState, MovementMode},
    surface::{CharacterFilter, CharacterIgnores, NotPushable, SurfaceGrip, SurfaceVelocity},
};
use crate::backend::{
    activity::Activity,
    neighbourhood::{MoverPose, ObstacleKind, Request},
    world::{PhysicsView, Verdict, WorldPose},
};

/// Faster than this nothing is moved, metres per second.
const FASTEST: f32 = 1.0e4;
/// Deeper than this inside something that closes in is being crushed, metres.
const CRUSH: f32 = 2.0e-3;

/// What a character can see of the world.
pub(super) struct Surroundings<'a, 'w, 's> {
    pub entity: Entity,
    pub view: PhysicsView<'a>,
    pub dt: f32,
    pub groups: CollisionGroups,
    pub filter: Option<&'a CharacterFilter>,
    pub ignores: Option<&'a CharacterIgnores>,
    pub activity: &'a Activity,
    pub surfaces: &'a Query<'w, 's, (Option<&'static SurfaceVelocity>, Option<&'static SurfaceGrip>)>,
    pub others: &'a Query<'w, 's, &'static CharacterSnapshot>,
    pub walls: &'a Query<'w, 's, (), With<NotPushable>>,
}

impl Surroundings<'_, '_, '_> {
    fn judge(&self, collider: Entity, body: Entity) -> Verdict {
        if body == self.entity
            || self
                .ignores
                .is_some_and(|i| i.0.contains(&collider) || i.0.contains(&body))
            || self
                .filter
                .is_some_and(|filter| !(filter.0)(self.entity, collider))
        {
            Verdict::Skip
        } else if let Ok(other) = self.others.get(body) {
            Verdict::Character(other.margin)
        } else if self.walls.contains(body) || self.walls.contains(collider) {
            Verdict::Wall
        } else {
            Verdict::AsIs
        }
    }

    fn surface_velocity(&self, entity: Entity) -> SurfaceVelocity {
        self.surfaces
            .get(entity)
            .ok()
            .and_then(|(velocity, _)| velocity.copied())
            .filter(|v| v.linear.is_finite() && v.angular.is_finite())
            .unwrap_or_default()
    }
}

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
    start: WorldPose,
    carry: Carry,
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
    ) -> Option<Self> {
        let (now, asked) = around.view.body_pose(handle)?;
        let mover = body.mover.as_ref()?;
        let placed = asked != now || now.position != state.last_position;
        let start = asked;
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
                around.dt,
            ),
            _ => Carry::default(),
        };
        let lost = state.on_ground() && !placed && carry.lost;
        let at_rest = !report.woken
            && !placed
            && !lost
            && !carry.moving
            && wanted == Some(state.height)
            && state.platform_velocity == Vec3::ZERO
            && state.view_offset == Vec3::ZERO
            && state.on_ground()
            && !state.crushed
            && motor.turn_rate.is_none()
            && !around.activity.near(middle - reach, middle + reach);
        if at_rest {
            if report.solved {
                report.solved = false;
            }
            return None;
        }
        let report = &mut **report;
        report.solved = true;
        report.happened = Happened::default();
        report.hits.clear();
        report.jump = (asked != now).then_some(asked);
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
            start,
            carry,
        })
    }

    /// Solves the tick.
    pub fn run(mut self, scratch: &mut Scratch) {
        let dt = self.around.dt;
        let placed = self.start.position != self.state.last_position;
        if placed {
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

        self.gather(scratch, &mover, pose, displacement, growth, false);
        let steps = grounded && walks && self.config.step.is_some();
        let near = &scratch.near;
        let wall_near = steps
            && near.pieces.iter().any(|piece| {
                piece.normal.dot(up) < 0.95
                    && piece.clearance - near.obstacle(piece).skin < displacement.length() + 0.01
            });
        if wall_near {
            self.gather(scratch, &mover, pose, displacement, growth, true);
        }

        let mut solver = Solver::new(self.config, mover, pose, dt, scratch);
        solver.velocity = self.state.velocity;
        solver.carry = self.carry.displacement;
        solver.grounded = grounded && walks;
        let from = solver.recover(pose.position);
        let recovered = from - pose.position;
        let mut p = solver.slide(from, displacement, 0.0, walks);
        if !p.is_finite() {
            p = pose.position;
            solver.velocity = Vec3::ZERO;
        }

        // A step, if something was in the way of feet on the ground.
        let mut climbed = None;
        if steps && !solver.blockers.is_empty() {
            let wish = solver.level(own);
            let missing = wish - solver.level(p - from - self.carry.displacement);
            // What was lost, not what was turned aside.
            let lost = missing.dot(wish) > 1.0e-5 * wish.length();
            if lost && let Some((q, height)) = solver.try_step(p, missing, self.state.velocity) {
                climbed = Some(((q - p).dot(up), height));
                p = q;
            }
        }

        let walking = own.length_squared() > 0.0;
        let mut support = solver.support(p, walking || climbed.is_some());
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
        if !walks && support.state == GroundState::OnGround && self.state.mode != MovementMode::Climb
        {
            support.state = GroundState::Unsupported;
        }
        if climbed.is_some() {
            support.state = GroundState::OnGround;
        } else if grounded
            && walks
            && (support.state != GroundState::OnGround || support.distance > 2.0e-4)
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
                    super::intent::Stance::Height(height) => height,
                    _ => self.config.crouch_height,
                })),
            };
        }

        self.note_crush(&mut solver, p);
        self.finish(&mut solver, p, rotation, support, climbed, snapped, recovered);
    }

    /// Rotation at the end of the tick: upright, turned with the platform, facing as asked.
    fn rotation(&mut self) -> Quat {
        let up = self.state.up;
        let mut rotation = self.start.rotation;
        if self.carry.turn != 0.0 && self.config.turn_with_platform {
            rotation = Quat::from_axis_angle(up, self.carry.turn) * rotation;
        }
        if let Some(rate) = self.motor.turn_rate {
            let facing = self.intent.facing.unwrap_or(self.intent.movement);
            let level = facing - up * facing.dot(up);
            if let Some(level) = level.try_normalize() {
                let ahead = rotation * Vec3::NEG_Z;
                let ahead = (ahead - up * ahead.dot(up)).normalize_or(level);
                let angle = ops::atan2(ahead.cross(level).dot(up), ahead.dot(level));
                let most = rate * self.around.dt;
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

    fn gather(
        &self,
        scratch: &mut Scratch,
        mover: &crate::backend::neighbourhood::Mover,
        pose: MoverPose,
        displacement: Vec3,
        growth: f32,
        wide: bool,
    ) {
        let up = pose.up;
        let step = self.config.step.map_or(0.0, |step| step.height);
        let min_width = self.config.step.map_or(0.0, |step| step.min_width);
        let below = if self.state.on_ground() { self.config.ground_snap } else { 0.0 };
        let above = growth + if wide { step + 0.05 } else { 0.0 };
        let margin = 0.05 + if wide { mover.width + min_width } else { 0.0 };
        let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
        let foot = pose.position - up * below;
        let head = pose.position + up * (2.0 * mover.middle + above);
        for p in [foot, head, foot + displacement, head + displacement] {
            low = low.min(p);
            high = high.max(p);
        }
        let grow = Vec3::splat(mover.width + margin) * (Vec3::ONE - up.abs() * 0.9)
            + up.abs() * 0.05;
        let request = Request {
            mover,
            pose,
            origin: self.start.position,
            low: low - grow,
            high: high + grow,
            reach: displacement.length() + below.max(above) + margin,
            probe: pose.position + up * mover.middle,
        };
        let around = self.around;
        around.view.gather(
            &request,
            around.groups,
            around.dt,
            |collider, body| around.judge(collider, body),
            &mut scratch.near,
        );
        let near = &mut scratch.near;
        // The order of the search tree depends on what else there is; geometry does not.
        near.pieces.sort_unstable_by(|a, b| {
            a.clearance
                .total_cmp(&b.clearance)
                .then(a.normal.x.total_cmp(&b.normal.x))
                .then(a.normal.y.total_cmp(&b.normal.y))
                .then(a.normal.z.total_cmp(&b.normal.z))
                .then(a.part.cmp(&b.part))
        });
        self.share_gaps(scratch, displacement);
    }

    /// Two characters that close on each other each get their share of the gap between them.
    fn share_gaps(&self, scratch: &mut Scratch, displacement: Vec3) {
        let near = &mut scratch.near;
        for piece in &near.pieces {
            let obstacle = &mut near.obstacles[piece.obstacle as usize];
            if obstacle.kind != ObstacleKind::Character {
                continue;
            }
            let Ok(other) = self.around.others.get(obstacle.body) else {
                continue;
            };
            let mine = (-piece.normal.dot(displacement)).max(0.0);
            let theirs = (piece.normal.dot(other.velocity) * self.around.dt).max(0.0);
            let gap = piece.clearance - obstacle.skin;
            if mine > 0.0 && theirs > 0.0 && gap > 0.0 {
                obstacle.skin += gap * theirs / (mine + theirs);
            }
        }
    }

    /// Finds out whether the character is caught between things that close.
    fn note_crush(&mut self, solver: &mut Solver, p: Vec3) {
        let crushed = solver
            .pinned
            .then(|| solver.crusher(p, CRUSH))
            .flatten();
        if let Some((by, against, depth)) = crushed
            && !self.state.crushed
        {
            let entity = |i: u32| solver.near.obstacles[i as usize].entity;
            self.report.happened.crushed = Some((entity(by), against.map(entity), depth));
        }
        self.state.crushed = crushed.is_some();
    }

    /// Writes the outcome into state, outputs and report.
    fn finish(
        &mut self,
        solver: &mut Solver,
        p: Vec3,
        rotation: Quat,
        support: Support,
        climbed: Option<(f32, f32)>,
        snapped: f32,
        recovered: Vec3,
    ) {
        let dt = self.around.dt;
        let up = self.state.up;
        let origin = self.start.position;
        let before = self.state.velocity;
        let was_on_ground = self.state.on_ground();

        // What single precision cannot hold of the position is kept beside it.
        let exact = origin.as_dvec3() + p.as_dvec3();
        let position = exact.as_vec3();
        self.state.residual = (exact - position.as_dvec3()).as_vec3();
        self.state.last_position = position;
        self.state.last_rotation = rotation;
        self.report.target = Some(WorldPose { position, rotation });

        let mut velocity = solver.velocity;
        if self.carry.turn != 0.0 && was_on_ground && self.config.turn_with_platform {
            velocity = Quat::from_axis_angle(up, self.carry.turn) * velocity;
        }
        let carried = self.carry.displacement / dt;
        let ground = self.ground(solver, &support, origin);
        let on_ground = support.state == GroundState::OnGround;
        self.state.velocity = velocity;
        if on_ground {
            let same = was_on_ground && self.state.ground.entity == ground.entity;
            let platform = if same { carried } else { ground.velocity };
            if !same {
                self.state.velocity += if was_on_ground { carried } else { Vec3::ZERO };
                self.state.velocity -= ground.velocity;
            }
            let level = self.state.velocity - up * self.state.velocity.dot(up);
            let length = if same || was_on_ground {
                self.state.velocity.length().min(before.length().max(level.length()))
            } else {
                level.length()
            };
            // Nearly vertical motion has no heading to keep.
            let level = level.normalize_or_zero()
                * match self.config.slope_speed {
                    super::config::SlopeSpeed::AlongGround if level.length() > 0.05 * length => length,
                    _ => level.length(),
                };
            self.state.velocity = along_ground(level, ground.normal, up, self.config.slope_speed);
            self.state.platform_velocity = platform;
            self.state.anchor = ground.entity.and_then(|entity| {
                let carrier = self.around.view.carrier(entity, dt)?;
                Some(Anchor {
                    entity,
                    position: carrier.end.position,
                    rotation: carrier.end.rotation,
                })
            });
        } else if was_on_ground {
            self.state.platform_velocity = carried;
            leave_ground(self.config, self.state);
        }
        if self.report.was == GroundState::OnGround && !on_ground {
            self.report.happened.left = true;
        }
        if self.report.was != GroundState::OnGround
            && on_ground
            && let Some(entity) = ground.entity
        {
            let speed = (ground.velocity - before).dot(ground.normal).max(0.0);
            self.report.happened.landed = Some((entity, speed, self.state.air_time));
        }
        self.state.air_time = if on_ground { 0.0 } else { self.state.air_time + dt };
        if on_ground {
            self.state.jumping = false;
        }
        self.state.ground = ground;
        self.state.volume = solver.near.volumes.iter().copied().min();

        self.note_step(solver, climbed, snapped, recovered);
        self.weigh(solver, &support, was_on_ground, origin);
        self.note_contacts(solver, origin);
    }

    /// The ground as the state tells it.
    fn ground(&self, solver: &Solver, support: &Support, origin: Vec3) -> Ground {
        let Some(index) = support.obstacle else {
            return Ground {
                state: support.state,
                normal: self.state.up,
                point: origin + support.point,
                ..default()
            };
        };
        let obstacle = &solver.near.obstacles[index as usize];
        let point = origin + support.point;
        let surface = self.around.surface_velocity(obstacle.entity);
        let conveyor = platform::surface_velocity_at(
            &surface,
            self.around.view.carrier(obstacle.entity, self.around.dt).map(|c| c.end),
            point,
        );
        let grip = self
            .around
            .surfaces
            .get(obstacle.entity)
            .ok()
            .and_then(|(_, grip)| grip.map(|grip| grip.0));
        Ground {
            state: support.state,
            entity: Some(obstacle.entity),
            normal: support.normal,
            point,
            velocity: support_velocity(solver, support, self.around.dt) + conveyor,
            material: GroundMaterial {
                friction: obstacle.friction,
                restitution: obstacle.restitution,
                grip: grip.filter(|grip| grip.is_finite()).unwrap_or(1.0),
            },
        }
    }

    fn note_step(
        &mut self,
        solver: &Solver,
        climbed: Option<(f32, f32)>,
        snapped: f32,
        recovered: Vec3,
    ) {
        let up = self.state.up;
        self.contacts.step = solver.step;
        self.contacts.snapped = snapped;
        self.contacts.queries = solver.near.queries;
        let _ = recovered;
        if let Some((_, height)) = climbed
            && !self.state.stepping
        {
            self.report.happened.stepped = Some(height);
        }
        self.state.stepping = climbed.is_some();
        let time = self.config.step_smoothing;
        if time > 0.0 {
            let rise = climbed.map_or(0.0, |(rise, _)| rise) - if snapped > 5.0e-3 { snapped } else { 0.0 };
            let fade = ops::exp(-self.around.dt / time);
            let offset = self.state.view_offset * fade - up * rise;
            self.state.view_offset = if offset.length_squared() > 1.0e-8 { offset } else { Vec3::ZERO };
        } else {
            self.state.view_offset = Vec3::ZERO;
        }
    }

    /// Collects the impulses for bodies: pushes, and the weight on what carries.
    fn weigh(&mut self, solver: &Solver, support: &Support, was_on_ground: bool, origin: Vec3) {
        self.report.impulses.clear();
        for i in solver.impulses.iter() {
            self.report.impulses.push(BodyImpulse {
                body: i.body,
                impulse: i.impulse,
                point: origin + i.point,
                wake: true,
            });
        }
        if !self.config.weighs_on_ground || support.state != GroundState::OnGround {
            return;
        }
        let Some(index) = support.obstacle else { return };
        let obstacle = &solver.near.obstacles[index as usize];
        if obstacle.dynamics.is_none() || obstacle.kind != ObstacleKind::Dynamic {
            return;
        }
        let gravity = self.motor.gravity.unwrap_or(self.around.view.gravity.length())
            * self.motor.gravity_scale;
        self.report.impulses.push(BodyImpulse {
            body: obstacle.body,
            impulse: -self.state.up * (self.config.mass * gravity * self.around.dt),
            point: origin + support.point,
            wake: !was_on_ground || self.report.woken,
        });
    }

    fn note_contacts(&mut self, solver: &mut Solver, origin: Vec3) {
        let contacts = &mut self.contacts.contacts;
        contacts.clear();
        core::mem::swap(&mut self.report.touching, &mut self.report.touched);
        self.report.touching.clear();
        for b in solver.blockers.iter() {
            let obstacle = &solver.near.obstacles[b.obstacle as usize];
            let impulse = solver
                .impulses
                .iter()
                .filter(|i| i.obstacle == b.obstacle)
                .map(|i| i.impulse)
                .sum();
            contacts.push(CharacterContact {
                entity: obstacle.entity,
                point: origin + b.point,
                normal: b.normal,
                distance: b.distance,
                impulse,
                blocked: true,
            });
            if b.bend == super::solver::Bend::Ground {
                continue;
            }
            if !self.report.touching.contains(&obstacle.entity) {
                self.report.touching.push(obstacle.entity);
            }
            if !self.report.touched.contains(&obstacle.entity)
                && !self.report.hits.iter().any(|hit| hit.other == obstacle.entity)
            {
                self.report.hits.push(NewHit {
                    other: obstacle.entity,
                    point: origin + b.point,
                    normal: b.normal,
                    speed: b.speed,
                    impulse,
                });
            }
        }
        for touch in solver.touches_now() {
            let entity = solver.near.obstacles[touch.obstacle as usize].entity;
            let known = contacts
                .iter()
                .any(|c| c.entity == entity && c.normal.dot(touch.normal) > 0.999);
            if !known {
                contacts.push(CharacterContact {
                    entity,
                    point: origin + touch.point,
                    normal: touch.normal,
                    distance: touch.distance,
                    impulse: Vec3::ZERO,
                    blocked: false,
                });
            }
        }
    }
}

/// Velocity of the ground at the point of support, without conveyors.
fn support_velocity(solver: &Solver, support: &Support, dt: f32) -> Vec3 {
    support.obstacle.map_or(Vec3::ZERO, |index| {
        solver.near.obstacles[index as usize]
            .motion
            .velocity(support.point, 1.0)
            / dt
    })
}
