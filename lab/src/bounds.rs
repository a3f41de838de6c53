//! What a measured value must be, and whether it is.

use core::fmt;

use serde::Serialize;

/// How a value is held against its bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Must {
    /// No more than the bound.
    BeAtMost,
    /// No less than the bound.
    BeAtLeast,
    /// Below the bound.
    BeBelow,
    /// Exactly the bound.
    Equal,
}

/// A value that was measured and its bound.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    pub what: String,
    pub value: f64,
    pub must: Must,
    pub bound: f64,
    /// Whether it is about time: such values mean nothing in a quick run.
    pub timing: bool,
}

impl Check {
    /// A bound on a time or a ratio of times.
    pub fn timing(what: impl Into<String>, value: f64, must: Must, bound: f64) -> Self {
        Self {
            what: what.into(),
            value,
            must,
            bound,
            timing: true,
        }
    }

    /// A bound on something that the machine's load cannot change.
    pub fn exact(what: impl Into<String>, value: f64, must: Must, bound: f64) -> Self {
        Self {
            timing: false,
            ..Self::timing(what, value, must, bound)
        }
    }

    /// Whether the bound is kept; never by what is not a number.
    pub fn passes(&self) -> bool {
        match self.must {
            Must::BeAtMost => self.value <= self.bound,
            Must::BeAtLeast => self.value >= self.bound,
            Must::BeBelow => self.value < self.bound,
            Must::Equal => self.value == self.bound,
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = match self.must {
            Must::BeAtMost => "<=",
            Must::BeAtLeast => ">=",
            Must::BeBelow => "<",
            Must::Equal => "=",
        };
        let verdict = if self.passes() { "pass" } else { "FAIL" };
        let (value, bound) = (rounded(self.value), self.bound);
        write!(f, "check {}: {value} {sign} {bound} {verdict}", self.what)
    }
}

fn rounded(value: f64) -> f64 {
    (value * 1e4).round() * 1e-4
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_kept_or_not() {
        let check = |value, must| Check::exact("x", value, must, 1.0).passes();
        assert!(check(1.0, Must::BeAtMost) && !check(1.1, Must::BeAtMost));
        assert!(check(1.0, Must::BeAtLeast) && !check(0.9, Must::BeAtLeast));
        assert!(check(0.9, Must::BeBelow) && !check(1.0, Must::BeBelow));
        assert!(check(1.0, Must::Equal) && !check(1.1, Must::Equal));
        assert!(!check(f64::NAN, Must::BeAtMost) && !check(f64::NAN, Must::BeAtLeast));
    }
}
