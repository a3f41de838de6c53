//! Systems that stand before and after what is measured.

use std::time::{Duration, Instant};

use bevy::prelude::*;

use crate::alloc;

/// What was spent between [`begin`] and [`end`] since it was last taken.
#[derive(Resource, Default)]
pub struct Probe {
    since: Option<Instant>,
    spent: Duration,
    allocations: u64,
    before: u64,
}

impl Probe {
    /// Time and allocations of the tick that is over.
    pub fn take(&mut self) -> (Duration, u64) {
        let taken = (self.spent, self.allocations);
        *self = Self::default();
        taken
    }
}

/// What is measured begins here.
pub fn begin(mut probe: ResMut<Probe>) {
    probe.before = alloc::counted();
    alloc::count(true);
    probe.since = Some(Instant::now());
}

/// What is measured ends here.
pub fn end(mut probe: ResMut<Probe>) {
    let Some(since) = probe.since.take() else {
        return;
    };
    probe.spent += since.elapsed();
    alloc::count(false);
    let before = probe.before;
    probe.allocations += alloc::counted() - before;
}
