//! Our controllers beside their peers, on one thread and two, at scale, at rest.

mod output;
mod world;

use std::{collections::BTreeSet, path::PathBuf, process::ExitCode};

use clap::Args;

use crate::{
    bounds::{Check, Must},
    readme,
    side::Side,
    subject::{self, Subject},
};
use output::{ratio, short};
use world::{World, measure_in_turns};

/// Threads on which the sides are compared.
const THREADS: [usize; 2] = [1, 2];
/// Sizes of the crowd for the scaling.
const SIZES: [u32; 3] = [100, 1000, 10_000];

/// What to measure.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// What is compared.
    #[arg(long, default_value = "characters")]
    scene: String,
    /// Short runs that show that everything works; their times mean nothing and are not judged.
    #[arg(long)]
    quick: bool,
    /// Runs of every world, in turns; more make it less sensitive to what else the machine does.
    #[arg(long)]
    repeats: Option<usize>,
    /// Writes every tick as CSV and every result as lines of JSON into this folder.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Replaces the table in this file, between its comments `bench:<scene>:begin` and `…:end`.
    #[arg(long)]
    readme: Option<PathBuf>,
}

/// Every world that was measured.
pub struct Results {
    /// Ours and the peer's, for each number of threads.
    sides: Vec<World>,
    /// Ours in each size.
    crowds: Vec<World>,
    /// Ours in the subject's other scenes.
    variants: Vec<World>,
}

/// Measures, prints, judges.
pub fn run(options: &Options) -> Result<ExitCode, String> {
    let subject = subject::find(&options.scene)?;
    let repeats = options
        .repeats
        .unwrap_or(if options.quick { 1 } else { 5 })
        .max(1);
    let results = measure(subject, options.quick, repeats)?;
    let mut checks = Vec::new();
    judge_sides(subject, &results.sides, &mut checks);
    judge_state(subject, &results.sides, &mut checks);
    judge_crowds(subject, &results.crowds, &mut checks);
    for (variant, world) in subject.variants.iter().zip(&results.variants) {
        let us = world.work();
        let digits = if us < 1.0 { 3 } else { 1 };
        println!("{} {} us={us:.digits$}", variant.name, subject.name);
        let what = format!("{}, microseconds", variant.label);
        checks.push(Check::timing(what, us, Must::BeBelow, variant.most));
    }
    if options.quick {
        println!("quick run: its times mean nothing");
    }
    for check in checks
        .iter()
        .filter(|check| !(options.quick && check.timing))
    {
        println!("{check}");
    }
    if let Some(folder) = &options.out {
        let worlds: Vec<&World> = results
            .sides
            .iter()
            .chain(&results.crowds)
            .chain(&results.variants)
            .collect();
        output::write_out(folder, &worlds, &checks)
            .map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    if let Some(file) = &options.readme {
        let table = output::table(subject, &results, repeats);
        readme::replace_table(file, &format!("bench:{}", subject.name), &table)?;
    }
    let failed = checks
        .iter()
        .any(|check| !(check.passes() || options.quick && check.timing));
    Ok(if failed {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    })
}

fn measure(subject: &Subject, quick: bool, repeats: usize) -> Result<Results, String> {
    let scene = subject.name;
    let steps = |full: usize| if quick { full / 20 } else { full };
    // What a quick run shows, a small crowd shows as well.
    let size = |full: u32| if quick { full.min(SIZES[0]) } else { full };
    let mut sides: Vec<World> = THREADS
        .into_iter()
        .flat_map(|threads| [(Side::Ours, threads), (Side::Rapier, threads)])
        .map(|(side, threads)| {
            let steps = steps(subject.steps);
            World::new(scene, side, threads, size(subject.count), steps)
        })
        .collect();
    measure_in_turns(&mut sides, repeats)?;
    // Large crowds take long; the same short stretch of time is measured for every size.
    let sizes = if quick { &SIZES[..2] } else { &SIZES[..] };
    let mut crowds: Vec<World> = sizes
        .iter()
        .map(|size| World::new(scene, Side::Ours, 1, *size, steps(100)))
        .collect();
    measure_in_turns(&mut crowds, repeats.min(3))?;
    let mut variants: Vec<World> = subject
        .variants
        .iter()
        .map(|variant| {
            let steps = steps(subject.steps);
            World::new(variant.scene, Side::Ours, 1, size(variant.count), steps)
        })
        .collect();
    measure_in_turns(&mut variants, repeats)?;
    Ok(Results {
        sides,
        crowds,
        variants,
    })
}

fn judge_sides(subject: &Subject, sides: &[World], checks: &mut Vec<Check>) {
    let scene = subject.name;
    for pair in sides.chunks_exact(2) {
        let threads = pair[0].options.threads;
        let (ours, rapier) = (pair[0].work(), pair[1].work());
        let factor = ours / rapier;
        println!(
            "peers {scene} threads={threads} ours={ours:.1}us rapier={rapier:.1}us ratio={}",
            ratio(factor)
        );
        println!(
            "whole update {scene} threads={threads} ours={:.0}us rapier={:.0}us",
            pair[0].whole(),
            pair[1].whole(),
        );
        if threads != 1 {
            continue;
        }
        let mut timing = |what: &str, value, bound: Option<f64>| {
            if let Some(bound) = bound {
                checks.push(Check::timing(what, value, Must::BeAtMost, bound));
            }
        };
        timing("ratio on one thread", factor, subject.bounds.ratio);
        timing("microseconds on one thread", ours, subject.bounds.most);
    }
    let speed_up = sides[0].wall() / sides[2].wall();
    println!("peers {scene} threads=2 speedup={speed_up:.2}x");
    checks.push(Check::timing(
        "speed-up by two threads",
        speed_up,
        Must::BeAtLeast,
        subject.bounds.speed_up,
    ));
}

fn judge_state(subject: &Subject, sides: &[World], checks: &mut Vec<Check>) {
    let scene = subject.name;
    let ours = [&sides[0], &sides[2]];
    let allocations = ours[0].allocations();
    println!("allocations per tick={}", short(allocations));
    // A quick run is over before every buffer has grown to its size.
    checks.push(Check::timing(
        "allocations per tick",
        allocations,
        Must::Equal,
        0.0,
    ));
    for world in ours {
        println!(
            "state {scene} threads={} hash={:016x}",
            world.options.threads,
            world.hash()
        );
    }
    let hashes: BTreeSet<u64> = ours
        .iter()
        .flat_map(|world| world.runs.iter().map(|run| run.hash))
        .collect();
    checks.push(Check::exact(
        "different states of one world",
        hashes.len() as f64,
        Must::Equal,
        1.0,
    ));
    let lost = ours[0].lost();
    println!("left the level {scene} n={lost} rapier={}", sides[1].lost());
    // Somebody far up in the air is cheap: figures with such are none.
    checks.push(Check::timing(
        format!("{scene} that left the level"),
        lost as f64,
        Must::Equal,
        0.0,
    ));
}

fn judge_crowds(subject: &Subject, crowds: &[World], checks: &mut Vec<Check>) {
    let Some(few) = crowds.first() else { return };
    for crowd in crowds {
        let (n, us) = (crowd.options.count, crowd.work());
        println!("scale {} n={n} us={us:.2}", subject.name);
        if n != SIZES[0] {
            let what = format!("cost of one of {n}, of one of {}", SIZES[0]);
            let growth = us / few.work();
            checks.push(Check::timing(
                what,
                growth,
                Must::BeAtMost,
                subject.bounds.growth,
            ));
        }
    }
}
