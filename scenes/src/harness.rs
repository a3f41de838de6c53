//! A headless world that runs one tick at a time.

use std::time::Duration;

use bevy::{
    app::Plugins,
    ecs::schedule::{MultiThreadedExecutor, Schedules, SingleThreadedExecutor},
    prelude::*,
    time::TimeUpdateStrategy,
};
use bevy_embody::prelude::*;
use bevy_rapier3d::prelude::*;

/// Runs these systems before and after all that systems in three sets do in a tick: one before Rapier
/// takes over changes, one between that and its step, one after its results are written back.
pub fn around_tick<S, B, E, M, N>(app: &mut App, [prepare, drive, react]: [S; 3], begin: B, end: E)
where
    S: SystemSet + Copy,
    B: IntoSystem<(), (), M> + Copy + 'static,
    E: IntoSystem<(), (), N> + Copy + 'static,
    M: 'static,
    N: 'static,
{
    app.add_systems(
        FixedPostUpdate,
        (
            begin.before(prepare),
            end.after(prepare).before(PhysicsSet::SyncBackend),
            begin
                .after(PhysicsSet::SyncBackend)
                .before(EmbodySystems::Drive),
            end.after(drive).before(PhysicsSet::StepSimulation),
            begin.after(PhysicsSet::Writeback).before(react),
            end.after(react),
        ),
    );
}

/// A headless app with `bevy_embody` in it.
pub struct Sim {
    /// The app, ready to run.
    pub app: App,
    hz: f64,
}

impl Sim {
    /// An empty world under 9.81 m/s² that ticks at `hz`.
    ///
    /// Without interpolation, so that a `Transform` read between ticks is the exact pose, and
    /// [in line](Self::in_line).
    pub fn new(hz: f64) -> Self {
        Self::threaded(hz).in_line()
    }

    /// The same with systems of every schedule run by Bevy's own executor, on threads where the build
    /// has them.
    pub fn threaded(hz: f64) -> Self {
        let plugins = EmbodyPlugins.build().disable::<EmbodyInterpolationPlugin>();
        let mut sim = Self::with(hz, plugins);
        sim.app.edit_schedule(FixedPostUpdate, |schedule| {
            schedule.set_executor(MultiThreadedExecutor::new());
        });
        sim
    }

    /// An empty world with these plugins beside Bevy's minimal ones.
    pub fn with<M>(hz: f64, plugins: impl Plugins<M>) -> Self {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, TransformPlugin))
            .insert_resource(Time::<Fixed>::from_hz(hz))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1))
            .add_plugins(plugins);
        app.finish();
        app.cleanup();
        // The first update only sets the clock.
        app.update();
        Self { app, hz }
    }

    /// Runs one system after the other. In a small world the executor with threads spends most of
    /// the time on handing over between systems; what comes out is the same.
    pub fn in_line(mut self) -> Self {
        let mut schedules = self.app.world_mut().resource_mut::<Schedules>();
        for (_, schedule) in schedules.iter_mut() {
            schedule.set_executor(SingleThreadedExecutor::new());
        }
        self
    }

    /// Length of a tick, seconds.
    pub fn dt(&self) -> f32 {
        (1.0 / self.hz) as f32
    }

    /// Runs `n` ticks.
    pub fn ticks(&mut self, n: usize) {
        for _ in 0..n {
            self.app.update();
        }
    }

    /// Runs for this time, seconds, rounded to whole ticks.
    pub fn seconds(&mut self, t: f64) {
        self.ticks((t * self.hz).round() as usize);
    }

    /// Changes the tick rate from the next tick on.
    pub fn set_hz(&mut self, hz: f64) {
        self.hz = hz;
        self.app
            .world_mut()
            .resource_mut::<Time<Fixed>>()
            .set_timestep(Duration::from_secs_f64(1.0 / hz));
    }

    /// Spawns any bundle.
    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    /// Spawns a character with its foot at this point.
    pub fn character(&mut self, character: Character, foot: Vec3) -> Entity {
        self.spawn((character, Transform::from_translation(foot)))
    }

    /// Spawns a fixed collider.
    pub fn fixed(&mut self, collider: Collider, at: Transform) -> Entity {
        self.spawn((RigidBody::Fixed, collider, at))
    }

    /// Spawns a fixed box by its centre and full size, metres.
    pub fn block(&mut self, center: Vec3, size: Vec3) -> Entity {
        let half = size * 0.5;
        self.fixed(
            Collider::cuboid(half.x, half.y, half.z),
            Transform::from_translation(center),
        )
    }

    /// Spawns a large level floor with its top at `y`.
    pub fn floor(&mut self, y: f32) -> Entity {
        self.block(Vec3::new(0.0, y - 0.5, 0.0), Vec3::new(400.0, 1.0, 400.0))
    }

    /// Spawns a position-driven kinematic body; move it by writing its `Transform` in
    /// `FixedUpdate` or between ticks.
    pub fn kinematic(&mut self, collider: Collider, at: Transform) -> Entity {
        self.spawn((RigidBody::KinematicPositionBased, collider, at))
    }

    /// Spawns a dynamic body of this mass, kilograms.
    pub fn dynamic(&mut self, collider: Collider, at: Transform, mass: f32) -> Entity {
        self.spawn((
            RigidBody::Dynamic,
            collider,
            ColliderMassProperties::Mass(mass),
            Velocity::default(),
            at,
        ))
    }

    /// Asks a character to move in this direction (length is the fraction of full speed).
    pub fn walk(&mut self, character: Entity, movement: Vec3) {
        self.intent(character, |intent| intent.movement = movement);
    }

    /// Changes a character's intent.
    pub fn intent(&mut self, character: Entity, change: impl FnOnce(&mut CharacterIntent)) {
        if let Some(mut intent) = self.app.world_mut().get_mut::<CharacterIntent>(character) {
            change(&mut intent);
        }
    }

    /// Where an entity is, metres; a character's foot.
    pub fn position(&self, entity: Entity) -> Vec3 {
        self.get::<Transform>(entity).translation
    }

    /// A character's state.
    pub fn state(&self, character: Entity) -> CharacterState {
        self.get::<CharacterState>(character)
    }

    /// A copy of a component.
    ///
    /// # Panics
    /// When the entity does not have it: a broken scene should stop its test.
    pub fn get<C: Component + Clone>(&self, entity: Entity) -> C {
        match self.app.world().get::<C>(entity) {
            Some(component) => component.clone(),
            None => panic!("{entity} has no {}", core::any::type_name::<C>()),
        }
    }

    /// Sets the position of an entity before the next tick.
    pub fn place(&mut self, entity: Entity, position: Vec3) {
        if let Some(mut transform) = self.app.world_mut().get_mut::<Transform>(entity) {
            transform.translation = position;
        }
    }
}
