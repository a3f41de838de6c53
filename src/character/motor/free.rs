//! Free movement in all directions: flying, and swimming in a flow.

use bevy::prelude::*;

use super::{Course, approach};

/// Approaches the velocity asked for, in a medium that itself moves.
pub(super) fn drift(velocity: Vec3, wish: Vec3, flow: Vec3, rate: f32, dt: f32) -> Course {
    let course = approach(velocity - flow, wish, rate, dt);
    Course {
        mean: course.mean + flow,
        end: course.end + flow,
    }
}
