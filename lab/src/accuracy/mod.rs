//! What comes out beside closed forms: ours and Rapier's controller on the same scenes, at several
//! tick rates. A new case is a function and a line in [`cases`].

mod cases;
mod stage;

use std::process::ExitCode;

use crate::{
    options::Selection,
    side::Side,
    table::{Table, number},
};
use stage::Stage;

/// Tick rates, hertz.
const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

/// A scene with a known answer.
pub struct Case {
    pub name: &'static str,
    pub what: &'static str,
    pub unit: &'static str,
    /// The closed form.
    pub asked: f64,
    /// What an error is measured in parts of; `None` shows errors in the case's own unit.
    pub scale: Option<f64>,
    /// Greatest error of ours, in parts of the scale, or in the unit where there is none; infinite where
    /// it is shown and not judged.
    pub bound: f64,
    /// Whether Rapier's controller can run it.
    pub peer: bool,
    /// Whether a quick run leaves it out.
    pub slow: bool,
    pub run: fn(Stage) -> f64,
}

/// Measures and prints.
pub fn run(options: &Selection) -> Result<ExitCode, String> {
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
    let mut failures = Vec::new();
    let (mut judged, mut open) = (0, 0);
    let asked = |case: &&Case| options.wants(case.name) && !(options.quick && case.slow);
    for case in cases::all().into_iter().filter(asked) {
        let mut ours = Vec::new();
        let mut peers = Vec::new();
        for &hz in rates {
            let own = (case.run)(Stage::new(hz, Side::Ours));
            *if case.bound.is_finite() {
                &mut judged
            } else {
                &mut open
            } += 1;
            if !keeps(case, own) {
                failures.push(format!(
                    "check {}: {} at {hz} Hz: {} FAIL",
                    case.name,
                    case.what,
                    error(case, own)
                ));
            }
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
            format!(
                "{}: {}{}",
                case.name,
                case.what,
                if case.bound.is_finite() {
                    ""
                } else {
                    " (open: not judged)"
                }
            ),
            format!("{} {}", number(case.asked), case.unit)
                .trim_end()
                .to_owned(),
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
    for failure in &failures {
        println!("{failure}");
    }
    println!("{}", verdict(judged, open, failures.len()));
    Ok(if failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    })
}

/// The last line: what was judged, and what was only shown.
fn verdict(judged: usize, open: usize, failed: usize) -> String {
    let outcome = if failed == 0 { "pass" } else { "FAIL" };
    format!(
        "check {judged} figures of ours within their bounds: {outcome}, {failed} failed, {open} open"
    )
}

/// Whether a value of ours is as near as it must be; never what is no number.
fn keeps(case: &Case, value: f64) -> bool {
    let off = (value - case.asked).abs() / case.scale.unwrap_or(1.0).abs();
    off <= case.bound
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
        None => {
            let shown = format!("{} {}", number(off), case.unit);
            shown.trim_end().to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_of_ours_has_a_name_of_its_own() {
        let mut names: Vec<_> = cases::all().iter().map(|c| (c.name, c.what)).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    #[test]
    fn the_verdict_tells_what_was_not_judged() {
        assert_eq!(
            verdict(8, 4, 0),
            "check 8 figures of ours within their bounds: pass, 0 failed, 4 open"
        );
        assert!(verdict(8, 0, 1).contains("FAIL, 1 failed"));
    }

    #[test]
    fn errors_are_in_parts_or_in_the_unit() {
        let mut case = Case {
            name: "",
            what: "",
            unit: "m",
            asked: 2.0,
            scale: Some(2.0),
            bound: 0.05,
            peer: false,
            slow: false,
            run: |_| 0.0,
        };
        assert_eq!(error(&case, 2.1), "+5.00 %");
        assert_eq!(error(&case, f64::NAN), "–");
        assert!(keeps(&case, 2.09) && !keeps(&case, 2.11) && !keeps(&case, f64::NAN));
        case.scale = None;
        assert_eq!(error(&case, 2.5), "0.500 m");
        assert!(keeps(&case, 1.96) && !keeps(&case, 2.06));
    }
}
