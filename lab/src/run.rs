//! One world, run and measured in this process.

use std::{collections::BTreeMap, time::Instant};

use bevy::{app::TaskPoolOptions, prelude::*};
use bevy_embody::EmbodyCorePlugin;
use clap::Args;
use embody_scenes::{Sim, terrain::StableId};
use serde::{Deserialize, Serialize};

use crate::{
    probe::{Probe, on_processor},
    side::Side,
    subject::{self, Joints, Subject},
};

/// Which world, and for how long.
#[derive(Args, Clone, Debug)]
pub struct Options {
    /// Name of the scene.
    #[arg(long, default_value = "characters")]
    pub scene: String,
    /// Whose controller.
    #[arg(long, value_enum, default_value = "ours")]
    pub only: Side,
    /// Threads that compute; on one, systems run one after another without an executor's threads.
    #[arg(long, default_value_t = 1)]
    pub threads: usize,
    /// How many.
    #[arg(long, default_value_t = 100)]
    pub count: u32,
    /// Ticks of 1/60 s that are measured.
    #[arg(long, default_value_t = 500)]
    pub steps: usize,
    /// Ticks before those; the scene's own number when left out.
    #[arg(long)]
    pub warm_up: Option<usize>,
    /// Prints everything as one line of JSON.
    #[arg(long)]
    pub json: bool,
}

/// What a world cost.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measured {
    /// The controllers' work, nanoseconds in each tick: time that passed.
    pub wall: Vec<u64>,
    /// The same, but time that the thread was on a processor; of meaning on one thread only.
    pub busy: Vec<u64>,
    /// A whole update of the app, nanoseconds in each tick; on one thread its time on a processor.
    pub whole: Vec<u64>,
    /// Heap allocations during the controllers' work, in each tick.
    pub allocations: Vec<u64>,
    /// Hash of where everything that moves is in the end.
    pub hash: u64,
    /// Mean level way in a tick, of what was wished for: shows that they do move.
    pub progress: f64,
    /// Fastest that anyone went, metres per second.
    pub fastest: f32,
    /// Who left the level: fell below the ground, was thrown high up, or fell over.
    pub lost: Vec<Lost>,
    /// The joints of figures.
    pub joints: Joints,
}

/// Where somebody was before and after it left the level.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Lost {
    pub id: u32,
    pub tick: usize,
    pub last: [f32; 3],
    pub at: [f32; 3],
}

/// Runs and prints.
pub fn run(options: &Options) -> Result<(), String> {
    let measured = measure(options)?;
    if options.json {
        let line = serde_json::to_string(&measured).map_err(|error| error.to_string())?;
        println!("{line}");
        return Ok(());
    }
    let mean = |of: &[u64]| of.iter().sum::<u64>() as f64 / of.len().max(1) as f64 * 1e-3;
    let n = f64::from(options.count.max(1));
    println!(
        "profile {} side={} threads={} n={} steps={} us={:.3} busy={:.3}us update={:.1}us allocations={} \
         progress={:.2} fastest={:.1}m/s lost={} hash={:016x}",
        options.scene,
        options.only.name(),
        options.threads,
        options.count,
        options.steps,
        mean(&measured.wall) / n,
        mean(&measured.busy) / n,
        mean(&measured.whole),
        measured.allocations.iter().sum::<u64>(),
        measured.progress,
        measured.fastest,
        measured.lost.len(),
        measured.hash,
    );
    if measured.joints.bodies > 0 {
        println!("{:?}", measured.joints);
    }
    for lost in &measured.lost {
        println!(
            "lost {} in tick {} from {:?} to {:?}",
            lost.id, lost.tick, lost.last, lost.at
        );
    }
    Ok(())
}

