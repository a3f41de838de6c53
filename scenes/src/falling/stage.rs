//! The yard of the falling stations: boxes, and how deep a body is in them.

use bevy::prelude::*;
use bevy_rapier3d::prelude::*;

/// The ground of all of them: its middle and its size; its top is level with the plaza.
pub const YARD: (Vec3, Vec3) = (Vec3::new(-84.0, -0.5, -10.0), Vec3::new(104.0, 1.0, 120.0));

/// Something fixed.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Its middle.
    pub at: Transform,
    /// Its size, metres.
    pub size: Vec3,
    /// sRGB.
    pub color: [f32; 3],
}

/// Concrete.
pub const CONCRETE: [f32; 3] = [0.62, 0.63, 0.64];
/// Bricks.
pub const BRICK: [f32; 3] = [0.66, 0.42, 0.33];
/// Wood.
pub const WOOD: [f32; 3] = [0.72, 0.55, 0.33];

impl Block {
    /// A level block by the middle of its base and its size.
    pub fn on(base: Vec3, size: Vec3, color: [f32; 3]) -> Self {
        Self {
            at: Transform::from_translation(base + Vec3::Y * (0.5 * size.y)),
            size,
            color,
        }
    }

    /// The yard itself, world.
    pub fn yard() -> Self {
        Self {
            at: Transform::from_translation(YARD.0),
            size: YARD.1,
            color: [0.53, 0.58, 0.47],
        }
    }

    /// The same in the axes that `place` is in.
    pub fn seen_from(mut self, place: &Transform) -> Self {
        self.at = *place * self.at;
        self
    }

    /// How deep a ball is in it, metres; negative outside.
    pub fn depth(&self, center: Vec3, radius: f32) -> f32 {
        // The largest of what is no number and something else is the latter.
        if !center.is_finite() {
            return f32::NAN;
        }
        let local = self.at.rotation.inverse() * (center - self.at.translation);
        let out = local.abs() - 0.5 * self.size;
        let outside = out.max(Vec3::ZERO).length();
        radius - outside - out.max_element().min(0.0)
    }

    /// Builds it.
    pub fn spawn(&self, world: &mut World) -> Entity {
        let half = 0.5 * self.size;
        let entity = world
            .spawn((
                RigidBody::Fixed,
                Collider::cuboid(half.x, half.y, half.z),
                self.at,
                Visibility::default(),
            ))
            .id();
        paint(world, entity, Cuboid::from_size(self.size), self.color);
        entity
    }
}

/// Gives an entity looks, where there is somebody to look.
pub fn paint(world: &mut World, entity: Entity, mesh: impl Into<Mesh>, [r, g, b]: [f32; 3]) {
    let Some(mut meshes) = world.get_resource_mut::<Assets<Mesh>>() else {
        return;
    };
    let mesh = meshes.add(mesh.into());
    let Some(mut materials) = world.get_resource_mut::<Assets<StandardMaterial>>() else {
        return;
    };
    let paint = materials.add(StandardMaterial {
        base_color: Color::srgb(r, g, b),
        perceptual_roughness: 0.85,
        ..default()
    });
    world
        .entity_mut(entity)
        .insert((Mesh3d(mesh), MeshMaterial3d(paint)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_as_deep_in_a_block_as_it_overlaps_its_nearest_face() {
        let turn = Quat::from_rotation_y(0.7);
        let block = Block {
            at: Transform::from_xyz(1.0, 2.0, 3.0).with_rotation(turn),
            size: Vec3::new(4.0, 2.0, 6.0),
            color: CONCRETE,
        };
        let at = |local: Vec3| Vec3::new(1.0, 2.0, 3.0) + turn * local;
        for (local, expected) in [
            (Vec3::new(0.0, 1.5, 0.0), -0.3),
            (Vec3::new(0.0, 1.1, 1.0), 0.1),
            (Vec3::new(0.0, 0.9, 0.0), 0.3),
            (Vec3::new(2.3, 1.4, 0.0), -0.3),
        ] {
            let depth = block.depth(at(local), 0.2);
            assert!((depth - expected).abs() < 1e-5, "{local}: {depth}");
        }
    }
}
