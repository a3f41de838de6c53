//! Measures `bevy_embody`: cost beside its peers, at scale, at rest, on several threads.
//!
//! Every measured world runs in a fresh process of this binary, because Bevy's task pools belong to
//! the process. Worlds that are compared run in turns, several times. As every world is
//! deterministic, tick `i` does the same work in every repetition: its cost is the median over the
//! repetitions, and the cost of a world is the mean over its ticks. A burst of foreign load on the
//! machine then spoils single values, not the result.

#![expect(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool"
)]

mod accuracy;
mod alloc;
mod bounds;
mod options;
mod peer;
mod peers;
mod probe;
mod process;
mod readme;
mod run;
mod scene;
mod side;
mod stability;
mod stats;
mod subject;
mod table;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

#[derive(Parser)]
#[command(about = "Measures bevy_embody")]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Cost beside Rapier's own controller, speed-up by threads, scaling, idle cost, allocations.
    Peers(peers::Options),
    /// Where explicit integration breaks, and ours does not.
    Stability(options::Selection),
    /// What comes out beside closed forms, of ours and of Rapier's controller.
    Accuracy(options::Selection),
    /// Runs one world in this process, for a profiler or by hand.
    Profile(run::Options),
    /// Lists the scenes.
    Scenes,
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Peers(options) => peers::run(&options),
        Command::Stability(options) => stability::run(&options),
        Command::Accuracy(options) => accuracy::run(&options),
        Command::Profile(options) => run::run(&options).map(|()| ExitCode::SUCCESS),
        Command::Scenes => {
            for (_, scene) in subject::all_scenes() {
                println!("{:18} {}", scene.name, scene.about);
            }
            Ok(ExitCode::SUCCESS)
        }
    };
    outcome.unwrap_or_else(|error| {
        eprintln!("{error}");
        ExitCode::FAILURE
    })
}
