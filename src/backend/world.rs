//! Reading and writing the physics world between its synchronisation and its step.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{
    plugin::context::{
        RapierContextColliders, RapierContextEntityLink, RapierContextSimulation,
        RapierRigidBodySet,
    },
    prelude::{CollisionGroups, RapierColliderHandle, RapierConfiguration, RapierRigidBodyHandle},
    rapier::{
        dynamics::{RigidBody, RigidBodyHandle, RigidBodyType},
        geometry::{Aabb, Collider, InteractionGroups},
        math::{AngularInertia, Pose},
        parry::{
            bounding_volume::BoundingVolume, partitioning::BvhNode, query::DefaultQueryDispatcher,
        },
        pipeline::QueryFilter,
    },
};

use super::{
    activity::Activity,
    neighbourhood::{Dynamics, Motion, Neighbourhood, Obstacle, ObstacleKind, Request},
};

/// All physics worlds, to be read.
#[derive(SystemParam)]
pub(crate) struct PhysicsWorlds<'w, 's> {
    contexts: Query<
        'w,
        's,
        (
            &'static RapierContextSimulation,
            &'static RapierContextColliders,
            &'static RapierRigidBodySet,
            &'static RapierConfiguration,
        ),
    >,
}

impl PhysicsWorlds<'_, '_> {
    /// The world that a body belongs to.
    pub fn of(&self, link: &RapierContextEntityLink) -> Option<PhysicsView<'_>> {
        let (simulation, colliders, bodies, config) = self.contexts.get(link.0).ok()?;
        Some(PhysicsView {
            simulation,
            colliders,
            bodies,
            gravity: config.gravity,
            active: config.physics_pipeline_active,
        })
    }
}

/// One physics world, to be read.
#[derive(Clone, Copy)]
pub(crate) struct PhysicsView<'a> {
    pub(super) simulation: &'a RapierContextSimulation,
    pub(super) colliders: &'a RapierContextColliders,
    pub(super) bodies: &'a RapierRigidBodySet,
    pub gravity: Vec3,
    /// Whether the world is stepped.
    pub active: bool,
}

/// A rigid pose in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorldPose {
    pub position: Vec3,
    pub rotation: Quat,
}

impl From<&Pose> for WorldPose {
    fn from(pose: &Pose) -> Self {
        Self {
            position: pose.translation,
            rotation: pose.rotation,
        }
    }
}

/// What the asker makes of a collider.
pub(crate) enum Verdict {
    /// As the physics world has it.
    AsIs,
    /// Leave it out.
    Skip,
    /// A body that is not pushed, and whether it pushes where it goes.
    Wall { pushes: bool },
    /// Another character: thicker than its collider by `skin`, on a way of at most `way` this tick.
    Character { skin: f32, way: f32 },
}

/// A collider that carries somebody.
pub(crate) struct Carrier {
    /// Its pose now.
    pub now: WorldPose,
    /// Its pose at the end of the tick.
    pub end: WorldPose,
    /// Mass of its body, kilograms; infinite when it moves as it wills.
    pub mass: f32,
    /// Whether its body is one that a weight would move.
    pub awake: bool,
}

impl<'a> PhysicsView<'a> {
    /// The pose of a body now and the one it was told to take; none of a disabled one.
    pub fn body_pose(&self, handle: &RapierRigidBodyHandle) -> Option<(WorldPose, WorldPose)> {
        let body = self
            .bodies
            .bodies
            .get(handle.0)
            .filter(|b| b.is_enabled())?;
        Some((body.position().into(), body.next_position().into()))
    }

    /// Where a collider is now and where it will be at the end of the tick.
    pub fn carrier(&self, entity: Entity, dt: f32) -> Option<Carrier> {
        let handle = self.colliders.entity2collider().get(&entity)?;
        let collider = self.colliders.colliders.get(*handle)?;
        if !collider.is_enabled() || collider.is_sensor() {
            return None;
        }
        let now = collider.position();
        let body = collider.parent().and_then(|h| self.bodies.bodies.get(h));
        let end = match (body, collider.position_wrt_parent()) {
            (Some(body), Some(local)) => match end_of_tick(body, dt) {
                Some(end) => end * *local,
                None => *now,
            },
            _ => *now,
        };
        Some(Carrier {
            now: now.into(),
            end: (&end).into(),
            mass: body
                .filter(|b| b.is_dynamic())
                .map_or(f32::INFINITY, RigidBody::mass),
            awake: body.is_some_and(|b| b.is_dynamic() && !b.is_sleeping()),
        })
    }

