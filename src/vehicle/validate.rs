//! Which values a vehicle cannot work with.

use super::{
    config::{Vehicle, VehicleMass},
    drivetrain::{Differential, Drivetrain, PowerSource, Shifting},
    suspension::{Damper, SpringRate},
    tire::TireModel,
    wheel::{Wheel, WheelProbe},
};
use crate::validate::{Check, Problem};

/// A wheel that lacks a component.
pub(super) fn absent(field: &'static str) -> Problem {
    Problem {
        field,
        value: "missing".into(),
        need: "to be on every entity with a WheelOf",
    }
}

/// More wheels than a vehicle can have.
pub(super) fn too_many(count: usize) -> Problem {
    Problem {
        field: "Wheels",
        value: count.to_string(),
        need: "at most 16",
    }
}

/// The first value of a vehicle that is out of its range.
pub(super) fn vehicle(config: &Vehicle) -> Option<Problem> {
    let mut check = Check::default();
    let right_angle = core::f32::consts::FRAC_PI_2;
    let steering = &config.steering;
    let ok = (0.0..right_angle).contains(&steering.max_angle);
    check.that(
        ok,
        "Vehicle::steering.max_angle",
        steering.max_angle,
        "0 to below π/2",
    );
    check.finite("Vehicle::steering.ackermann", steering.ackermann);
    check.finite("Vehicle::steering.offset", steering.offset);
    check.not_negative("Vehicle::steering.skid_torque", steering.skid_torque);
    let ok = steering.rate > 0.0;
    check.that(
        ok,
        "Vehicle::steering.rate",
        steering.rate,
        "a number above 0",
    );
    for p in &steering.speed_curve {
        check.not_negative("Vehicle::steering.speed_curve.speed", p.speed);
        check.part("Vehicle::steering.speed_curve.part", p.part);
    }
    let ordered = steering
        .speed_curve
        .windows(2)
        .all(|w| w[0].speed < w[1].speed);
    check.that(
        ordered,
        "Vehicle::steering.speed_curve",
        steering.speed_curve.len() as f32,
        "points in the order of their speeds",
    );
    check.not_negative("Vehicle::brakes.torque", config.brakes.torque);
    check.part("Vehicle::brakes.balance", config.brakes.balance);
    check.not_negative("Vehicle::brakes.hand_torque", config.brakes.hand_torque);
    for bar in &config.anti_roll {
        check.not_negative("Vehicle::anti_roll", *bar);
    }
    if let Some(aero) = &config.aero {
        check.not_negative("Vehicle::aero.drag_area", aero.drag_area);
        let down = aero.downforce_area;
        check.finite("Vehicle::aero.downforce_area", down.x + down.y);
        check.not_negative("Vehicle::aero.air_control.x", aero.air_control.x);
        check.not_negative("Vehicle::aero.air_control.y", aero.air_control.y);
        check.not_negative("Vehicle::aero.air_control.z", aero.air_control.z);
    }
    let ok = (0.0..right_angle).contains(&config.max_ground_angle);
    check.that(
        ok,
        "Vehicle::max_ground_angle",
        config.max_ground_angle,
        "0 to below π/2",
    );
    if let Some(drivetrain) = &config.drivetrain {
        check_drivetrain(&mut check, drivetrain);
    }
    check.0
}

fn check_drivetrain(check: &mut Check, drivetrain: &Drivetrain) {
    match &drivetrain.source {
        PowerSource::Engine(engine) => {
            check.positive("Engine::idle", engine.idle);
            let ok = engine.redline > engine.idle && engine.redline.is_finite();
            check.that(
                ok,
                "Engine::redline",
                engine.redline,
                "more than the idle speed",
            );
            check.positive("Engine::inertia", engine.inertia);
            check.not_negative("Engine::friction", engine.friction);
            check.not_negative("Engine::viscosity", engine.viscosity);
            check.not_negative("Engine::stall", engine.stall.unwrap_or(0.0));
            for p in &engine.torque {
                check.finite("Engine::torque", p.rpm + p.torque);
            }
            let ordered = engine.torque.windows(2).all(|w| w[0].rpm < w[1].rpm);
            let n = engine.torque.len() as f32;
            check.that(
                ordered && n > 0.0,
                "Engine::torque",
                n,
                "points in the order of their rpm",
            );
        }
        PowerSource::Motor(motor) => {
            check.not_negative("ElectricMotor::torque", motor.torque);
            check.not_negative("ElectricMotor::power", motor.power);
            check.positive("ElectricMotor::redline", motor.redline);
            check.positive("ElectricMotor::inertia", motor.inertia);
            check.not_negative("ElectricMotor::recuperation", motor.recuperation);
        }
        PowerSource::Direct { force } => check.not_negative("PowerSource::Direct.force", *force),
    }
    check.not_negative("Clutch::torque", drivetrain.clutch.torque);
    let gearbox = &drivetrain.gearbox;
    let n = gearbox.forward.len() as f32;
    check.that(n > 0.0, "Gearbox::forward", n, "at least one ratio");
    for ratio in &gearbox.forward {
        check.positive("Gearbox::forward", *ratio);
    }
    check.positive("Gearbox::reverse", gearbox.reverse);
    check.not_negative("Gearbox::shift_time", gearbox.shift_time);
    if let Shifting::Automatic { up, down } = gearbox.shifting {
        check.not_negative("Shifting::Automatic.up", up);
        check.not_negative("Shifting::Automatic.down", down);
    }
    check.positive("Drivetrain::final_drive", drivetrain.final_drive);
    check.positive("Drivetrain::efficiency", drivetrain.efficiency);
    check.part("Drivetrain::efficiency", drivetrain.efficiency);
    let listed = drivetrain.axles.iter().map(|a| a.differential);
    for differential in listed.chain([drivetrain.center]) {
        if let Differential::LimitedSlip { bias, preload } = differential {
            let ok = bias >= 1.0 && bias.is_finite();
            check.that(
                ok,
                "Differential::bias",
                bias,
                "a finite number of at least 1",
            );
            check.not_negative("Differential::preload", preload);
        }
    }
    for axle in &drivetrain.axles {
        check.not_negative("DrivenAxle::share", axle.share);
    }
}

