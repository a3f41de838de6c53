//! What comes out beside closed forms: ours and Rapier's controller on the same scenes, at several
//! tick rates. A new case is a function and a line in [`cases::CASES`].

mod cases;
mod stage;

use std::{path::PathBuf, process::ExitCode};

use clap::Args;

use crate::{
    side::Side,
    table::{Table, number},
};
use stage::Stage;

/// Tick rates, hertz.
const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

/// What to measure.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// Only cases whose name contains this.
    #[arg(long)]
    filter: Option<String>,
    /// One tick rate only.
    #[arg(long)]
    quick: bool,
    /// Writes the tables as Markdown and CSV into this folder.
    #[arg(long)]
    out: Option<PathBuf>,
}

/// A scene with a known answer.
pub struct Case {
    pub name: &'static str,
    pub what: &'static str,
    pub unit: &'static str,
    /// The closed form.
    pub asked: f64,
    /// What an error is measured in parts of; `None` shows errors in the case's own unit.
    pub scale: Option<f64>,
    /// Whether Rapier's controller can run it.
    pub peer: bool,
    pub run: fn(Stage) -> f64,
}

/// Measures and prints.
pub fn run(options: &Options) -> Result<ExitCode, String> {
    let filter = options.filter.as_deref().unwrap_or_default();
    let rates = if options.quick {
        &RATES[1..2]
    } else {
        &RATES[..]
    };
    let mut head = vec!["case".to_owned(), "closed form".to_owned()];
    for side in ["ours", "Rapier's"] {
        for hz in rates {
            head.push(format!("{side}, {hz} Hz"));
        }
    }
    let mut summary = Table::new("vehicle_accuracy", &[]);
    summary.head = head;
    let mut full = Table::new(
        "vehicle_accuracy_full",
        &[
            "case", "what", "unit", "hz", "asked", "ours", "error", "rapier", "error",
        ],
    );
    let mut lost = false;
    for case in cases::CASES.iter().filter(|c| c.name.contains(filter)) {
        let mut ours = Vec::new();
        let mut peers = Vec::new();
        for &hz in rates {
            let own = (case.run)(Stage::new(hz, Side::Ours));
            lost |= !own.is_finite();
            let peer = if case.peer {
                (case.run)(Stage::new(hz, Side::Rapier))
            } else {
                f64::NAN
            };
            full.rows.push(vec![
                case.name.to_owned(),
                case.what.to_owned(),
                case.unit.to_owned(),
                number(hz),
                number(case.asked),
                format!("{own:.5}"),
                error(case, own),
                if case.peer {
                    format!("{peer:.5}")
                } else {
                    "–".to_owned()
                },
                error(case, peer),
            ]);
            ours.push(error(case, own));
            peers.push(error(case, peer));
        }
        let mut row = vec![
            format!("{}: {}", case.name, case.what),
            format!("{} {}", number(case.asked), case.unit),
        ];
        row.extend(ours);
        row.extend(peers);
        summary.rows.push(row);
        eprintln!("{}: {}", case.name, case.what);
    }
    println!("{}", summary.markdown());
    if let Some(folder) = &options.out {
        summary.save(folder)?;
        full.save(folder)?;
    }
    Ok(if lost {
        println!("check: a case of ours has no result FAIL");
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

/// How far a value is from what was asked.
fn error(case: &Case, value: f64) -> String {
    if !value.is_finite() {
        return "–".to_owned();
    }
    let off = value - case.asked;
    match case.scale {
        Some(scale) => {
            let percent = 100.0 * off / scale;
            if percent.abs() < 0.005 {
                "0.00 %".to_owned()
            } else {
                format!("{percent:+.2} %")
            }
        }
        None => format!("{} {}", number(off), case.unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_of_ours_has_a_name_of_its_own() {
        let mut names: Vec<_> = cases::CASES.iter().map(|c| (c.name, c.what)).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), cases::CASES.len());
    }

    #[test]
    fn errors_are_in_parts_or_in_the_unit() {
        let mut case = Case {
            name: "",
            what: "",
            unit: "m",
            asked: 2.0,
            scale: Some(2.0),
            peer: false,
            run: |_| 0.0,
        };
        assert_eq!(error(&case, 2.1), "+5.00 %");
        assert_eq!(error(&case, f64::NAN), "–");
        case.scale = None;
        assert_eq!(error(&case, 2.5), "0.500 m");
    }
}
