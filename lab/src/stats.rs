//! Figures out of repeated runs of the same deterministic world.

/// The value in the middle, or 0 of nothing.
pub fn median(values: &mut [f64]) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let n = values.len();
    match n {
        0 => 0.0,
        _ if n % 2 == 1 => values[n / 2],
        _ => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

/// Mean over the ticks of the median over the repetitions, nanoseconds.
pub fn typical(repetitions: &[&[u64]]) -> f64 {
    let ticks = repetitions.iter().map(|run| run.len()).min().unwrap_or(0);
    let sum: f64 = (0..ticks)
        .map(|tick| {
            let mut values: Vec<f64> = repetitions.iter().map(|run| run[tick] as f64).collect();
            median(&mut values)
        })
        .sum();
    sum / ticks.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_the_value_in_the_middle() {
        assert_eq!(median(&mut [3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), 2.5);
        assert_eq!(median(&mut []), 0.0);
    }

    #[test]
    fn a_burst_in_one_repetition_does_not_count() {
        let runs: [&[u64]; 3] = [&[10, 20, 9000], &[10, 20, 30], &[7000, 20, 30]];
        assert_eq!(typical(&runs), 20.0);
    }
}