    /// Mean velocity over the tick of a point that goes with a collider, sensors included, metres
    /// per second.
    pub fn point_velocity(&self, entity: Entity, point: Vec3, dt: f32) -> Vec3 {
        let end = self
            .colliders
            .entity2collider()
            .get(&entity)
            .and_then(|handle| self.colliders.colliders.get(*handle)?.parent())
            .and_then(|handle| self.bodies.bodies.get(handle))
            .and_then(|body| Some((body.position(), end_of_tick(body, dt)?)));
        let Some((now, end)) = end else {
            return Vec3::ZERO;
        };
        // Relative to the body first, so that a far origin costs no digits.
        let arm = point - now.translation;
        let turned = end.rotation * (now.rotation.inverse() * arm);
        (end.translation - now.translation + (turned - arm)) / dt
    }

    /// Collects what is near. `judge` is asked about every collider by its entity and its body's.
    pub fn gather(
        &self,
        request: &Request,
        groups: CollisionGroups,
        dt: f32,
        judge: impl Fn(Entity, Entity) -> Verdict,
        out: &mut Neighbourhood,
    ) {
        out.clear();
        let groups: InteractionGroups = groups.into();
        let low = request.origin + request.low;
        let high = request.origin + request.high;
        if !(low.is_finite() && high.is_finite()) {
            return;
        }
        let area = BvhNode::leaf(Aabb::new(low, high), 0);
        let pipeline = self.simulation.broad_phase.as_query_pipeline(
            &DefaultQueryDispatcher,
            &self.bodies.bodies,
            &self.colliders.colliders,
            QueryFilter::default(),
        );
        for leaf in pipeline.bvh.leaves(|node| node.intersects(&area)) {
            let Some((collider, _)) = pipeline.colliders.get_unknown_gen(leaf) else {
                continue;
            };
            if !collider.is_enabled() || !collider.collision_groups().test(groups) {
                continue;
            }
            if collider.is_sensor() {
                let probe = request.origin + request.probe;
                if collider.shape().contains_point(collider.position(), probe) {
                    out.volumes.push(entity_of(collider.user_data));
                }
                continue;
            }
            self.add_obstacle(request, collider, dt, &judge, out);
        }
    }

    fn add_obstacle(
        &self,
        request: &Request,
        collider: &'a Collider,
        dt: f32,
        judge: &impl Fn(Entity, Entity) -> Verdict,
        out: &mut Neighbourhood,
    ) {
        let entity = entity_of(collider.user_data);
        let body = collider.parent().and_then(|h| self.bodies.bodies.get(h));
        let body_entity = body.map_or(entity, |b| entity_of(b.user_data));
        let verdict = judge(entity, body_entity);
        let mut obstacle = Obstacle {
            entity,
            body: body_entity,
            kind: ObstacleKind::Static,
            motion: Motion::NONE,
            dynamics: None,
            friction: collider.friction(),
            restitution: collider.restitution(),
            skin: 0.0,
        };
        let mut ahead = 0.0;
        match verdict {
            Verdict::Skip => return,
            Verdict::Character { skin, way } => {
                obstacle.kind = ObstacleKind::Character;
                obstacle.skin = skin;
                ahead = way;
            }
            Verdict::AsIs | Verdict::Wall { .. } => {
                if let Some(body) = body {
                    describe_motion(&mut obstacle, body, request.origin, dt);
                    if let Verdict::Wall { pushes } = verdict
                        && obstacle.kind == ObstacleKind::Dynamic
                    {
                        obstacle.dynamics = None;
                        if pushes {
                            // A wall goes where it goes, as one that moves as it wills.
                            obstacle.kind = ObstacleKind::Kinematic;
                        }
                    }
                }
            }
        }
        let motion = if obstacle.motion.is_none() {
            0.0
        } else {
            out.moving = true;
            let middle = (request.low + request.high) * 0.5;
            let reach = (request.high - request.low).length() * 0.5;
            obstacle.motion.reach(middle, reach)
        };
        out.slack = out.slack.max(motion);
        // Where a character will be is shared out later; until then it stands.
        let slack = obstacle.skin + ahead + motion;
        let index = out.obstacles.len() as u32;
        out.obstacles.push(obstacle);
        let pieces = out.pieces.len();
        out.add_shape(
            request,
            index,
            collider.shared_shape(),
            collider.position(),
            slack,
        );
        if out.pieces.len() == pieces {
            out.obstacles.pop();
        }
    }
}

