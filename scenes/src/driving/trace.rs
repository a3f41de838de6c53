//! What a vehicle did, tick by tick, in the station's axes.

use bevy::prelude::*;
use bevy_embody::vehicle::{VehicleTelemetry, WheelState};

use crate::stations::{OfStep, Trace};

/// A vehicle after a tick.
#[derive(Clone, Debug)]
pub struct DriveSample {
    /// The step of the script that the tick belonged to.
    pub step: usize,
    /// Seconds since the start of the station.
    pub time: f64,
    /// Pose of the vehicle's origin.
    pub pose: Transform,
    /// Velocity of the centre of mass, metres per second.
    pub velocity: Vec3,
    /// Centre of mass.
    pub center: Vec3,
    /// What the tick found out.
    pub telemetry: VehicleTelemetry,
    /// The wheels.
    pub wheels: Vec<WheelState>,
    /// Poses of the nodes that the station tracks, in its order.
    pub nodes: Vec<Transform>,
}

impl DriveSample {
    /// Which way up it is: 1 upright, −1 on its roof.
    pub fn upright(&self) -> f32 {
        (self.pose.rotation * Vec3::Y).y
    }

    /// Distance ahead of the origin of the station, metres.
    pub fn ahead(&self) -> f32 {
        -self.pose.translation.z
    }
}

impl OfStep for DriveSample {
    fn step(&self) -> usize {
        self.step
    }

    fn time(&self) -> f64 {
        self.time
    }
}

/// All samples of a driving station.
pub type DriveTrace = Trace<DriveSample>;

/// Mean of a quantity; NaN of nothing, so that what never happened meets no bound.
pub fn mean<'a>(
    samples: impl IntoIterator<Item = &'a DriveSample>,
    quantity: impl Fn(&DriveSample) -> f32,
) -> f32 {
    let (mut sum, mut count) = (0.0f64, 0u32);
    for sample in samples {
        sum += f64::from(quantity(sample));
        count += 1;
    }
    if count == 0 {
        f32::NAN
    } else {
        (sum / f64::from(count)) as f32
    }
}

/// The least and the greatest value; NaN of nothing.
pub fn range(samples: &[DriveSample], quantity: impl Fn(&DriveSample) -> f32) -> (f32, f32) {
    let mut all = samples.iter().map(quantity);
    let Some(first) = all.next() else {
        return (f32::NAN, f32::NAN);
    };
    all.fold((first, first), |(low, high), v| {
        if v.is_nan() {
            (f32::NAN, f32::NAN)
        } else {
            (low.min(v), high.max(v))
        }
    })
}

/// The samples from this many seconds after the first of them.
pub fn after(samples: &[DriveSample], seconds: f64) -> &[DriveSample] {
    let Some(first) = samples.first() else {
        return samples;
    };
    let from = samples.partition_point(|s| s.time < first.time + seconds - 1e-9);
    &samples[from..]
}

/// The last samples of this many seconds.
pub fn end(samples: &[DriveSample], seconds: f64) -> &[DriveSample] {
    let Some(last) = samples.last() else {
        return samples;
    };
    let from = samples.partition_point(|s| s.time < last.time - seconds);
    &samples[from..]
}
