//! Engine, clutch, gears, differentials and brakes as shafts and friction rows.

use super::{
    Found, Surroundings,
    brakes::BrakeTorques,
    traction::{driven_slip, load},
};
use crate::vehicle::{
    assists::Load,
    config::Vehicle,
    drivetrain::{
        Differential, Drivetrain, GearboxState, Power, PowerSource, from_rpm, motor_power, power,
    },
    intent::VehicleIntent,
    output::VehicleTelemetry,
    report::VehicleReport,
    solve::{MOST_WHEELS, Row, Spin},
    state::VehicleState,
    surface::SurfaceFriction,
};

/// What later has to be read out of the solved shafts.
pub(super) struct Driveline {
    pub engine: Option<usize>,
    pub clutch: Option<usize>,
    pub brakes: [Option<usize>; MOST_WHEELS],
    /// Engine torque without its implicit part, newton-metres.
    pub power: Power,
    /// Torque of direct drive and skid steering on each wheel, newton-metres.
    pub direct: [f32; MOST_WHEELS],
}

/// `weight` is the part of the vehicle's weight along itself, newtons, positive forward.
pub(super) fn build(
    s: &Surroundings,
    config: &Vehicle,
    state: &mut VehicleState,
    report: &mut VehicleReport,
    telemetry: &mut VehicleTelemetry,
    asked: &VehicleIntent,
    found: &[Found],
    brakes: &BrakeTorques,
    speed: f32,
    weight: f32,
    spin: &mut Spin,
) -> Driveline {
    let dt = s.dt;
    let mut line = Driveline {
        engine: None,
        clutch: None,
        brakes: [None; MOST_WHEELS],
        power: Power::default(),
        direct: [0.0; MOST_WHEELS],
    };
    for (i, wheel) in s.wheels.iter().enumerate() {
        spin.shaft(state.wheels[i].spin, wheel.inertia);
        let load = if found[i].contact.is_some() {
            found[i].law.force(found[i].compression).max(0.0)
        } else {
            0.0
        };
        let surface = found[i]
            .contact
            .and_then(|t| s.surfaces.get(t.entity).ok()?.0.copied())
            .filter(SurfaceFriction::is_sound)
            .unwrap_or_default();
        let rolling = wheel.tire.rolling_resistance * surface.rolling_resistance;
        let torque = brakes.torque[i] + rolling * load * wheel.radius;
        line.brakes[i] = spin.row(Row::brake(i, f64::from(torque * dt)));
    }
    if let Some(drivetrain) = &config.drivetrain {
        drive(
            s, drivetrain, state, report, telemetry, asked, found, speed, weight, spin, &mut line,
        );
        let skid = config.steering.skid_torque * asked.steer;
        for (i, wheel) in s.wheels.iter().enumerate() {
            if wheel.driven {
                line.direct[i] -= skid * wheel.attachment.x.signum();
            }
        }
    }
    for (i, torque) in line.direct.iter().enumerate().take(s.wheels.len()) {
        spin.known[i] += f64::from(torque * dt);
    }
    line
}

