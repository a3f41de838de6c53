//! What a tick decided about a vehicle, on its way from the solver to the physics world and to the
//! events. Lives within one tick, but for a few things that save work in the next.

use arrayvec::ArrayVec;
use bevy::prelude::*;

use crate::backend::probe::WheelMemory;

use super::{drivetrain::Shift, output::WheelState, solve::MOST_WHEELS};

/// After this many ticks a vehicle whose body wheels cannot carry is named in a warning: what is
/// spawned piece by piece has its pieces by then.
pub(crate) const UNFIT_TICKS: u8 = 4;

/// The decisions of one tick.
#[derive(Component)]
pub(crate) struct VehicleReport {
    /// Whether the config is one that can work.
    pub valid: bool,
    /// Whether the vehicle was solved this tick.
    pub solved: bool,
    pub asleep: bool,
    /// Whether it is a body without wheels for now.
    pub bare: bool,
    /// Whether something about the vehicle changed that a sleeper has to look at.
    pub changed: bool,
    /// Ticks for which the body was none that wheels can carry, at most [`UNFIT_TICKS`].
    pub unfit: u8,
    /// Whether its body has to wake up although nothing is solved.
    pub wake: bool,
    /// The wheels of the tick, in the order of everything else here.
    pub wheels: ArrayVec<Entity, MOST_WHEELS>,
    /// On the chassis, about its centre of mass, newtons and newton-metres.
    pub force: Vec3,
    pub torque: Vec3,
    /// On dynamic bodies under the wheels.
    pub pushes: ArrayVec<GroundPush, MOST_WHEELS>,
    pub ground_bodies: [Option<Entity>; MOST_WHEELS],
    pub ground_velocities: [Vec3; MOST_WHEELS],
    /// Velocities of the dynamic bodies under the wheels, at their centres of mass.
    pub ground_speeds: [Vec3; MOST_WHEELS],
    /// How the ground under the wheels turns, their mean, world axes, radians per second.
    pub ground_spin: Vec3,
    pub outputs: ArrayVec<WheelState, MOST_WHEELS>,
    pub events: ArrayVec<(usize, WheelEvent), 64>,
    pub shift: Option<Shift>,
    pub stalled: bool,
    /// Static share of the mass on each wheel, kilograms, and what it was found for.
    pub shares: ArrayVec<f32, MOST_WHEELS>,
    pub shares_key: Option<(f32, Vec3, usize)>,
    pub reshare: bool,
    /// The ground near its wheels.
    pub meshes: WheelMemory,
}

impl Default for VehicleReport {
    fn default() -> Self {
        Self {
            valid: false,
            solved: false,
            asleep: false,
            bare: false,
            changed: true,
            unfit: 0,
            wake: false,
            wheels: ArrayVec::new(),
            force: Vec3::ZERO,
            torque: Vec3::ZERO,
            pushes: ArrayVec::new(),
            ground_bodies: [None; MOST_WHEELS],
            ground_velocities: [Vec3::ZERO; MOST_WHEELS],
            ground_speeds: [Vec3::ZERO; MOST_WHEELS],
            ground_spin: Vec3::ZERO,
            outputs: ArrayVec::new(),
            events: ArrayVec::new(),
            shift: None,
            stalled: false,
            shares: ArrayVec::new(),
            shares_key: None,
            reshare: true,
            meshes: WheelMemory::default(),
        }
    }
}

impl VehicleReport {
    /// Forgets the last tick.
    pub fn clear(&mut self) {
        self.solved = false;
        self.asleep = false;
        self.bare = false;
        self.force = Vec3::ZERO;
        self.torque = Vec3::ZERO;
        self.pushes.clear();
        self.events.clear();
        self.shift = None;
        self.stalled = false;
        self.ground_bodies = [None; MOST_WHEELS];
        self.ground_spin = Vec3::ZERO;
    }
}

/// The opposite of a wheel's force, on what it stands on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundPush {
    pub body: Entity,
    /// Newtons, world axes.
    pub force: Vec3,
    /// World, metres.
    pub point: Vec3,
    /// Whether a sleeping body wakes up by it.
    pub wake: bool,
}

/// Something that happened to a wheel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum WheelEvent {
    /// On this collider, with this speed, after this time in the air.
    Landed(Entity, f32, f32),
    LeftGround,
    /// With this force.
    BottomedOut(f32),
    /// With this speed.
    SlipStarted(f32),
    SlipEnded,
}
