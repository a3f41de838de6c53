//! Refuses values that a system cannot work with: the first bad one of a config, and the warning.

use bevy::prelude::*;

/// A refused value.
#[derive(Debug, PartialEq)]
pub(crate) struct Problem {
    pub field: &'static str,
    pub value: String,
    pub need: &'static str,
}

/// Says which value is bad and what becomes of its entity.
pub(crate) fn warn_bad(entity: Entity, field: &str, value: &str, need: &str, then: &str) {
    tracing::warn!("{entity}: {field} is {value}, but needs {need}; {then}");
}

/// Keeps the first problem that it finds.
#[derive(Default)]
pub(crate) struct Check(pub Option<Problem>);

impl Check {
    pub fn that(&mut self, ok: bool, field: &'static str, value: f32, need: &'static str) {
        if !ok && self.0.is_none() {
            self.0 = Some(Problem {
                field,
                value: value.to_string(),
                need,
            });
        }
    }

    pub fn positive(&mut self, field: &'static str, value: f32) {
        let ok = value > 0.0 && value.is_finite();
        self.that(ok, field, value, "a finite number above 0");
    }

    pub fn not_negative(&mut self, field: &'static str, value: f32) {
        let ok = value >= 0.0 && value.is_finite();
        self.that(ok, field, value, "a finite number of at least 0");
    }

    /// A limit may be infinite: then there is none.
    #[cfg(feature = "character")]
    pub fn limit(&mut self, field: &'static str, value: f32) {
        self.that(value >= 0.0, field, value, "a number of at least 0");
    }

    pub fn finite(&mut self, field: &'static str, value: f32) {
        self.that(value.is_finite(), field, value, "a finite number");
    }

    #[cfg(feature = "vehicle")]
    pub fn part(&mut self, field: &'static str, value: f32) {
        self.that((0.0..=1.0).contains(&value), field, value, "0 to 1");
    }

    #[cfg(feature = "vehicle")]
    pub fn finite_vec(&mut self, field: &'static str, value: Vec3) {
        self.finite(field, value.x + value.y + value.z);
    }
}
