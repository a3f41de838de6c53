//! Our controllers beside their peers, on one thread and two, at scale, at rest.

mod joints;
mod output;
mod world;

use std::{collections::BTreeSet, path::PathBuf, process::ExitCode, time::Instant};

use clap::Args;

use crate::{
    bounds::{Check, Must},
    readme,
    side::Side,
    subject::{self, Compared, Subject},
};
use output::{ratio, short};
use world::{Turns, World};

/// Threads on which the sides are compared.
const THREADS: [usize; 2] = [1, 2];
/// Sizes of the crowd for the scaling.
const SIZES: [u32; 3] = [100, 1000, LARGEST];
const LARGEST: u32 = 10_000;

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
    /// Runs every world by this command, such as `nice -n -5` or one that quiets the machine.
    #[arg(long)]
    under: Option<String>,
    /// Writes every tick as CSV and every result as lines of JSON into this folder.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Replaces the table in this file, between its comments `bench:<scene>:begin` and `…:end`.
    #[arg(long)]
    readme: Option<PathBuf>,
}

/// Every world that was measured.
pub struct Results {
    /// For each number of threads all of ours that are compared, and the peers'.
    sides: Vec<Vec<World>>,
    /// Ours in each size.
    crowds: Vec<World>,
    /// Ours in the middle size on two threads.
    shared: Option<World>,
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
    let results = measure(subject, options, repeats)?;
    let mut checks = Vec::new();
    judge_sides(subject, &results.sides, &mut checks);
    judge_state(subject, &results.sides, &mut checks);
    if subject.together {
        joints::judge(subject, &results.sides, &mut checks);
    }
    judge_crowds(subject, &results.crowds, &mut checks);
    judge_shared(subject, &results, &mut checks);
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
            .flatten()
            .chain(&results.crowds)
            .chain(&results.shared)
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

fn measure(subject: &Subject, options: &Options, repeats: usize) -> Result<Results, String> {
    let quick = options.quick;
    let under = options.under.as_deref().unwrap_or_default();
    let under: Vec<String> = under.split_whitespace().map(str::to_owned).collect();
    let turns = Turns {
        under: &under,
        started: Instant::now(),
    };
    let steps = |full: usize| if quick { full / 20 } else { full };
    // What a quick run shows, a small crowd shows as well.
    let size = |full: u32| if quick { full.min(SIZES[0]) } else { full };
    let world = |scene: &str, side, threads| {
        let steps = steps(subject.steps);
        World::new(scene, side, threads, size(subject.count), steps)
    };
    let mut sides: Vec<World> = THREADS
        .into_iter()
        .flat_map(|threads| {
            let ours = subject.compared.iter().map(|c| (c.scene, Side::Ours));
            ours.chain(peers(subject).map(|scene| (scene, Side::Rapier)))
                .map(move |(scene, side)| (scene, side, threads))
        })
        .map(|(scene, side, threads)| world(scene, side, threads))
        .collect();
    turns.measure(&mut sides, |_| repeats)?;
    let mut left = sides.into_iter();
    let sides = THREADS
        .iter()
        .map(|_| {
            let each = subject.compared.len() + peers(subject).count();
            left.by_ref().take(each).collect()
        })
        .collect();
    // Large crowds take long: the same short stretch of time is measured for every size, and the
    // largest, which is a mean over many already, once.
    let sizes = match (subject.together, quick) {
        (true, _) => &[],
        (_, true) => &SIZES[..2],
        _ => &SIZES[..],
    };
    let mut crowds: Vec<World> = sizes
        .iter()
        .map(|size| World::new(subject.name, Side::Ours, 1, *size, steps(100)))
        .collect();
    let shared = World::new(subject.name, Side::Ours, 2, size(SIZES[1]), steps(100));
    // Beside the one that it is compared with.
    if !crowds.is_empty() {
        crowds.insert(1, shared);
    }
    turns.measure(&mut crowds, |world| {
        repeats.min(3).min((LARGEST / world.options.count) as usize)
    })?;
    let shared = (!crowds.is_empty()).then(|| crowds.remove(1));
    let mut variants: Vec<World> = subject
        .variants
        .iter()
        .map(|variant| {
            let steps = steps(subject.steps);
            World::new(variant.scene, Side::Ours, 1, size(variant.count), steps)
        })
        .collect();
    turns.measure(&mut variants, |_| repeats)?;
    Ok(Results {
        sides,
        crowds,
        shared,
        variants,
    })
}

fn judge_sides(subject: &Subject, sides: &[Vec<World>], checks: &mut Vec<Check>) {
    for worlds in sides {
        for (compared, own, peer) in pairs(subject, worlds) {
            let threads = own.options.threads;
            let about = about(subject, threads, compared.tag);
            let (ours, rapier) = (own.work(), peer.work());
            let factor = ours / rapier;
            let (scale, unit) = if subject.together {
                (1e-3 * f64::from(own.options.count), "ms")
            } else {
                (1.0, "us")
            };
            println!(
                "peers {about} ours={:.1}{unit} rapier={:.1}{unit} ratio={}",
                ours * scale,
                rapier * scale,
                ratio(factor)
            );
            println!(
                "whole update {about} ours={:.0}us rapier={:.0}us",
                own.whole(),
                peer.whole(),
            );
            if threads != 1 {
                continue;
            }
            let mut timing = |what: &str, value, bound: Option<f64>| {
                if let Some(bound) = bound {
                    let what = format!("{what} on one thread {}", compared.tag);
                    checks.push(Check::timing(what.trim(), value, Must::BeAtMost, bound));
                }
            };
            timing("ratio", factor, compared.ratio);
            timing("microseconds", ours, compared.most);
        }
    }
    for (compared, speed_up) in speed_ups(subject, sides) {
        let about = about(subject, THREADS[1], compared.tag);
        println!("peers {about} speedup={speed_up:.2}x");
        let what = format!("speed-up by two threads {}", compared.tag);
        let least = subject.bounds.speed_up;
        checks.push(Check::timing(what.trim(), speed_up, Must::BeAtLeast, least));
    }
}

/// The peer's scenes.
fn peers(subject: &Subject) -> impl Iterator<Item = &'static str> + use<> {
    let own = subject.compared.iter().map(|c| c.scene);
    let count = if subject.together { own.len() } else { 0 };
    let one = (count == 0).then_some(subject.name);
    own.take(count).chain(one)
}

