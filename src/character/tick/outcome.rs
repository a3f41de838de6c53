//! From the solver's answer to state, outputs, events and effects on bodies.

use bevy::{math::ops, prelude::*};

use super::Tick;
use crate::{
    backend::{motion::WorldPose, neighbourhood::ObstacleKind},
    character::{
        config::SlopeSpeed,
        motor::{along_ground, kept_velocity, leave_ground},
        output::{CharacterContact, StepAttempt},
        platform,
        report::{BodyImpulse, NewHit},
        solver::{Bend, Solver, Support},
        state::{Anchor, Ground, GroundMaterial, GroundState, LastPose, MovementMode},
    },
};

/// Who leans on something that faces a ladder's climber by at least this cosine hangs on over its end.
const LEANS: f32 = 0.3;

impl Tick<'_, '_, '_, '_> {
    /// Writes the outcome into state, outputs and report.
    pub(super) fn finish(
        &mut self,
        solver: &mut Solver,
        p: Vec3,
        rotation: Quat,
        support: Support,
        climbed: Option<(f32, f32)>,
        snapped: f32,
        ramp: f32,
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
        let first = self.state.last_pose.is_none();
        self.state.last_pose = Some(LastPose { position, rotation });
        self.report.target = Some(WorldPose { position, rotation });

        let mut velocity = solver.velocity;
        if self.carry.turn != 0.0 && was_on_ground && self.config.turn_with_platform {
            velocity = Quat::from_axis_angle(up, self.carry.turn) * velocity;
        }
        let carried = self.carry.velocity;
        let ground = self.ground(solver, &support, origin);
        let on_ground = support.state == GroundState::OnGround;
        self.state.velocity = velocity;
        if on_ground {
            let same = was_on_ground && self.state.ground.entity == ground.entity;
            let platform = if same {
                carried
            } else if stands_on_lighter(solver, &support) {
                // It takes the rider along by friction only, from the next tick on.
                Vec3::ZERO
            } else {
                ground.velocity
            };
            if !same {
                // From one ground to the next it is the difference that is kept or not.
                self.state.velocity += if was_on_ground {
                    kept_velocity(self.config, up, carried - platform)
                } else {
                    -platform
                };
            }
            let level = self.state.velocity - up * self.state.velocity.dot(up);
            let length = if same || was_on_ground {
                self.state
                    .velocity
                    .length()
                    .min(before.length().max(level.length()))
            } else {
                level.length()
            };
            // Nearly vertical motion has no heading to keep.
            let level = level.normalize_or_zero()
                * match self.config.slope_speed {
                    SlopeSpeed::AlongGround if level.length() > 0.05 * length => length,
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
        // Who begins on the ground has not come down on it.
        if self.report.was != GroundState::OnGround
            && on_ground
            && !first
            && let Some(entity) = ground.entity
        {
            let speed = (ground.velocity - before).dot(ground.normal).max(0.0);
            self.report.happened.landed = Some((entity, speed, self.state.air_time));
        }
        self.state.air_time = if on_ground {
            0.0
        } else {
            self.state.air_time + dt
        };
        if on_ground {
            self.state.jumping = false;
        }
        let stood_on = core::mem::replace(&mut self.state.ground, ground);
        // What the slope does not explain is a step, up or down.
        let rise = if on_ground && was_on_ground {
            (p - solver.pose.position).dot(up) - ramp
        } else {
            0.0
        };
        self.note_step(solver, climbed, snapped, rise);
        self.weigh(solver, &support, &stood_on, origin);
        self.note_contacts(solver, p, origin);
        self.note_volumes(solver);
    }

    /// The water and the ladder that it is at.
    fn note_volumes(&mut self, solver: &Solver) {
        let volumes = solver.near.volumes.iter();
        let about_middle = volumes.clone().filter(|v| v.middle).map(|v| v.entity);
        let water = self.state.water;
        self.state.water = self
            .around
            .volume(about_middle.clone(), water, |v| v.0.is_some());
        let last = self.state.ladder;
        let contacts = &self.contacts.contacts;
        self.state.ladder = self
            .around
            .volume(about_middle, last, |v| v.1.is_some())
            .or_else(|| {
                // Over its end a climber goes on until the feet are clear of what it leans on.
                let climbs = self.state.mode == MovementMode::Climb;
                let at_end = volumes.clone().any(|v| Some(v.entity) == last);
                let (_, ladder, pose) = self.around.volumes.get(last?).ok()?;
                let out = pose.rotation() * Vec3::Z;
                let leans = contacts.iter().any(|c| c.normal.dot(out) > LEANS);
                last.filter(|_| climbs && at_end && ladder.is_some() && leans)
            });
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
            self.around
                .view
                .carrier(obstacle.entity, self.around.dt)
                .map(|c| c.end),
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

    fn note_step(&mut self, solver: &Solver, climbed: Option<(f32, f32)>, snapped: f32, rise: f32) {
        let up = self.state.up;
        self.contacts.step = solver.step.map(|attempt| StepAttempt {
            point: self.start.position + attempt.point,
            ..attempt
        });
        self.contacts.snapped = snapped;
        self.contacts.queries = solver.near.queries;
        if let Some((_, height)) = climbed
            && !self.state.stepping
        {
            self.report.happened.stepped = Some(height);
        }
        self.state.stepping = climbed.is_some();
        let time = self.config.step_smoothing;
        if time > 0.0 {
            let rise = if rise.abs() > 5.0e-3 { rise } else { 0.0 };
            let fade = ops::exp(-self.around.dt / time);
            let offset = self.state.view_offset * fade - up * rise;
            self.state.view_offset = if offset.length_squared() > 1.0e-8 {
                offset
            } else {
                Vec3::ZERO
            };
        } else {
            self.state.view_offset = Vec3::ZERO;
        }
    }

    /// Collects the impulses for bodies: pushes, and the weight on what carries.
    fn weigh(&mut self, solver: &Solver, support: &Support, stood_on: &Ground, origin: Vec3) {
        let known = core::mem::take(&mut self.state.weight);
        self.report.impulses.clear();
        self.report.impulses.reserve(8);
        for i in solver.impulses.iter() {
            self.report.impulses.push(BodyImpulse {
                body: i.body,
                impulse: i.impulse,
                force: i.work / self.around.dt,
                point: origin + i.point,
                wake: true,
            });
        }
        if !self.config.weighs_on_ground || support.state != GroundState::OnGround {
            return;
        }
        let Some(index) = support.obstacle else {
            return;
        };
        let obstacle = &solver.near.obstacles[index as usize];
        let Some(body) = obstacle
            .dynamics
            .filter(|_| obstacle.kind == ObstacleKind::Dynamic)
        else {
            return;
        };
        let gravity = self.motor.downward(self.around.view.gravity);
        let (up, mass) = (self.state.up, self.config.mass);
        let full = mass * gravity;
        let was_on_ground = stood_on.state == GroundState::OnGround;
        self.state.weight = if was_on_ground && stood_on.entity == Some(obstacle.entity) {
            let now = self.state.ground.velocity;
            let acceleration = (now - stood_on.velocity).dot(up) / self.around.dt;
            let share = mass / body.effective_mass(support.point, up);
            ease_weight(known, full, mass * acceleration, share)
        } else {
            full
        };
        self.report.impulses.push(BodyImpulse {
            body: obstacle.body,
            impulse: Vec3::ZERO,
            force: -up * self.state.weight,
            point: origin + support.point,
            wake: !was_on_ground || self.report.woken,
        });
    }

    fn note_contacts(&mut self, solver: &mut Solver, p: Vec3, origin: Vec3) {
        // A look at another place, for a step or for growing, may have been the last.
        solver.touch_at_end(p);
        let contacts = &mut self.contacts.contacts;
        contacts.clear();
        // Room for more than a usual tick needs, so that later ticks need no memory.
        contacts.reserve(24);
        self.report.hits.reserve(8);
        core::mem::swap(&mut self.report.touching, &mut self.report.touched);
        self.report.touching.clear();
        self.report.touching.reserve(8);
        for b in solver.blockers.iter() {
            let obstacle = &solver.near.obstacles[b.obstacle as usize];
            let impulse = solver
                .impulses
                .iter()
                .filter(|i| i.obstacle == b.obstacle)
                .map(|i| i.impulse + i.work)
                .sum();
            contacts.push(CharacterContact {
                entity: obstacle.entity,
                point: origin + b.point,
                normal: b.normal,
                distance: b.distance,
                impulse,
                blocked: true,
            });
            if b.bend == Bend::Ground {
                continue;
            }
            if !self.report.touching.contains(&obstacle.entity) {
                self.report.touching.push(obstacle.entity);
            }
            if !self.report.touched.contains(&obstacle.entity)
                && !self
                    .report
                    .hits
                    .iter()
                    .any(|hit| hit.other == obstacle.entity)
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
        for touch in solver.touches() {
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

/// The weight on ground that accelerates: `full` and `inertia` (mass times the ground's acceleration
/// upwards) in newtons, `share` the mass over the mass that the ground opposes.
///
/// Ground that falls away is pressed less, ground that lifts more. The acceleration seen is the one
/// that the last weight made, so the new one is approached by a part that keeps the loop stable for
/// every ratio of the masses; at rest and in steady acceleration it is exact.
fn ease_weight(last: f32, full: f32, inertia: f32, share: f32) -> f32 {
    let wanted = (full + inertia).clamp(0.0, 1.5 * full);
    last + (wanted - last) * 0.5 / (1.0 + share)
}

/// Velocity of the ground at the point of support, without conveyors.
pub(super) fn support_velocity(solver: &Solver, support: &Support, dt: f32) -> Vec3 {
    support.obstacle.map_or(Vec3::ZERO, |index| {
        solver.near.obstacles[index as usize]
            .motion
            .velocity(support.point, 1.0)
            / dt
    })
}

/// Whether the ground is a body lighter than who stands on it.
fn stands_on_lighter(solver: &Solver, support: &Support) -> bool {
    support
        .obstacle
        .and_then(|index| solver.near.obstacles[index as usize].dynamics)
        .is_some_and(|body| body.inverse_mass.max_element() * solver.config.mass > 1.0)
}
