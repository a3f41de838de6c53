//! Our controller beside its peer, on one thread and two, at scale, at rest.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use clap::Args;
use serde::Serialize;

use crate::{
    bounds::{Check, Must},
    process, readme,
    run::{self, Measured},
    scene,
    side::Side,
    stats::typical,
};

/// Threads on which the sides are compared.
const THREADS: [usize; 2] = [1, 2];
/// Sizes of the crowd for the scaling.
const SIZES: [u32; 3] = [100, 1000, 10_000];

/// Most of the peer's time that a character may take, on one thread.
const RATIO: f64 = 0.10;
/// Least speed-up by a second thread.
const SPEED_UP: f64 = 1.7;
/// Most that a character in a large crowd may cost, of one in the smallest.
const GROWTH: f64 = 1.2;
/// An idle character costs less than this, microseconds.
const IDLE: f64 = 0.3;

/// What to measure.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// Scene in which the sides are compared.
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
    /// Replaces the table in this file, between its `bench:begin` and `bench:end` comments.
    #[arg(long)]
    readme: Option<PathBuf>,
}

/// One kind of world and what all its runs measured.
struct World {
    options: run::Options,
    runs: Vec<Measured>,
}

impl World {
    fn new(scene: &str, only: Side, threads: usize, characters: u32, steps: usize) -> Self {
        Self {
            options: run::Options {
                scene: scene.to_owned(),
                only,
                threads,
                characters,
                steps,
                warm_up: None,
                json: true,
            },
            runs: Vec::new(),
        }
    }

    /// The characters' work, microseconds per character and tick. On one thread it is the time on a
    /// processor, which other programs cannot add to; on several the time that passed.
    fn work(&self) -> f64 {
        match self.options.threads {
            1 => self.typical(|run| &run.busy) / f64::from(self.options.characters),
            _ => self.wall(),
        }
    }

    /// The time that passed during the characters' work, microseconds per character and tick.
    fn wall(&self) -> f64 {
        self.typical(|run| &run.wall) / f64::from(self.options.characters)
    }

    /// An update of the app, microseconds.
    fn whole(&self) -> f64 {
        self.typical(|run| &run.whole)
    }

    fn typical(&self, of: impl Fn(&Measured) -> &[u64]) -> f64 {
        let runs: Vec<&[u64]> = self.runs.iter().map(of).collect();
        typical(&runs) * 1e-3
    }

    /// The most allocations of a run, per tick.
    fn allocations(&self) -> f64 {
        let most = self
            .runs
            .iter()
            .map(|run| run.allocations.iter().sum::<u64>())
            .max();
        most.map_or(f64::NAN, |most| most as f64 / self.options.steps as f64)
    }
}

/// Runs every world as often as asked, in turns.
fn measure_in_turns(worlds: &mut [World], repeats: usize) -> Result<(), String> {
    for turn in 0..repeats {
        for i in 0..worlds.len() {
            // Every other turn backwards, so that none always comes first.
            let i = if turn % 2 == 0 {
                i
            } else {
                worlds.len() - 1 - i
            };
            let options = &worlds[i].options;
            eprintln!(
                "run {}/{repeats}: {} {} threads={} n={}",
                turn + 1,
                options.scene,
                options.only.name(),
                options.threads,
                options.characters,
            );
            let measured = process::measure(options)?;
            worlds[i].runs.push(measured);
        }
    }
    Ok(())
}

/// One line of results.
#[derive(Serialize)]
struct Line {
    scene: String,
    side: Side,
    threads: usize,
    characters: u32,
    us_per_character: f64,
    us_per_update: f64,
    allocations_per_tick: f64,
    hash: String,
}

