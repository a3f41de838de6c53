//! Tyre impulses, wheel by wheel, each implicit in its own slip.
//!
//! A wheel's slip velocity would be `s` without its tyre; an impulse `λ` takes `G λ` off it. The
//! carcass, a spring of stiffness `k` stretched by `u`, takes up the rest of the slip that the patch
//! does not: `u' = s − G λ − s_p`, and gives the force `k u` that it ends the tick with. The patch slips by
//! `s_p` under that force. With the secant `c` of its curve, `s_p = c k u`, a linear filter, whose exact
//! answer to a slip that is constant over the tick ([`super::relaxation`]) is
//!
//! `λ = (b u / dt + s) / (a / (k dt²) + G)`, `a = h / (1 − e^{−h})`, `b = a − h`, `h = dt k c`,
//!
//! one division for any stiffness. It gives away as much energy as it is given, or more, for any `c`, even
//! one that changes from tick to tick: `v₁² + k u₁² / m ≤ v₀² + k u² / m`. At a standstill `c` is 0 below
//! the friction limit: `a` and `b` are 1, and the carcass alone holds. In a steady slide `s − G λ = s_p`
//! whatever `h`. The combined slip that `c` belongs to is found by one Newton step in each sweep.

use bevy::math::Vec2;

use super::{Contact, Problem, relaxation::Relaxation};
use crate::vehicle::tire::{Patch, Secant};

/// Applies what the tyres begin with.
pub(super) fn start(problem: &mut Problem) {
    for i in 0..problem.contacts.len() {
        let contact = &problem.contacts[i];
        let (chassis, grounds) = (&problem.chassis, &*problem.grounds);
        let own = |axis| contact.mobility(axis, contact, axis, chassis, grounds);
        let mobility = Vec2::new(own(contact.along), own(contact.across));
        let contact = &mut problem.contacts[i];
        contact.mobility = mobility;
        let impulse = contact.normal * contact.push
            + contact.along * contact.grip.x
            + contact.across * contact.grip.y;
        contact.push_both(impulse, &mut problem.chassis, problem.grounds);
        let turned = contact.grip.x * contact.radius;
        problem.spin.preload(contact.wheel, f64::from(turned));
    }
}

