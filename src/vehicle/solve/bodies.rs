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
    pub fn push(&mut self, impulse: Vec3, arm: Vec3) {
        self.velocity += impulse * self.inverse_mass;
        self.spin += self.inverse_inertia * arm.cross(impulse);
    }
}

/// A dynamic body under wheels: how the tick's impulses change it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundBody {
    pub entity: Entity,
    /// Change of velocity against the ground's at the start of the tick. Begins with the last tick's
    /// wheel forces taken back: what else holds the body (a floor, joints) is assumed to act as it
    /// did, so that a body on a floor is not taken for something that gives way.
    pub velocity: Vec3,
    pub spin: Vec3,
    /// Kilograms.
    pub mass: f32,
    /// Along the world's axes, 1/kg.
    pub inverse_mass: Vec3,
    pub inverse_inertia: Mat3,
}

impl GroundBody {
    pub fn push(&mut self, impulse: Vec3, arm: Vec3) {
        self.velocity += impulse * self.inverse_mass;
        self.spin += self.inverse_inertia * arm.cross(impulse);
    }
}

impl Contact<'_> {
    /// Velocity of the chassis against the ground at the contact, with all impulses so far.
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
            sum += (from * body.inverse_mass).dot(to) + other_arm.cross(to).dot(turned);
        }
        sum
    }
}
