//! One vehicle in one tick: look, solve, remember.

mod bend;
mod brakes;
mod contacts;
mod driveline;
mod finish;
mod outside;
mod sense;
mod shares;
mod steer;
mod traction;

use arrayvec::ArrayVec;
use bevy::prelude::*;
use bevy_rapier3d::prelude::CollisionGroups;

use super::{
    assists::{AntiLockBrakes, HillHold, LeanControl, StabilityControl, TractionControl},
    config::Vehicle,
    intent::VehicleIntent,
    output::VehicleTelemetry,
    report::{UNFIT_TICKS, VehicleReport},
    solve::{Chassis, Contact, GroundBody, MOST_WHEELS, Problem, Spin},
    state::VehicleState,
    surface::{RoadVelocity, SurfaceFriction},
    wheel::Wheel,
};
use crate::backend::{
    handles::RapierRigidBodyHandle, probe::Ground, rigid::Rigid, world::PhysicsView,
};

pub(super) use sense::Found;

/// A vehicle's wheels, in order.
pub(super) type WheelList<'a> = ArrayVec<&'a Wheel, MOST_WHEELS>;

/// What the colliders say about themselves.
pub(super) type Surfaces<'w, 's> = Query<
    'w,
    's,
    (
        Option<&'static SurfaceFriction>,
        Option<&'static RoadVelocity>,
    ),
>;

/// Helpers of the driver, as far as the vehicle has them.
#[derive(Clone, Copy, Default)]
pub(super) struct Assists<'a> {
    pub abs: Option<&'a AntiLockBrakes>,
    pub traction: Option<&'a TractionControl>,
    pub stability: Option<&'a StabilityControl>,
    pub hill: Option<&'a HillHold>,
    pub lean: Option<&'a LeanControl>,
}

/// What a tick is given besides the vehicle itself.
pub(super) struct Surroundings<'a, 'w, 's> {
    pub view: PhysicsView<'a>,
    pub dt: f32,
    pub entity: Entity,
    pub handle: &'a RapierRigidBodyHandle,
    pub groups: Option<CollisionGroups>,
    pub surfaces: &'a Surfaces<'w, 's>,
    pub wheels: WheelList<'a>,
    /// Their entities, in the same order.
    pub wheel_entities: ArrayVec<Entity, MOST_WHEELS>,
    /// Ticks from one look at the ground to the next.
    pub probe_every: u8,
    pub assists: Assists<'a>,
}

/// Memory that is kept between vehicles.
#[derive(Default)]
pub(super) struct Scratch {
    spin: Spin,
    ground: Ground,
}

/// For how long a woken vehicle is not left to sleep, seconds: until its steering has turned.
const STAY_AWAKE: f32 = 1.0;

/// Axes of a body in the world.
#[derive(Clone, Copy)]
struct Axes {
    right: Vec3,
    up: Vec3,
    forward: Vec3,
}

/// Whether a vehicle sleeps and nothing asks it to wake: then there is nothing to solve.
pub(super) fn rests(
    view: &PhysicsView,
    handle: &RapierRigidBodyHandle,
    dt: f32,
    intent: &VehicleIntent,
    state: &mut VehicleState,
    report: &VehicleReport,
) -> bool {
    let asked = intent.clean();
    if asked != state.asked {
        state.stay_awake = STAY_AWAKE;
    }
    if !view.sleeps(handle) {
        return false;
    }
    let stirs = |ground| view.ground_stirs(ground, dt);
    let moved = state.wheels.iter().any(|w| w.ground.is_some_and(stirs));
    // A hold that ends has to be seen.
    let held = state.hill_hold > 0.0;
    if report.changed || moved || held || asked.throttle > 0.0 {
        state.stay_awake = STAY_AWAKE;
    }
    // Not `> 0`: what is no number does not keep awake.
    !(state.stay_awake > 0.0)
}

