//! Tyre impulses, wheel by wheel, each implicit in its own slip.
//!
//! A wheel's slip velocity would be `s` without its tyre; an impulse `λ` takes `G λ` off it. The
//! carcass, a spring of stiffness `k` stretched by `u`, takes up the rest of the slip that the patch
//! does not: `λ = k dt (u + dt (s − G λ − s_p))`. The patch slips by `s_p` under the force `λ / dt`. With
//! the secant `c` of its curve, `s_p = c λ / dt`, and
//!
//! `λ = (u / dt + s) / (1 / (k dt²) + G + c / dt)`,
//!
//! one division for any stiffness. At a standstill `c` is 0 below the friction limit: the carcass
//! alone holds. The combined slip that `c` belongs to is found by one Newton step in each sweep.

use bevy::math::Vec2;

use super::{Contact, Problem};
use crate::vehicle::tire::Patch;

/// One step for every wheel; returns the greatest change in parts of the friction limit.
pub(super) fn sweep(problem: &mut Problem) -> f32 {
    let mut change = 0.0f32;
    let dt = problem.dt;
    for i in 0..problem.contacts.len() {
        let contact = &problem.contacts[i];
        let (wheel, radius) = (contact.wheel, contact.radius);
        let before = contact.grip;
        let load = contact.push / dt;
        let grip = if load > 0.0 {
            let patch = match contact.patch {
                Some(patch) => patch,
                None => Patch::new(contact.tire, load, contact.surface),
            };
            let patch = if (patch.load - load).abs() > 1.0e-5 * load {
                Patch::new(contact.tire, load, contact.surface)
            } else {
                patch
            };
            let (grip, slip, combined) = solve(problem, i, &patch);
            let contact = &mut problem.contacts[i];
            contact.patch = Some(patch);
            contact.slip = slip;
            contact.combined = combined;
            let scale = dt * patch.limit.max_element() + 1.0e-6;
            change = change.max((grip - before).abs().max_element() / scale);
            grip
        } else {
            let contact = &mut problem.contacts[i];
            contact.slip = Vec2::ZERO;
            contact.combined = 0.0;
            Vec2::ZERO
        };
        let delta = grip - before;
        if delta == Vec2::ZERO || !delta.is_finite() {
            continue;
        }
        let contact = &mut problem.contacts[i];
        contact.grip = grip;
        let impulse = contact.along * delta.x + contact.across * delta.y;
        contact.push_both(impulse, &mut problem.chassis, problem.grounds);
        problem.spin.push(wheel, f64::from(delta.x * radius));
    }
    change
}

/// Impulse, slip velocity of the patch and combined slip velocity of one wheel.
fn solve(problem: &Problem, i: usize, patch: &Patch) -> (Vec2, Vec2, f32) {
    let dt = problem.dt;
    let contact: &Contact = &problem.contacts[i];
    let (chassis, grounds) = (&problem.chassis, &*problem.grounds);
    let velocity = contact.velocity(chassis, grounds);
    let spin = problem.spin.w[contact.wheel] as f32 * contact.radius;
    let slip = Vec2::new(
        spin - velocity.dot(contact.along),
        contact.camber_slip * contact.speed - velocity.dot(contact.across),
    ) + contact.turn_slip;
    let turned = problem.spin.mobility(contact.wheel) as f32 * contact.radius * contact.radius;
    let own = |axis| contact.mobility(axis, contact, axis, chassis, grounds);
    let mobility = Vec2::new(own(contact.along) + turned, own(contact.across));
    // What the slip would be without this tyre's impulse, the stretch of the carcass included.
    let drive = contact.bristle / dt + slip + mobility * contact.grip;
    let stiff = mobility + (patch.carcass * (dt * dt)).recip();

    let step = |combined: f32| {
        let secant = patch.secant(combined, contact.speed);
        let grip = drive / (stiff + secant.compliance / dt);
        (secant, grip, grip * secant.compliance / dt)
    };
    let limit = (patch.limit * dt).max(Vec2::splat(1.0e-9));
    let mut combined = contact.combined;
    let (mut secant, mut grip, mut slipping) = step(combined);
    let excess = (grip / limit).length();
    if excess > 1.0 + 1.0e-4 {
        // Full slide: the rest of the drive is slip.
        combined = patch.combined(drive * (1.0 - 1.0 / excess), contact.speed);
        (secant, grip, slipping) = step(combined);
    }
    // One step of Newton's towards the combined slip that belongs to this impulse.
    let reached = patch.combined(slipping, contact.speed);
    let weight = grip.length_squared();
    if weight > 0.0 {
        let stiffness = (grip * grip).dot(stiff) / weight * dt;
        let compliance = (grip * grip).dot(secant.compliance) / weight;
        if compliance > 0.0 {
            let slope = (1.0 + stiffness * secant.slope).max(0.3);
            let next = combined + (reached - combined) * (1.0 + stiffness / compliance) / slope;
            combined = next.clamp(0.0, patch.combined(drive, contact.speed));
        }
        (_, grip, slipping) = step(combined);
    }
    // Newton's last step may leave the ellipse by a little.
    let excess = (grip / limit).length();
    if excess > 1.0 {
        grip /= excess;
    }
    (grip, slipping, combined)
}
