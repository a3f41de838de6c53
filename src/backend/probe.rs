//! Feeling for the ground: rays and swept shapes, behind one question.

use bevy::prelude::*;
use bevy_rapier3d::{
    plugin::context::RapierContextColliders,
    prelude::{CollisionGroups, RapierRigidBodyHandle},
    rapier::{
        geometry::Ray,
        math::Pose,
        parry::{
            query::{DefaultQueryDispatcher, ShapeCastOptions},
            shape::{Ball, Cylinder, Shape},
        },
        pipeline::QueryFilter,
    },
};

use super::world::PhysicsView;

/// What is moved along the probe's way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ProbeShape {
    Ray,
    /// Radius, metres.
    Ball(f32),
    /// Radius and half width, metres; its axle is the rotated `X`.
    Wheel(f32, f32),
}

/// A probe from `origin` along `direction` (unit length) over `reach` metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probe {
    pub origin: Vec3,
    pub rotation: Quat,
    pub direction: Vec3,
    pub reach: f32,
    pub shape: ProbeShape,
}

/// What a probe met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProbeHit {
    /// How far the shape went, metres.
    pub distance: f32,
    pub point: Vec3,
    /// Of the ground, against the probe's direction.
    pub normal: Vec3,
    /// Entity of the collider.
    pub entity: Entity,
}

/// What a probe saw first.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Seen {
    Ground(ProbeHit),
    /// The inside of a solid that it began in.
    Inside,
}

impl PhysicsView<'_> {
    /// The nearest solid collider on the probe's way that is not of the body `own`.
    pub fn probe(
        &self,
        probe: &Probe,
        own: &RapierRigidBodyHandle,
        groups: Option<CollisionGroups>,
    ) -> Option<Seen> {
        if !probe.origin.is_finite() || !(probe.reach > 0.0) {
            return None;
        }
        let mut filter = QueryFilter::default()
            .exclude_rigid_body(own.0)
            .exclude_sensors();
        if let Some(groups) = groups {
            filter = filter.groups(groups.into());
        }
        let pipeline = self.simulation.broad_phase.as_query_pipeline(
            &DefaultQueryDispatcher,
            &self.bodies.bodies,
            &self.colliders.colliders,
            filter,
        );
        let cast = |shape: &dyn Shape| {
            let start = Pose::from_parts(probe.origin, probe.rotation);
            let options = ShapeCastOptions {
                max_time_of_impact: probe.reach,
                // A shape that starts inside something moves on until it is out.
                stop_at_penetration: false,
                ..ShapeCastOptions::default()
            };
            pipeline
                .cast_shape(&start, probe.direction, shape, options)
                .map(|(handle, hit)| (handle, hit.time_of_impact, hit.witness1, hit.normal1))
        };
        let (handle, distance, point, normal) = match probe.shape {
            ProbeShape::Ray => {
                let ray = Ray::new(probe.origin, probe.direction);
                let (handle, hit) = pipeline.cast_ray_and_get_normal(&ray, probe.reach, true)?;
                if hit.time_of_impact <= 0.0 {
                    return Some(Seen::Inside);
                }
                let point = probe.origin + probe.direction * hit.time_of_impact;
                (handle, hit.time_of_impact, point, hit.normal)
            }
            ProbeShape::Ball(radius) => cast(&Ball::new(radius))?,
            ProbeShape::Wheel(radius, half) => {
                // Parry's cylinders stand along Y.
                let upright = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
                let start = Pose::from_parts(probe.origin, probe.rotation * upright);
                let options = ShapeCastOptions {
                    max_time_of_impact: probe.reach,
                    stop_at_penetration: false,
                    ..ShapeCastOptions::default()
                };
                let shape = Cylinder::new(half, radius);
                let (handle, hit) =
                    pipeline.cast_shape(&start, probe.direction, &shape, options)?;
                (handle, hit.time_of_impact, hit.witness1, hit.normal1)
            }
        };
        let collider = self.colliders.colliders.get(handle)?;
        if !normal.is_finite() || !point.is_finite() {
            return None;
        }
        // The backs of triangles hold as their fronts do.
        let normal = if normal.dot(probe.direction) > 0.0 {
            -normal
        } else {
            normal
        };
        Some(Seen::Ground(ProbeHit {
            distance,
            point,
            normal,
            entity: RapierContextColliders::entity_from_collider(collider),
        }))
    }
}
