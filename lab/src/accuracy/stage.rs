//! One car of either side on a scene of its own.

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;
use embody_scenes::{
    Sim,
    reference::{Car, HEIGHT, MASS, Plan, RADIUS, plane},
};

use crate::{
    peer::{Peer, peer, update_controllers},
    side::Side,
};

/// Force of the brakes of a wheel, as torque over radius, newtons: far more than the tyres hold.
const BRAKE: f32 = 40_000.0 / 4.0 / RADIUS;

pub struct Stage {
    pub sim: Sim,
    hz: f64,
    side: Side,
    car: Option<Car>,
    body: Entity,
    force: f32,
    max_angle: f32,
}

impl Stage {
    pub fn new(hz: f64, side: Side) -> Self {
        let plugin = move |app: &mut App| match side {
            Side::Ours => {
                app.add_plugins(VehiclePlugin);
            }
            Side::Rapier => {
                app.add_systems(
                    FixedPostUpdate,
                    update_controllers
                        .after(PhysicsSet::SyncBackend)
                        .before(PhysicsSet::StepSimulation),
                );
            }
        };
        Self {
            sim: Sim::with(hz, (EmbodyCorePlugin, plugin)),
            hz,
            side,
            car: None,
            body: Entity::PLACEHOLDER,
            force: 0.0,
            max_angle: 1.0,
        }
    }

    /// Puts a car here that never sleeps; `force` in newtons is what full throttle gives its driven
    /// wheels together.
    pub fn spawn(&mut self, plan: &Plan, force: f32, at: Transform) {
        self.force = force;
        self.max_angle = plan.vehicle.steering.max_angle;
        match self.side {
            Side::Ours => {
                let car = plan.spawn(&mut self.sim, at);
                self.body = car.body;
                self.car = Some(car);
            }
            Side::Rapier => {
                let body = peer(&plan.mass, plan.hull.clone(), &plan.wheels);
                self.body = self.sim.spawn((body, Sleeping::disabled(), at));
            }
        }
        self.sim.ticks(1);
    }

    /// A plane with a car at rest on it, both turned.
    pub fn park(&mut self, plan: &Plan, force: f32, rotation: Quat) {
        plane(&mut self.sim, rotation);
        let up = rotation * Vec3::Y;
        let at = Transform::from_translation(up * HEIGHT).with_rotation(rotation);
        self.spawn(plan, force, at);
    }

    /// Throttle and brake from 0 to 1, angle of the front wheels in radians to the right.
    pub fn ask(&mut self, throttle: f32, brake: f32, angle: f32) {
        let (force, max_angle, dt) = (self.force, self.max_angle, self.sim.dt());
        let world = self.sim.app.world_mut();
        if let Some(mut intent) = world.get_mut::<VehicleIntent>(self.body) {
            intent.throttle = throttle;
            intent.brake = brake;
            intent.steer = angle / max_angle;
        }
        if let Some(mut peer) = world.get_mut::<Peer>(self.body) {
            peer.ask(angle, throttle * force, brake * BRAKE * dt);
        }
    }

    /// Sets the car in motion, wheels rolling along.
    pub fn roll(&mut self, velocity: Vec3) {
        match &self.car {
            Some(car) => car.clone().roll(&mut self.sim, velocity),
            None => self.push(velocity),
        }
    }

    /// Sets the car's velocity, its wheels left as they turn.
    pub fn push(&mut self, velocity: Vec3) {
        let world = self.sim.app.world_mut();
        if let Some(mut now) = world.get_mut::<Velocity>(self.body) {
            now.linear = velocity;
        }
    }

    /// Adds components to the car.
    pub fn equip(&mut self, bundle: impl Bundle) {
        self.sim
            .app
            .world_mut()
            .entity_mut(self.body)
            .insert(bundle);
    }

    /// The car, if it is ours.
    pub fn own(&self) -> Option<Car> {
        self.car.clone()
    }

    /// Moment of inertia of each wheel: Rapier's have none.
    pub fn wheel_inertia(&self) -> f64 {
        match self.side {
            Side::Ours => 1.0,
            Side::Rapier => 0.0,
        }
    }

    pub fn is_ours(&self) -> bool {
        self.side == Side::Ours
    }

    /// Ticks per second.
    pub fn hz(&self) -> f64 {
        self.hz
    }

    /// The same stage, empty, at another tick rate.
    pub fn again(&self, hz: f64) -> Self {
        Self::new(hz, self.side)
    }

    pub fn velocity(&self) -> Velocity {
        self.sim.get::<Velocity>(self.body)
    }

    pub fn pose(&self) -> Transform {
        self.sim.get::<Transform>(self.body)
    }

    /// Level speed, metres per second.
    pub fn speed(&self) -> f64 {
        f64::from(self.velocity().linear.with_y(0.0).length())
    }

    /// Force of each spring along the normal, newtons.
    pub fn loads(&self) -> Vec<f64> {
        let loads = match &self.car {
            Some(car) => car.loads(&self.sim),
            None => self.of_peer(|wheel| wheel.wheel_suspension_force),
        };
        loads.into_iter().map(f64::from).collect()
    }

    /// Compression of each spring from droop, metres.
    pub fn compressions(&self) -> Vec<f64> {
        let all = match &self.car {
            Some(car) => car.all(&self.sim).iter().map(|w| w.compression).collect(),
            None => self.of_peer(|wheel| {
                wheel.suspension_rest_length - wheel.raycast_info().suspension_length
            }),
        };
        all.into_iter().map(f64::from).collect()
    }

    /// Force of each tyre along its ground, in parts of its load.
    pub fn grips(&self) -> Vec<f64> {
        let dt = self.sim.dt();
        let grips = match &self.car {
            Some(car) => car
                .all(&self.sim)
                .iter()
                .map(|w| w.force.length() / w.load.max(1.0))
                .collect(),
            None => self.of_peer(|wheel| {
                let impulse = Vec2::new(wheel.forward_impulse, wheel.side_impulse);
                impulse.length() / (wheel.wheel_suspension_force * dt).max(1.0)
            }),
        };
        grips.into_iter().map(f64::from).collect()
    }

    fn of_peer(&self, read: impl Fn(&bevy_rapier3d::rapier::control::Wheel) -> f32) -> Vec<f32> {
        let peer = self.sim.app.world().get::<Peer>(self.body);
        let controller = peer.and_then(|peer| peer.controller.as_ref());
        controller.map_or_else(Vec::new, |c| c.wheels().iter().map(read).collect())
    }

    /// How long it takes, seconds, until something holds; infinite after `most` seconds.
    pub fn time_until(&mut self, most: f64, holds: impl Fn(&Self) -> bool) -> f64 {
        let dt = f64::from(self.sim.dt());
        let mut t = 0.0;
        while t < most {
            self.sim.ticks(1);
            t += dt;
            if holds(self) {
                return t;
            }
        }
        f64::INFINITY
    }

    /// Momentum of the car, kilogram-metres per second.
    pub fn momentum(&self) -> Vec3 {
        self.velocity().linear * MASS
    }
}
