//! The one coupled solve per vehicle and tick.
//!
//! Unknown are the impulses of the tick: the normal one of each wheel, its tyre's two, and those of
//! every friction row of the drivetrain (brakes, clutch, differentials). Known is what the velocities
//! would be without them, gravity of this very tick included. The equations:
//!
//! - **normals** ([`normal`]): spring, damper, anti-roll bar and stop are linear in the velocity that
//!   they lead to ([`super::suspension`]); all wheels together are one symmetric system, solved
//!   directly. Wheels that would pull are left out.
//! - **spins** ([`spin`]): wheels and engine with brakes, clutch and differentials; a dense inverse,
//!   built by one rank-one update for each row that holds. A row that would need more than it can
//!   gives all it has instead.
//! - **tyres** ([`tires`]): each wheel's two impulses by a secant of its curve, on the friction
//!   ellipse, implicitly in slip and carcass.
//!
//! Sweeps over the three begin with the last tick's impulses and repeat until none changes by more than
//! 3e-5 of the wheel's load, at most [`MOST_SWEEPS`] times. Each is implicit, so that no stiffness, friction, brake torque or `dt`
//! makes the tick unstable; a sweep that has not converged is still a valid, passive step. Cost: about
//! `n³ / 6` for the normals, `(n + 1)²` for each row that holds, and `n²` for each sweep.

mod bodies;
mod dense;
mod normal;
mod relaxation;
mod spin;
mod tires;

use bevy::prelude::*;

pub(crate) use bodies::{Chassis, GroundBody};
pub(crate) use spin::{Row, Spin};
pub(crate) use tires::Answer;

use super::{suspension::Law, tire::Patch};

/// The most wheels of a vehicle.
pub(crate) const MOST_WHEELS: usize = 16;
/// Change of an impulse in parts of a wheel's load that ends the sweeps.
const CLOSE: f32 = 3.0e-5;
/// The most sweeps of a tick.
pub(crate) const MOST_SWEEPS: u32 = 24;

/// One wheel on the ground, as the solve sees it.
pub(crate) struct Contact<'a> {
    /// Which wheel.
    pub wheel: usize,
    /// From the chassis' centre of mass to the contact, world axes, metres.
    pub arm: Vec3,
    pub normal: Vec3,
    /// Directions of the tyre on the ground, unit length.
    pub along: Vec3,
    pub across: Vec3,
    /// Cosine between the suspension's axis and the normal.
    pub cosine: f32,
    /// Velocity of the ground at the contact at the start of the tick, and at its end, where the
    /// contact then is.
    pub ground_start: Vec3,
    pub ground_end: Vec3,
    /// By how much the latter is other than it is, to make up for how the step moves bodies.
    pub ground_drift: Vec3,
    /// The dynamic body it stands on, by index, and the arm from that body's centre of mass.
    pub ground: Option<(usize, Vec3)>,
    pub law: Law,
    /// Compression at the start, metres; negative above the ground.
    pub compression: f32,
    /// The wheel at the other side of the axle among the contacts, with the stiffness of the bar.
    pub bar: Option<(usize, f32)>,
    /// Stiffness of a bar whose other wheel hangs in the air, newtons per metre.
    pub lone_bar: f32,
    pub tire: &'a super::tire::Tire,
    /// Friction of the surface.
    pub surface: f32,
    pub radius: f32,
    /// Deflection of the carcass at the start, metres.
    pub bristle: Vec2,
    /// Slip velocity that the turning of the wheel within the tick adds, metres per second.
    pub turn_slip: Vec2,
    /// Slip across that the camber adds, dimensionless.
    pub camber_slip: f32,
    /// Velocity for each newton-second along and across, of chassis and ground, 1/kg.
    pub mobility: Vec2,
    // Found by the solve; they begin as in the last tick.
    /// Impulse along the normal, newton-seconds.
    pub push: f32,
    /// Impulses of the tyre along and across, newton-seconds.
    pub grip: Vec2,
    /// Combined slip velocity, metres per second.
    pub combined: f32,
    /// Speed that the slip is measured against, metres per second.
    pub speed: f32,
    pub patch: Option<Patch<'a>>,
    pub answer: Option<Answer>,
}

/// A vehicle in one tick.
pub(crate) struct Problem<'a, 's> {
    pub dt: f32,
    /// Share of the end velocity in how far the physics step moves a body.
    pub theta: f32,
    pub chassis: Chassis,
    pub grounds: &'s mut [GroundBody],
    pub contacts: &'s mut [Contact<'a>],
    pub spin: &'s mut Spin,
}

impl Problem<'_, '_> {
    /// Finds all impulses; the velocities of chassis, grounds and wheels are those at the end of the
    /// tick. Returns the number of sweeps.
    pub fn solve(&mut self) -> u32 {
        let mut normals = normal::Normals::new(self);
        tires::start(self);
        self.spin.start(self.dt);
        let mut sweeps = 0;
        // Without contacts the spins are all there is.
        while sweeps < MOST_SWEEPS {
            sweeps += 1;
            let mut change = normals.sweep(self, sweeps <= 8);
            change = change.max(tires::sweep(self));
            let switched = self.spin.switch(sweeps <= 12);
            if !switched && change < CLOSE && sweeps > 1 {
                break;
            }
        }
        sweeps
    }
}