/// The entity of a body or collider; of one that the game put into Rapier itself, none that exists.
fn entity_of(user_data: u128) -> Entity {
    Entity::try_from_bits(user_data as u64).unwrap_or(Entity::PLACEHOLDER)
}

/// The pose of a body at the end of the tick, or `None` when it does not move.
pub(super) fn end_of_tick(body: &RigidBody, dt: f32) -> Option<Pose> {
    let end = match body.body_type() {
        RigidBodyType::Fixed => return None,
        RigidBodyType::KinematicPositionBased => *body.next_position(),
        RigidBodyType::KinematicVelocityBased => body.predict_position_using_velocity(dt),
        RigidBodyType::Dynamic => {
            if body.is_sleeping() {
                return None;
            }
            body.predict_position_using_velocity(dt)
        }
    };
    (end != *body.position()).then_some(end)
}

/// A symmetric matrix in full.
pub(super) fn symmetric(m: &AngularInertia) -> Mat3 {
    Mat3::from_cols(
        Vec3::new(m.m11, m.m12, m.m13),
        Vec3::new(m.m12, m.m22, m.m23),
        Vec3::new(m.m13, m.m23, m.m33),
    )
}

/// Fills in how a body moves this tick.
fn describe_motion(obstacle: &mut Obstacle, body: &RigidBody, origin: Vec3, dt: f32) {
    match body.body_type() {
        RigidBodyType::Fixed => {}
        RigidBodyType::Dynamic => {
            obstacle.kind = ObstacleKind::Dynamic;
            let properties = body.mass_properties();
            let center = body.center_of_mass() - origin;
            let dynamics = Dynamics {
                linear_velocity: body.linvel(),
                angular_velocity: body.angvel(),
                center,
                inverse_mass: properties.effective_inv_mass,
                inverse_inertia: symmetric(&properties.effective_world_inv_inertia),
            };
            if !body.is_sleeping() {
                obstacle.motion = Motion {
                    pivot: center,
                    linear: dynamics.linear_velocity * dt,
                    turn: dynamics.angular_velocity * dt,
                };
            }
            obstacle.dynamics = Some(dynamics);
        }
        RigidBodyType::KinematicPositionBased | RigidBodyType::KinematicVelocityBased => {
            if let Some(end) = end_of_tick(body, dt) {
                let start = body.position();
                obstacle.kind = ObstacleKind::Kinematic;
                // Of the two quaternions of a turn the one by less than half a circle.
                let turn = end.rotation * start.rotation.inverse();
                let turn = if turn.w < 0.0 { -turn } else { turn };
                obstacle.motion = Motion {
                    pivot: start.translation - origin,
                    linear: end.translation - start.translation,
                    turn: if end.rotation == start.rotation {
                        Vec3::ZERO
                    } else {
                        turn.to_scaled_axis()
                    },
                };
            }
        }
    }
}

/// All physics worlds, to be written.
#[derive(SystemParam)]
pub(crate) struct PhysicsWorldsMut<'w, 's> {
    contexts: Query<
        'w,
        's,
        (
            &'static mut RapierContextSimulation,
            &'static mut RapierContextColliders,
            &'static mut RapierRigidBodySet,
        ),
    >,
    forced: ResMut<'w, ForcedBodies>,
}