/// The first value of a mass that is out of its range.
pub(super) fn mass(mass: &VehicleMass) -> Option<Problem> {
    let mut check = Check::default();
    check.positive("VehicleMass::mass", mass.mass);
    check.finite_vec("VehicleMass::center", mass.center);
    check.positive("VehicleMass::inertia.x", mass.inertia.x);
    check.positive("VehicleMass::inertia.y", mass.inertia.y);
    check.positive("VehicleMass::inertia.z", mass.inertia.z);
    check.0
}

/// The first value of a wheel that is out of its range.
pub(super) fn wheel(config: &Wheel) -> Option<Problem> {
    let mut check = Check::default();
    check.finite_vec("Wheel::attachment", config.attachment);
    check.positive("Wheel::direction (length)", config.direction.length());
    check.positive("Wheel::radius", config.radius);
    check.positive("Wheel::width", config.width);
    check.positive("Wheel::inertia", config.inertia);
    check.finite("Wheel::steer", config.steer);
    check.not_negative("Wheel::brake", config.brake);
    check.finite("Wheel::camber", config.camber);
    check.finite("Wheel::toe", config.toe);
    if let WheelProbe::Sphere { radius } = config.probe {
        check.positive("WheelProbe::Sphere.radius", radius);
    }
    let suspension = &config.suspension;
    match suspension.spring {
        SpringRate::RideFrequency(hz) => check.positive("SpringRate::RideFrequency", hz),
        SpringRate::Stiffness(k) => check.positive("SpringRate::Stiffness", k),
    }
    match suspension.damping {
        Damper::Ratio { bump, rebound } | Damper::Coefficient { bump, rebound } => {
            check.not_negative("Damper::bump", bump);
            check.not_negative("Damper::rebound", rebound);
        }
    }
    check.positive("Suspension::travel", suspension.travel);
    check.not_negative("Suspension::preload", suspension.preload);
    check.not_negative("Suspension::progression", suspension.progression);
    let ok = (0.0..=suspension.travel).contains(&suspension.stop_length);
    check.that(
        ok,
        "Suspension::stop_length",
        suspension.stop_length,
        "0 to the travel",
    );
    check.not_negative("Suspension::stop_stiffness", suspension.stop_stiffness);
    check.not_negative("Suspension::unsprung_mass", suspension.unsprung_mass);
    let tire = &config.tire;
    for model in [&tire.along, &tire.across] {
        check_model(&mut check, model);
    }
    check.not_negative("Tire::friction.x", tire.friction.x);
    check.not_negative("Tire::friction.y", tire.friction.y);
    check.positive("Tire::nominal_load", tire.nominal_load);
    check.part("Tire::load_sensitivity", tire.load_sensitivity);
    check.part("Tire::stiffness_exponent", tire.stiffness_exponent);
    check.positive("Tire::relaxation_length.x", tire.relaxation_length.x);
    check.positive("Tire::relaxation_length.y", tire.relaxation_length.y);
    check.not_negative("Tire::rolling_resistance", tire.rolling_resistance);
    check.finite("Tire::camber_stiffness", tire.camber_stiffness);
    check.0
}

fn check_model(check: &mut Check, model: &TireModel) {
    match model {
        TireModel::Linear { stiffness } | TireModel::Brush { stiffness } => {
            check.positive("TireModel::stiffness", *stiffness);
        }
        TireModel::Magic { b, c, e } => {
            check.positive("TireModel::Magic.b", *b);
            check.positive("TireModel::Magic.c", *c);
            let ok = *e <= 1.0 && e.is_finite();
            check.that(ok, "TireModel::Magic.e", *e, "a finite number of at most 1");
        }
        TireModel::Curve { points } => {
            let n = points.len() as f32;
            let ordered = points.windows(2).all(|w| w[0].slip < w[1].slip);
            check.that(
                ordered && n > 0.0,
                "TireModel::Curve.points",
                n,
                "points in the order of their slip",
            );
            for p in points {
                check.positive("TireModel::Curve.slip", p.slip);
                check.not_negative("TireModel::Curve.force", p.force);
            }
        }
    }
}
