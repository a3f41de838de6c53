//! Stiffness of the suspension against the tick rate, at half of critical damping.
//!
//! A mass `m` on a spring `k` and damper `c = 2 ζ √(k m)`. Explicit Euler is stable for
//! `k < 4 ζ² m / dt²`, semi-implicit Euler for `k < 4 m (√(1 + ζ²) − ζ)² / dt²`: both follow from the
//! eigenvalues of one tick.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::PhysicsSet;
use embody_scenes::{
    Sim,
    reference::{HEIGHT, MASS, Plan, SAG, plane},
};

use super::{Limit, Map, find_limit};
use crate::peer::{peer, update_controllers};

const RATES: [f64; 5] = [30.0, 60.0, 120.0, 240.0, 480.0];
const RATIO: f64 = 0.5;
/// Softer springs would lie on their stops, newtons per metre.
const LEAST: f64 = 2.0e4;
const MOST: f64 = 1.0e10;
/// How far above its rest a car starts, metres.
const DROP: f32 = 0.01;

pub fn map(quick: bool) -> Map {
    let rates = if quick { &RATES[1..2] } else { &RATES[..4] };
    let most = if quick { 1.0e8 } else { MOST };
    let mut limits: Vec<Limit> = formulas()
        .into_iter()
        .filter(|limit| rates.contains(&limit.at))
        .collect();
    for &hz in rates {
        limits.push(Limit {
            method: "Rapier's controller",
            at: hz,
            predicted: None,
            measured: find_limit(LEAST, most, |k| settles(hz, k as f32, false)),
            ours: false,
        });
    }
    for &hz in rates {
        limits.push(Limit {
            method: "bevy_embody",
            at: hz,
            predicted: Some(f64::INFINITY),
            measured: find_limit(LEAST, most, |k| settles(hz, k as f32, true)),
            ours: true,
        });
    }
    Map {
        name: "vehicle_suspension",
        title: "Stiffest suspension that stays stable: 1500 kg on four wheels, half of critical damping",
        across: "tick rate (Hz)",
        up: "stiffness of each spring (N/m)",
        most,
        limits,
    }
}

/// The methods without a physics world.
pub fn formulas() -> Vec<Limit> {
    let m = f64::from(MASS) / 4.0;
    let mut limits = Vec::new();
    for hz in RATES {
        let dt = 1.0 / hz;
        limits.push(Limit {
            method: "explicit Euler",
            at: hz,
            predicted: Some(4.0 * RATIO * RATIO * m / (dt * dt)),
            measured: find_limit(LEAST, MOST, |k| decays(m, k, dt, true)),
            ours: false,
        });
    }
    for hz in RATES {
        let dt = 1.0 / hz;
        let part = (1.0 + RATIO * RATIO).sqrt() - RATIO;
        limits.push(Limit {
            method: "semi-implicit Euler",
            at: hz,
            predicted: Some(4.0 * m * part * part / (dt * dt)),
            measured: find_limit(LEAST, MOST, |k| decays(m, k, dt, false)),
            ours: false,
        });
    }
    limits
}

/// Whether a quarter of the car comes to rest.
fn decays(m: f64, k: f64, dt: f64, explicit: bool) -> bool {
    let c = 2.0 * RATIO * (k * m).sqrt();
    let (mut x, mut v) = (1.0f64, 0.0f64);
    for _ in 0..4000 {
        let a = -(k * x + c * v) / m;
        if explicit {
            x += dt * v;
            v += dt * a;
        } else {
            v += dt * a;
            x += dt * v;
        }
    }
    x.abs() <= 1.0 && (v * dt).abs() <= 2.0
}

/// Whether a car that is let go a little above its rest comes to rest there.
fn settles(hz: f64, k: f32, ours: bool) -> bool {
    let plugin = move |app: &mut App| {
        if ours {
            app.add_plugins(VehiclePlugin);
        } else {
            app.add_systems(
                FixedPostUpdate,
                update_controllers
                    .after(PhysicsSet::SyncBackend)
                    .before(PhysicsSet::StepSimulation),
            );
        }
    };
    let mut sim = Sim::with(hz, (EmbodyCorePlugin, plugin));
    plane(&mut sim, Quat::IDENTITY);
    let plan = Plan::reference().suspension(|s| {
        s.spring = SpringRate::Stiffness(k);
        s.stop_stiffness = 0.0;
    });
    let rest = HEIGHT + SAG - MASS * 9.81 / (4.0 * k);
    let at = Transform::from_xyz(0.0, rest + DROP, 0.0);
    let body = if ours {
        plan.spawn(&mut sim, at).body
    } else {
        sim.spawn((peer(&plan.mass, plan.hull.clone(), &plan.wheels), at))
    };
    sim.seconds(1.5);
    // About where it comes to rest, which is not where it should for everyone.
    let (mut low, mut high) = (f32::MAX, f32::MIN);
    for _ in 0..(0.5 * hz) as usize {
        sim.ticks(1);
        let y = sim.position(body).y;
        if !y.is_finite() {
            return false;
        }
        (low, high) = (low.min(y), high.max(y));
    }
    high - low <= 2.0 * DROP && (0.5 * (high + low) - rest).abs() < 0.1
}
