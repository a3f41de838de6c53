//! Reading the physics world between its synchronisation and its step.

use bevy::{ecs::system::SystemParam, prelude::*};
use bevy_rapier3d::{
    plugin::context::{
        RapierContextColliders, RapierContextEntityLink, RapierContextJoints,
        RapierContextSimulation, RapierRigidBodySet,
    },
    prelude::{CollisionGroups, RapierConfiguration, RapierRigidBodyHandle},
    rapier::{
        dynamics::RigidBody,
        geometry::{Aabb, Collider, ColliderHandle, InteractionGroups},
        parry::{partitioning::BvhNode, query::DefaultQueryDispatcher},
        pipeline::QueryFilter,
    },
};

use super::{
    handles::entity_of,
    motion::{WorldPose, describe_motion, end_of_tick},
    neighbourhood::{Motion, MoverMemory, Neighbourhood, Obstacle, ObstacleKind, Request, Volume},
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
            &'static RapierContextJoints,
            &'static RapierConfiguration,
        ),
    >,
}

impl PhysicsWorlds<'_, '_> {
    /// The world that a body belongs to.
    pub fn of(&self, link: &RapierContextEntityLink) -> Option<PhysicsView<'_>> {
        let (simulation, colliders, bodies, joints, config) = self.contexts.get(link.0).ok()?;
        Some(PhysicsView {
            simulation,
            colliders,
            bodies,
            joints,
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
    #[cfg_attr(
        not(feature = "vehicle"),
        expect(dead_code, reason = "what only vehicles ask")
    )]
    pub(super) joints: &'a RapierContextJoints,
    pub gravity: Vec3,
    /// Whether the world is stepped.
    pub active: bool,
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

    /// Every collider in the search tree below nodes that are `near`, by its handle, and whether it is of
    /// the body `own`.
    #[cfg(feature = "vehicle")]
    pub(super) fn colliders_in(
        &self,
        near: impl Fn(&BvhNode) -> bool,
        own: &RapierRigidBodyHandle,
    ) -> impl Iterator<Item = (ColliderHandle, &'a Collider, bool)> {
        let pipeline = self.simulation.broad_phase.as_query_pipeline(
            &DefaultQueryDispatcher,
            &self.bodies.bodies,
            &self.colliders.colliders,
            QueryFilter::default(),
        );
        let own = own.0;
        pipeline.bvh.leaves(near).filter_map(move |leaf| {
            let (collider, handle) = pipeline.colliders.get_unknown_gen(leaf)?;
            collider
                .is_enabled()
                .then_some((handle, collider, collider.parent() == Some(own)))
        })
    }

    /// Collects what is near. `judge` is asked about every collider by its entity and its body's.
    pub fn gather(
        &self,
        request: &Request,
        groups: CollisionGroups,
        dt: f32,
        judge: impl Fn(Entity, Entity) -> Verdict,
        memory: &mut MoverMemory,
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
            let Some((collider, handle)) = pipeline.colliders.get_unknown_gen(leaf) else {
                continue;
            };
            if !collider.is_enabled() || !collider.collision_groups().test(groups) {
                continue;
            }
            if collider.is_sensor() {
                let inside = |point: Vec3| {
                    let shape = collider.shape();
                    shape.contains_point(collider.position(), request.origin + point)
                };
                let (middle, foot) = (inside(request.middle), inside(request.foot));
                if middle || foot {
                    out.volumes.push(Volume {
                        entity: entity_of(collider.user_data),
                        middle,
                    });
                }
                continue;
            }
            self.add_obstacle(request, (handle, collider), dt, &judge, memory, out);
        }
    }

    fn add_obstacle(
        &self,
        request: &Request,
        (handle, collider): (ColliderHandle, &'a Collider),
        dt: f32,
        judge: &impl Fn(Entity, Entity) -> Verdict,
        memory: &mut MoverMemory,
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
        out.add_shape(request, memory, index, (handle, collider), slack);
        if out.pieces.len() == pieces {
            out.obstacles.pop();
        }
    }
}
