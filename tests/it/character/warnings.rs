//! Counts the warnings that name an entity, for tests that run side by side in one process.

use std::sync::{
    Mutex, Once,
    atomic::{AtomicU32, Ordering},
};

use bevy::prelude::*;
use embody_scenes::Sim;
use tracing::{Event, Level, Metadata, Subscriber, field, span};

static LINES: Mutex<Vec<String>> = Mutex::new(Vec::new());
static START: Once = Once::new();
static WORLDS: AtomicU32 = AtomicU32::new(1);

/// Takes in warnings and errors, nothing else.
struct Ear;

struct Line(String);

impl field::Visit for Line {
    fn record_debug(&mut self, field: &field::Field, value: &dyn core::fmt::Debug) {
        use core::fmt::Write;
        write!(self.0, "{}={value:?} ", field.name()).expect("a string takes everything");
    }
}

impl Subscriber for Ear {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        *metadata.level() <= Level::WARN && metadata.target().starts_with("bevy_embody")
    }
    fn new_span(&self, _: &span::Attributes<'_>) -> span::Id {
        span::Id::from_u64(1)
    }
    fn record(&self, _: &span::Id, _: &span::Record<'_>) {}
    fn record_follows_from(&self, _: &span::Id, _: &span::Id) {}
    fn event(&self, event: &Event<'_>) {
        let mut line = Line(String::new());
        event.record(&mut line);
        LINES
            .lock()
            .expect("no test panics while it holds this")
            .push(line.0);
    }
    fn enter(&self, _: &span::Id) {}
    fn exit(&self, _: &span::Id) {}
}

/// Starts to listen, and makes the ids of the entities that this world spawns from now on its own.
pub fn unique_entities(sim: &mut Sim) {
    START.call_once(|| {
        tracing::subscriber::set_global_default(Ear).expect("no other listener in this binary");
    });
    // Worlds that do not listen stay below the first id; those that do spawn less than the step.
    let first = 20_000 + WORLDS.fetch_add(1, Ordering::Relaxed) * 256;
    let world = sim.app.world_mut();
    while world.spawn_empty().id().index_u32() < first {}
}

/// The warnings so far that name this entity.
pub fn about(entity: Entity) -> Vec<String> {
    let name = entity.to_string();
    LINES
        .lock()
        .expect("no test panics while it holds this")
        .iter()
        .filter(|line| {
            line.match_indices(&name).any(|(at, _)| {
                !line[..at].ends_with(|c: char| c.is_ascii_digit())
                    && !line[at + name.len()..].starts_with(|c: char| c.is_ascii_digit())
            })
        })
        .cloned()
        .collect()
}