/// Each of ours with its peer.
pub fn pairs<'a>(
    subject: &'a Subject,
    worlds: &'a [World],
) -> impl Iterator<Item = (&'a Compared, &'a World, &'a World)> {
    let (ours, peers) = worlds.split_at(subject.compared.len().min(worlds.len()));
    let all = subject.compared.iter().zip(ours).enumerate();
    all.filter_map(|(i, (compared, own))| Some((compared, own, peers.get(i).or(peers.last())?)))
}

/// By what factor the second thread makes each of ours faster.
fn speed_ups<'a>(
    subject: &'a Subject,
    sides: &'a [Vec<World>],
) -> impl Iterator<Item = (&'a Compared, f64)> {
    let on = |i: usize| sides.get(i).map_or(&[][..], Vec::as_slice);
    let pairs = on(0).iter().zip(on(1));
    let compared = subject.compared.iter();
    compared
        .zip(pairs)
        .map(|(c, (one, two))| (c, one.wall() / two.wall()))
}

/// By what factor the second thread makes the crowd of the middle size faster.
fn shared_speed_up(results: &Results) -> Option<f64> {
    let (alone, shared) = (results.crowds.get(1)?, results.shared.as_ref()?);
    (alone.options.count == shared.options.count).then(|| alone.wall() / shared.wall())
}

fn judge_shared(subject: &Subject, results: &Results, checks: &mut Vec<Check>) {
    let (Some(speed_up), Some(shared)) = (shared_speed_up(results), &results.shared) else {
        return;
    };
    let n = shared.options.count;
    println!(
        "scale {} n={n} threads=2 speedup={speed_up:.2}x",
        subject.name
    );
    let what = format!("speed-up of {n} by two threads");
    let least = subject.bounds.speed_up;
    checks.push(Check::timing(what, speed_up, Must::BeAtLeast, least));
}

/// What a line of results is about.
fn about(subject: &Subject, threads: usize, tag: &str) -> String {
    let line = format!("{} threads={threads} {tag}", subject.name);
    line.trim_end().to_owned()
}

fn judge_state(subject: &Subject, sides: &[Vec<World>], checks: &mut Vec<Check>) {
    let [one, two] = sides else { return };
    for (compared, ours) in subject.compared.iter().zip(one.iter().zip(two)) {
        let ours = [ours.0, ours.1];
        let named = |what: &str| format!("{what} {}", compared.tag).trim_end().to_owned();
        let allocations = ours[0].allocations();
        println!(
            "{}",
            named(&format!("allocations per tick={}", short(allocations)))
        );
        // A quick run is over before every buffer has grown to its size; a whole tick is the engine's, too.
        if !subject.together {
            checks.push(Check::timing(
                named("allocations per tick"),
                allocations,
                Must::Equal,
                0.0,
            ));
        }
        for world in ours {
            println!(
                "state {} hash={:016x}",
                about(subject, world.options.threads, compared.tag),
                world.hash()
            );
        }
        let hashes: BTreeSet<u64> = ours
            .iter()
            .flat_map(|world| world.runs.iter().map(|run| run.hash))
            .collect();
        checks.push(Check::exact(
            named("different states of one world"),
            hashes.len() as f64,
            Must::Equal,
            1.0,
        ));
        let lost = ours[0].lost();
        let of_peer = one.last().map_or(0, World::lost);
        println!(
            "{}",
            named(&format!(
                "left the level {} n={lost} rapier={of_peer}",
                subject.name
            ))
        );
        // Somebody far up in the air is cheap: figures with such are none.
        checks.push(Check::timing(
            named(&format!("{} that left the level", subject.name)),
            lost as f64,
            Must::Equal,
            0.0,
        ));
    }
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
