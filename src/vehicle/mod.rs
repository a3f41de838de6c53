//! Vehicles on wheels.
//!
//! A [`Vehicle`] is a dynamic body with [`Wheel`]s tied to it. Each tick every wheel looks for the
//! ground ([`WheelProbe`]), and one coupled implicit solve finds the forces of all suspensions, tyres,
//! brakes and the drivetrain together; gravity of the same tick is part of it. The result goes to the
//! body as a force for the whole tick, which the physics step integrates as it integrates gravity, and
//! its opposite to whatever the wheels stand on.
//!
//! What follows from that: static sag is `g / ω²` to a fraction of a percent at every tick rate; a
//! parked car stays where it is on a slope by the stretch of its tyres, awake or asleep; no stiffness,
//! brake torque or engine makes it unstable at 30 ticks per second.
//!
//! What lies under a wheel gives way as far as nothing else holds it: a crate in the air flies off, the
//! same crate on the floor carries its wheel. A wheel that finds itself in the ground, or under a step
//! that it cannot climb, is pushed out at no more than 3 m/s.
//!
//! Limits: wheels have no mass of their own but for spin and the speed of droop; no gyroscopic
//! torque of wheels; suspension links are straight lines.

mod aero;
mod assists;
mod config;
mod drive;
mod drivetrain;
mod events;
mod intent;
mod measure;
mod output;
mod prepare;
mod present;
mod presets;
mod react;
mod report;
mod solve;
mod state;
mod steering;
mod surface;
mod suspension;
mod tick;
mod tire;
mod validate;
mod wheel;

use bevy::prelude::*;
use bevy_rapier3d::prelude::PhysicsSet;

#[cfg(doc)]
use crate::schedule::EmbodyCorePlugin;
use crate::{
    backend::forces::ForcedBodies, diagnostics::VehicleDiagnostics, schedule::EmbodySystems,
};

pub use aero::Aero;
pub use assists::{AntiLockBrakes, HillHold, LeanControl, StabilityControl, TractionControl};
pub use config::{Brakes, Vehicle, VehicleMass};
pub use drivetrain::{
    Clutch, Differential, DrivenAxle, Drivetrain, ElectricMotor, Engine, Gearbox, PowerSource,
    Shifting, TorquePoint,
};
pub use events::{
    BottomedOut, EngineStalled, GearShifted, SlipEnded, SlipStarted, WheelLanded, WheelLeftGround,
};
pub use intent::{Gear, VehicleIntent};
pub use output::{VehicleTelemetry, WheelContact, WheelState};
pub use presets::VehiclePreset;
pub use state::{GroundPlane, VehicleState, WheelDynamics};
pub use steering::{SteerPoint, Steering};
pub use surface::{RoadVelocity, SurfaceFriction};
pub use suspension::{Damper, SpringRate, Suspension};
pub use tire::{SlipPoint, Tire, TireModel};
pub use wheel::{ProbeInterval, Wheel, WheelOf, WheelProbe, Wheels};

/// Where vehicles work in a tick; each right behind the set of the same name of [`EmbodySystems`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum VehicleSystems {
    /// Configs are checked, masses set.
    Prepare,
    /// Ground is looked for, forces are found and written.
    Drive,
    /// Wheel states and events.
    React,
    /// Wheels are put where they are seen.
    Present,
}

/// Adds vehicles. Needs [`EmbodyCorePlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct VehiclePlugin;

impl Plugin for VehiclePlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Vehicle>()
            .register_type::<VehicleMass>()
            .register_type::<VehicleIntent>()
            .register_type::<VehicleState>()
            .register_type::<VehicleTelemetry>()
            .register_type::<Wheel>()
            .register_type::<WheelOf>()
            .register_type::<Wheels>()
            .register_type::<WheelState>()
            .register_type::<SurfaceFriction>()
            .register_type::<RoadVelocity>()
            .register_type::<AntiLockBrakes>()
            .register_type::<TractionControl>()
            .register_type::<StabilityControl>()
            .register_type::<HillHold>()
            .register_type::<LeanControl>()
            .register_type::<ProbeInterval>()
            .init_resource::<ForcedBodies>()
            .init_resource::<measure::Stopwatch>()
            .configure_sets(
                FixedPostUpdate,
                (
                    VehicleSystems::Prepare
                        .after(EmbodySystems::Prepare)
                        .before(PhysicsSet::SyncBackend),
                    VehicleSystems::Drive
                        .after(EmbodySystems::Drive)
                        .before(PhysicsSet::StepSimulation),
                    VehicleSystems::React.after(EmbodySystems::React),
                ),
            )
            .configure_sets(
                PostUpdate,
                VehicleSystems::Present
                    .after(EmbodySystems::Present)
                    .before(TransformSystems::Propagate),
            )
            .add_systems(
                FixedPostUpdate,
                (
                    (
                        prepare::check_configs,
                        prepare::check_helpers,
                        prepare::check_surfaces,
                        prepare::set_masses,
                        prepare::unset_masses,
                    )
                        .chain()
                        .in_set(VehicleSystems::Prepare),
                    (
                        measure::start.run_if(resource_exists::<VehicleDiagnostics>),
                        drive::admit_new,
                        drive::solve_vehicles,
                        drive::apply_forces,
                        measure::stop.run_if(resource_exists::<VehicleDiagnostics>),
                    )
                        .chain()
                        .in_set(VehicleSystems::Drive),
                    (
                        react::write_wheels,
                        present::remember,
                        react::trigger_events,
                    )
                        .chain()
                        .in_set(VehicleSystems::React),
                )
                    .run_if(any_with_component::<Vehicle>),
            )
            .add_observer(drive::let_fall::<Vehicle>)
            .add_observer(drive::let_fall::<Wheels>)
            // Also when the last vehicle is gone.
            .add_systems(
                FixedPostUpdate,
                drive::end_forces
                    .after(PhysicsSet::SyncBackend)
                    .before(EmbodySystems::Drive),
            )
            .add_systems(
                PostUpdate,
                present::show
                    .in_set(VehicleSystems::Present)
                    .run_if(any_with_component::<Wheel>),
            );
    }
}