/// Solves one vehicle.
pub(super) fn run(
    s: &Surroundings,
    config: &Vehicle,
    intent: &VehicleIntent,
    state: &mut VehicleState,
    telemetry: &mut VehicleTelemetry,
    report: &mut VehicleReport,
    scratch: &mut Scratch,
) {
    report.clear();
    let Some(rigid) = s.view.rigid(s.handle) else {
        report.bare = true;
        if report.unfit < UNFIT_TICKS
            && let Some((what, need)) = s.view.unfit(s.handle)
        {
            report.unfit += 1;
            if report.unfit == UNFIT_TICKS {
                crate::validate::warn_bad(
                    s.entity,
                    what,
                    "none that wheels can carry",
                    need,
                    "it has no wheels",
                );
            }
        }
        return;
    };
    // One that drove and is switched over, for a cut scene or a crash, is no mistake.
    report.unfit = UNFIT_TICKS;
    if !(rigid.velocity.is_finite() && rigid.spin.is_finite() && rigid.position.is_finite()) {
        return;
    }
    state.follow(&s.wheel_entities);
    state.heal();
    report.wheels.clone_from(&s.wheel_entities);
    let asked = intent.clean();
    state.stay_awake = (state.stay_awake - s.dt).max(0.0);
    state.asked = asked;
    report.changed = false;
    report.solved = true;

    let dt = s.dt;
    let axes = Axes {
        right: rigid.rotation * Vec3::X,
        up: rigid.rotation * Vec3::Y,
        forward: rigid.rotation * Vec3::NEG_Z,
    };
    let speed = (rigid.velocity - state.ground_velocity).dot(axes.forward);
    // Nothing falls along an axis that is locked.
    let gravity = s.view.gravity * rigid.gravity_scale * rigid.free_axes();
    report.refresh_shares(s, &rigid);

    let angles = steer::steer(s, config, state, &asked, speed);
    let found = sense::sense(
        s,
        config,
        state,
        report,
        &rigid,
        &angles,
        gravity,
        &mut scratch.ground,
    );
    sense::remember(s, state, &found);

    // What the body would do without wheels.
    let mut chassis = Chassis {
        start: rigid.velocity,
        start_spin: rigid.spin,
        velocity: rigid.velocity + (gravity + rigid.force * rigid.inverse_mass) * dt,
        spin: rigid.spin + rigid.inverse_inertia * rigid.torque * dt,
        inverse_mass: rigid.inverse_mass,
        inverse_inertia: rigid.inverse_inertia,
    };
    let grounded = found.iter().filter(|f| f.contact.is_some()).count();
    let height = outside::height(&rigid, axes.up, &found);
    let outside =
        outside::outside_forces(s, config, &rigid, &axes, &asked, speed, grounded, height);
    chassis.velocity += outside.force * rigid.inverse_mass * dt;
    chassis.spin += rigid.inverse_inertia * outside.torque * dt;

    let mut grounds: ArrayVec<GroundBody, MOST_WHEELS> = ArrayVec::new();
    let mut contacts: ArrayVec<Contact, MOST_WHEELS> = ArrayVec::new();
    contacts::build(
        s,
        config,
        state,
        report,
        &rigid,
        &found,
        &mut grounds,
        &mut contacts,
    );

    scratch.spin.clear();
    let brakes = brakes::brakes(
        s,
        config,
        state,
        telemetry,
        &asked,
        &rigid,
        &axes,
        &found,
        speed,
        report.ground_spin,
    );
    let line = driveline::build(
        s,
        config,
        state,
        report,
        telemetry,
        &asked,
        &found,
        &brakes,
        speed,
        rigid.mass * gravity.dot(axes.forward),
        &mut scratch.spin,
    );
    let mut problem = Problem {
        dt,
        theta: s.view.end_share(),
        chassis,
        grounds: &mut grounds,
        contacts: &mut contacts,
        spin: &mut scratch.spin,
    };
    let sweeps = problem.solve();
    telemetry.sweeps = sweeps;
    let chassis = problem.chassis;
    finish::finish(
        s,
        state,
        telemetry,
        report,
        finish::Solved {
            rigid: &rigid,
            axes: &axes,
            found: &found,
            chassis: &chassis,
            grounds: &grounds,
            contacts: &contacts,
            spin: &scratch.spin,
            line: &line,
            outside: &outside,
            brakes: &brakes,
        },
    );
}

impl VehicleReport {
    /// Finds the mass that rests on each wheel, when masses or wheels changed.
    fn refresh_shares(&mut self, s: &Surroundings, rigid: &Rigid) {
        let center = rigid.rotation.inverse() * (rigid.center - rigid.position);
        let key = (rigid.mass, center, s.wheels.len());
        if self.shares_key == Some(key) && !self.reshare {
            return;
        }
        self.shares_key = Some(key);
        self.reshare = false;
        self.shares.clear();
        self.shares
            .extend(shares::shares(rigid.mass, center, &s.wheels));
    }
}