/// Measures, prints, judges.
pub fn run(options: &Options) -> Result<ExitCode, String> {
    let scene = scene::find(&options.scene)?.name;
    let steps = |full: usize| if options.quick { full / 20 } else { full };
    let repeats = options
        .repeats
        .unwrap_or(if options.quick { 1 } else { 5 })
        .max(1);
    let mut checks = Vec::new();

    let mut sides: Vec<World> = THREADS
        .into_iter()
        .flat_map(|threads| [(Side::Ours, threads), (Side::Rapier, threads)])
        .map(|(side, threads)| World::new(scene, side, threads, SIZES[0], steps(500)))
        .collect();
    measure_in_turns(&mut sides, repeats)?;
    for (pair, threads) in sides.chunks_exact(2).zip(THREADS) {
        let (ours, rapier) = (pair[0].work(), pair[1].work());
        let ratio = ours / rapier;
        println!(
            "peers {scene} threads={threads} ours={ours:.1}us rapier={rapier:.1}us ratio={ratio:.3}"
        );
        println!(
            "whole update {scene} threads={threads} ours={:.0}us rapier={:.0}us",
            pair[0].whole(),
            pair[1].whole(),
        );
        if threads == 1 {
            checks.push(Check::timing(
                "ratio on one thread",
                ratio,
                Must::BeAtMost,
                RATIO,
            ));
        }
    }
    let speed_up = sides[0].wall() / sides[2].wall();
    println!("peers {scene} threads=2 speedup={speed_up:.2}x");
    checks.push(Check::timing(
        "speed-up by two threads",
        speed_up,
        Must::BeAtLeast,
        SPEED_UP,
    ));
    let allocations = sides[0].allocations();
    println!("allocations per tick={}", short(allocations));
    // A quick run is over before every buffer has grown to its size.
    checks.push(Check::timing(
        "allocations per tick",
        allocations,
        Must::Equal,
        0.0,
    ));
    let hashes: BTreeSet<u64> = [&sides[0], &sides[2]]
        .iter()
        .flat_map(|world| world.runs.iter().map(|run| run.hash))
        .collect();
    for world in [&sides[0], &sides[2]] {
        let hash = world.runs.first().map_or(0, |run| run.hash);
        println!(
            "state {scene} threads={} hash={hash:016x}",
            world.options.threads
        );
    }
    let different = hashes.len() as f64;
    checks.push(Check::exact(
        "different states of one world",
        different,
        Must::Equal,
        1.0,
    ));

    let lost = sides[0]
        .runs
        .iter()
        .map(|run| run.lost.len())
        .max()
        .unwrap_or(0);
    println!("left the level {scene} n={lost}");
    // Somebody far up in the air is cheap: figures with such are none.
    checks.push(Check::timing(
        "characters that left the level",
        lost as f64,
        Must::Equal,
        0.0,
    ));

    // Large crowds take long; the same short stretch of time is measured for every size.
    let sizes = if options.quick {
        &SIZES[..2]
    } else {
        &SIZES[..]
    };
    let mut crowds: Vec<World> = sizes
        .iter()
        .map(|size| World::new(scene, Side::Ours, 1, *size, steps(100)))
        .collect();
    measure_in_turns(&mut crowds, repeats.min(3))?;
    let small = crowds[0].work();
    for crowd in &crowds {
        let (n, us) = (crowd.options.characters, crowd.work());
        println!("scale {scene} n={n} us={us:.2}");
        if n != SIZES[0] {
            let what = format!("cost in a crowd of {n}, of one in {}", SIZES[0]);
            checks.push(Check::timing(what, us / small, Must::BeAtMost, GROWTH));
        }
    }

    let mut idle = [World::new("idle", Side::Ours, 1, 1000, steps(500))];
    measure_in_turns(&mut idle, repeats)?;
    println!("idle {scene} us={:.3}", idle[0].work());
    checks.push(Check::timing(
        "idle character, microseconds",
        idle[0].work(),
        Must::BeBelow,
        IDLE,
    ));

    if options.quick {
        println!("quick run: its times mean nothing");
    }
    for check in checks
        .iter()
        .filter(|check| !(options.quick && check.timing))
    {
        println!("{check}");
    }
    let worlds: Vec<&World> = sides.iter().chain(&crowds).chain(&idle).collect();
    if let Some(folder) = &options.out {
        write_out(folder, &worlds, &checks)
            .map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    if let Some(file) = &options.readme {
        readme::replace_table(file, &table(&sides, &crowds, &idle[0], repeats))?;
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

/// Results as lines of JSON, and every tick of every run as CSV.
fn write_out(folder: &Path, worlds: &[&World], checks: &[Check]) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut lines = String::new();
    let mut ticks = String::from(
        "scene,side,threads,characters,run,tick,wall_ns,busy_ns,update_ns,allocations\n",
    );
    for world in worlds {
        let o = &world.options;
        let line = Line {
            scene: o.scene.clone(),
            side: o.only,
            threads: o.threads,
            characters: o.characters,
            us_per_character: world.work(),
            us_per_update: world.whole(),
            allocations_per_tick: world.allocations(),
            hash: format!("{:016x}", world.runs.first().map_or(0, |run| run.hash)),
        };
        lines += &serde_json::to_string(&line)?;
        lines.push('\n');
        for (r, run) in world.runs.iter().enumerate() {
            for (i, wall) in run.wall.iter().enumerate() {
                ticks += &format!(
                    "{},{},{},{},{r},{i},{wall},{},{},{}\n",
                    o.scene,
                    o.only.name(),
                    o.threads,
                    o.characters,
                    run.busy[i],
                    run.whole[i],
                    run.allocations[i],
                );
            }
        }
    }
    for check in checks {
        lines += &serde_json::to_string(check)?;
        lines.push('\n');
    }
    fs::write(folder.join("peers.jsonl"), lines)?;
    fs::write(folder.join("peers_ticks.csv"), ticks)
}

/// The table of the README.
fn table(sides: &[World], crowds: &[World], idle: &World, repeats: usize) -> String {
    let mut table = String::from(
        "| per character and tick | `bevy_embody` | Rapier's controller | ratio |\n|---|---|---|---|\n",
    );
    for pair in sides.chunks_exact(2) {
        let threads = match pair[0].options.threads {
            1 => "one thread".to_owned(),
            n => format!("{n} threads"),
        };
        let (ours, rapier) = (pair[0].work(), pair[1].work());
        table += &format!(
            "| {threads} | {ours:.1} µs | {rapier:.1} µs | {:.3} |\n",
            ours / rapier
        );
    }
    for crowd in &crowds[1..] {
        table += &format!(
            "| in a crowd of {}, one thread | {:.1} µs | | |\n",
            crowd.options.characters,
            crowd.work(),
        );
    }
    table += &format!("| idle | {:.2} µs | | |\n", idle.work());
    table += &format!(
        "\nHeap allocations per tick after warm-up: {}. The state after {} ticks is the same, bit for bit, on one thread and two.\n\
         What is timed is the characters' work alone: all our systems; for Rapier its controller's system and\n\
         the game's gravity. A whole update of the app, physics step included, on one thread: {:.1} ms and {:.1} ms.\n\
         Medians of {repeats} runs in turns on {}.\n",
        short(sides[0].allocations()),
        sides[0].options.steps,
        sides[0].whole() * 1e-3,
        sides[1].whole() * 1e-3,
        machine(),
    );
    table
}

/// A number without needless digits.
fn short(value: f64) -> String {
    let digits = format!("{value:.4}");
    digits
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}

/// What the figures were measured on.
fn machine() -> String {
    let model = fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|info| {
            let line = info.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| "an unknown processor".to_owned());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{cores} cores of {model}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lose_their_needless_digits() {
        assert_eq!(short(0.0), "0");
        assert_eq!(short(0.0125), "0.0125");
        assert_eq!(short(10.0), "10");
    }
}
