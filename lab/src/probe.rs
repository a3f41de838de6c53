//! Systems that stand before and after what is measured.

use std::time::{Duration, Instant};

use bevy::prelude::*;

use crate::alloc;

/// What was spent between [`begin`] and [`end`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Time that passed.
    pub wall: Duration,
    /// Time that the calling thread was on a processor: on one thread the same, but for what other
    /// programs of the machine took in between.
    pub busy: Duration,
    /// Heap allocations of all threads.
    pub allocations: u64,
}

/// The running measurement of a tick.
#[derive(Resource, Default)]
pub struct Probe {
    spent: Spent,
    since: Option<(Instant, Duration, u64)>,
}

impl Probe {
    /// What was spent since the last call.
    pub fn take(&mut self) -> Spent {
        core::mem::take(&mut self.spent)
    }
}

/// What is measured begins here.
pub fn begin(mut probe: ResMut<Probe>) {
    let allocations = alloc::counted();
    alloc::count(true);
    probe.since = Some((Instant::now(), on_processor(), allocations));
}

/// What is measured ends here.
pub fn end(mut probe: ResMut<Probe>) {
    let Some((wall, busy, allocations)) = probe.since.take() else {
        return;
    };
    probe.spent.busy += on_processor().saturating_sub(busy);
    probe.spent.wall += wall.elapsed();
    alloc::count(false);
    probe.spent.allocations += alloc::counted() - allocations;
}

/// How long the calling thread has been on a processor.
#[cfg(unix)]
pub fn on_processor() -> Duration {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(now.tv_sec as u64, now.tv_nsec as u32)
}

/// How long the process has been running: there is no better clock here.
#[cfg(not(unix))]
pub fn on_processor() -> Duration {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}
