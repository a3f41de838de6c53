//! From a loaded level to entities.

use bevy::{platform::collections::HashMap, prelude::*};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use super::{
    Course, CourseMotion, Node, Planet,
    extras::{BodyKind, ColliderSpec},
};

/// On every entity of a spawned course: its place in [`Course::nodes`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CourseNode(pub usize);

/// Spawns every node of a course: bodies, colliders and what they do to characters. What they look
/// like is left to whoever has a renderer.
pub fn spawn_course(commands: &mut Commands, course: &Course) {
    let mut named = HashMap::new();
    for (index, node) in course.nodes.iter().enumerate() {
        let mut entity = commands.spawn((
            Name::new(node.name.clone()),
            CourseNode(index),
            node.transform,
        ));
        named.insert(node.name.as_str(), entity.id());
        if let Some(collider) = collider(node) {
            add_physics(&mut entity, node, collider);
        }
        if let Some(planet) = node.extras.planet {
            entity.insert(Planet {
                gravity: planet.gravity,
                reach: planet.reach,
            });
        }
    }
    for node in &course.nodes {
        if let Some(hinge) = &node.extras.hinge
            && let Some(&body) = named.get(node.name.as_str())
            && let Some(&stand) = named.get(hinge.on.as_str())
        {
            let mut joint = RevoluteJointBuilder::new(Vec3::from_array(hinge.axis))
                .local_anchor1(Vec3::from_array(hinge.on_anchor))
                .local_anchor2(Vec3::from_array(hinge.anchor))
                .limits([-hinge.limit, hinge.limit])
                .build();
            // The stand is where the hinge is, so the two always touch.
            joint.set_contacts_enabled(false);
            commands
                .entity(body)
                .insert(ImpulseJoint::new(stand, joint));
        }
    }
}

/// Removes every entity of a spawned course.
pub fn despawn_course(commands: &mut Commands, nodes: &Query<Entity, With<CourseNode>>) {
    for entity in nodes {
        commands.entity(entity).despawn();
    }
}

fn add_physics(entity: &mut EntityCommands, node: &Node, collider: Collider) {
    let extras = &node.extras;
    entity.insert((
        collider,
        match extras.body {
            BodyKind::Fixed => RigidBody::Fixed,
            BodyKind::Kinematic => RigidBody::KinematicPositionBased,
            BodyKind::Dynamic => RigidBody::Dynamic,
        },
    ));
    if let Some(motion) = extras.motion {
        entity.insert(CourseMotion {
            motion,
            base: node.transform,
            time: 0.0,
        });
    }
    if extras.body == BodyKind::Dynamic {
        entity.insert(Velocity::default());
        if let Some(mass) = extras.mass {
            entity.insert(ColliderMassProperties::Mass(mass));
        }
    }
    if let Some(friction) = extras.friction {
        entity.insert(Friction {
            coefficient: friction,
            combine_rule: CoefficientCombineRule::Min,
        });
    }
    if let Some(friction) = extras.road {
        entity.insert(SurfaceFriction::new(friction));
    }
    if let Some(velocity) = extras.conveyor {
        entity.insert(SurfaceVelocity {
            linear: velocity.into(),
            ..default()
        });
    }
    if let Some(flow) = extras.water {
        entity.insert((Sensor, WaterVolume { flow: flow.into() }));
    }
    if extras.ladder {
        entity.insert((Sensor, Ladder));
    }
}

/// The collider of a node; none when it has none or its numbers make no shape.
pub(super) fn collider(node: &Node) -> Option<Collider> {
    let collider = match node.extras.collider.as_ref()? {
        ColliderSpec::Box { size } => Collider::cuboid(size[0] * 0.5, size[1] * 0.5, size[2] * 0.5),
        ColliderSpec::Ball { radius } => Collider::ball(*radius),
        ColliderSpec::Cylinder { height, radius } => Collider::cylinder(height * 0.5, *radius),
        ColliderSpec::Trimesh => {
            let (corners, triangles) = triangles(node);
            Collider::trimesh_with_flags(
                corners,
                triangles,
                TriMeshFlags::FIX_INTERNAL_EDGES | TriMeshFlags::DELETE_DEGENERATE_TRIANGLES,
            )
            .ok()?
        }
        ColliderSpec::Convex => Collider::convex_hull(&triangles(node).0)?,
        ColliderSpec::Voxels { size, columns } => {
            let cells: Vec<IVec3> = columns
                .iter()
                .flat_map(|&[x, z, height]| (0..height).map(move |y| IVec3::new(x, y, z)))
                .collect();
            Collider::voxels(Vec3::splat(*size), &cells)
        }
    };
    Some(collider)
}

/// All corners and triangles of a node's surfaces.
fn triangles(node: &Node) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut corners = Vec::new();
    let mut triangles = Vec::new();
    for surface in &node.surfaces {
        let first = corners.len() as u32;
        corners.extend(surface.positions.iter().map(|&p| Vec3::from_array(p)));
        triangles.extend(
            surface
                .indices
                .as_chunks::<3>()
                .0
                .iter()
                .map(|&[a, b, c]| [a + first, b + first, c + first]),
        );
    }
    (corners, triangles)
}
