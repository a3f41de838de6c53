//! What a tick found out about a vehicle; rebuilt each tick, never read back by the solver.

use bevy::prelude::*;

/// What a vehicle did in the last tick.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct VehicleTelemetry {
    /// Speed along its front against the ground that it stands or last stood on, metres per second,
    /// negative backward.
    pub speed: f32,
    /// Engine speed, revolutions per minute.
    pub rpm: f32,
    /// Torque of the engine, newton-metres.
    pub engine_torque: f32,
    /// Gear: −1 reverse, 0 neutral, from 1 on forward.
    pub gear: i8,
    /// Steering angle of the middle of the axle, radians.
    pub steer_angle: f32,
    /// Acceleration by the wheels and the air, in the vehicle's axes (right, up, back), metres per
    /// second squared: the g-g diagram.
    pub acceleration: Vec3,
    /// Sum of all wheel loads, newtons.
    pub load: f32,
    /// Number of wheels on the ground.
    pub grounded: u32,
    /// Air drag, newtons.
    pub drag: f32,
    /// Whether traction control cut the throttle.
    pub traction_control: bool,
    /// Whether stability control braked a wheel.
    pub stability_control: bool,
    /// Sweeps that the solve took.
    pub sweeps: u32,
    /// Whether the vehicle was left alone because it sleeps.
    pub asleep: bool,
}

/// What a wheel did in the last tick.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Default, Debug, PartialEq, Clone)]
pub struct WheelState {
    /// What it touches.
    pub contact: Option<WheelContact>,
    /// Compression of the suspension, metres, 0 at droop.
    pub compression: f32,
    /// Force of the suspension along its axis, newtons.
    pub suspension_force: f32,
    /// Load: normal force of the ground, newtons.
    pub load: f32,
    /// Force of the tyre along and across the wheel, newtons, positive forward and right.
    pub force: Vec2,
    /// Slip ratio: slip velocity along the wheel over its speed, positive driving.
    pub slip_ratio: f32,
    /// Slip angle, radians, positive when the wheel slides to its left.
    pub slip_angle: f32,
    /// Greatest forces along and across at this load and surface, newtons: the friction ellipse.
    pub limit: Vec2,
    /// Spin, radians per second.
    pub spin: f32,
    /// Torque of the drivetrain, newton-metres.
    pub drive_torque: f32,
    /// Torque of the brakes and of rolling resistance, newton-metres, against the spin.
    pub brake_torque: f32,
    /// Steering angle with toe, radians, positive to the right.
    pub steer_angle: f32,
    /// Whether the anti-lock system held back the brake.
    pub abs: bool,
}

/// Ground under a wheel.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
pub struct WheelContact {
    /// The entity of the collider.
    pub entity: Entity,
    /// World, metres.
    pub point: Vec3,
    /// Along which the ground pushes, unit length, world axes: its normal under the wheel, on a curve
    /// turned by as much as it turns on the way of the tick. The load times its cosine to the suspension's
    /// axis is [`WheelState::suspension_force`].
    pub normal: Vec3,
    /// Direction of the wheel on the ground, unit length, world axes.
    pub forward: Vec3,
    /// Velocity of the ground there, world axes, metres per second.
    pub velocity: Vec3,
    /// Friction of the surface, dimensionless.
    pub friction: f32,
}
