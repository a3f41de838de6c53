//! The cases, by the car of [`embody_scenes::reference`]: 1500 kg, wheelbase 2.8 m, track 1.6 m, centre
//! of mass 0.55 m up, 1.5 Hz at half of critical damping, friction 1. A new one is a function and a line
//! in the list of its file.

mod brakes;
mod differentials;
mod drive;
mod extremes;
mod gears;
mod ground;
mod launch;
mod obstacles;
mod repeat;
mod springs;
mod tires;
mod turning;

use super::{Case, stage::Stage};

/// All lists.
const LISTS: &[&[Case]] = &[
    springs::CASES,
    drive::CASES,
    launch::CASES,
    brakes::CASES,
    turning::CASES,
    tires::CASES,
    gears::CASES,
    differentials::CASES,
    ground::CASES,
    obstacles::CASES,
    repeat::CASES,
    extremes::CASES,
];

/// All cases, in the order of their names.
pub fn all() -> Vec<&'static Case> {
    let mut all: Vec<&Case> = LISTS.iter().copied().flatten().collect();
    // Stable: those of one name keep their order.
    all.sort_by_key(|case| number(case.name));
    all
}

/// The number at the end of a name.
fn number(name: &str) -> u32 {
    let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
    digits.parse().unwrap_or(u32::MAX)
}

/// `asked` is the closed form, `bound` the greatest error in parts of it.
const fn case(
    name: &'static str,
    what: &'static str,
    unit: &'static str,
    asked: f64,
    bound: f64,
    run: fn(Stage) -> f64,
) -> Case {
    Case {
        name,
        what,
        unit,
        asked,
        scale: Some(asked),
        bound,
        peer: true,
        slow: false,
        run,
    }
}

/// One that is asked for nothing: its errors and their bound are in its unit.
const fn nothing(
    name: &'static str,
    what: &'static str,
    unit: &'static str,
    bound: f64,
    run: fn(Stage) -> f64,
) -> Case {
    Case {
        scale: None,
        ..case(name, what, unit, 0.0, bound, run)
    }
}

/// One that Rapier's controller has no means for.
const fn alone(case: Case) -> Case {
    Case {
        peer: false,
        ..case
    }
}

/// One that a quick run leaves out.
const fn slow(case: Case) -> Case {
    Case { slow: true, ..case }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Value and place of the greatest of a path, by the parabola through it and its neighbours; in ticks.
fn peak(path: &[f64]) -> (f64, f64) {
    let mut top = 1;
    for i in 1..path.len().saturating_sub(1) {
        if path[i] > path[top] {
            top = i;
        }
    }
    let [a, b, c] = path[top - 1..=top + 1] else {
        return (f64::NAN, f64::NAN);
    };
    let bend = a - 2.0 * b + c;
    if bend.abs() < 1.0e-12 {
        return (b, top as f64);
    }
    let off = 0.5 * (a - c) / bend;
    (b - 0.25 * (a - c) * off, top as f64 + off)
}
