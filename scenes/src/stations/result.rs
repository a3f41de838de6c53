//! What came of a station.

use super::{
    Check, Verdict,
    trace::{OfStep, Trace},
    tracked::Tracked,
};

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckResult {
    /// What was asked.
    pub asked: String,
    /// What happened.
    pub got: String,
    /// Whether it is what was asked.
    pub pass: bool,
}

/// What came of a station.
#[derive(Clone, Debug, PartialEq)]
pub struct StationResult {
    /// Its name.
    pub name: String,
    /// Its checks, the first of which is that the script could be played to its end.
    pub checks: Vec<CheckResult>,
    /// Seconds of simulated time that it took.
    pub seconds: f64,
    /// Why nothing was asked, if nothing was: what the station has in it is not for this one.
    pub exempt: Option<String>,
}

/// How far a script was played.
#[derive(Debug)]
pub struct Played<'a> {
    /// Why it was given up, if it was.
    pub stopped: Option<&'a str>,
    /// The step that comes next, from 0.
    pub step: usize,
    /// How many steps there are.
    pub steps: usize,
    /// The nodes that were followed.
    pub tracked: &'a Tracked,
}

impl Played<'_> {
    fn verdict(&self) -> Verdict {
        let missing = &self.tracked.missing;
        match self.stopped {
            Some(why) => Verdict::new(false, why),
            None if self.step < self.steps => Verdict::new(
                false,
                format!("was at step {} of {}", self.step + 1, self.steps),
            ),
            None if !missing.is_empty() => Verdict::new(
                false,
                format!("the level has no node {}", missing.join(", ")),
            ),
            None => Verdict::new(true, "done"),
        }
    }
}

impl StationResult {
    /// Judges a trace: first that the script, which is `describe`, could be played, then each check.
    pub fn judge<S: OfStep>(
        name: String,
        describe: &str,
        played: &Played,
        checks: &[Check<Trace<S>>],
        trace: &Trace<S>,
    ) -> Self {
        let result = |asked: &str, verdict: Verdict| CheckResult {
            asked: asked.into(),
            got: verdict.got,
            pass: verdict.pass,
        };
        // Without its nodes a check would look at others.
        let playable = played.tracked.missing.is_empty();
        let judged = checks.iter().map(|check| {
            let verdict = if playable {
                check.judge(trace)
            } else {
                Verdict::new(false, "could not be judged")
            };
            result(&check.asked, verdict)
        });
        Self {
            name,
            checks: core::iter::once(result(describe, played.verdict()))
                .chain(judged)
                .collect(),
            seconds: trace.last().map_or(0.0, S::time),
            exempt: None,
        }
    }

    /// Whether all that was asked happened.
    pub fn passed(&self) -> bool {
        self.exempt.is_none() && self.checks.iter().all(|check| check.pass)
    }

    /// Whether something that was asked did not happen.
    pub fn failed(&self) -> bool {
        self.exempt.is_none() && !self.passed()
    }
}
