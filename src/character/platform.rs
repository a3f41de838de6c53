//! Being carried by what one stands on.
//!
//! The foot is fixed to the ground's frame: over the tick it goes where the ground takes that
//! point, by the whole rigid motion from the pose at which the foot was set down to the pose at
//! the end of the tick. Turns are therefore arcs, and a platform that was placed rather than moved
//! carries as well. Computed in double precision: a turntable does not let its rider drift.

use bevy::{
    math::{DQuat, DVec3, ops},
    prelude::*,
};

use super::{
    state::{Anchor, CharacterState},
    surface::SurfaceVelocity,
};
use crate::backend::{motion::WorldPose, world::Carrier};

/// Acceleration that friction gives to a rider at most, metres per second squared.
const GRIP: f32 = 10.0;

/// What the ground does to its rider in a tick.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Carry {
    /// Displacement of the foot, metres.
    pub displacement: Vec3,
    /// Velocity of the ground under the foot, metres per second. Ground that is placed elsewhere
    /// takes the foot along, but does not move.
    pub velocity: Vec3,
    /// Turn about the rider's up, radians.
    pub turn: f32,
    pub moving: bool,
    /// Whether the ground is gone.
    pub lost: bool,
}

/// How the ground carries a foot at `position` this tick.
pub(super) fn carry(
    carrier: Option<Carrier>,
    anchor: &Anchor,
    surface: SurfaceVelocity,
    position: Vec3,
    state: &CharacterState,
    mass: f32,
    dt: f32,
) -> Carry {
    let Some(carrier) = carrier else {
        return Carry {
            lost: true,
            ..default()
        };
    };
    let held = WorldPose {
        position: anchor.position,
        rotation: anchor.rotation,
    };
    let still = carrier.end == held && carrier.now == held;
    let on_belt = surface != SurfaceVelocity::default();
    if still && !on_belt {
        return Carry {
            // It would rise if the weight on it were left out.
            moving: carrier.awake,
            ..default()
        };
    }
    let foot = position.as_dvec3() + state.residual.as_dvec3();
    let mut displacement = DVec3::ZERO;
    let mut belt = DVec3::ZERO;
    let mut turn = 0.0;
    if !still {
        let from = anchor.rotation.as_dquat();
        let delta = (carrier.end.rotation.as_dquat() * from.inverse()).normalize();
        let arm = foot - anchor.position.as_dvec3();
        displacement = (carrier.end.position - anchor.position).as_dvec3() + (delta * arm - arm);
        if carrier.end.rotation != anchor.rotation {
            turn = twist(delta, state.up);
        }
    }
    if on_belt {
        let rotation = carrier.end.rotation;
        let spin = (rotation * surface.angular).as_dvec3() * f64::from(dt);
        let arm = foot + displacement - carrier.end.position.as_dvec3();
        let around = DQuat::from_scaled_axis(spin);
        belt = (rotation * surface.linear).as_dvec3() * f64::from(dt) + (around * arm - arm);
        displacement += belt;
        turn += twist(around, state.up);
    }
    let mut velocity = if carrier.now == held {
        displacement / f64::from(dt)
    } else {
        let (now, end) = (carrier.now, carrier.end);
        let back = (now.rotation.as_dquat() * end.rotation.as_dquat().inverse()).normalize();
        let arm = foot + displacement - belt - end.position.as_dvec3();
        let moved = (end.position - now.position).as_dvec3() + (arm - back * arm);
        (moved + belt) / f64::from(dt)
    }
    .as_vec3();
    let mut displacement = displacement.as_vec3();
    if carrier.mass < mass {
        // A pebble that spins away under a foot does not take the walker with it: what is lighter
        // than its rider changes his motion no faster than friction does.
        let change = displacement / dt - state.platform_velocity;
        let most = GRIP * dt;
        if change.length() > most {
            velocity = state.platform_velocity + change.clamp_length_max(most);
            displacement = velocity * dt;
            turn = 0.0;
        }
    }
    Carry {
        displacement,
        velocity,
        turn,
        moving: true,
        lost: false,
    }
}

/// Velocity that a moving surface adds at a point, metres per second.
pub(super) fn surface_velocity_at(
    surface: &SurfaceVelocity,
    pose: Option<WorldPose>,
    point: Vec3,
) -> Vec3 {
    let Some(pose) = pose else { return Vec3::ZERO };
    pose.rotation * surface.linear + (pose.rotation * surface.angular).cross(point - pose.position)
}

/// The part of a rotation that turns about `axis`, radians.
fn twist(rotation: DQuat, axis: Vec3) -> f32 {
    let along = rotation.xyz().dot(axis.as_dvec3());
    let half = ops::atan2(along as f32, rotation.w as f32);
    let angle = 2.0 * half;
    if angle > core::f32::consts::PI {
        angle - core::f32::consts::TAU
    } else if angle < -core::f32::consts::PI {
        angle + core::f32::consts::TAU
    } else {
        angle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turntable_carries_along_the_arc() {
        let step = core::f32::consts::TAU / 60.0;
        let mut foot = Vec3::new(3.0, 0.0, 0.0);
        let mut state = CharacterState::default();
        let mut rotation = Quat::IDENTITY;
        for i in 1..=600 {
            let anchor = Anchor {
                entity: Entity::PLACEHOLDER,
                position: Vec3::ZERO,
                rotation,
            };
            let now = WorldPose {
                position: Vec3::ZERO,
                rotation,
            };
            rotation = Quat::from_rotation_y(step * i as f32);
            let end = WorldPose { rotation, ..now };
            let found = carry(
                Some(Carrier {
                    now,
                    end,
                    mass: f32::INFINITY,
                    awake: false,
                }),
                &anchor,
                SurfaceVelocity::default(),
                foot,
                &state,
                70.0,
                1.0 / 60.0,
            );
            assert!((found.turn - step).abs() < 1e-4);
            let exact = foot.as_dvec3() + state.residual.as_dvec3() + found.displacement.as_dvec3();
            foot = exact.as_vec3();
            state.residual = (exact - foot.as_dvec3()).as_vec3();
        }
        assert!((foot.length() - 3.0).abs() < 1e-4, "{}", foot.length());
    }
}