/// Builds the world and runs it.
pub fn measure(options: &Options) -> Result<Measured, String> {
    let (subject, scene) = subject::find_scene(&options.scene)?;
    if options.threads == 0 {
        return Err("there must be at least one thread".into());
    }
    create_pools(options.threads);
    let side = options.only;
    let plugin = move |app: &mut App| {
        app.init_resource::<Probe>();
        (subject.plugin)(app, side);
    };
    let mut sim = Sim::with(60.0, (EmbodyCorePlugin, plugin));
    (scene.build)(&mut sim, side, options.count);
    if options.threads == 1 {
        sim = sim.in_line();
    }
    sim.ticks(options.warm_up.unwrap_or(scene.warm_up));
    let mut measured = Measured {
        wall: Vec::with_capacity(options.steps),
        busy: Vec::with_capacity(options.steps),
        whole: Vec::with_capacity(options.steps),
        allocations: Vec::with_capacity(options.steps),
        hash: 0,
        progress: 0.0,
        fastest: 0.0,
        lost: Vec::new(),
        joints: Joints::default(),
    };
    let mut way = Way::default();
    sim.app.world_mut().resource_mut::<Probe>().take();
    let alone = options.threads == 1;
    for tick in 0..options.steps {
        let start = (Instant::now(), on_processor());
        sim.ticks(1);
        let whole = if alone {
            on_processor() - start.1
        } else {
            start.0.elapsed()
        };
        let spent = sim.app.world_mut().resource_mut::<Probe>().take();
        measured.whole.push(whole.as_nanos() as u64);
        measured.wall.push(spent.wall.as_nanos() as u64);
        measured.busy.push(spent.busy.as_nanos() as u64);
        measured.allocations.push(spent.allocations);
        way.follow(sim.app.world_mut(), subject, tick);
        if subject.together {
            let now = subject::joints(sim.app.world_mut());
            measured.joints.then(&now, tick + 1);
        }
    }
    measured.hash = hash(sim.app.world_mut());
    // Figures wish to go nowhere.
    if way.wished > 0.0 {
        measured.progress = way.went / way.wished;
    }
    measured.fastest = way.fastest;
    measured.lost = way.lost;
    Ok(measured)
}

/// Makes the task pools of this process before Bevy does.
fn create_pools(threads: usize) {
    let mut options = TaskPoolOptions::default();
    options.compute.min_threads = threads;
    options.compute.max_threads = threads;
    options.create_default_pools();
}

/// How far everyone got.
#[derive(Default)]
struct Way {
    last: BTreeMap<StableId, (Vec3, bool)>,
    went: f64,
    wished: f64,
    fastest: f32,
    lost: Vec<Lost>,
}

impl Way {
    fn follow(&mut self, world: &mut World, subject: &Subject, tick: usize) {
        for seen in (subject.watch)(world) {
            let at = seen.at;
            let well = seen.upright && subject.level.contains(&at.y);
            let Some((last, was_well)) = self.last.insert(seen.id, (at, well)) else {
                continue;
            };
            self.went += f64::from((at - last).with_y(0.0).length());
            self.wished += f64::from(seen.wished / 60.0);
            self.fastest = self.fastest.max((at - last).length() * 60.0);
            if !well && was_well {
                self.lost.push(Lost {
                    id: seen.id.0,
                    tick,
                    last: last.to_array(),
                    at: at.to_array(),
                });
            }
        }
    }
}

/// Bits of the poses of everything with a number, in the order of the numbers.
fn hash(world: &mut World) -> u64 {
    let mut poses: Vec<(StableId, Transform)> = world
        .query::<(&StableId, &Transform)>()
        .iter(world)
        .map(|(id, transform)| (*id, *transform))
        .collect();
    poses.sort_unstable_by_key(|(id, _)| *id);
    let bits = poses.iter().flat_map(|(id, transform)| {
        let (p, q) = (transform.translation, transform.rotation);
        let floats = [p.x, p.y, p.z, q.x, q.y, q.z, q.w];
        [id.0].into_iter().chain(floats.map(f32::to_bits))
    });
    // FNV-1a.
    bits.flat_map(u32::to_le_bytes)
        .fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3)
        })
}