/// One step for every wheel; returns the greatest change in parts of the friction limit.
pub(super) fn sweep(problem: &mut Problem) -> f32 {
    let mut change = 0.0f32;
    let dt = problem.dt;
    for i in 0..problem.contacts.len() {
        let contact = &problem.contacts[i];
        let (wheel, radius) = (contact.wheel, contact.radius);
        let before = contact.grip;
        let load = contact.push / dt;
        let (tire, surface) = (contact.tire, contact.surface);
        let mut grip = Vec2::ZERO;
        if load > 0.0 {
            let patch = match contact.patch {
                Some(patch) if (patch.load - load).abs() <= SAME * load => patch,
                _ => {
                    problem.contacts[i].answer = None;
                    Patch::new(tire, load, surface)
                }
            };
            let step = step(problem, i, &patch);
            let contact = &mut problem.contacts[i];
            contact.patch = Some(patch);
            contact.answer = Some(step.answer);
            contact.combined = step.next;
            let scale = dt * patch.limit.max_element() + 1.0e-6;
            let moved = (step.grip - before).abs().max_element();
            change = change.max(moved.max(step.open) / scale);
            grip = step.grip;
        } else {
            problem.contacts[i].combined = 0.0;
        }
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

/// Loads and slips that differ by less than this part count as one: far below what ends the sweeps.
const SAME: f32 = 1.0e-5;

/// What patch and carcass answer near one combined slip.
#[derive(Clone, Copy)]
pub(crate) struct Answer {
    combined: f32,
    secant: Secant,
    filter: Relaxation,
}

impl Answer {
    fn new(patch: &Patch, combined: f32, contact: &Contact, dt: f32) -> Self {
        let secant = patch.secant(combined, contact.speed);
        Self {
            combined,
            secant,
            filter: Relaxation::new(patch.carcass * secant.compliance * dt),
        }
    }
}

/// What one step finds.
struct Step {
    answer: Answer,
    /// Newton-seconds.
    grip: Vec2,
    /// Combined slip velocity to go on with, metres per second.
    next: f32,
    /// By how much that will still change the impulse, newton-seconds.
    open: f32,
}

fn step(problem: &Problem, i: usize, patch: &Patch) -> Step {
    let dt = problem.dt;
    let contact: &Contact = &problem.contacts[i];
    let velocity = contact.velocity(&problem.chassis, problem.grounds);
    let spin = problem.spin.w[contact.wheel] as f32 * contact.radius;
    let slip = Vec2::new(
        spin - velocity.dot(contact.along),
        contact.camber_slip * contact.speed - velocity.dot(contact.across),
    ) + contact.turn_slip;
    let turned = problem.spin.mobility(contact.wheel) as f32 * contact.radius * contact.radius;
    let mobility = contact.mobility + Vec2::new(turned, 0.0);
    // What the slip would be without this tyre's impulse, without and with the stretch of the carcass.
    let free = slip + mobility * contact.grip;
    let stretch = contact.bristle / dt;
    let drive = stretch + free;
    let spring = (patch.carcass * (dt * dt)).recip();
    let gripped = |Answer { filter, .. }: &Answer| {
        (filter.b * stretch + free) / (filter.a * spring + mobility)
    };

    let mut combined = contact.combined;
    let mut answer = match contact.answer {
        Some(answer) if (answer.combined - combined).abs() <= SAME * combined => answer,
        _ => Answer::new(patch, combined, contact, dt),
    };
    let mut grip = gripped(&answer);
    let limit = (patch.limit * dt).max(Vec2::splat(1.0e-9));
    if (grip / limit).length() > 1.0 + 1.0e-4 {
        // A full slide: what the carcass alone would hold beyond the limit is slip. From far below,
        // Newton's steps would be small.
        let held = (drive / (mobility + spring) / limit).length().max(1.0);
        let slide = patch.combined(drive * (1.0 - 1.0 / held), contact.speed);
        if combined < 0.5 * slide {
            combined = slide;
            answer = Answer::new(patch, combined, contact, dt);
            grip = gripped(&answer);
        }
    }
    let Answer { secant, filter, .. } = &answer;
    // One step of Newton's towards the combined slip `ρ` that belongs to this impulse: with the force
    // `F(ρ)` it solves `ρ + F (b / (k dt) + G dt) = b u / dt + s`.
    let mut next = combined;
    let mut open = 0.0;
    let weight = grip.length_squared();
    if weight > 0.0 {
        let reached = patch.combined(grip * secant.compliance / dt, contact.speed);
        let part = grip * grip / weight;
        let stiffness = part.dot(mobility + filter.b * spring) * dt;
        let compliance = part.dot(secant.compliance);
        if compliance > 0.0 {
            // `b` falls while `ρ` grows, by as much as the curve bends.
            let before = (contact.bristle * patch.carcass).dot(grip) * dt / weight;
            let bent = (1.0 - compliance * secant.slope).clamp(0.0, 1.0);
            let falls = part.dot(filter.falls) * bent * (1.0 - before).clamp(-1.0, 1.0);
            let slope = (1.0 + stiffness * secant.slope - falls).max(0.3);
            next = combined + (reached - combined) * (1.0 + stiffness / compliance) / slope;
            // No `clamp`: that panics where its limits are no numbers.
            let most = patch.combined(drive.abs().max(free.abs()), contact.speed);
            next = next.min(most).max(0.0);
            open = (next - combined).abs() * secant.slope.abs() * dt;
        }
    }
    // A slip that has not converged may leave the ellipse by a little.
    let excess = (grip / limit).length();
    if excess > 1.0 {
        grip /= excess;
    }
    Step {
        answer,
        grip,
        next,
        open,
    }
}