fn drive(
    s: &Surroundings,
    drivetrain: &Drivetrain,
    state: &mut VehicleState,
    report: &mut VehicleReport,
    telemetry: &mut VehicleTelemetry,
    asked: &VehicleIntent,
    found: &[Found],
    speed: f32,
    weight: f32,
    spin: &mut Spin,
    line: &mut Driveline,
) {
    let dt = s.dt;
    let shares = wheel_shares(s, drivetrain);
    let mean: f32 = (0..s.wheels.len())
        .map(|i| shares[i] * state.wheels[i].spin)
        .sum();
    let (slipping, reference) = driven_slip(s, state, speed);

    let mut gearbox = GearboxState {
        gear: state.gear,
        // Less than whole when the config changed meanwhile.
        shifting: state.shifting.min(drivetrain.gearbox.shift_time),
        settled: state.gear_age,
    };
    let per_gear = gearbox.ratio(&drivetrain.gearbox) * drivetrain.final_drive;
    let shaft_rpm = (mean * per_gear).abs() / from_rpm(1.0);
    let engine_rpm = state.engine_speed.abs() / from_rpm(1.0);
    let shift = gearbox.tick(
        &drivetrain.gearbox,
        asked.gear,
        engine_rpm,
        shaft_rpm,
        speed,
        slipping > 0.2,
        dt,
    );
    state.gear = gearbox.gear;
    state.shifting = gearbox.shifting;
    state.gear_age = gearbox.settled.min(1.0e3);
    report.shift = shift;

    let mut throttle = asked.throttle;
    let mut ratio = gearbox.ratio(&drivetrain.gearbox) * drivetrain.final_drive;
    if gearbox.gear < 0 && matches!(drivetrain.source, PowerSource::Motor(_)) {
        // The motor itself turns backward; the gear stays the first one.
        ratio = drivetrain.gearbox.forward.first().copied().unwrap_or(1.0) * drivetrain.final_drive;
    }
    match s.assists.traction {
        Some(control) if throttle > 0.0 => {
            let load = load(s, drivetrain, state, found, ratio, reference, weight);
            let load = Load {
                held: load.held / throttle,
                slowing: load.slowing / throttle,
                needed: load.needed / throttle,
            };
            state.traction_cut = control.part(state.traction_cut, slipping, load, dt);
            throttle *= state.traction_cut;
            telemetry.traction_control = state.traction_cut < 0.98;
        }
        _ => {
            state.traction_cut = 1.0;
            telemetry.traction_control = false;
        }
    }
    let engine_inertia;
    let closed;
    match &drivetrain.source {
        PowerSource::Direct { force } => {
            let direction = f32::from(gearbox.gear.signum());
            for (i, wheel) in s.wheels.iter().enumerate() {
                if wheel.driven {
                    line.direct[i] += force * wheel.radius * throttle * direction;
                }
            }
            state.engine_speed = 0.0;
            differentials(s, drivetrain, state, &shares, ratio, spin);
            return;
        }
        PowerSource::Motor(motor) => {
            let direction = f32::from(gearbox.gear.signum());
            if !state.started {
                state.started = true;
                state.engine_speed = mean * ratio;
            }
            line.power = motor_power(motor, state.engine_speed, throttle, direction);
            engine_inertia = motor.inertia;
            closed = f32::INFINITY;
        }
        PowerSource::Engine(engine) => {
            let idle = from_rpm(engine.idle);
            if !state.started {
                state.started = true;
                state.engine_speed = idle;
            }
            if state.stalled && asked.starter {
                state.stalled = false;
                state.engine_speed = idle;
            }
            if let Some(stall) = engine.stall
                && !state.stalled
                && state.engine_speed < from_rpm(stall)
            {
                state.stalled = true;
                report.stalled = true;
            }
            let redline = from_rpm(engine.redline);
            // The fuel comes back a hundred revolutions below the redline.
            state.limiting = state.engine_speed > redline
                || (state.limiting && state.engine_speed > redline - from_rpm(100.0));
            let fed = if state.shifting > 0.0 { 0.0 } else { throttle };
            line.power = if state.stalled {
                let mut dead = power(engine, state.engine_speed, 0.0, true, false, dt);
                dead.torque = dead.torque.min(0.0);
                dead
            } else {
                let free = ratio == 0.0 || asked.clutch > 0.5;
                power(engine, state.engine_speed, fed, state.limiting, free, dt)
            };
            engine_inertia = engine.inertia;
            let pedal = 1.0 - asked.clutch;
            let auto = if drivetrain.clutch.automatic {
                // Closes between idle and a third of the way to the redline.
                let from = 1.1 * idle;
                let over = 0.35 * (redline - idle).max(1.0);
                ((state.engine_speed - from) / over).clamp(0.0, 1.0)
            } else {
                1.0
            };
            closed = drivetrain.clutch.torque * pedal * auto;
        }
    }
    telemetry.engine_torque = line.power.torque - line.power.damping * state.engine_speed;
    let shaft = spin.shaft(state.engine_speed, engine_inertia);
    spin.damp(shaft, line.power.damping);
    spin.known[shaft] += f64::from(line.power.torque * dt);
    line.engine = Some(shaft);
    if ratio != 0.0 {
        // Losses are on the way to the wheels when driving, on the way back when braking.
        let efficiency = if state.clutch_torque >= 0.0 {
            drivetrain.efficiency
        } else {
            1.0 / drivetrain.efficiency
        };
        let mut p = [0.0; MOST_WHEELS + 1];
        let mut q = [0.0; MOST_WHEELS + 1];
        for i in 0..s.wheels.len() {
            let leverage = ratio * shares[i];
            q[i] = f64::from(leverage);
            p[i] = f64::from(leverage * efficiency);
        }
        p[shaft] = -1.0;
        q[shaft] = -1.0;
        line.clutch = spin.row(Row::new(p, q, f64::from(closed.min(1.0e9) * dt)));
    }
    differentials(s, drivetrain, state, &shares, ratio, spin);
}

