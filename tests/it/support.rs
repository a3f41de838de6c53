//! What all tests share: rates, collected findings, edits of components.

use std::{
    env,
    fmt::{self, Display},
    io::{self, Write},
    thread,
};

use bevy::prelude::*;
use embody_scenes::Sim;

/// The tick rates that everything must hold at, hertz.
pub const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

/// Gravity of the harness, metres per second squared.
pub const G: f32 = 9.81;

/// Collects what went wrong, so that one failure shows the numbers of all cases.
#[derive(Default)]
pub struct Findings {
    wrong: Vec<String>,
    checked: usize,
}

impl Findings {
    pub fn new() -> Self {
        Self::default()
    }

    /// `measured` must be within `tolerance` of `wanted`.
    pub fn near(&mut self, what: impl Display, measured: f32, wanted: f32, tolerance: f32) {
        self.checked += 1;
        let off = (measured - wanted).abs();
        tell(format_args!(
            "{what}: {measured} for {wanted} ± {tolerance}"
        ));
        if off.is_nan() || off > tolerance {
            self.wrong.push(format!(
                "{what}: measured {measured}, wanted {wanted} ± {tolerance} (off by {off:.6})"
            ));
        }
    }

    /// `measured` must be within a part of `wanted`.
    pub fn within(&mut self, what: impl Display, measured: f32, wanted: f32, part: f32) {
        self.near(what, measured, wanted, (wanted * part).abs());
    }

    /// `measured` must not exceed `bound`.
    pub fn at_most(&mut self, what: impl Display, measured: f32, bound: f32) {
        self.checked += 1;
        tell(format_args!("{what}: {measured} at most {bound}"));
        if measured.is_nan() || measured > bound {
            self.wrong.push(format!(
                "{what}: measured {measured}, wanted at most {bound}"
            ));
        }
    }

    /// `measured` must not fall below `bound`.
    pub fn at_least(&mut self, what: impl Display, measured: f32, bound: f32) {
        self.checked += 1;
        tell(format_args!("{what}: {measured} at least {bound}"));
        if measured.is_nan() || measured < bound {
            self.wrong.push(format!(
                "{what}: measured {measured}, wanted at least {bound}"
            ));
        }
    }

    /// Two runs must be equal, tick by tick.
    pub fn same<T: PartialEq>(&mut self, what: impl Display, first: &[T], again: &[T]) {
        let differ = first.iter().zip(again).position(|(a, b)| a != b);
        self.holds(
            format!("{what}: first tick that differs {differ:?}"),
            differ.is_none() && first.len() == again.len(),
        );
    }

    /// Must be so.
    pub fn holds(&mut self, what: impl Display, so: bool) {
        self.checked += 1;
        if !so {
            self.wrong.push(format!("{what}: does not hold"));
        }
    }
}

/// Prints every figure when the variable `EMBODY_FIGURES` is set, for reports.
fn tell(line: fmt::Arguments) {
    if env::var_os("EMBODY_FIGURES").is_some() {
        let _ = writeln!(io::stderr(), "{line}");
    }
}

impl Drop for Findings {
    fn drop(&mut self) {
        if thread::panicking() {
            return;
        }
        assert!(self.checked > 0, "nothing was checked");
        assert!(
            self.wrong.is_empty(),
            "{} of {} checks failed:\n  {}",
            self.wrong.len(),
            self.checked,
            self.wrong.join("\n  ")
        );
    }
}

/// Changes a component in place.
pub fn edit<C: Component<Mutability = bevy::ecs::component::Mutable>>(
    sim: &mut Sim,
    entity: Entity,
    change: impl FnOnce(&mut C),
) {
    let mut entity = sim.app.world_mut().entity_mut(entity);
    change(&mut entity.get_mut::<C>().expect("the component is there"));
}

/// Adds components to an entity.
pub fn insert(sim: &mut Sim, entity: Entity, bundle: impl Bundle) {
    sim.app.world_mut().entity_mut(entity).insert(bundle);
}