impl PhysicsWorldsMut<'_, '_> {
    /// Brings the search tree up to the tick that is about to run: what was spawned or placed since
    /// the last step, and the whole way of everything that moves. Marks where anything moves.
    ///
    /// `is_own` tells the bodies whose motion the caller decides, which are left alone;
    /// `touched` are the colliders that were added or placed.
    pub fn refresh<'a>(
        &mut self,
        dt: f32,
        touched: impl Iterator<Item = (&'a RapierColliderHandle, &'a RapierContextEntityLink)>,
        is_own: impl Fn(Entity) -> bool,
        activity: &mut Activity,
    ) {
        for (mut simulation, mut colliders, bodies) in &mut self.contexts {
            let simulation = &mut *simulation;
            bodies
                .bodies
                .propagate_modified_body_positions_to_colliders(
                    &mut colliders.bypass_change_detection().colliders,
                );
            for handle in simulation.islands.active_bodies() {
                let Some(body) = bodies.bodies.get(handle) else {
                    continue;
                };
                if !body.is_enabled() || is_own(entity_of(body.user_data)) {
                    continue;
                }
                let Some(end) = end_of_tick(body, dt) else {
                    continue;
                };
                for collider in body.colliders() {
                    let Some((co, local)) = colliders
                        .colliders
                        .get(*collider)
                        .and_then(|co| Some((co, co.position_wrt_parent()?)))
                    else {
                        continue;
                    };
                    if !co.is_enabled() {
                        continue;
                    }
                    let aabb = co.compute_swept_aabb(&(end * *local));
                    activity.mark(aabb.mins, aabb.maxs);
                    if aabb.mins.is_finite() && aabb.maxs.is_finite() {
                        simulation.broad_phase.set_aabb(
                            &simulation.integration_parameters,
                            *collider,
                            aabb,
                        );
                    }
                }
            }
        }
        for (handle, link) in touched {
            let Ok((mut simulation, colliders, bodies)) = self.contexts.get_mut(link.0) else {
                continue;
            };
            let Some(collider) = colliders.colliders.get(handle.0) else {
                continue;
            };
            // What starts to move in this tick is not among the active bodies yet.
            let end = collider
                .parent()
                .and_then(|body| bodies.bodies.get(body))
                .and_then(|body| end_of_tick(body, dt))
                .zip(collider.position_wrt_parent());
            let aabb = match end {
                Some((end, local)) => collider.compute_swept_aabb(&(end * *local)),
                None => collider.compute_aabb(),
            };
            if !collider.is_enabled() || !aabb.mins.is_finite() || !aabb.maxs.is_finite() {
                continue;
            }
            let simulation = &mut *simulation;
            // A body that moves this tick has its whole way in the tree already.
            let pipeline = simulation.broad_phase.as_query_pipeline(
                &DefaultQueryDispatcher,
                &bodies.bodies,
                &colliders.colliders,
                QueryFilter::default(),
            );
            let aabb = match pipeline.bvh.leaf_node(handle.0.into_raw_parts().0) {
                Some(node) => node.aabb().merged(&aabb),
                None => aabb,
            };
            // Also where it was: ground that shrinks leaves somebody without.
            activity.mark(aabb.mins, aabb.maxs);
            simulation
                .broad_phase
                .set_aabb(&simulation.integration_parameters, handle.0, aabb);
        }
    }

    /// Widens a collider's place in the search tree by the way that it goes this tick.
    pub fn look_ahead(
        &mut self,
        handle: &RapierColliderHandle,
        link: &RapierContextEntityLink,
        way: Vec3,
    ) {
        let Ok((mut simulation, colliders, _)) = self.contexts.get_mut(link.0) else {
            return;
        };
        let Some(collider) = colliders.colliders.get(handle.0) else {
            return;
        };
        let here = collider.compute_aabb();
        let there = Aabb::new(here.mins + way, here.maxs + way);
        let aabb = here.merged(&there);
        if aabb.mins.is_finite() && aabb.maxs.is_finite() {
            let simulation = &mut *simulation;
            simulation
                .broad_phase
                .set_aabb(&simulation.integration_parameters, handle.0, aabb);
        }
    }

    /// Puts a kinematic body where it is at the end of the tick, without a velocity: what it pushes
    /// aside on the way was decided by its own solver, and must not be pushed again, with unlimited
    /// force, by the physics step.
    pub fn place_body(
        &mut self,
        link: &RapierContextEntityLink,
        handle: &RapierRigidBodyHandle,
        pose: WorldPose,
    ) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0)
            && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle.0)
        {
            let pose = Pose::from_parts(pose.position, pose.rotation);
            if *body.position() != pose || *body.next_position() != pose {
                body.set_position(pose, true);
                body.set_next_kinematic_position(pose);
            }
        }
    }

    /// Gives a dynamic body an impulse at once and a force for the whole tick, at a point of the
    /// world. A sleeping body is left asleep unless `wake`.
    ///
    /// The force goes through Rapier's own substeps, so damping and friction act against it as they
    /// would against any force; [`Self::end_forces`] takes it away again.
    pub fn push_body(
        &mut self,
        link: &RapierContextEntityLink,
        body: Entity,
        impulse: Vec3,
        force: Vec3,
        point: Vec3,
        wake: bool,
    ) {
        if let Ok((_, _, mut bodies)) = self.contexts.get_mut(link.0) {
            let Some(handle) = bodies.entity2body().get(&body).copied() else {
                return;
            };
            let Some(body) = bodies.bypass_change_detection().bodies.get_mut(handle) else {
                return;
            };
            if !body.is_dynamic() || (body.is_sleeping() && !wake) {
                return;
            }
            if impulse != Vec3::ZERO {
                body.apply_impulse_at_point(impulse, point, wake);
            }
            if force != Vec3::ZERO {
                let before = (body.user_force(), body.user_torque());
                body.add_force_at_point(force, point, wake);
                let after = (body.user_force(), body.user_torque());
                self.forced.0.push(Forced {
                    link: link.0,
                    body: handle,
                    before,
                    after,
                });
            }
        }
    }

    /// Remembers a body's force and torque before it was pushed, to give them back after the tick.
    #[cfg(feature = "vehicle")]
    pub(super) fn note_forced(
        &mut self,
        link: Entity,
        handle: RigidBodyHandle,
        before: (Vec3, Vec3),
    ) {
        if let Ok((_, _, bodies)) = self.contexts.get(link)
            && let Some(body) = bodies.bodies.get(handle)
        {
            let after = (body.user_force(), body.user_torque());
            self.forced.0.push(Forced {
                link,
                body: handle,
                before,
                after,
            });
        }
    }

    /// A body, to be written.
    #[cfg(feature = "vehicle")]
    pub(super) fn body_mut(
        &mut self,
        link: Entity,
        handle: RigidBodyHandle,
    ) -> Option<&mut RigidBody> {
        let (_, _, bodies) = self.contexts.get_mut(link).ok()?;
        bodies.into_inner().bodies.get_mut(handle)
    }

    /// Everything of one world.
    #[cfg(feature = "vehicle")]
    pub(super) fn parts_mut(
        &mut self,
        link: Entity,
    ) -> Option<(
        &mut RapierContextSimulation,
        &mut RapierContextColliders,
        &mut RapierRigidBodySet,
    )> {
        let (simulation, colliders, bodies) = self.contexts.get_mut(link).ok()?;
        Some((
            simulation.into_inner(),
            colliders.into_inner(),
            bodies.into_inner(),
        ))
    }

    /// Gives the bodies back the forces that they had before the last tick's pushes, unless the game
    /// gave them others meanwhile.
    pub fn end_forces(&mut self) {
        // The last push of a body is undone first.
        for forced in self.forced.0.drain(..).rev() {
            if let Ok((_, _, mut bodies)) = self.contexts.get_mut(forced.link)
                && let Some(body) = bodies.bypass_change_detection().bodies.get_mut(forced.body)
                && (body.user_force(), body.user_torque()) == forced.after
            {
                body.reset_forces(false);
                body.reset_torques(false);
                body.add_force(forced.before.0, false);
                body.add_torque(forced.before.1, false);
            }
        }
    }
}

/// The force and torque of a body before and after a tick's pushes.
#[derive(Clone, Copy)]
struct Forced {
    link: Entity,
    body: RigidBodyHandle,
    before: (Vec3, Vec3),
    after: (Vec3, Vec3),
}

/// The pushes of this tick, in their order; empty between ticks.
#[derive(Resource)]
pub(crate) struct ForcedBodies(Vec<Forced>);

impl Default for ForcedBodies {
    fn default() -> Self {
        Self(Vec::with_capacity(256))
    }
}
