//! Judgements that several stations share. All are in the station's axes, where ahead is `-Z`.

use bevy::prelude::*;

use super::{
    Sample, Verdict,
    trace::{airborne, crossing},
};

/// Distance ahead of the start, metres.
pub fn ahead(sample: &Sample) -> f32 {
    -sample.foot.z
}

/// Whether no tick was in the air.
pub fn never_airborne(samples: &[Sample]) -> Verdict {
    let count = airborne(samples);
    Verdict::new(
        count == 0 && !samples.is_empty(),
        format!("in the air in {count} of {} ticks", samples.len()),
    )
}

/// Whether no tick went against `direction` by more than rounding.
pub fn never_backwards(samples: &[Sample], direction: Vec3) -> Verdict {
    let worst = samples
        .windows(2)
        .map(|pair| (pair[1].foot - pair[0].foot).dot(direction))
        .reduce(f32::min)
        .unwrap_or(f32::NAN);
    Verdict::new(worst >= -1e-4, format!("least tick {:+.2} mm", worst * 1e3))
}

/// Whether the way from one distance ahead to another took at most this long, seconds.
pub fn within_time(
    samples: &[Sample],
    distance: impl Fn(&Sample) -> f32 + Copy,
    [from, to]: [f32; 2],
    bound: f32,
) -> Verdict {
    match (
        crossing(samples, distance, from),
        crossing(samples, distance, to),
    ) {
        (Some(start), Some(end)) => Verdict::at_most(
            end - start,
            f64::from(bound),
            format!("{:.3} s", end - start),
        ),
        (None, _) => Verdict::never("got there"),
        (_, None) => Verdict::never("got to the end"),
    }
}

/// Whether the way from one distance to another, this long, was gone at this speed within a part.
pub fn at_speed(
    samples: &[Sample],
    distance: impl Fn(&Sample) -> f32 + Copy,
    [from, to]: [f32; 2],
    length: f32,
    speed: f32,
    part: f64,
) -> Verdict {
    match (
        crossing(samples, distance, from),
        crossing(samples, distance, to),
    ) {
        (Some(start), Some(end)) => {
            let got = f64::from(length) / (end - start);
            Verdict::close(got, f64::from(speed), part, format!("{got:.3} m/s"))
        }
        _ => Verdict::never("went that way"),
    }
}

/// Whether the last of these samples has its foot at this height, metres.
pub fn ends_at_height(samples: &[Sample], height: f32, tolerance: f32) -> Verdict {
    match samples.last() {
        Some(last) => Verdict::at_most(
            f64::from((last.foot.y - height).abs()),
            f64::from(tolerance),
            format!("{:.4} m", last.foot.y),
        ),
        None => Verdict::never("got there"),
    }
}

/// Greatest distance of the foot from where it was in the first of these samples, metres.
pub fn drift(samples: &[Sample]) -> Option<f32> {
    let first = samples.first()?.foot;
    samples
        .iter()
        .map(|s| s.foot.distance(first))
        .reduce(f32::max)
}

/// Whether the foot stayed where it was, metres.
pub fn stays(samples: &[Sample], bound: f32) -> Verdict {
    match drift(samples) {
        Some(drift) => Verdict::at_most(
            f64::from(drift),
            f64::from(bound),
            format!("moved {:.3} mm", drift * 1e3),
        ),
        None => Verdict::never("stood"),
    }
}

/// The samples from this many seconds after the first of them.
pub fn after(samples: &[Sample], seconds: f64) -> &[Sample] {
    let Some(first) = samples.first() else {
        return samples;
    };
    let from = samples.partition_point(|s| s.time < first.time + seconds - 1e-9);
    &samples[from..]
}
