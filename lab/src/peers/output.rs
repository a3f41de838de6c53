//! Results as files and as the table of the README.

use std::{fs, path::Path};

use serde::Serialize;

use super::{Results, World, pairs, shared_speed_up, speed_ups};
use crate::{bounds::Check, side::Side, subject::Subject};

/// One line of results.
#[derive(Serialize)]
struct Line {
    scene: String,
    side: Side,
    threads: usize,
    count: u32,
    us_each: f64,
    us_per_update: f64,
    allocations_per_tick: f64,
    hash: String,
}

/// Results as lines of JSON, and every tick of every run as CSV.
pub fn write_out(folder: &Path, worlds: &[&World], checks: &[Check]) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut lines = String::new();
    let mut ticks =
        String::from("scene,side,threads,count,run,tick,wall_ns,busy_ns,update_ns,allocations\n");
    for world in worlds {
        let o = &world.options;
        let line = Line {
            scene: o.scene.clone(),
            side: o.only,
            threads: o.threads,
            count: o.count,
            us_each: world.work(),
            us_per_update: world.whole(),
            allocations_per_tick: world.allocations(),
            hash: format!("{:016x}", world.hash()),
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
                    o.count,
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
pub fn table(subject: &Subject, results: &Results, repeats: usize) -> String {
    let mut table = format!(
        "| per {} and tick | `bevy_embody` | Rapier's controller | ratio |\n|---|---|---|---|\n",
        subject.one
    );
    for worlds in &results.sides {
        for (compared, own, peer) in pairs(subject, worlds) {
            let threads = match own.options.threads {
                1 => "one thread".to_owned(),
                n => format!("{n} threads"),
            };
            let comma = if compared.label.is_empty() { "" } else { ", " };
            let (ours, rapier) = (own.work(), peer.work());
            table += &format!(
                "| {}{comma}{threads} | {ours:.1} µs | {rapier:.1} µs | {} |\n",
                compared.label,
                ratio(ours / rapier)
            );
        }
    }
    for crowd in &results.crowds {
        if crowd.options.count != subject.count {
            table += &format!(
                "| one of {}, one thread | {:.1} µs | | |\n",
                crowd.options.count,
                crowd.work(),
            );
        }
    }
    for (variant, world) in subject.variants.iter().zip(&results.variants) {
        let work = world.work();
        let digits = if work < 1.0 { 2 } else { 1 };
        table += &format!("| {} | {work:.digits$} µs | | |\n", variant.label);
    }
    let Some((rapier, ours @ [first, ..])) = results.sides.first().and_then(|w| w.split_last())
    else {
        return table;
    };
    let mut speed_ups = listed(
        speed_ups(subject, &results.sides)
            .map(|(compared, factor)| (compared.label, format!("{factor:.2}"))),
    );
    if let Some(crowd) = results.shared.as_ref().map(|w| w.options.count)
        && crowd != subject.count
        && let Some(factor) = shared_speed_up(results)
    {
        speed_ups += &format!(", {factor:.2} ({crowd} of them)");
    }
    let of_each = |tell: fn(&World) -> String| {
        let all = subject.compared.iter().zip(ours);
        listed(all.map(|(compared, world)| (compared.label, tell(world))))
    };
    table += &format!(
        "\nThere are {} {}. A second thread makes them faster by {}. Heap allocations per tick after warm-up: {}. The state after {} ticks is the same, bit for bit,\n\
         on one thread and two. {}\n\
         A whole update of the app, physics step included, on one thread: {}, Rapier's controller {:.1} ms.\n\
         Medians of {repeats} runs in turns on {}.\n",
        subject.count,
        subject.name,
        speed_ups,
        of_each(|world| short(world.allocations())),
        first.options.steps,
        subject.counted,
        of_each(|world| format!("{:.1} ms", world.whole() * 1e-3)),
        rapier.whole() * 1e-3,
        machine(),
    );
    table
}

/// Values one after another, each with what it is of where that has a name.
fn listed<'a>(all: impl Iterator<Item = (&'a str, String)>) -> String {
    let named: Vec<String> = all
        .map(|(label, value)| {
            if label.is_empty() {
                value
            } else {
                format!("{value} ({label})")
            }
        })
        .collect();
    named.join(", ")
}

/// A ratio to three digits.
pub fn ratio(value: f64) -> String {
    let digits = if value < 1.0 { 3 } else { 2 };
    format!("{value:.digits$}")
}

/// A number without needless digits.
pub fn short(value: f64) -> String {
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

    #[test]
    fn every_compared_kind_is_told_by_its_name() {
        let two = [("rays", "1".to_owned()), ("cylinders", "2".to_owned())];
        assert_eq!(listed(two.into_iter()), "1 (rays), 2 (cylinders)");
        assert_eq!(listed([("", "3".to_owned())].into_iter()), "3");
    }

    #[test]
    fn ratios_have_three_digits() {
        assert_eq!(ratio(0.0651), "0.065");
        assert_eq!(ratio(3.0512), "3.05");
    }
}
