//! The rigid bodies of a vehicle's tick, as velocities that take up impulses.

use bevy::prelude::*;

use super::Contact;

/// The vehicle's own body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chassis {
    /// At the start of the tick, at the centre of mass.
    pub start: Vec3,
    pub start_spin: Vec3,
    /// With all impulses of the tick so far, gravity included.
    pub velocity: Vec3,
    pub spin: Vec3,
    /// Along the world's axes, 1/kg.
    pub inverse_mass: Vec3,
    /// World axes, 1/(kg·m²).
    pub inverse_inertia: Mat3,
}

impl Chassis {
    #[inline(always)]
    pub fn push(&mut self, impulse: Vec3, arm: Vec3) {
        self.velocity += impulse * self.inverse_mass;
        self.spin += self.inverse_inertia * arm.cross(impulse);
    }
}

/// Change of velocity that a push must be good for, alone, to tell whether a floor holds against it, metres
/// per second.
const TELLING: f32 = 0.02;
/// Friction of floors, as far as it is taken for granted, dimensionless.
const FRICTION: f32 = 0.5;

/// A dynamic body under wheels: how the tick's impulses change it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundBody {
    pub entity: Entity,
    /// Change of velocity against the ground's at the start of the tick.
    pub velocity: Vec3,
    pub spin: Vec3,
    /// Kilograms.
    pub mass: f32,
    /// Part of the speed with which a wheel is pushed out of the ground that it can stand, `0..=1`.
    pub withstands: f32,
    /// As far as it gives way: world axes, 1/kg and 1/(kg·m²).
    pub inverse_mass: Mat3,
    pub inverse_inertia: Mat3,
    /// Normal of the floor that it lies flat on, whose friction answers within the tick.
    pub flat_on: Option<Vec3>,
    /// Impulse and turning impulse of the wheels in the last tick.
    pub pushed: Vec3,
    pub turned: Vec3,
}

impl GroundBody {
    #[inline(always)]
    pub fn push(&mut self, impulse: Vec3, arm: Vec3) {
        self.velocity += self.inverse_mass * impulse;
        self.spin += self.inverse_inertia * arm.cross(impulse);
    }

    /// Begins with what will act on it besides the wheels. That is not known here: floors, joints and
    /// other vehicles answer the wheels as they will. It is taken from the last tick: `moved` is by how
    /// much that tick changed the body's velocity, `fall` what gravity gives it in a tick. As far as the
    /// wheels' push and gravity show up in it, the body is free; as far as they do not, others take
    /// them up, and go on to: joints and other vehicles as much as in the last tick, a floor by its
    /// friction the same part of whatever comes. Were that left out, the tyre on a light plate would press
    /// against the plate's own mass, and come to the force that holds the wheel only after many ticks.
    pub fn begin(&mut self, moved: Vec3, fall: Vec3) {
        // Along what cannot give way nothing shows.
        let gives = self.inverse_mass * self.mass;
        let alone = self.inverse_mass * self.pushed + gives * fall;
        let size = alone.length_squared();
        let free = if size > 1.0e-12 {
            (moved.dot(alone) / size).clamp(0.0, 1.0)
        } else {
            0.0
        };
        // Beyond the friction of the floor it slides.
        let held = self.flat_on.is_some_and(|normal| {
            let press = -self.pushed.dot(normal);
            self.pushed.reject_from_normalized(normal).length() < FRICTION * press
        });
        if held && size > TELLING * TELLING {
            self.inverse_mass *= free;
            self.inverse_inertia *= free;
            self.velocity = gives * fall * free;
            self.spin = Vec3::ZERO;
            return;
        }
        self.velocity = gives * fall * free - self.inverse_mass * self.pushed * (1.0 - free);
        self.spin = self.inverse_inertia * self.turned * (free - 1.0);
    }
}

impl Contact<'_> {
    /// Velocity of the chassis against the ground at the contact, with all impulses so far.
    #[inline(always)]
    pub fn velocity(&self, chassis: &Chassis, grounds: &[GroundBody]) -> Vec3 {
        let own = chassis.velocity + chassis.spin.cross(self.arm) - self.ground_end;
        match self.ground {
            Some((index, arm)) => {
                let body = &grounds[index];
                own - body.velocity - body.spin.cross(arm)
            }
            None => own,
        }
    }

    /// The same at the start of the tick.
    pub fn start_velocity(&self, chassis: &Chassis) -> Vec3 {
        chassis.start + chassis.start_spin.cross(self.arm) - self.ground_start
    }

    /// Applies an impulse to the chassis and its opposite to the ground.
    #[inline(always)]
    pub fn push_both(&self, impulse: Vec3, chassis: &mut Chassis, grounds: &mut [GroundBody]) {
        chassis.push(impulse, self.arm);
        if let Some((index, arm)) = self.ground {
            grounds[index].push(-impulse, arm);
        }
    }

    /// Velocity along `to` at `other` for each newton-second along `from` at this contact, 1/kg.
    pub fn mobility(
        &self,
        from: Vec3,
        other: &Contact,
        to: Vec3,
        chassis: &Chassis,
        grounds: &[GroundBody],
    ) -> f32 {
        let turned = chassis.inverse_inertia * self.arm.cross(from);
        let mut sum = (from * chassis.inverse_mass).dot(to) + other.arm.cross(to).dot(turned);
        if let (Some((a, arm)), Some((b, other_arm))) = (self.ground, other.ground)
            && a == b
        {
            let body = &grounds[a];
            let turned = body.inverse_inertia * arm.cross(from);
            sum += (body.inverse_mass * from).dot(to) + other_arm.cross(to).dot(turned);
        }
        sum
    }
}
