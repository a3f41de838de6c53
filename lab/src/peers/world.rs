//! One kind of world and what all its runs measured.

use std::time::Instant;

use crate::{
    process,
    run::{self, Measured},
    side::Side,
    stats::typical,
};

pub struct World {
    pub options: run::Options,
    pub runs: Vec<Measured>,
}

impl World {
    pub fn new(scene: &str, only: Side, threads: usize, count: u32, steps: usize) -> Self {
        Self {
            options: run::Options {
                scene: scene.to_owned(),
                only,
                threads,
                count,
                steps,
                warm_up: None,
                json: true,
            },
            runs: Vec::new(),
        }
    }

    /// The controllers' work, microseconds for each and tick. On one thread it is the time on a
    /// processor, which other programs cannot add to; on several the time that passed.
    pub fn work(&self) -> f64 {
        match self.options.threads {
            1 => self.typical(|run| &run.busy) / f64::from(self.options.count),
            _ => self.wall(),
        }
    }

    /// The time that passed during the controllers' work, microseconds for each and tick.
    pub fn wall(&self) -> f64 {
        self.typical(|run| &run.wall) / f64::from(self.options.count)
    }

    /// An update of the app, microseconds.
    pub fn whole(&self) -> f64 {
        self.typical(|run| &run.whole)
    }

    fn typical(&self, of: impl Fn(&Measured) -> &[u64]) -> f64 {
        let runs: Vec<&[u64]> = self.runs.iter().map(of).collect();
        typical(&runs) * 1e-3
    }

    /// The most allocations of a run, per tick.
    pub fn allocations(&self) -> f64 {
        let most = self
            .runs
            .iter()
            .map(|run| run.allocations.iter().sum::<u64>())
            .max();
        most.map_or(f64::NAN, |most| most as f64 / self.options.steps as f64)
    }

    /// State in the end of the first run.
    pub fn hash(&self) -> u64 {
        self.runs.first().map_or(0, |run| run.hash)
    }

    /// The most that were lost in a run.
    pub fn lost(&self) -> usize {
        let lost = self.runs.iter().map(|run| run.lost.len());
        lost.max().unwrap_or(0)
    }
}

/// Runs worlds in turns and tells how far it got.
pub struct Turns<'a> {
    /// Command that every world is run by.
    pub under: &'a [String],
    pub started: Instant,
}

impl Turns<'_> {
    /// Runs every world as often as `repeats` says of it.
    pub fn measure(
        &self,
        worlds: &mut [World],
        repeats: impl Fn(&World) -> usize,
    ) -> Result<(), String> {
        let most = worlds.iter().map(&repeats).max().unwrap_or(0);
        for turn in 0..most {
            for i in 0..worlds.len() {
                // Every other turn backwards, so that none always comes first.
                let i = if turn % 2 == 0 {
                    i
                } else {
                    worlds.len() - 1 - i
                };
                let times = repeats(&worlds[i]);
                if turn >= times {
                    continue;
                }
                let options = &worlds[i].options;
                eprintln!(
                    "{:4.0} s: run {}/{times}: {} {} threads={} n={}",
                    self.started.elapsed().as_secs_f64(),
                    turn + 1,
                    options.scene,
                    options.only.name(),
                    options.threads,
                    options.count,
                );
                let measured = process::measure(options, self.under)?;
                worlds[i].runs.push(measured);
            }
        }
        Ok(())
    }
}
