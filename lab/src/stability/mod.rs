//! Where integration breaks: the stiffest that each method bears, predicted by formula and found by
//! bisection.

mod plot;
mod quarter_car;
mod wheel_slip;

use std::process::ExitCode;

use crate::{
    options::Selection,
    table::{Table, number},
};

/// All maps. A new one is a function.
const MAPS: &[(&str, fn(bool) -> Map)] = &[
    ("vehicle_suspension", quarter_car::map),
    ("vehicle_tire", wheel_slip::map),
];

/// The limits of several methods along one axis.
pub struct Map {
    pub name: &'static str,
    pub title: &'static str,
    /// What changes from left to right, with its unit.
    pub across: &'static str,
    /// What is made stiffer, with its unit.
    pub up: &'static str,
    /// The stiffest that is tried.
    pub most: f64,
    pub limits: Vec<Limit>,
}

/// The stiffest that a method bears at one place; infinite where there is no limit, or none up to the
/// stiffest that was tried.
pub struct Limit {
    pub method: &'static str,
    pub at: f64,
    pub predicted: Option<f64>,
    pub measured: f64,
    /// Whether it is one of ours: it must have no limit.
    pub ours: bool,
}

/// Measures, prints, judges.
pub fn run(options: &Selection) -> Result<ExitCode, String> {
    let mut broken = false;
    for (_, map) in MAPS.iter().filter(|(name, _)| options.wants(name)) {
        let map = map(options.quick);
        let table = table(&map);
        println!("{}\n\n{}", map.title, table.markdown());
        for limit in map.limits.iter().filter(|l| l.ours) {
            if limit.measured.is_finite() {
                println!(
                    "check {} at {}: breaks at {} FAIL",
                    map.name,
                    limit.at,
                    number(limit.measured)
                );
                broken = true;
            }
        }
        if let Some(folder) = &options.out {
            table.save(folder)?;
            plot::save(&map, folder)?;
        }
    }
    Ok(if broken {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

fn table(map: &Map) -> Table {
    let head = ["method", map.across, "limit by formula", "limit measured"];
    let mut table = Table::new(map.name, &head);
    for limit in &map.limits {
        let measured = if limit.measured.is_finite() {
            number(limit.measured)
        } else {
            format!("none up to {}", number(map.most))
        };
        let predicted = match limit.predicted {
            Some(p) if p.is_finite() => number(p),
            Some(_) => "none".to_owned(),
            None => String::new(),
        };
        table.rows.push(vec![
            limit.method.to_owned(),
            number(limit.at),
            predicted,
            measured,
        ]);
    }
    table
}

/// The least value between `low` and `most` that is not stable, to a percent; infinite when all are.
/// Every third of a decade is tried before the bisection.
pub fn find_limit(low: f64, most: f64, stable: impl Fn(f64) -> bool) -> f64 {
    let step = 10f64.powf(1.0 / 3.0);
    let mut good = low;
    if !stable(good) {
        return low;
    }
    let mut bad = loop {
        let next = good * step;
        if next > most * 1.001 {
            return f64::INFINITY;
        }
        if !stable(next) {
            break next;
        }
        good = next;
    };
    while bad / good > 1.01 {
        let middle = (good * bad).sqrt();
        if stable(middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    bad
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_found_to_a_percent_and_none_where_there_is_none() {
        let found = find_limit(1.0, 1.0e9, |v| v < 12_345.0);
        assert!((found / 12_345.0 - 1.0).abs() < 0.011, "{found}");
        assert_eq!(find_limit(1.0, 1.0e9, |_| true), f64::INFINITY);
        assert_eq!(find_limit(2.0, 1.0e9, |_| false), 2.0);
    }

    #[test]
    fn pure_integrators_break_where_their_formulas_say() {
        for map in [quarter_car::formulas(), wheel_slip::formulas()] {
            for limit in map {
                let predicted = limit.predicted.unwrap_or(f64::NAN);
                let near = (limit.measured / predicted - 1.0).abs() < 0.03;
                let none = predicted.is_infinite() && limit.measured.is_infinite();
                assert!(
                    near || none,
                    "{} at {}: {} for {predicted}",
                    limit.method,
                    limit.at,
                    limit.measured
                );
            }
        }
    }
}
