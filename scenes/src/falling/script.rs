//! Who takes part in a station, and what is done to them.

use core::fmt;

use bevy::prelude::*;
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

use super::stage::{WOOD, paint};
use crate::{
    course::layout::Place,
    driving::{Figures, spawn_vehicle},
    figures::{Gait, Human},
};

/// Who takes part.
#[derive(Clone, Debug, Default)]
pub struct Crew {
    /// Humans.
    pub figures: Vec<Entity>,
    /// Crates.
    pub props: Vec<Entity>,
    /// A vehicle.
    pub car: Option<Entity>,
}

/// The crew in its world, in the axes of the station.
pub struct Scene<'a> {
    /// The world.
    pub world: &'a mut World,
    /// The axes.
    pub place: Place,
    /// Who takes part.
    pub crew: &'a mut Crew,
}

impl Scene<'_> {
    fn pose(&self, local: Transform) -> Transform {
        let at = self.place.transform(local.translation);
        at.with_rotation(at.rotation * local.rotation)
    }

    /// A human who is a ragdoll and nothing else.
    pub fn doll(&mut self, at: Transform, mode: RagdollMode, ragdoll: Ragdoll) -> Entity {
        let skin = RagdollFromSkin {
            ragdoll,
            ..default()
        };
        let intent = RagdollIntent { mode, ..default() };
        let at = self.pose(at);
        let doll = self.world.spawn((Human, skin, intent, at)).id();
        self.crew.figures.push(doll);
        doll
    }

    /// A human who walks, falls and gets up.
    pub fn person(&mut self, at: Transform, falls: CharacterRagdoll) -> Entity {
        let mode = falls.upright;
        let person = self.doll(at, mode, Ragdoll::default());
        let motor = CharacterMotor {
            turn_rate: Some(8.0),
            ..default()
        };
        self.world.entity_mut(person).insert((
            Character {
                mass: 75.0,
                ..default()
            },
            motor,
            falls,
            HitReaction::default(),
        ));
        person
    }

    /// A crate of this size and mass, as fast as this.
    pub fn crate_(&mut self, at: Vec3, size: f32, mass: f32, velocity: Vec3) -> Entity {
        let at = self.place.transform(at);
        let linear = self.place.direction(velocity);
        let half = 0.5 * size;
        let crate_ = self
            .world
            .spawn((
                RigidBody::Dynamic,
                Collider::cuboid(half, half, half),
                ColliderMassProperties::Mass(mass),
                Velocity {
                    linear,
                    angular: 0.6 * linear.yzx(),
                },
                ReadMassProperties::default(),
                Interpolated,
                Visibility::default(),
                at,
            ))
            .id();
        paint(
            self.world,
            crate_,
            Cuboid::from_size(Vec3::splat(size)),
            WOOD,
        );
        self.crew.props.push(crate_);
        crate_
    }

    /// A vehicle of this name.
    pub fn car(&mut self, name: &str, at: Transform) {
        let all = Figures::all();
        let Some(figures) = all.iter().find(|figures| figures.name == name) else {
            return;
        };
        let at = self.pose(at);
        let car = spawn_vehicle(&mut self.world.commands(), figures, at);
        self.world.flush();
        self.world
            .entity_mut(car)
            .insert((Visibility::default(), Interpolated));
        #[cfg(feature = "window")]
        self.world
            .entity_mut(car)
            .insert(crate::shell::ModelOf(figures.name));
        self.crew.car = Some(car);
    }

    /// A figure by its number.
    pub fn figure(&self, number: usize) -> Entity {
        let figure = self.crew.figures.get(number).copied();
        figure.unwrap_or(Entity::PLACEHOLDER)
    }

    /// A bone of a figure by its name.
    pub fn bone(&self, figure: usize, name: &str) -> Option<Entity> {
        let bones = self.world.get::<Bones>(self.figure(figure))?;
        let named = |bone: &Entity| self.world.get::<Name>(*bone).is_some_and(|n| **n == *name);
        bones.iter().find(named)
    }

    /// Hits the middle of a bone with this impulse, newton-seconds.
    pub fn hit(&mut self, figure: usize, name: &str, impulse: Vec3) {
        let Some(bone) = self.bone(figure, name) else {
            return;
        };
        let Some(at) = self.world.get::<Transform>(bone) else {
            return;
        };
        let center = match self.world.get::<AdditionalMassProperties>(bone) {
            Some(AdditionalMassProperties::MassProperties(p)) => p.local_center_of_mass,
            _ => Vec3::ZERO,
        };
        let point = at.transform_point(center);
        let impulse = self.place.direction(impulse);
        self.world.commands().hit(bone, point, impulse);
        self.world.flush();
    }

    /// Lets a person fall.
    pub fn fall(&mut self, figure: usize) {
        let person = self.figure(figure);
        self.world.commands().become_ragdoll(person);
        self.world.flush();
    }

    /// Asks a person to go this way; the length is the part of full speed.
    pub fn walk(&mut self, figure: usize, movement: Vec3, sprint: bool) {
        let person = self.figure(figure);
        let movement = self.place.direction(movement);
        if let Some(mut intent) = self.world.get_mut::<CharacterIntent>(person) {
            (intent.movement, intent.sprint) = (movement, sprint);
        }
    }

    /// Changes a component of a figure.
    pub fn edit<C: Component<Mutability = bevy::ecs::component::Mutable>>(
        &mut self,
        figure: usize,
        change: impl FnOnce(&mut C),
    ) {
        let figure = self.figure(figure);
        if let Some(mut component) = self.world.get_mut::<C>(figure) {
            change(&mut component);
        }
    }

    /// Puts a figure that is no character somewhere in this tick, its legs as fast as this.
    pub fn put(&mut self, figure: usize, at: Transform, speed: f32) {
        let at = self.pose(at);
        self.edit::<Transform>(figure, |transform| *transform = at);
        self.edit::<Gait>(figure, |gait| gait.0 = speed);
    }
}

/// A part of a script.
pub struct FallStep {
    /// What is done.
    pub describe: String,
    /// For how long, seconds.
    pub seconds: f32,
    act: Box<dyn Fn(&mut Scene, f32) + Send + Sync>,
}

impl fmt::Debug for FallStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FallStep")
            .field("describe", &self.describe)
            .field("seconds", &self.seconds)
            .finish_non_exhaustive()
    }
}

impl FallStep {
    /// Lets time pass.
    pub fn wait(describe: &str, seconds: f32) -> Self {
        Self::each(describe, seconds, |_, _| {})
    }

    /// Does something at the beginning, then lets time pass.
    pub fn once(
        describe: &str,
        seconds: f32,
        act: impl Fn(&mut Scene) + Send + Sync + 'static,
    ) -> Self {
        Self::each(describe, seconds, move |scene, time| {
            if time <= 0.0 {
                act(scene);
            }
        })
    }

    /// Does something before each tick; it is told the time since the beginning, seconds.
    pub fn each(
        describe: &str,
        seconds: f32,
        act: impl Fn(&mut Scene, f32) + Send + Sync + 'static,
    ) -> Self {
        Self {
            describe: describe.into(),
            seconds,
            act: Box::new(act),
        }
    }

    /// Does it.
    pub fn act(&self, scene: &mut Scene, time: f32) {
        (self.act)(scene, time);
    }
}