/// Share of each wheel in the torque of the propeller shaft; all together 1.
fn wheel_shares(s: &Surroundings, drivetrain: &Drivetrain) -> [f32; MOST_WHEELS] {
    let mut shares = [0.0; MOST_WHEELS];
    for (i, wheel) in s.wheels.iter().enumerate() {
        if wheel.driven {
            let on_axle = |w: &&&super::Wheel| w.driven && w.axle == wheel.axle;
            let count = s.wheels.iter().filter(on_axle).count().max(1);
            shares[i] = axle_share(drivetrain, wheel.axle) / count as f32;
        }
    }
    let total: f32 = shares.iter().sum();
    if total > 0.0 {
        for share in &mut shares {
            *share /= total;
        }
    }
    shares
}

fn axle_share(drivetrain: &Drivetrain, axle: u8) -> f32 {
    let listed = drivetrain.axles.iter().find(|a| a.axle == axle);
    listed.map_or(1.0, |a| a.share)
}

/// Rows between the outputs of all differentials.
fn differentials(
    s: &Surroundings,
    drivetrain: &Drivetrain,
    state: &VehicleState,
    shares: &[f32; MOST_WHEELS],
    ratio: f32,
    spin: &mut Spin,
) {
    let through = (state.clutch_torque * ratio * drivetrain.efficiency).abs();
    let n = s.wheels.len();
    if drivetrain.tracks {
        for right in [false, true] {
            let mut before = None;
            for (i, wheel) in s.wheels.iter().enumerate() {
                if wheel.driven && (wheel.attachment.x > 0.0) == right {
                    if let Some(before) = before {
                        tie(&[before], &[i], f32::INFINITY, s.dt, spin);
                    }
                    before = Some(i);
                }
            }
        }
        return;
    }
    let mut axle_before: Option<([usize; MOST_WHEELS], usize, f32)> = None;
    let mut done = [false; MOST_WHEELS];
    for first in 0..n {
        if !s.wheels[first].driven || done[first] {
            continue;
        }
        let axle = s.wheels[first].axle;
        let mut group = [0; MOST_WHEELS];
        let mut count = 0;
        let mut share = 0.0;
        for i in first..n {
            if s.wheels[i].driven && s.wheels[i].axle == axle {
                group[count] = i;
                count += 1;
                share += shares[i];
                done[i] = true;
            }
        }
        let listed = drivetrain.axles.iter().find(|a| a.axle == axle);
        let kind = listed.map_or(Differential::Open, |a| a.differential);
        for pair in group[..count].windows(2) {
            let most = limit(kind, through * share, 0.5);
            tie(&pair[..1], &pair[1..], most, s.dt, spin);
        }
        if let Some((other, other_count, other_share)) = axle_before {
            let total = (share + other_share).max(1.0e-6);
            let part = share / total;
            let most = limit(drivetrain.center, through * total, part);
            tie(&other[..other_count], &group[..count], most, s.dt, spin);
        }
        axle_before = Some((group, count, share));
    }
}

/// Torque that a differential can move from one output to the other, newton-metres.
fn limit(kind: Differential, through: f32, part: f32) -> f32 {
    match kind {
        Differential::Open => 0.0,
        Differential::LimitedSlip { bias, preload } => {
            let bias = (bias - 1.0) / (bias + 1.0);
            preload + through * bias * 2.0 * part * (1.0 - part)
        }
        Differential::Locked => f32::INFINITY,
    }
}

/// A row that holds the mean speeds of two groups of wheels together.
fn tie(a: &[usize], b: &[usize], most: f32, dt: f32, spin: &mut Spin) {
    if !(most > 0.0) || a.is_empty() || b.is_empty() {
        return;
    }
    let mut axis = [0.0; MOST_WHEELS + 1];
    for i in a {
        axis[*i] = 1.0 / a.len() as f64;
    }
    for i in b {
        axis[*i] = -1.0 / b.len() as f64;
    }
    spin.row(Row::new(axis, axis, f64::from(most.min(1.0e9) * dt)));
}
