//! What is asked of a walker or a driver, and whether it happened.

use core::fmt;

use super::trace::Trace;

/// Something asked of who is at a station; `T` is the trace by which it is judged.
pub struct Check<T = Trace> {
    /// What is asked, for a reader.
    pub asked: String,
    judge: Box<dyn Fn(&T) -> Verdict + Send + Sync>,
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What happened, for a reader.
    pub got: String,
    /// Whether it is what was asked.
    pub pass: bool,
}

impl Verdict {
    /// A verdict.
    pub fn new(pass: bool, got: impl Into<String>) -> Self {
        Self {
            got: got.into(),
            pass,
        }
    }

    /// Whether a value is at most this; a NaN is not.
    pub fn at_most(value: f64, bound: f64, got: impl Into<String>) -> Self {
        Self::new(value <= bound, got)
    }

    /// Whether a value is this one, within a part of it; a NaN is not.
    pub fn close(value: f64, expected: f64, part: f64, got: impl Into<String>) -> Self {
        Self::new((value - expected).abs() <= part * expected.abs(), got)
    }

    /// Something that had to happen before it could be judged did not.
    pub fn never(what: &str) -> Self {
        Self::new(false, format!("never {what}"))
    }
}

impl<T> Check<T> {
    /// Asks something; `judge` looks at what was done.
    pub fn new(
        asked: impl Into<String>,
        judge: impl Fn(&T) -> Verdict + Send + Sync + 'static,
    ) -> Self {
        Self {
            asked: asked.into(),
            judge: Box::new(judge),
        }
    }

    /// Judges.
    pub fn judge(&self, trace: &T) -> Verdict {
        (self.judge)(trace)
    }
}

impl<T> fmt::Debug for Check<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Check")
            .field("asked", &self.asked)
            .finish_non_exhaustive()
    }
}
